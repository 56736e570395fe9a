//! A simulated KES test beside its measurement: rows, document, charts and text.

mod text;

pub(super) use text::text;

use std::borrow::Cow;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::failure::Failure;
use super::folder::Folder;
use super::rests_on::{self, Ground};
use super::sampled::{self, SamplingEntry};
use super::task::Task;
use crate::characterise::{FabricSheet, Modulus, ValueStatus};
use crate::instrument::{Direction, Parameter, Test};
use crate::kes::StiffnessSpec;
use crate::law::Mode;
use crate::quantity::{Band, Curve, Estimate};
use crate::report::chart::{self, ParityPoint, SimulatedCurve};
use crate::report::html::{Figure, FigureKind};
use crate::report::number::counted;
use crate::report::table::{PredictionRow, relative_error};
use crate::study::{
    Case, Comparison, EdgeEffect, Prediction, VirtualCurve, VirtualLoop, compare_curves, measured_curve,
};

/// A simulated test with what was measured.
#[derive(Clone, Debug)]
pub struct Tested {
    /// E.g. `bending warp`.
    pub name: String,
    /// Name of its case.
    pub case: String,
    /// The simulated curve over the measured range.
    pub curve: Curve,
    /// The simulated test.
    pub simulated: VirtualCurve,
    /// The distance from the measured curves, where there are any.
    pub comparison: Option<Comparison>,
    /// The stiffness that the test is meant to measure; none of compression.
    pub stiffness: Option<Stiffness>,
    /// What the simulated curve rests on that is not to be relied on: a stand-in of the section, a doubtful stiffness.
    pub(super) grounds: Vec<Ground>,
}

/// The stiffness that a test measures.
#[derive(Clone, Debug)]
pub struct Stiffness {
    /// `E`, `G` or `B`.
    pub symbol: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// The estimate in the sheet.
    pub measured: Option<Estimate>,
    /// Whether the sheet has it for warp and weft together only.
    pub is_of_both: bool,
}

impl Tested {
    /// A simulated test beside the sheet of its fabric.
    pub(super) fn new(task: &Task, sheet: &FabricSheet, simulated: VirtualCurve) -> Self {
        let case = task.case;
        let (test, direction) = (simulated.test, simulated.direction);
        let [from, to] = abscissae(sheet, test, direction);
        let curve = if from < to { simulated.curve(from, to) } else { Curve::default() };
        let name = match direction {
            Some(direction) => format!("{} {direction}", test.name()),
            None => test.name().to_string(),
        };
        let stiffness = stiffness(case, sheet, test, direction);
        Self {
            name,
            case: case.name.clone(),
            curve,
            comparison: compare_curves(sheet, &simulated),
            grounds: grounds(task, stiffness.as_ref(), &simulated),
            stiffness,
            simulated,
        }
    }

    /// `, on an assumed E and a doubtful B warp`, with the words before it; nothing where all was measured.
    pub(super) fn rests_on(&self, before: &str) -> String {
        let weak = self.grounds.iter().filter(|ground| ground.status != ValueStatus::Measured);
        let text = rests_on::joined(weak);
        if text.is_empty() { text } else { format!("{before}{text}") }
    }

    fn direction(&self) -> &'static str {
        self.simulated.direction.map_or("", Direction::name)
    }

    /// The 95 % band of the simulated stiffness for the mean fabric.
    fn band(&self) -> Option<Band> {
        self.simulated.uncertainty.as_ref().and_then(|u| u.bands).map(|b| b.mean_fabric)
    }
}

/// What a simulated test along a direction rests on that is not to be relied on.
fn grounds(task: &Task, stiffness: Option<&Stiffness>, simulated: &VirtualCurve) -> Vec<Ground> {
    let (along, known) = (simulated.direction.map_or("", Direction::name), rests_on::known(task));
    let of_cycle = simulated.cycle.iter().flat_map(|cycle| cycle.values.keys());
    let symbols = stiffness.iter().map(|s| s.symbol).chain(of_cycle.map(|parameter| parameter.symbol()));
    rests_on::each_once(symbols.flat_map(|symbol| rests_on::grounds(&known, &format!("{symbol} {along}"))))
}

