//! The population that the control chart of the page compares fabrics with: mean and SD of each parameter.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::table::FabricRow;
use crate::kes::{HAND, Parameter};
use crate::quantity::{Estimate, Unit};

/// Fabrics behind a mean and a standard deviation, at least.
pub const LEAST: usize = 3;

/// A population with its source.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Population {
    /// Where it comes from, as it is named in the chart.
    pub source: String,
    /// What is known of it, each parameter once.
    pub parameters: Vec<ReferenceParameter>,
}

/// Mean and standard deviation of a parameter over the fabrics of a population, in KES units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReferenceParameter {
    /// E.g. `2HB`; the mean of warp and weft where there are both.
    pub symbol: String,
    /// Whether mean and standard deviation are those of the decadic logarithm.
    pub log: bool,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
    /// Number of fabrics, where it is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub n: Option<u64>,
}

/// A parameter as it is written in a file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Written {
    /// `LT`, or `log B` where mean and SD are those of the decadic logarithm.
    pub parameter: String,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
    /// Number of fabrics.
    pub n: Option<u64>,
    /// Unit of the parameter; `1` of a pure number.
    pub unit: String,
}

/// What is wrong in a line of a file (0 if nobody knows which).
#[derive(Clone, Debug, PartialEq)]
pub struct PopulationError {
    /// The line, from 1.
    pub line: usize,
    /// What was found and what was expected.
    pub message: String,
}

impl ReferenceParameter {
    /// The parameter of a file, in KES units.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub fn of(written: &Written) -> Result<Self, String> {
        let name = written.parameter.trim();
        let (log, symbol) = match name.strip_prefix("log ") {
            Some(symbol) => (true, symbol.trim()),
            None => (false, name),
        };
        let known = Parameter::from_symbol(symbol).filter(|p| p.takes_logarithm().is_some());
        let Some(parameter) = known else {
            return Err(format!("`{name}` is none of the 16 parameters, such as `LT` or `log B`"));
        };
        let by = in_kes(parameter, &written.unit)?;
        if !(written.mean.is_finite() && written.sd.is_finite() && written.sd > 0.0) {
            return Err(format!(
                "`{name}` has mean {} and SD {}: an SD above 0 is expected",
                written.mean, written.sd
            ));
        }
        let (mean, sd) =
            if log { (written.mean + by.log10(), written.sd) } else { (written.mean * by, written.sd * by) };
        Ok(Self { symbol: parameter.symbol().into(), log, mean, sd, n: written.n })
    }
}

/// How many KES units one of a unit is.
fn in_kes(parameter: Parameter, unit: &str) -> Result<f64, String> {
    let (symbol, kes) = (parameter.symbol(), parameter.kes_unit());
    let text = unit.trim();
    if text == kes {
        return Ok(1.0);
    }
    let found = Unit::parse(text).map_err(|e| format!("`{symbol}`: {e}; its unit in KES is {kes}"))?;
    let expected = Unit::parse(parameter.si_unit()).map_err(|e| e.to_string())?;
    if found.dimension != expected.dimension {
        return Err(format!(
            "`{symbol}` in {text}, where a unit such as {kes} or {} was expected",
            parameter.si_unit()
        ));
    }
    Ok(found.factor / parameter.kes_factor())
}

/// The population of a table: columns `parameter`, `mean`, `sd`, `unit` and, if it is known, `n`; or the columns of
/// `fabrics.csv`, of which mean and SD over its fabrics are taken.
///
/// # Errors
/// The first line that is not understood, or that there are too few fabrics.
pub fn of_csv(bytes: &[u8], source: &str) -> Result<Population, PopulationError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
    let is_of_fabrics = reader.headers().map_err(|e| problem(&e))?.iter().any(|name| name == "fabric");
    if is_of_fabrics {
        let rows: Result<Vec<FabricRow>, csv::Error> = reader.deserialize().collect();
        let rows = rows.map_err(|e| problem(&e))?;
        return of_rows(&rows, source).map_err(|message| PopulationError { line: 0, message });
    }
    let mut written = Vec::new();
    for (at, row) in reader.deserialize::<Written>().enumerate() {
        written.push((at + 2, row.map_err(|e| problem(&e))?));
    }
    of_written(written.iter().map(|(line, row)| (*line, row)), source)
}

fn problem(error: &csv::Error) -> PopulationError {
    let line = error.position().map_or(1, |at| usize::try_from(at.line()).unwrap_or(0));
    PopulationError { line, message: error.to_string() }
}

/// The population of parameters as they are written, with the line of each.
///
/// # Errors
/// The first that cannot be used, or is there twice; or that there is none.
pub fn of_written<'w>(
    written: impl Iterator<Item = (usize, &'w Written)>,
    source: &str,
) -> Result<Population, PopulationError> {
    let mut parameters: Vec<ReferenceParameter> = Vec::new();
    for (line, row) in written {
        let reference = ReferenceParameter::of(row).map_err(|message| PopulationError { line, message })?;
        if parameters.iter().any(|known| known.symbol == reference.symbol) {
            let message = format!("`{}` is there twice", reference.symbol);
            return Err(PopulationError { line, message });
        }
        parameters.push(reference);
    }
    if parameters.is_empty() {
        return Err(PopulationError { line: 0, message: "there is no parameter in it".into() });
    }
    Ok(Population { source: source.into(), parameters })
}

