//! Measured loops beside their friction laws: dots, the law, a straight line, residuals, figures.

use crate::characterise::{Basis, FabricSheet, FrictionLaw, LawBand, LawTrace};
use crate::instrument::{Direction, Parameter, Test};
use crate::report::number::{plain_exponent, power_of_ten, significant, unit_text};

use super::axes::{Frame, Label, Range};
use super::canvas::{Align, Canvas, HEIGHT, Point, Stroke, Type, WIDTH};
use super::error::ChartError;
use super::fabric::symbol;
use super::head::Head;
use super::loops::TestAxes;
use super::output::Chart;
use super::palette::{self, GREY, INK, darker, lighter};
use super::panel::{self, Row};

/// Between which abscissae of the page the panels stand.
const PANELS: [f64; 2] = [30.0, 1390.0];
/// Room left of a panel for its ordinates.
const ORDINATES: f64 = 135.0;
/// Top and bottom of a loop, top and bottom of its residuals.
const HEIGHTS: [f64; 4] = [205.0, 890.0, 995.0, 1225.0];

/// One loop and its law.
struct Loop<'a> {
    law: &'a FrictionLaw,
    traces: Vec<LawTrace>,
    /// Over the specimens, where there are several.
    band: Option<LawBand>,
}

/// The laws of a test beside the loops that they are identified from, one panel a direction (the
/// specimen of [`FabricSheet::law`]); `None` in place of a test draws the strips of a FAB file.
///
/// # Errors
/// [`ChartError::NothingToDraw`] if no loop was recorded, or none has a law.
pub fn friction(sheet: &FabricSheet, test: Option<Test>) -> Result<Chart, ChartError> {
    let loops = loops(sheet, test);
    let what = match test {
        Some(Test::Tensile) => "tension",
        Some(test) => test.name(),
        None => "tension of strips",
    };
    if loops.is_empty() {
        return Err(ChartError::NothingToDraw {
            chart: format!("{what} friction"),
            name: sheet.name.clone(),
            missing: "no recorded loop has a friction law".into(),
        });
    }
    let axes = TestAxes::of(test.unwrap_or(Test::Tensile));
    let mut canvas = Canvas::new();
    let name = if sheet.info.title.is_empty() { &sheet.name } else { &sheet.info.title };
    let kind = format!(", friction in {what}");
    let subtitle = "The law is fitted to one cycle; other cycles are predicted. Residual: measured less law, of the fitted span";
    Head { title: name, kind: &kind, subtitle, origin: &format!("{} data", sheet.info.origin.name()) }
        .draw(&mut canvas)?;
    let width = (PANELS[1] - PANELS[0]) / loops.len() as f64;
    let mut rows = legend(&loops);
    for (i, one) in loops.iter().enumerate() {
        let left = PANELS[0] + width * i as f64;
        draw_loop(&mut canvas, one, &axes, [left + ORDINATES, left + width - 25.0])?;
        rows.push(Row::Gap);
        rows.extend(figures(sheet, one));
    }
    let across = [1420.0, WIDTH as f64 - 40.0];
    panel::draw(&mut canvas, &rows, across, [HEIGHTS[0] - 25.0, HEIGHT as f64 - 40.0])?;
    Ok(canvas.chart())
}

fn loops(sheet: &FabricSheet, test: Option<Test>) -> Vec<Loop<'_>> {
    let laws: Vec<&FrictionLaw> = match test {
        Some(test) => [None, Some(Direction::Warp), Some(Direction::Weft), Some(Direction::Bias)]
            .into_iter()
            .filter_map(|d| sheet.law(test, d).filter(|l| l.direction == d && l.basis == Basis::Loop))
            .collect(),
        // The long strips: less of their extension is in the clamps.
        None => sheet.laws.iter().filter(|l| l.basis == Basis::Strip && l.specimen == 2).collect(),
    };
    let bands = if test.is_some() { sheet.law_bands() } else { Vec::new() };
    let band_of = |law: &FrictionLaw| {
        bands.iter().find(|b| (b.test, b.direction) == (law.test, law.direction)).cloned()
    };
    let with = |law| Loop { law, traces: FrictionLaw::traces(law, sheet), band: band_of(law) };
    laws.into_iter().map(with).filter(|l| !l.traces.is_empty()).collect()
}