/// Where a simulated curve begins and ends: as the measured one, or as the instrument goes.
fn abscissae(sheet: &FabricSheet, test: Test, direction: Option<Direction>) -> [f64; 2] {
    let measured = measured_curve(sheet, test, direction);
    if measured.len() > 1 {
        let least = measured.x.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = measured.x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        return [least, greatest];
    }
    test.spec().range
}

fn stiffness(
    case: &Case,
    sheet: &FabricSheet,
    test: Test,
    direction: Option<Direction>,
) -> Option<Stiffness> {
    let StiffnessSpec { symbol, unit, parameter, .. } = *test.spec().stiffness.as_ref()?;
    let Some(parameter) = parameter else {
        let name = case.assumptions().map_or(Modulus::TangentLow, |a| a.modulus).name();
        let measured = direction.and_then(|d| sheet.moduli.get(&(name, d)).cloned());
        return Some(Stiffness { symbol, unit, measured, is_of_both: false });
    };
    let own = sheet.get(parameter, direction);
    let of_fabric = sheet.get(parameter, None);
    let (measured, is_of_both) = (own.or(of_fabric).cloned(), own.is_none() && of_fabric.is_some());
    Some(Stiffness { symbol, unit, measured, is_of_both })
}

/// An entry of `kesf.comparison/1`: a simulated KES test.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct TestEntry {
    name: String,
    case: String,
    fabric: Option<String>,
    rmse: Option<f64>,
    nrmse: Option<f64>,
    r2: Option<f64>,
    n: usize,
    unit: Option<Cow<'static, str>>,
    stiffness: Option<StiffnessEntry>,
    edge_effect: Option<EdgeEffect>,
    unstable_from: Option<f64>,
    cycle: Option<IndexMap<Cow<'static, str>, CycleEntry>>,
    uncertainty: Option<SamplingEntry>,
    x: Option<Vec<f64>>,
    simulated: Option<Vec<f64>>,
    measured: Option<Vec<f64>>,
    /// Origin of the data of the fabric: `measured`, `published` or `synthetic`.
    #[serde(default)]
    origin: Option<String>,
    /// What the simulated stiffness rests on that is not to be relied on.
    #[serde(default)]
    rests_on: Vec<Ground>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct StiffnessEntry {
    symbol: Cow<'static, str>,
    unit: Cow<'static, str>,
    simulated: f64,
    mean_fabric: Option<Band>,
    next_specimen: Option<Band>,
    without_spread: Option<Vec<String>>,
    measured: Option<f64>,
    sd: Option<f64>,
}

/// A parameter of a simulated cycle beside the measured one (SI).
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct CycleEntry {
    simulated: f64,
    measured: Option<f64>,
    unit: Cow<'static, str>,
}

/// The entry of a document.
pub(super) fn entry(task: &Task, t: &Tested) -> TestEntry {
    let c = t.comparison.as_ref();
    TestEntry {
        name: t.name.clone(),
        case: task.case.name.clone(),
        fabric: task.fabric_name().map(str::to_string),
        rmse: c.map(|c| c.rmse),
        nrmse: c.map(|c| c.nrmse),
        r2: c.map(|c| c.r2),
        n: c.map_or(0, |c| c.n),
        unit: c.map(|c| c.unit.into()),
        stiffness: t.stiffness.as_ref().map(|stiffness| stiffness_entry(stiffness, &t.simulated)),
        edge_effect: t.simulated.edge.clone(),
        unstable_from: t.simulated.unstable_from,
        cycle: t.simulated.cycle.as_ref().map(|cycle| cycle_entries(task, cycle)),
        uncertainty: task.sampling().map(|s| SamplingEntry::ending_with(s, t.direction())),
        x: c.map(|c| c.measured.x.clone()),
        simulated: c.map(|c| c.simulated.y.clone()),
        measured: c.map(|c| c.measured.y.clone()),
        origin: task.origin_name(),
        rests_on: t.grounds.clone(),
    }
}

