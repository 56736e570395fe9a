//! The charts of a fabric, one for each test.

use std::collections::BTreeSet;

use crate::characterise::Key;
use crate::characterise::{FabricSheet, mean_branches};
use crate::instrument::{Direction, Origin, Parameter, Shape, Test};
use crate::kes::ValueStatus;
use crate::quantity::{Curve, Estimate, stated_repeats};
use crate::report::number::{fixed, plain_exponent, power_of_ten, significant, unit_text, with_spread};
use crate::study::Comparison;

use super::axes::{Frame, Range};
use super::canvas::{Canvas, HEIGHT, Point, Stroke, WIDTH};
use super::error::ChartError;
use super::head::Head;
use super::loops::{self, TestAxes, Trace};
use super::marks::{Marks, has_readings, reading_stroke};
use super::output::Chart;
use super::palette::{self, GREY, darker, lighter};
use super::panel::{self, Row};
use super::schematic;
use super::spread::Spread;

/// A simulated curve to be drawn over the measured ones, with its distance from them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SimulatedCurve {
    /// What made it, e.g. `linear` or `CS-FEM strip`.
    pub label: String,
    /// Yarn direction; `None` for compression.
    pub direction: Option<Direction>,
    /// The curve in SI, with the axes of its test (see [`Test`]).
    pub curve: Curve,
    /// Root mean square difference of ordinates (SI).
    pub rmse: Option<f64>,
    /// RMSE over the measured span of ordinates (1).
    pub nrmse: Option<f64>,
    /// Coefficient of determination (1).
    pub r2: Option<f64>,
    /// Ends of the 95 % band of the mean fabric, in SI.
    pub band: Option<[Curve; 2]>,
    /// The fewest repeats behind the band.
    pub repeats: Option<usize>,
    /// Parameters and their 95 % bands of the mean fabric, in KES units.
    pub bands: Vec<(String, String)>,
}

impl From<&Comparison> for SimulatedCurve {
    /// The simulated ordinates of a comparison in order of their abscissae, so that a law without hysteresis
    /// is one line however often the measured loops pass over it.
    fn from(comparison: &Comparison) -> Self {
        let mut points: Vec<(f64, f64)> = comparison.simulated.points().collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.dedup();
        let finite = |v: f64| v.is_finite().then_some(v);
        Self {
            label: "simulated".into(),
            direction: comparison.direction,
            curve: Curve::from_points(points),
            rmse: finite(comparison.rmse),
            nrmse: finite(comparison.nrmse),
            r2: finite(comparison.r2),
            band: None,
            repeats: None,
            bands: Vec::new(),
        }
    }
}

/// KES-FB1 tensile: force per width against strain, with WT and WT' and the strain at maximum force.
///
/// # Errors
/// [`ChartError::NothingToDraw`] if the sheet has neither curves nor LT, WT and EMT.
pub fn tensile(sheet: &FabricSheet, simulated: &[SimulatedCurve]) -> Result<Chart, ChartError> {
    of_test(sheet, Test::Tensile, simulated)
}

/// KES-FB1 shear: shear force per width against angle, with the window of G and the bars 2HG, 2HG5.
///
/// # Errors
/// [`ChartError::NothingToDraw`] if the sheet has neither curves nor G and 2HG.
pub fn shear(sheet: &FabricSheet, simulated: &[SimulatedCurve]) -> Result<Chart, ChartError> {
    of_test(sheet, Test::Shear, simulated)
}

/// KES-FB2 bending: moment per width against curvature, with the windows of B and the bars 2HB.
///
/// # Errors
/// [`ChartError::NothingToDraw`] if the sheet has neither curves nor B and 2HB.
pub fn bending(sheet: &FabricSheet, simulated: &[SimulatedCurve]) -> Result<Chart, ChartError> {
    of_test(sheet, Test::Bending, simulated)
}

/// KES-FB3 compression: pressure against thickness, with WC and WC', T0 and Tm.
///
/// # Errors
/// [`ChartError::NothingToDraw`] if the sheet has neither curves nor LC, WC, T0 and Tm.
pub fn compression(sheet: &FabricSheet, simulated: &[SimulatedCurve]) -> Result<Chart, ChartError> {
    of_test(sheet, Test::Compression, simulated)
}

