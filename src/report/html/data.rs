//! What the script of the page works on: numbers in SI and what is needed to show them in KES units.

use std::collections::BTreeMap;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::shapes::Shapes;
use crate::instrument::{Direction, Parameter, Test};
use crate::kes::TestSpec;
use crate::quantity::Curve;
use crate::report::number::unit_text;
use crate::report::population::Population;
use crate::report::table::{FabricRow, UnitSystem};

/// Most points of a branch on the page.
pub const POINTS: usize = 120;

/// The parameters that nearly every laboratory has: they come first, so that a table of fabrics from many sources does
/// not begin with columns of nothing.
const LEADING: [Parameter; 6] =
    [Parameter::W, Parameter::T0, Parameter::B, Parameter::Hb, Parameter::G, Parameter::Hg];

/// Everything that the script shows.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PageData {
    /// Columns of the table of parameters.
    pub columns: Vec<Column>,
    /// Its rows.
    pub fabrics: Vec<FabricValues>,
    /// Tests with curves, fabric by fabric.
    pub curves: Vec<TestCurves>,
    /// Deflected sheets, fabric by fabric.
    #[serde(skip_serializing_if = "Shapes::is_empty")]
    pub shapes: Shapes,
    /// What fabrics are compared with; none for the fabrics of the page themselves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub population: Option<Population>,
    /// How many fabrics the run has, where this page holds some of them only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fabrics_of_run: Option<usize>,
}

/// A parameter in a direction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Column {
    /// E.g. `2HB`, or `E secant` of a modulus.
    pub symbol: String,
    /// `warp`, `weft` or `bias`; `None` for the fabric as a whole.
    pub direction: Option<String>,
    /// The test it comes from; `weight` for the balance.
    pub test: &'static str,
    /// KES unit as printed.
    pub kes: String,
    /// SI value of one KES unit.
    pub factor: f64,
    /// SI unit as printed.
    pub si: String,
    /// Whether the hand equations of Kawabata (1980) take its logarithm; `None` if it is none of their 16 parameters.
    pub log: Option<bool>,
}

/// The values of a fabric.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FabricValues {
    /// Identifier.
    pub name: String,
    /// For people: title, weave, composition, origin.
    pub about: String,
    /// `measured`, `published` or `synthetic`; empty of a fabric of which nothing could be read.
    pub origin: String,
    /// How many of its inputs could not be read, and how many of its results could not be made.
    #[serde(skip_serializing_if = "is_zero")]
    pub failed: usize,
    /// Its values by their column.
    pub values: BTreeMap<usize, Value>,
}

/// Mean and spread of a parameter (SI).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Value {
    /// Mean over the repeats.
    pub mean: f64,
    /// Sample standard deviation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sd: Option<f64>,
    /// Number of repeats.
    pub n: u64,
    /// `measured`, `inferred`, `assumed` or `doubtful`.
    pub status: String,
}

/// The curves of one test of one fabric.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TestCurves {
    /// Place in [`PageData::fabrics`].
    pub fabric: usize,
    /// `tensile`, `shear`, `bending`, `compression`, `friction` or `roughness`.
    pub test: String,
    /// Abscissa and ordinate.
    pub axes: [AxisEntry; 2],
    /// Measured specimens.
    pub specimens: Vec<SpecimenCurves>,
    /// Simulated curves.
    pub simulated: Vec<SimulatedLine>,
}

/// How an axis is labelled.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AxisEntry {
    /// E.g. `Curvature K`.
    pub quantity: String,
    /// Unit and its SI value, in KES units.
    pub kes: (String, f64),
    /// The same in SI.
    pub si: (String, f64),
}

/// A measured specimen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpecimenCurves {
    /// `warp`, `weft` or `bias`.
    pub direction: Option<String>,
    /// Its number, from 1.
    pub specimen: usize,
    /// Branches in recorded order, thinned.
    pub branches: Vec<Polyline>,
    /// Windows of fits and readings: symbol, abscissae and ordinates of both ends.
    pub windows: Vec<(String, [f64; 2], [f64; 2])>,
}

/// A simulated curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimulatedLine {
    /// What made it.
    pub label: String,
    /// Name of its case.
    pub case: String,
    /// `warp`, `weft` or `bias`.
    pub direction: Option<String>,
    /// The curve.
    pub line: Polyline,
}