fn stiffness_entry(stiffness: &Stiffness, simulated: &VirtualCurve) -> StiffnessEntry {
    let prediction: Option<&Prediction> = simulated.uncertainty.as_ref();
    let bands = prediction.and_then(|p| p.bands);
    let measured = stiffness.measured.as_ref();
    StiffnessEntry {
        symbol: stiffness.symbol.into(),
        unit: stiffness.unit.into(),
        simulated: simulated.apparent,
        mean_fabric: bands.map(|b| b.mean_fabric),
        next_specimen: bands.map(|b| b.next_specimen),
        without_spread: prediction.map(|p| p.without_spread.clone()),
        measured: measured.map(|e| e.mean),
        sd: measured.and_then(|e| e.sd),
    }
}

/// By symbol, in the order of the parameters.
fn cycle_entries(task: &Task, cycle: &VirtualLoop) -> IndexMap<Cow<'static, str>, CycleEntry> {
    let entry = |(parameter, simulated): (&Parameter, &f64)| {
        let measured = task.measured(*parameter, Some(cycle.direction));
        let unit = parameter.si_unit().into();
        (parameter.symbol().into(), CycleEntry { simulated: *simulated, measured, unit })
    };
    cycle.values.iter().map(entry).collect()
}

/// Rows of `predictions.csv`: the stiffness, or what the cycle of a sheet with friction gives (its elastic part alone
/// is that of the case without friction).
pub(super) fn rows(task: &Task, t: &Tested) -> Vec<PredictionRow> {
    if let Some(cycle) = &t.simulated.cycle {
        return cycle
            .values
            .iter()
            .map(|(parameter, value)| cycle_row(task, t, *parameter, *value))
            .collect();
    }
    let Some(Stiffness { symbol, unit, measured, .. }) = &t.stiffness else { return Vec::new() };
    let (simulated, band) = (t.simulated.apparent, t.band());
    let mean = measured.as_ref().map(|e| e.mean);
    vec![PredictionRow {
        quantity: format!("{symbol} {}", t.direction()),
        simulated: Some(simulated),
        measured: mean,
        unit: (*unit).into(),
        error: mean.and_then(|m| relative_error(simulated, m)),
        simulated_low: band.map(|b| simulated - b.half_width),
        simulated_high: band.map(|b| simulated + b.half_width),
        ..task.row()
    }]
}

fn cycle_row(task: &Task, t: &Tested, parameter: Parameter, value: f64) -> PredictionRow {
    let measured = task.measured(parameter, t.simulated.direction);
    PredictionRow {
        quantity: format!("{parameter} {}", t.direction()),
        simulated: Some(value),
        measured,
        unit: parameter.si_unit().into(),
        error: measured.and_then(|m| relative_error(value, m)),
        ..task.row()
    }
}

/// Points of the chart of simulated against measured stiffness, one a direction; one alone where the measured value is that
/// of warp and weft together.
pub(super) fn parity_points(task: &Task, tested: &[Tested]) -> Vec<ParityPoint> {
    let is_of_both = |t: &Tested| t.stiffness.as_ref().is_some_and(|stiffness| stiffness.is_of_both);
    let is_first = |at: usize| !tested[..at].iter().any(is_of_both);
    let counted = tested.iter().enumerate().filter(|(at, t)| !is_of_both(t) || is_first(*at));
    counted.filter_map(|(_, t)| parity_point(task, t)).collect()
}

fn parity_point(task: &Task, t: &Tested) -> Option<ParityPoint> {
    let stiffness = t.stiffness.as_ref().filter(|_| t.simulated.cycle.is_none())?;
    let measured = stiffness.measured.as_ref()?;
    let quantity = match stiffness.symbol {
        "E" => "Tensile stiffness",
        "G" => "Shear stiffness G",
        _ => "Bending rigidity B",
    };
    Some(ParityPoint {
        label: task.fabric_name().unwrap_or_default().into(),
        group: format!("{}, {}", if stiffness.is_of_both { "both" } else { t.direction() }, task.origin()),
        quantity: quantity.into(),
        unit: stiffness.unit.into(),
        measured: measured.mean,
        measured_half_width: measured.ci95(),
        simulated: t.simulated.apparent,
        simulated_half_width: t.band().map(|b| b.half_width),
        simulated_band: None,
        is_closed_loop: true,
        status: rests_on::status(&t.grounds),
    })
}