fn law_stroke(law: &FrictionLaw) -> Stroke {
    let color = darker(palette::direction(law.direction, 1.0).color, 0.45);
    Stroke::solid(color, 4.0)
}

const LINE: Stroke = Stroke { color: GREY, width: 2.6, dash: Some([14.0, 10.0]) };

/// Edges of the band of one more specimen.
const NEXT: Stroke = Stroke { color: GREY, width: 2.0, dash: Some([4.0, 6.0]) };

/// The band of the mean fabric.
fn mean_color(law: &FrictionLaw) -> plotters::prelude::RGBColor {
    lighter(palette::direction(law.direction, 1.0).color, 0.72)
}

/// Fitted dots have the colour of the direction, predicted ones another that is darker than all of those, in print too.
fn dot_color(law: &FrictionLaw, fitted: bool) -> plotters::prelude::RGBColor {
    if fitted {
        lighter(palette::direction(law.direction, 1.0).color, 0.35)
    } else {
        darker(palette::GROUPS[3], 0.3)
    }
}

fn draw_loop(
    canvas: &mut Canvas,
    one: &Loop<'_>,
    axes: &TestAxes,
    [left, right]: [f64; 2],
) -> Result<(), ChartError> {
    let Some(fit) = &one.law.fit else { return Ok(()) };
    let [top, bottom, lower_top, lower_bottom] = HEIGHTS;
    let edges: Vec<[Vec<Point>; 4]> = (one.band.iter().flat_map(|b| &b.branches))
        .map(|b| [&b.low, &b.high, &b.next_specimen[0], &b.next_specimen[1]].map(|c| axes.convert(c)))
        .collect();
    let of_edges = || edges.iter().flatten().flatten().copied();
    let xs = one.traces.iter().flat_map(|t| t.x.iter().map(|x| x / axes.x_factor));
    let ys = one.traces.iter().flat_map(|t| t.measured.iter().chain(&t.law).map(|y| y / axes.y_factor));
    let (xs, ys) = (xs.chain(of_edges().map(|p| p.0)), ys.chain(of_edges().map(|p| p.1)));
    let frame = Frame { left, top, right, bottom, x: Range::around(xs), y: Range::around(ys) };
    for [low, high, next_low, next_high] in &edges {
        let place = |p: &Point| frame.at(p.0, p.1);
        let around: Vec<Point> = low.iter().chain(high.iter().rev()).map(place).collect();
        canvas.polygon(&around, mean_color(one.law))?;
        for edge in [next_low, next_high] {
            canvas.line(&edge.iter().map(place).collect::<Vec<_>>(), NEXT)?;
        }
    }
    let no_x = Label::new("", "");
    frame.draw(canvas, &no_x, &Label { second: None, ..axes.y.clone() }, true)?;
    let title = Type::new(29.0, INK).bold().align(Align::Centre);
    canvas.text((0.5 * (left + right), top - 18.0), &heading(one.law), title)?;

    let fitted: Vec<&LawTrace> = one.traces.iter().filter(|t| t.fitted).collect();
    let span = span(fitted.iter().flat_map(|t| t.measured.iter().copied()));
    let part = |t: &LawTrace, i: usize| 100.0 * (t.measured[i] - t.law[i]) / span;
    let residuals = || one.traces.iter().flat_map(|t| (0..t.x.len()).map(move |i| part(t, i)));
    let noise = 200.0 * fit.noise;
    let largest = residuals().fold(noise.max(1e-6), |a, r| a.max(r.abs()));
    let largest = rounded_up(largest);
    let (x, y) = (frame.x, Range::around([-largest, largest]));
    let lower = Frame { left, top: lower_top, right, bottom: lower_bottom, x, y };
    let (a, b) = (lower.at(x.from, -noise), lower.at(x.to, noise));
    canvas.rectangle((a.0, b.1), (b.0, a.1), lighter(GREY, 0.7))?;
    lower.draw(canvas, &Label { second: None, ..axes.x.clone() }, &Label::new("Residual", "%"), true)?;

    // Predicted cycles below the fitted one.
    for t in one.traces.iter().filter(|t| !t.fitted).chain(fitted.iter().copied()) {
        let color = dot_color(one.law, t.fitted);
        for i in 0..t.x.len() {
            let x = t.x[i] / axes.x_factor;
            canvas.dot(frame.at(x, t.measured[i] / axes.y_factor), 5.0, color)?;
            canvas.dot(lower.at(x, part(t, i)), 3.5, color)?;
        }
    }
    for t in &fitted {
        let ends =
            (0..t.x.len()).filter(|&i| (frame.y.from..=frame.y.to).contains(&(t.line[i] / axes.y_factor)));
        let by = |i: &usize, j: &usize| t.x[*i].total_cmp(&t.x[*j]);
        let ends = [ends.clone().min_by(by), ends.max_by(by)];
        let line: Vec<_> = ends
            .iter()
            .flatten()
            .map(|&i| frame.at(t.x[i] / axes.x_factor, t.line[i] / axes.y_factor))
            .collect();
        canvas.line(&line, LINE)?;
    }
    for t in &one.traces {
        let points = t.x.iter().zip(&t.law).map(|(x, y)| frame.at(x / axes.x_factor, y / axes.y_factor));
        let stroke = law_stroke(one.law);
        let stroke = if t.fitted { stroke } else { Stroke { width: 2.4, dash: Some([9.0, 7.0]), ..stroke } };
        canvas.line(&points.collect::<Vec<_>>(), stroke)?;
    }
    Ok(())
}

