//! FAB bend tests: force against clamp distance, measured and simulated, a panel a test.

use crate::instrument::fab::FabKind;
use crate::report::number::{fixed, significant};
use crate::study::bending::{Agreement, BendLoop, BendLoops};

use super::axes::{Frame, Label, Range};
use super::canvas::{Canvas, Point, Stroke, Type, WIDTH};
use super::palette::{BLUE, GREY, INK, VERMILLION, lighter};
use super::panel::{self, Row};
use super::{ChartError, Head};

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

/// Measured samples as dots (those of inner cycles paler), the simulation as a line, a panel a test; the errors
/// stand beside.
///
/// # Errors
/// [`ChartError::NothingToDraw`] without a test.
pub fn bend_loops(plot: &ForcePlot) -> Result<Vec<u8>, ChartError> {
    let tests = &plot.loops.loops;
    if tests.is_empty() {
        return Err(ChartError::NothingToDraw {
            chart: "bend loop".into(),
            name: plot.title.clone(),
            missing: "there is no FAB bend test".into(),
        });
    }
    let mut canvas = Canvas::new()?;
    let kind = format!(", FAB bend loop, {}", plot.loops.direction);
    let subtitle =
        "force against clamp distance; pull is positive; the zero of the load is fitted in every test";
    Head { title: &plot.title, kind: &kind, subtitle, origin: &plot.origin }.draw(&mut canvas)?;
    for (cell, test) in cells(tests.len()).into_iter().zip(tests) {
        draw_test(&mut canvas, cell, test)?;
    }
    panel::draw(&mut canvas, &rows(plot.loops), [1400.0, WIDTH as f64 - 40.0], [150.0, 1310.0])?;
    canvas.png(&format!("{}{kind}", plot.title))
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
    let measured: Vec<Point> = test.measured.points().map(|(d, f)| (d / CM, f / GF)).collect();
    let simulated: Vec<Point> = test.simulated.points().map(|(d, f)| (d / CM, f / GF)).collect();
    let all = || measured.iter().chain(&simulated);
    let frame = Frame {
        left,
        top,
        right,
        bottom,
        x: Range::around(all().map(|p| p.0)),
        y: Range::around(all().map(|p| p.1)),
    };
    frame.draw(canvas, &Label::new("Clamp distance", "cm"), &Label::new("Force", "gf"), true)?;
    let role = if test.fitted { "fitted" } else { "PREDICTED" };
    let heading = format!("{}: {}, {role}", test.kind.name(), words(test.kind));
    let kind = Type::new(28.0, INK).bold();
    let heading = panel::fitted(canvas, &heading, kind, right - left + 60.0)?;
    canvas.text((left, top - 26.0), &heading, kind)?;
    let outermost = outermost(test);
    for (i, p) in measured.iter().enumerate() {
        let color = if i < outermost { lighter(INK, 0.62) } else { INK };
        canvas.dot(frame.at(p.0, p.1), 6.0, color)?;
    }
    let stroke = line_of(test);
    let starts = test.branches.iter().copied();
    for (from, to) in starts.zip(test.branches.iter().copied().skip(1).chain([simulated.len()])) {
        if from >= outermost {
            let branch: Vec<Point> = simulated[from..to].iter().map(|p| frame.at(p.0, p.1)).collect();
            canvas.line(&branch, stroke)?;
        }
    }
    Ok(())
}

fn outermost(test: &BendLoop) -> usize {
    test.branches.len().checked_sub(2).map_or(0, |i| test.branches[i])
}

fn line_of(test: &BendLoop) -> Stroke {
    if test.fitted {
        Stroke::solid(BLUE, 4.5)
    } else {
        Stroke { color: VERMILLION, width: 4.5, dash: Some([20.0, 9.0]) }
    }
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
    let mut rows = vec![
        Row::Remark("● measured, outer cycle".into(), INK),
        Row::Remark("● measured, inner cycles".into(), lighter(INK, 0.62)),
        Row::Sample(Stroke::solid(BLUE, 4.5), "simulated, fitted".into()),
        Row::Sample(
            Stroke { color: VERMILLION, width: 4.5, dash: Some([20.0, 9.0]) },
            "simulated, predicted".into(),
        ),
        Row::Gap,
        Row::Value("B".into(), format!("{} µN·m", significant(1e6 * loops.rigidity, 3))),
        Row::Value("elements".into(), loops.cells.to_string()),
        Row::Gap,
    ];
    let percent = |a: Agreement| format!("{} %", significant(100.0 * a.nrmse, 3));
    for test in &loops.loops {
        let role = if test.fitted { "fitted" } else { "predicted" };
        rows.push(Row::Heading(format!("{} {role}", test.kind.name())));
        if let Some(outer) = test.outer {
            rows.push(Row::Value("NRMSE, outer".into(), percent(outer)));
            rows.push(Row::Value("R²".into(), fixed(outer.r2, 3)));
        }
        if let Some(inner) = test.inner {
            rows.push(Row::Value("NRMSE, inner".into(), percent(inner)));
        }
        rows.push(Row::Gap);
    }
    rows.push(Row::Remark("Inner cycles are predicted in every test.".into(), GREY));
    rows
}