/// The population of fabrics (SI): mean and SD of what the hand equations take, the mean of warp and weft, and its
/// logarithm where they take that.
fn of_rows(rows: &[FabricRow], source: &str) -> Result<Population, String> {
    let mut values: BTreeMap<(&str, &str), [Option<f64>; 3]> = BTreeMap::new();
    for row in rows {
        let at = ["warp", "weft"].iter().position(|d| row.direction.as_deref() == Some(*d));
        let at = match (at, row.direction.as_deref()) {
            (Some(at), _) => at,
            (None, None | Some("")) => 2,
            (None, Some(_)) => continue,
        };
        values.entry((&row.parameter, &row.fabric)).or_default()[at] = row.mean;
    }
    let parameters = HAND.iter().filter_map(|&(parameter, log)| {
        let of_fabrics = values.iter().filter(|((symbol, _), _)| *symbol == parameter.symbol());
        let means = of_fabrics.filter_map(|(_, [warp, weft, whole])| match (warp, weft) {
            (Some(warp), Some(weft)) => Some(0.5 * (warp + weft)),
            _ => *whole,
        });
        let in_kes = means.map(|mean| mean / parameter.kes_factor()).filter(|mean| !log || *mean > 0.0);
        let shown: Vec<f64> = in_kes.map(|mean| if log { mean.log10() } else { mean }).collect();
        let estimate = Estimate::of(&shown).filter(|_| shown.len() >= LEAST)?;
        let sd = estimate.sd.filter(|sd| *sd > 1e-9 * estimate.mean.abs())?;
        let n = Some(shown.len() as u64);
        Some(ReferenceParameter { symbol: parameter.symbol().into(), log, mean: estimate.mean, sd, n })
    });
    let parameters: Vec<ReferenceParameter> = parameters.collect();
    if parameters.is_empty() {
        return Err(format!("no parameter has different values of {LEAST} fabrics"));
    }
    Ok(Population { source: source.into(), parameters })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_deviations_are_brought_to_kes_units() {
        let table =
            "parameter,mean,sd,n,unit\nlog B,-1,0.2,212,gf·cm²/cm\nLT,0.6,0.05,,1\nlog W,-1,0.1,9,kg/m²\n";
        let found = of_csv(table.as_bytes(), "own").unwrap();
        let by = |symbol: &str| found.parameters.iter().find(|p| p.symbol == symbol).unwrap().clone();
        assert_eq!((by("B").mean, by("B").sd, by("B").n, by("B").log), (-1.0, 0.2, Some(212), true));
        assert_eq!((by("LT").mean, by("LT").log, by("LT").n), (0.6, false, None));
        // One kg/m² is 100 mg/cm²: the logarithm is larger by 2, its deviation the same.
        assert!((by("W").mean - 1.0).abs() < 1e-12 && by("W").sd == 0.1);
    }

    #[test]
    fn what_cannot_be_used_is_told_with_its_line() {
        let refusal =
            |lines: &str| of_csv(format!("parameter,mean,sd,unit\n{lines}").as_bytes(), "").unwrap_err();
        assert_eq!(refusal("LT,0.6,0.05,1\nZZ,1,1,1\n").line, 3);
        assert!(refusal("ZZ,1,1,1\n").message.contains("`ZZ` is none of the 16 parameters"));
        assert!(refusal("LT,0.6,0,1\n").message.contains("an SD above 0 is expected"));
        assert!(
            refusal("B,0.6,0.1,mm\n").message.contains("`B` in mm, where a unit such as gf·cm²/cm or N·m")
        );
        assert!(refusal("LT,0.6,0.1,1\nLT,0.6,0.1,1\n").message.contains("`LT` is there twice"));
        assert_eq!(refusal("LT,0.6,x,1\n").line, 2);
        assert!(refusal("").message.contains("no parameter"));
    }

    #[test]
    fn fabrics_of_a_run_are_a_population() {
        let row = |fabric: &str, direction: &str, mean: f64| {
            format!("{fabric},B,{direction},{mean},,3,N·m,measured,,\n")
        };
        let b = 9.80665e-5;
        let lines: String = [("a", 0.01), ("b", 0.1), ("c", 1.0)]
            .iter()
            .map(|(fabric, mean)| row(fabric, "warp", 0.5 * mean * b) + &row(fabric, "weft", 1.5 * mean * b))
            .collect();
        let table = format!("fabric,parameter,direction,mean,sd,n,unit,status,cv,ci95\n{lines}");
        let found = of_csv(table.as_bytes(), "own").unwrap();
        let [b] = &found.parameters[..] else { panic!("{found:?}") };
        // log10 of 0.01, 0.1, 1 gf·cm²/cm.
        assert!((b.mean + 1.0).abs() < 1e-9 && (b.sd - 1.0).abs() < 1e-9 && b.n == Some(3) && b.log, "{b:?}");
        let two = of_csv(table.replace("c,B", "b,B").as_bytes(), "own").unwrap_err();
        assert!(two.message.contains("3 fabrics"), "{two:?}");
    }
}
