//! FAB bend tests: force against clamp distance, measured and simulated, a panel a test.

use crate::instrument::fab::FabKind;
use plotters::prelude::RGBColor;

use crate::quantity::Curve;
use crate::report::number::{fixed, significant};
use crate::study::bending::{Agreement, BendLoop, BendLoops, Simulated};

use super::axes::{Frame, Label, Range};
use super::canvas::{Canvas, Point, Stroke, Type, WIDTH};
use super::error::ChartError;
use super::head::Head;
use super::output::Chart;
use super::palette::{BLUE, GREY, INK, VERMILLION, lighter};
use super::panel::{self, Row};

/// What [`bend_loops`] draws.
#[derive(Clone, Debug, PartialEq)]
pub struct ForcePlot<'a> {
    /// Headline, e.g. the fabric.
    pub title: String,
    /// Mark in the corner, e.g. `measured data`; empty for none.
    pub origin: String,
    /// The tests of one direction.
    pub loops: &'a BendLoops,
}

const CM: f64 = 1e-2;
const GF: f64 = 9.80665e-3;

/// Measured samples as dots (those of inner cycles paler), a panel a test; of the outermost cycle the elastic
/// simulation as a grey line, and that with friction in colour; of the inner cycles, which are predicted, that with
/// friction as a thin line. The errors stand beside.
///
/// # Errors
/// [`ChartError::NothingToDraw`] without a test.
pub fn bend_loops(plot: &ForcePlot) -> Result<Chart, ChartError> {
    let tests = &plot.loops.loops;
    if tests.is_empty() {
        return Err(ChartError::NothingToDraw {
            chart: "bend loop".into(),
            name: plot.title.clone(),
            missing: "there is no FAB bend test".into(),
        });
    }
    let mut canvas = Canvas::new();
    let kind = format!(", FAB bend loop, {}", plot.loops.direction);
    let subtitle =
        "force against clamp distance; pull is positive; the zero of the load is fitted in every test";
    Head { title: &plot.title, kind: &kind, subtitle, origin: &plot.origin }.draw(&mut canvas)?;
    for (cell, test) in cells(tests.len()).into_iter().zip(tests) {
        draw_test(&mut canvas, cell, test)?;
    }
    panel::draw(&mut canvas, &rows(plot.loops), [1400.0, WIDTH as f64 - 40.0], [150.0, 1310.0])?;
    Ok(canvas.chart())
}

/// `[left, top, right, bottom]` of each frame: two above, the others below at full width.
fn cells(count: usize) -> Vec<[f64; 4]> {
    let (left, right, middle) = (150.0, 1350.0, 750.0);
    let upper = [[left, 220.0, middle - 60.0, 660.0], [middle + 90.0, 220.0, right, 660.0]];
    match count {
        1 => vec![[left, 220.0, right, 1220.0]],
        2 => upper.to_vec(),
        _ => vec![upper[0], upper[1], [left, 850.0, right, 1230.0]],
    }
}

fn draw_test(
    canvas: &mut Canvas,
    [left, top, right, bottom]: [f64; 4],
    test: &BendLoop,
) -> Result<(), ChartError> {
    let points = |c: &Curve| -> Vec<Point> { c.points().map(|(d, f)| (d / CM, f / GF)).collect() };
    let (measured, elastic) = (points(&test.measured), points(&test.elastic.force));
    let friction = test.friction.as_ref().map(|s| points(&s.force));
    let outermost = test.outermost();
    // The elastic curve of the inner cycles lies on that of the outermost: it is not drawn.
    let drawn = || measured.iter().chain(&elastic[outermost..]);
    let with_friction = || friction.iter().flatten();
    let x = Range::around(drawn().map(|p| p.0));
    let y = Range::around(drawn().chain(with_friction()).map(|p| p.1));
    let frame = Frame { left, top, right, bottom, x, y };
    frame.draw(canvas, &Label::new("Clamp distance", "cm"), &Label::new("Force", "gf"), true)?;
    let role = if test.fitted { "fitted" } else { "PREDICTED" };
    let heading = format!("{}: {}, {role}", test.kind.name(), words(test.kind));
    let kind = Type::new(28.0, INK).bold();
    let heading = panel::fitted(canvas, &heading, kind, right - left + 60.0)?;
    canvas.text((left, top - 26.0), &heading, kind)?;
    for (i, p) in measured.iter().enumerate() {
        let color = if i < outermost { pale() } else { INK };
        canvas.dot(frame.at(p.0, p.1), 6.0, color)?;
    }
    let ends = test.branches.iter().copied().skip(1).chain([measured.len()]);
    for (from, to) in test.branches.iter().copied().zip(ends) {
        let mut draw = |curve: &[Point], stroke| {
            let branch: Vec<Point> = curve[from..to].iter().map(|p| frame.at(p.0, p.1)).collect();
            canvas.line(&branch, stroke)
        };
        if from >= outermost {
            draw(&elastic, elastic_line())?;
        }
        if let Some(curve) = &friction {
            draw(curve, if from < outermost { inner_line() } else { friction_line(test.fitted) })?;
        }
    }
    Ok(())
}