/// The chart of any test: its curves with the windows and readings of the parameters. A sweep of KES-FB4 has a line at
/// its mean, as long as the evaluated part, and a bar of twice the mean deviation.
///
/// # Errors
/// [`ChartError::NothingToDraw`] if the sheet has neither curves nor the values that a curve can be drawn from.
pub fn of_test(sheet: &FabricSheet, test: Test, simulated: &[SimulatedCurve]) -> Result<Chart, ChartError> {
    let axes = TestAxes::of(test);
    let mut traces = loops::traces(sheet, test, &axes);
    let recorded = !traces.is_empty();
    if !recorded {
        traces = schematic::traces(sheet, test, &axes);
    }
    if traces.is_empty() {
        return Err(ChartError::NothingToDraw {
            chart: test.name().into(),
            name: sheet.name.clone(),
            missing: schematic::needs(test),
        });
    }
    let overlay: Vec<Vec<Point>> = simulated.iter().map(|s| axes.convert(&s.curve)).collect();
    let spread = Spread::of(mean_branches(sheet, test), simulated, &axes);
    let frame = frame(test, &traces, &overlay, &spread);

    let mut canvas = Canvas::new();
    let name = if sheet.info.title.is_empty() { &sheet.name } else { &sheet.info.title };
    let kind = format!(", {}", test.name());
    Head {
        title: name,
        kind: &kind,
        subtitle: &subtitle(sheet, test, &traces, recorded),
        origin: &format!("{} data", sheet.info.origin.name()),
    }
    .draw(&mut canvas)?;
    let marks = Marks { sheet, test, axes: &axes, frame: &frame, overlay: &overlay, recorded };
    marks.areas(&mut canvas, &traces)?;
    spread.draw_measured(&mut canvas, &frame)?;
    frame.draw(&mut canvas, &axes.x, &axes.y, true)?;
    draw_traces(&mut canvas, &frame, &traces, !simulated.is_empty())?;
    for (curve, line) in simulated.iter().zip(&overlay) {
        let points: Vec<Point> = line.iter().map(|p| frame.at(p.0, p.1)).collect();
        canvas.line(&points, simulated_stroke(curve.direction))?;
    }
    spread.draw_simulated(&mut canvas, &frame)?;
    marks.readings(&mut canvas, &traces)?;
    let mut rows = legend(sheet, &traces, simulated, &spread, recorded);
    rows.push(Row::Gap);
    rows.extend(value_rows(sheet, test));
    rows.extend(distance_rows(&axes, simulated));
    panel::draw(&mut canvas, &rows, [1405.0, WIDTH as f64 - 40.0], [frame.top - 20.0, HEIGHT as f64 - 40.0])?;
    Ok(canvas.chart())
}

fn frame(test: Test, traces: &[Trace], overlay: &[Vec<Point>], spread: &Spread) -> Frame {
    let points = || {
        let measured = traces.iter().flat_map(|t| t.parts.iter().flat_map(|p| p.1.iter()));
        measured.chain(overlay.iter().flatten()).chain(spread.points())
    };
    // The axes of one-sided tests begin at zero load, so that areas are seen whole.
    let zero = (test.shape() == Shape::Rise).then_some(0.0);
    Frame {
        left: 185.0,
        top: if test == Test::Compression { 170.0 } else { 235.0 },
        right: 1215.0,
        bottom: HEIGHT as f64 - 125.0,
        x: Range::around(points().map(|p| p.0)),
        y: Range::around(points().map(|p| p.1).chain(zero)),
    }
}

fn subtitle(sheet: &FabricSheet, test: Test, traces: &[Trace], recorded: bool) -> String {
    let mut parts = vec![test.instrument().to_string()];
    if recorded {
        parts.push(format!("{} specimen{}", traces.len(), if traces.len() == 1 { "" } else { "s" }));
    } else if sheet.info.origin == Origin::Published {
        parts.push("drawn from published values, no curve measured".into());
    } else {
        parts.push("drawn from a table of results, no curve recorded".into());
    }
    parts.extend(sheet.info.weave.clone());
    parts.extend(sheet.info.composition.clone());
    parts.extend(sheet.info.source.clone());
    parts.join("  ·  ")
}