fn heading(law: &FrictionLaw) -> String {
    let direction = law.direction.map_or("fabric", Direction::name);
    let which = if law.basis == Basis::Strip { "strip S" } else { "specimen " };
    format!("{direction}, {which}{}", law.specimen)
}

fn legend(loops: &[Loop<'_>]) -> Vec<Row> {
    let law = loops[0].law;
    let dots = |fitted| Stroke { color: dot_color(law, fitted), width: 11.0, dash: Some([11.0, 9.0]) };
    let mut rows = vec![
        Row::Sample(dots(true), "measured, fitted".into()),
        Row::Sample(law_stroke(law), "friction law".into()),
        Row::Sample(LINE, "straight line".into()),
        Row::Sample(Stroke::solid(lighter(GREY, 0.7), 22.0), "± 2 SD of the noise".into()),
    ];
    if let Some(band) = loops.iter().find_map(|l| l.band.as_ref()) {
        let mean = format!("95 %, mean (n = {})", band.n);
        rows.push(Row::Sample(Stroke::solid(mean_color(law), 22.0), mean));
        rows.push(Row::Sample(NEXT, "95 %, next one".into()));
    }
    if loops.iter().any(|l| l.traces.iter().any(|t| !t.fitted)) {
        rows.insert(1, Row::Sample(dots(false), "measured, not fitted".into()));
        let dashed = Stroke { width: 2.4, dash: Some([9.0, 7.0]), ..law_stroke(law) };
        rows.insert(3, Row::Sample(dashed, "law, predicted".into()));
    }
    rows
}

/// The box of a loop: quality of the fit, and parameters re-extracted beside measured ones.
fn figures(sheet: &FabricSheet, one: &Loop<'_>) -> Vec<Row> {
    let law = one.law;
    let Some(fit) = &law.fit else { return Vec::new() };
    let percent = |v: f64| format!("{} %", significant(100.0 * v, 2));
    let value = |name: &str, v: String| Row::Value(name.into(), v);
    let mut rows = vec![
        Row::Heading(heading(law)),
        value("NRMSE", percent(fit.fitted.nrmse)),
        value("  straight line", percent(fit.fitted.line_nrmse)),
        value("  noise floor", percent(fit.noise)),
        value("R²", format!("{:.5}", fit.fitted.r_squared)),
        value("energy error", fit.fitted.loop_energy.map_or("no loop".into(), percent)),
    ];
    if let Some(memory) = &law.memory {
        rows.push(value("set of the greatest strain", percent(memory.set)));
        if let Some(relaxation) = &memory.relaxation {
            rows.push(value("relaxes within", format!("{} samples", significant(relaxation.time, 2))));
        }
    }
    for u in &fit.unseen {
        let number = |v: f64| significant(100.0 * v, 2);
        let text = format!("{} (line {}) %", number(u.nrmse), number(u.line_nrmse));
        rows.push(value(&format!("cycle {}", u.cycle + 1), text));
    }
    let mine = sheet.specimens.iter().find(|s| {
        let m = &s.measurement;
        (m.test, m.direction, m.specimen) == (law.test, law.direction, law.specimen)
    });
    if let Some(specimen) = mine.filter(|_| law.basis == Basis::Loop) {
        rows.push(Row::Remark("law | measured, KES units".into(), GREY));
        for (p, ours) in &law.values {
            if let Some(theirs) = specimen.values.get(p) {
                rows.push(pair(*p, *ours, *theirs));
            }
        }
    }
    rows
}

/// A parameter simulated and measured, in KES units.
fn pair(p: Parameter, ours: f64, theirs: f64) -> Row {
    let exponent = plain_exponent(theirs.abs() / p.kes_factor());
    let factor = p.kes_factor() * 10f64.powi(exponent);
    let power = if exponent == 0 { String::new() } else { format!(" {}", power_of_ten(exponent)) };
    let unit = unit_text(p.kes_unit());
    let name = if unit == "1" || unit.is_empty() {
        symbol(p).to_string()
    } else if unit.chars().count() <= 2 {
        format!("{} ({unit})", symbol(p))
    } else {
        format!("{}{power}", symbol(p))
    };
    Row::Value(name, format!("{} | {}", significant(ours / factor, 3), significant(theirs / factor, 3)))
}

/// 1, 2 or 5 times a power of ten, not below a positive value.
fn rounded_up(value: f64) -> f64 {
    let decade = 10f64.powf(value.log10().floor());
    [1.0, 2.0, 5.0].into_iter().map(|d| d * decade).find(|v| *v >= value).unwrap_or(10.0 * decade)
}

fn span(values: impl Iterator<Item = f64>) -> f64 {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    high - low
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::characterise::characterise;
    use crate::instrument::Shape;

    /// The fabric of `kesf_data`, synthetic; with `KESF_GALLERY=dir` the files are kept.
    #[test]
    fn laws_are_drawn_beside_their_loops() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("kesf_data/poplin");
        let batch = crate::instrument::read_fabrics(&[folder], &Default::default(), &|_| ());
        let sheet = characterise(&batch.fabrics[0], &Default::default());
        for test in Test::ALL.into_iter().filter(|t| t.shape() != Shape::Sweep) {
            let bytes = friction(&sheet, Some(test)).unwrap().png().unwrap();
            if test == Test::Bending {
                let again = friction(&sheet, Some(test)).unwrap().png().unwrap();
                assert_eq!(bytes, again, "same data, same bytes");
            }
            if let Some(folder) = std::env::var_os("KESF_GALLERY") {
                let name = format!("friction_{}.png", test.name());
                std::fs::write(std::path::Path::new(&folder).join(name), bytes).unwrap();
            }
        }
        assert!(matches!(friction(&sheet, None), Err(ChartError::NothingToDraw { .. })));
        // The instrument's own evaluation sees the measured parameters in the simulated cycles.
        for r in sheet.re_extracted() {
            let part = r.simulated.mean / r.measured.mean - 1.0;
            assert!(part.abs() < 0.06, "{:?}: {part}", r.key);
        }
    }

    #[test]
    fn residual_ranges_are_round() {
        assert_eq!([0.013, 0.02, 1.1, 7.0].map(rounded_up), [0.02, 0.02, 2.0, 10.0]);
    }
}