fn pale() -> RGBColor {
    lighter(INK, 0.62)
}

fn elastic_line() -> Stroke {
    Stroke::solid(lighter(GREY, 0.35), 4.0)
}

/// Blue where it was fitted, vermillion and dashed where it is a prediction.
fn friction_line(fitted: bool) -> Stroke {
    if fitted {
        Stroke::solid(BLUE, 4.5)
    } else {
        Stroke { color: VERMILLION, width: 4.5, dash: Some([20.0, 9.0]) }
    }
}

/// Predicted in every test.
fn inner_line() -> Stroke {
    Stroke { color: lighter(VERMILLION, 0.35), width: 2.0, dash: Some([10.0, 7.0]) }
}

fn words(kind: FabKind) -> &'static str {
    match kind {
        FabKind::D1 => "2 cm, hanging",
        FabKind::U1 => "2 cm, standing",
        FabKind::D2 => "8 cm, hanging",
        FabKind::S1 | FabKind::S2 => "stretched",
    }
}

fn rows(loops: &BendLoops) -> Vec<Row> {
    let micro = |v: f64, unit: &str| format!("{} {unit}", significant(1e6 * v, 3));
    let mut rows = vec![
        Row::Remark("● measured, outer cycle".into(), INK),
        Row::Remark("● measured, inner cycles".into(), pale()),
        Row::Sample(elastic_line(), "elastic".into()),
        Row::Value("B".into(), micro(loops.elastic.rigidity, "µN·m")),
    ];
    if let Some(friction) = &loops.friction {
        rows.push(Row::Sample(friction_line(true), "friction, fitted".into()));
        rows.push(Row::Sample(friction_line(false), "friction, predicted".into()));
        rows.push(Row::Sample(inner_line(), "inner, predicted".into()));
        rows.push(Row::Value("B as KES".into(), micro(friction.kes_rigidity, "µN·m")));
        rows.push(Row::Value("2HB/2 as KES".into(), micro(friction.kes_couple, "µN")));
    }
    let turned = loops.friction.as_ref().map_or(loops.elastic.inclination, |f| f.inclination);
    if turned != 0.0 {
        rows.push(Row::Value("clamps inclined".into(), format!("{}°", fixed(turned.to_degrees(), 1))));
    }
    rows.extend([Row::Gap, Row::Remark("NRMSE: elastic | friction".into(), GREY)]);
    let percent = |a: Option<Agreement>| a.map_or("–".into(), |a| fixed(100.0 * a.nrmse, 1));
    for test in &loops.loops {
        let role = if test.fitted { "fitted" } else { "predicted" };
        rows.push(Row::Heading(format!("{} {role}", test.kind.name())));
        let friction = |of: fn(&Simulated) -> Option<Agreement>| percent(test.friction.as_ref().and_then(of));
        let both = |of: fn(&Simulated) -> Option<Agreement>| {
            format!("{} | {} %", percent(of(&test.elastic)), friction(of))
        };
        rows.push(Row::Value("outer".into(), both(|s| s.outer)));
        rows.push(Row::Value("inner".into(), both(|s| s.inner)));
        rows.push(Row::Value("own zero".into(), both(|s| s.inner_with_own_zero)));
    }
    rows.push(Row::Gap);
    rows.push(Row::Remark(
        "Inner cycles are predicted; own zero: with a load zero of their own.".into(),
        GREY,
    ));
    rows
}