/// Points of a line (SI) to five significant digits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Polyline {
    /// Abscissae.
    pub x: Vec<f64>,
    /// Ordinates.
    pub y: Vec<f64>,
}

impl Polyline {
    /// At most [`POINTS`] points of a curve.
    pub fn of(curve: &Curve) -> Self {
        let thin = curve.thinned(POINTS);
        let short = |values: Vec<f64>| values.into_iter().map(shortened).collect();
        Self { x: short(thin.x), y: short(thin.y) }
    }
}

/// Five significant digits.
pub(crate) fn shortened(value: f64) -> f64 {
    f64::from_str(&format!("{value:.4e}")).unwrap_or(value)
}

impl AxisEntry {
    /// Both axes of a test.
    pub fn of(test: Test) -> [Self; 2] {
        let TestSpec { x, y, .. } = test.spec();
        [x, y].map(|axis| {
            let kes = (unit_text(axis.kes), axis.kes_factor());
            let si = axis.beside.map(|(unit, factor)| (unit.to_string(), factor));
            Self { quantity: axis.label.to_string(), si: si.unwrap_or_else(|| kes.clone()), kes }
        })
    }
}

impl PageData {
    /// The table of `rows` (SI) for the fabrics, yet without values; rows without a mean are none of a parameter.
    pub fn of_rows<'a>(
        fabrics: impl Iterator<Item = FabricValues>,
        rows: impl Iterator<Item = &'a FabricRow> + Clone,
    ) -> Self {
        let columns = columns(rows.clone());
        let place: BTreeMap<(&str, Option<&str>), usize> = columns
            .iter()
            .enumerate()
            .map(|(i, c)| ((c.symbol.as_str(), c.direction.as_deref()), i))
            .collect();
        let mut values: BTreeMap<&str, BTreeMap<usize, Value>> = BTreeMap::new();
        for row in rows {
            let column = place.get(&(row.parameter.as_str(), row.direction.as_deref()));
            if let Some((&column, mean)) = column.zip(row.mean) {
                let value = Value { mean, sd: row.sd, n: row.n, status: row.status.clone() };
                values.entry(&row.fabric).or_default().insert(column, value);
            }
        }
        let fabrics = fabrics.map(|fabric| {
            let values = values.get(fabric.name.as_str()).cloned().unwrap_or_default();
            FabricValues { values, ..fabric }
        });
        Self { fabrics: fabrics.collect(), columns, ..Self::default() }
    }

    /// The data as text for a `<script>` element of JSON: no `<` in it ends the element.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn json(&self) -> serde_json::Result<String> {
        Ok(serde_json::to_string(self)?.replace('<', "\\u003c"))
    }
}

/// What is not there is not written.
fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// The parameters and directions that occur: [`LEADING`], the other parameters in their order, then moduli.
fn columns<'a>(rows: impl Iterator<Item = &'a FabricRow>) -> Vec<Column> {
    let mut seen: Vec<((usize, String), Option<String>)> = rows
        .filter(|row| row.mean.is_some() && row.is_of_parameter())
        .map(|row| {
            let order = LEADING.iter().chain(Parameter::ALL).position(|p| p.symbol() == row.parameter);
            ((order.unwrap_or(usize::MAX), row.parameter.clone()), row.direction.clone())
        })
        .collect();
    seen.sort_by_key(|(parameter, direction)| (parameter.clone(), direction_order(direction.as_deref())));
    seen.dedup();
    seen.into_iter().map(|((_, symbol), direction)| column(symbol, direction)).collect()
}

fn direction_order(direction: Option<&str>) -> usize {
    Direction::ALL.iter().position(|d| Some(d.name()) == direction).unwrap_or(Direction::ALL.len())
}

fn column(symbol: String, direction: Option<String>) -> Column {
    let parameter = Parameter::from_symbol(&symbol);
    let (kes, factor) = parameter.map_or(UnitSystem::Kes.of_modulus(), |p| UnitSystem::Kes.of(p));
    let (si, _) = parameter.map_or(UnitSystem::Si.of_modulus(), |p| UnitSystem::Si.of(p));
    let test = parameter.map_or(Some(Test::Tensile), Parameter::test).map_or("weight", Test::name);
    let log = parameter.and_then(Parameter::takes_logarithm);
    Column { kes: unit_text(kes), si: unit_text(si), log, symbol, direction, test, factor }
}