fn simulated_stroke(direction: Option<Direction>) -> Stroke {
    let stroke = palette::direction(direction, 4.2);
    Stroke { color: darker(stroke.color, 0.55), ..stroke }
}

/// Under a simulated curve the measured one is a broad pale band, so that both are seen.
fn measured_stroke(trace: &Trace, under_simulation: bool) -> Stroke {
    let stroke = palette::direction(trace.direction, 5.0);
    match (trace.emphasised, under_simulation) {
        (true, false) => stroke,
        (true, true) => Stroke {
            color: lighter(stroke.color, 0.5),
            width: 10.0,
            dash: stroke.dash.map(|[on, off]| [2.0 * on, off]),
        },
        (false, _) => {
            let dash = stroke.dash.map(|[on, off]| [0.6 * on, 0.6 * off]);
            Stroke { color: lighter(stroke.color, 0.45), width: 2.0, dash }
        }
    }
}

fn draw_traces(
    canvas: &mut Canvas,
    frame: &Frame,
    traces: &[Trace],
    under_simulation: bool,
) -> Result<(), ChartError> {
    for emphasised in [false, true] {
        for trace in traces.iter().filter(|t| t.emphasised == emphasised) {
            for (_, part) in &trace.parts {
                let points: Vec<Point> = part.iter().map(|p| frame.at(p.0, p.1)).collect();
                canvas.line(&points, measured_stroke(trace, under_simulation))?;
            }
        }
    }
    Ok(())
}

/// How far the simulated curves are from the measured ones.
fn distance_rows(axes: &TestAxes, simulated: &[SimulatedCurve]) -> Vec<Row> {
    let mut rows = Vec::new();
    let is_compared = |c: &&SimulatedCurve| c.rmse.or(c.nrmse).or(c.r2).is_some() || !c.bands.is_empty();
    for curve in simulated.iter().filter(is_compared) {
        rows.push(Row::Gap);
        let direction = curve.direction.map_or(String::new(), |d| format!("{d}, "));
        rows.push(Row::Heading(format!("{direction}{}", curve.label)));
        if let Some(rmse) = curve.rmse {
            let value = format!("{} {}", significant(rmse / axes.y_factor, 3), axes.y_unit);
            rows.push(Row::Value("RMSE".into(), value));
        }
        if let Some(nrmse) = curve.nrmse {
            rows.push(Row::Value("NRMSE".into(), format!("{} %", significant(100.0 * nrmse, 3))));
        }
        if let Some(r2) = curve.r2 {
            rows.push(Row::Value("R²".into(), fixed(r2, 4)));
        }
        if !curve.bands.is_empty() {
            rows.push(Row::Remark("95 %, mean fabric".into(), GREY));
        }
        rows.extend(curve.bands.iter().map(|(name, band)| Row::Value(name.clone(), band.clone())));
    }
    rows
}

fn legend(
    sheet: &FabricSheet,
    traces: &[Trace],
    simulated: &[SimulatedCurve],
    spread: &Spread,
    recorded: bool,
) -> Vec<Row> {
    let mut rows = Vec::new();
    for trace in traces.iter().filter(|t| t.emphasised) {
        let who = trace.direction.map_or("fabric".to_string(), |d| d.to_string());
        let text = if recorded { format!("{who}, specimen {}", trace.specimen) } else { who };
        rows.push(Row::Sample(measured_stroke(trace, !simulated.is_empty()), text));
    }
    if let Some(other) = traces.iter().find(|t| !t.emphasised) {
        rows.push(Row::Sample(measured_stroke(other, false), "other specimens".into()));
    }
    for curve in simulated {
        let direction = curve.direction.map_or(String::new(), |d| format!("{d}, "));
        rows.push(Row::Sample(simulated_stroke(curve.direction), format!("{direction}{}", curve.label)));
    }
    rows.extend(spread.rows(simulated));
    if let Some(trace) = traces.iter().find(|t| has_readings(t)) {
        rows.push(Row::Sample(reading_stroke(trace), "fitted or read here".into()));
    }
    if !recorded {
        let text = match sheet.info.origin {
            Origin::Published => "From published values, no curve measured.",
            Origin::Measured | Origin::Synthetic => "From a table of results, no curve recorded.",
        };
        rows.push(Row::Remark(text.into(), palette::WARNING));
    }
    rows
}

