//! The claims of the paper of Nguyen-Trong, Ferreira and Gomes, each with the lines that hold it against a reference and with
//! the data of its pictures.

use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::error::VerifyError;
use super::line::Line;
use super::problem::VerifyProblem;
use super::problem::plate::{BentPlate, PlateProblem};
use super::problem::setting::Statics;
use super::suite::{Entry, with};
use crate::platform;

/// What the paper says, and how that came out.
#[derive(Clone, Debug)]
pub struct Claim {
    /// Name, one word.
    pub id: String,
    /// What it is about.
    pub title: String,
    /// Where in the paper.
    pub place: String,
    /// What is said there.
    pub says: String,
    /// What the lines show.
    pub found: String,
    /// Names of shipped cases that show it too.
    pub cases: Vec<String>,
    /// The lines; one that is known to be beyond its bound shows what does not hold.
    pub lines: Vec<Line>,
    /// Pictures of curves.
    pub charts: Vec<CurveChart>,
    /// Pictures of a sheet.
    pub sheets: Vec<SheetPicture>,
}

/// A picture of curves, not yet computed.
#[derive(Clone, Debug)]
pub struct CurveChart {
    /// Name of its file without the ending.
    pub stem: String,
    /// Headline.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    /// What is to the right.
    pub x: String,
    /// What is upwards.
    pub y: String,
    x_of: Abscissa,
    factor: f64,
    curves: Vec<CurveEntry>,
}

/// What the parameter of a curve is on the page.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Abscissa {
    /// Itself.
    #[default]
    Itself,
    /// Its binary logarithm.
    Log2,
    /// Its decimal logarithm.
    Log10,
}

impl Abscissa {
    fn at(self, value: f64) -> f64 {
        match self {
            Self::Itself => value,
            Self::Log2 => value.log2(),
            Self::Log10 => value.log10(),
        }
    }
}

/// A value over a parameter of a problem.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct CurveEntry {
    name: String,
    /// One key: the family; its value: the parameters.
    problem: Option<Table>,
    /// The value instead of a problem.
    constant: Option<f64>,
    /// Dotted path of the parameter.
    along: String,
    /// Values of the parameter.
    values: Vec<Value>,
}

/// A curve of a picture.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PaperCurve {
    /// What it is called.
    pub name: String,
    /// To the right and upwards.
    pub points: Vec<[f64; 2]>,
}

/// A picture of a bent sheet.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SheetPicture {
    /// Begin of the names of its files.
    pub stem: String,
    /// Headline.
    pub title: String,
    /// Second line.
    pub subtitle: String,
    problem: PlateProblem,
}

impl SheetPicture {
    /// The sheet.
    ///
    /// # Errors
    /// Those of the solve.
    pub fn bent(&self) -> Result<BentPlate, VerifyError> {
        self.problem.bent()
    }
}

impl CurveChart {
    /// Computes the curves.
    ///
    /// # Errors
    /// That of the first problem that has no value.
    pub fn computed(&self) -> Result<Vec<PaperCurve>, VerifyError> {
        self.curves.iter().map(|curve| self.curve(curve)).collect()
    }

    fn curve(&self, curve: &CurveEntry) -> Result<PaperCurve, VerifyError> {
        let points =
            platform::map(&curve.values, |value| Ok([self.x_of.at(number(value)), curve.at(value)?]));
        let points: Result<Vec<[f64; 2]>, VerifyError> = points.into_iter().collect();
        let scaled = points?.into_iter().map(|[x, y]| [x, self.factor * y]).collect();
        Ok(PaperCurve { name: curve.name.clone(), points: scaled })
    }
}

impl CurveEntry {
    /// The value for one of the parameter.
    fn at(&self, value: &Value) -> Result<f64, VerifyError> {
        if let Some(constant) = self.constant {
            return Ok(constant);
        }
        let problem = self.problem.clone().unwrap_or_default();
        let problem: VerifyProblem = with(&problem, &self.along, value)
            .try_into()
            .unwrap_or_else(|e| panic!("built-in claims: {}: {e}", self.name));
        Ok(problem.value(&mut Statics::default())?.0)
    }
}

fn number(value: &Value) -> f64 {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64)).unwrap_or(f64::NAN)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ClaimFile {
    claim: Vec<ClaimText>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ClaimText {
    id: String,
    title: String,
    place: String,
    says: String,
    found: String,
    cases: Vec<String>,
    line: Vec<Entry>,
    #[serde(default)]
    chart: Vec<ChartText>,
    #[serde(default)]
    sheet: Vec<SheetPicture>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ChartText {
    stem: String,
    title: String,
    subtitle: String,
    x: String,
    y: String,
    #[serde(default)]
    x_of: Abscissa,
    #[serde(default = "one")]
    factor: f64,
    curve: Vec<CurveEntry>,
}

fn one() -> f64 {
    1.0
}

/// Every claim, in the order of the file.
///
/// # Panics
/// Only if the file that is compiled into the program is malformed; a test reads it.
pub fn claims() -> Vec<Claim> {
    let file: ClaimFile = toml::from_str(include_str!("suite/paper.toml")).expect("built-in claims");
    file.claim.into_iter().map(ClaimText::claim).collect()
}

impl ClaimText {
    fn claim(self) -> Claim {
        Claim {
            id: self.id,
            title: self.title,
            place: self.place,
            says: self.says,
            found: self.found,
            cases: self.cases,
            lines: self.line.into_iter().flat_map(Entry::expand).collect(),
            charts: self.chart.into_iter().map(ChartText::chart).collect(),
            sheets: self.sheet,
        }
    }
}

impl ChartText {
    fn chart(self) -> CurveChart {
        let Self { stem, title, subtitle, x, y, x_of, factor, curve: curves } = self;
        CurveChart { stem, title, subtitle, x, y, x_of, factor, curves }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn the_claims_parse_and_no_id_is_given_twice() {
        let claims = claims();
        let lines: Vec<&Line> = claims.iter().flat_map(|claim| &claim.lines).collect();
        let ids: BTreeSet<&str> = lines.iter().map(|line| line.id.as_str()).collect();
        assert_eq!(ids.len(), lines.len());
        let claimed: BTreeSet<&str> = claims.iter().map(|claim| claim.id.as_str()).collect();
        assert_eq!(claimed.len(), claims.len());
        assert!(claims.iter().all(|claim| !claim.cases.is_empty()));
        // Every curve has a problem that can be read, or is a constant.
        for curve in claims.iter().flat_map(|claim| &claim.charts).flat_map(|chart| &chart.curves) {
            let Some(problem) = &curve.problem else {
                assert!(curve.constant.is_some(), "{}", curve.name);
                continue;
            };
            let read: Result<VerifyProblem, _> = with(problem, &curve.along, &curve.values[0]).try_into();
            assert!(read.is_ok(), "{}: {read:?}", curve.name);
        }
    }
}