/// Writes the chart `<fabric>/<case>`, the simulated curves on the measured ones; its name, if there is one.
pub(super) fn write_chart(
    task: &Task,
    tested: &[Tested],
    folder: &Folder,
) -> Result<Option<String>, Failure> {
    let (Some(sheet), Some(first)) = (task.fabric, tested.first()) else { return Ok(None) };
    let test = first.simulated.test;
    let curves = curves(Some(task), tested.iter(), test);
    folder.chart(&task.stem(), || chart::of_test(sheet, test, &curves))
}

/// Writes the charts `<fabric>/tensile` ..., with the simulated curves of its cases on top; those that there are. Cycles
/// with friction have charts of their own.
pub(super) fn write_fabric_charts(
    sheet: &FabricSheet,
    tested: &[Tested],
    folder: &Folder,
) -> Result<Vec<Figure>, Failure> {
    let mut drawn = Vec::new();
    for test in Test::ALL {
        let curves = curves(None, tested.iter().filter(|t| t.simulated.cycle.is_none()), test);
        let stem = format!("{}/{}", sheet.name, test.name());
        if let Some(picture) = folder.chart(&stem, || chart::of_test(sheet, test, &curves))? {
            let specimens = sheet.specimens.iter().filter(|s| s.measurement.test == test).count();
            let alt = format!(
                "Chart of the {} test of {}: {} and {}.",
                test.name(),
                sheet.name,
                counted(specimens, "measured specimen"),
                counted(curves.len(), "simulated curve")
            );
            drawn.push(Figure { caption: test.name().into(), alt, picture, kind: FigureKind::Test });
        }
    }
    Ok(drawn)
}

/// With the bands of the parameters of a cycle, where the task is named.
fn curves<'a>(
    task: Option<&Task>,
    tested: impl Iterator<Item = &'a Tested>,
    test: Test,
) -> Vec<SimulatedCurve> {
    tested.filter(|t| t.simulated.test == test && !t.curve.is_empty()).map(|t| curve(task, t)).collect()
}

fn curve(task: Option<&Task>, t: &Tested) -> SimulatedCurve {
    let label = match t.simulated.cycle.as_ref().map(|c| c.mode) {
        None => "simulated",
        Some(Mode::Virgin) => "first loading with friction",
        Some(Mode::Elastic | Mode::Friction) => "with friction",
    };
    let comparison = t.comparison.as_ref();
    SimulatedCurve {
        label: format!("{label}{}", t.rests_on(", on ")),
        direction: t.simulated.direction,
        curve: t.curve.clone(),
        rmse: comparison.map(|c| c.rmse),
        nrmse: comparison.map(|c| c.nrmse),
        r2: comparison.map(|c| c.r2).filter(|r| r.is_finite()),
        band: edges(t),
        bands: task.map_or_else(Vec::new, |task| sampled_values(task, t)),
        repeats: t.simulated.repeats(),
    }
}

/// The bands of the parameters of a cycle for the mean fabric, in KES units.
fn sampled_values(task: &Task, t: &Tested) -> Vec<(String, String)> {
    let Some((cycle, sampling)) = t.simulated.cycle.as_ref().zip(task.sampling()) else { return Vec::new() };
    let mut values = Vec::new();
    for parameter in cycle.values.keys() {
        let band = sampling.of(&format!("{parameter} {}", cycle.direction)).and_then(|q| q.mean_fabric);
        if band.is_some() {
            values.push((parameter.to_string(), sampled::interval(band, parameter.kes_factor())));
        }
    }
    values
}

/// Both edges of the band of a simulated curve, where it has one at every point.
fn edges(t: &Tested) -> Option<[Curve; 2]> {
    Some([edge(t, -1.0)?, edge(t, 1.0)?])
}

fn edge(t: &Tested, sign: f64) -> Option<Curve> {
    let at = |(x, y): (f64, f64)| Some((x, y + sign * t.simulated.band(x)?.half_width));
    Some(Curve::from_points(t.curve.points().map(at).collect::<Option<Vec<_>>>()?))
}