/// The parameters of the test: mean ± SD in KES units per direction.
fn value_rows(sheet: &FabricSheet, test: Test) -> Vec<Row> {
    let parameters: Vec<Parameter> =
        Parameter::ALL.iter().copied().filter(|p| p.test() == Some(test)).collect();
    let estimates = |p: Parameter| {
        [None, Some(Direction::Warp), Some(Direction::Weft), Some(Direction::Bias)].into_iter().filter_map(
            move |direction| {
                let key = Key { parameter: p, direction };
                sheet.values.get(&key).map(|estimate| Stated {
                    direction,
                    estimate,
                    status: sheet.status(key),
                })
            },
        )
    };
    let counts: Vec<Option<u64>> = parameters
        .iter()
        .flat_map(|&p| estimates(p))
        .map(|s| stated_repeats(s.estimate.n as u64, s.estimate.sd))
        .collect();
    let Some(heading) = heading_of(&counts) else { return Vec::new() };
    let mut rows = vec![Row::Heading(heading)];
    let mut statuses = BTreeSet::new();
    for p in parameters {
        let found: Vec<Stated> = estimates(p).collect();
        statuses.extend(found.iter().map(|s| s.status));
        let largest = found.iter().fold(0f64, |a, s| a.max(s.estimate.mean.abs())) / p.kes_factor();
        let exponent = plain_exponent(largest);
        let factor = p.kes_factor() * 10f64.powi(exponent);
        let power = (exponent != 0).then(|| power_of_ten(exponent));
        let unit: Vec<String> = power.into_iter().chain([unit_text(p.kes_unit())]).collect();
        let unit = unit.join(" ");
        match found.as_slice() {
            [] => {}
            // A short unit leaves room for the value in the same line.
            [only @ Stated { direction: None, .. }] if unit.chars().count() <= 2 => {
                rows.push(Row::Value(symbol(p).into(), only.text(factor, &unit)));
            }
            several => {
                rows.push(Row::Value(symbol(p).into(), unit));
                rows.extend(several.iter().map(|stated| {
                    let name = stated.direction.map_or("  fabric".into(), |d| format!("  {d}"));
                    Row::Value(name, stated.text(factor, ""))
                }));
            }
        }
    }
    rows.extend(meanings(&statuses));
    rows
}

/// A value of the sheet as it stands beside the plot.
struct Stated<'s> {
    direction: Option<Direction>,
    estimate: &'s Estimate,
    status: ValueStatus,
}

impl Stated<'_> {
    /// Mean ± SD, unit, and the mark of a value that was not plainly measured.
    fn text(&self, factor: f64, unit: &str) -> String {
        let words = [&with_spread(self.estimate, factor), unit, self.status.mark()];
        words.into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
    }
}

/// What the marks mean that stand behind values.
fn meanings(statuses: &BTreeSet<ValueStatus>) -> impl Iterator<Item = Row> {
    statuses.iter().rev().filter(|status| !status.mark().is_empty()).map(|status| {
        let color = if *status == ValueStatus::Inferred { GREY } else { palette::WARNING };
        Row::Remark(format!("{} {}", status.mark(), status.meaning()), color)
    })
}

/// What stands over values with so many repeats each; `None` where nobody stated how many.
fn heading_of(counts: &[Option<u64>]) -> Option<String> {
    let (fewest, most) = (counts.iter().min()?, counts.iter().max()?);
    Some(match (fewest, most) {
        (Some(1), Some(1)) => "Value (n = 1)".into(),
        (Some(fewest), Some(most)) if fewest == most => format!("Mean ± SD (n = {most})"),
        (Some(fewest), Some(most)) => format!("Mean ± SD (n = {fewest} to {most})"),
        _ => "Mean ± SD (n not stated)".into(),
    })
}

/// The symbol as printed.
pub(super) fn symbol(parameter: Parameter) -> &'static str {
    match parameter {
        Parameter::T0 => "T₀",
        Parameter::Tm => "Tₘ",
        p => p.symbol(),
    }
}
