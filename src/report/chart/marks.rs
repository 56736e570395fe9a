//! What a chart shows of how its parameters were obtained: areas, slopes, loop widths, readings.

use crate::characterise::{FabricSheet, Window};
use crate::instrument::{Parameter, Shape, Test};

use super::axes::Frame;
use super::canvas::{Align, Canvas, Point, Stroke, Type};
use super::error::ChartError;
use super::fabric::symbol;
use super::loops::{TestAxes, Trace};
use super::palette::{self, GREY, INK, darker, lighter};

/// Everything that the marks of one chart depend on.
pub(super) struct Marks<'a> {
    pub sheet: &'a FabricSheet,
    pub test: Test,
    pub axes: &'a TestAxes,
    pub frame: &'a Frame,
    /// Simulated curves in chart units.
    pub overlay: &'a [Vec<Point>],
    /// Whether there are recorded curves.
    pub recorded: bool,
}

const LABEL: f64 = 28.0;

impl Marks<'_> {
    /// Energy under the loading branch (tinted) and under the unloading branch (hatched), of the first
    /// emphasised trace; drawn below everything else.
    pub(super) fn areas(&self, canvas: &mut Canvas, traces: &[Trace]) -> Result<(), ChartError> {
        if self.test.shape() != Shape::Rise {
            return Ok(());
        }
        let Some(trace) = traces.iter().find(|t| t.emphasised) else { return Ok(()) };
        let color = palette::direction(trace.direction, 1.0).color;
        if let Some(area) = self.area(trace, true) {
            canvas.polygon(&area, lighter(color, 0.86))?;
        }
        if let Some(area) = self.area(trace, false) {
            canvas.hatch(&area, 26.0, Stroke::solid(lighter(color, 0.55), 1.8))?;
        }
        Ok(())
    }

    /// The polygon between the last branch of a kind and the abscissa.
    fn area(&self, trace: &Trace, outgoing: bool) -> Option<Vec<Point>> {
        let (_, part) = trace.parts.iter().rfind(|p| p.0 == outgoing && p.1.len() > 1)?;
        let (first, last) = (part.first()?, part.last()?);
        let mut polygon: Vec<Point> = part.iter().map(|p| self.frame.at(p.0, p.1.max(0.0))).collect();
        polygon.push(self.frame.at(last.0, 0.0));
        polygon.push(self.frame.at(first.0, 0.0));
        Some(polygon)
    }

    /// Fitted slopes, loop widths and read thicknesses of the emphasised traces; the symbols once each, at
    /// the first direction.
    pub(super) fn readings(&self, canvas: &mut Canvas, traces: &[Trace]) -> Result<(), ChartError> {
        for (i, trace) in traces.iter().filter(|t| t.emphasised).enumerate() {
            for window in trace.windows.iter().filter(|w| !is_thickness(w)) {
                // Loop widths are read at the same abscissa in every direction: the bars stand side by side.
                let same = window.from == window.to && self.test != Test::Tensile;
                let aside = if same { 9.0 * i as f64 } else { 0.0 };
                let ends = self.ends(window).map(|p| (p.0 + aside, p.1));
                self.window(canvas, ends, reading_stroke(trace))?;
            }
        }
        let Some(first) = traces.iter().find(|t| t.emphasised) else { return Ok(()) };
        let mut labels = Labels { frame: self.frame, obstacles: self.obstacles(traces), taken: Vec::new() };
        if self.test == Test::Compression && self.recorded {
            for p in [Parameter::T0, Parameter::Tm] {
                self.drop_line(canvas, first, p, &mut labels)?;
            }
        }
        self.area_labels(canvas, first, &mut labels)?;
        let mut named = Vec::new();
        for window in first.windows.iter().filter(|w| !is_thickness(w)) {
            if !named.contains(&window.parameter) {
                named.push(window.parameter);
                let [a, b] = self.ends(window);
                let anchor = (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1));
                labels.place(canvas, symbol(window.parameter), anchor, 55.0)?;
            }
        }
        Ok(())
    }

    /// Points of the page, a few pixels apart, that a label should not cover.
    fn obstacles(&self, traces: &[Trace]) -> Vec<Point> {
        let mut points = Vec::new();
        let curves = traces.iter().flat_map(|t| t.parts.iter().map(|p| &p.1)).chain(self.overlay);
        for curve in curves {
            let places: Vec<Point> = curve.iter().map(|p| self.frame.at(p.0, p.1)).collect();
            places.windows(2).for_each(|pair| sample(pair[0], pair[1], &mut points));
        }
        for window in traces.iter().filter(|t| t.emphasised).flat_map(|t| &t.windows) {
            let [a, b] = self.ends(window);
            sample(a, b, &mut points);
        }
        let (x, y) = (self.frame.x, self.frame.y);
        sample(self.frame.at(x.from, 0.0), self.frame.at(x.to, 0.0), &mut points);
        sample(self.frame.at(0.0, y.from), self.frame.at(0.0, y.to), &mut points);
        points
    }

    fn ends(&self, window: &Window) -> [Point; 2] {
        let at = |x: f64, y: f64| self.frame.at(x / self.axes.x_factor, y / self.axes.y_factor);
        [at(window.from, window.ordinates[0]), at(window.to, window.ordinates[1])]
    }

    fn window(&self, canvas: &mut Canvas, [a, b]: [Point; 2], stroke: Stroke) -> Result<(), ChartError> {
        let length = (b.0 - a.0).hypot(b.1 - a.1);
        if !length.is_finite() {
            return Ok(());
        }
        if length < 1.0 {
            return canvas.dot(a, 7.0, stroke.color);
        }
        canvas.line(&[a, b], stroke)?;
        // Caps across the line show where the window begins and ends.
        let (nx, ny) = (-(b.1 - a.1) / length * 12.0, (b.0 - a.0) / length * 12.0);
        for p in [a, b] {
            canvas.line(&[(p.0 - nx, p.1 - ny), (p.0 + nx, p.1 + ny)], stroke)?;
        }
        Ok(())
    }

    fn area_labels(&self, canvas: &mut Canvas, trace: &Trace, labels: &mut Labels) -> Result<(), ChartError> {
        if self.test.shape() != Shape::Rise {
            return Ok(());
        }
        let energy = self.test.spec().leading.symbol();
        let names = [energy, &format!("{energy}′")];
        let height_at = |outgoing: bool, x: f64| {
            let part = &trace.parts.iter().rfind(|p| p.0 == outgoing)?.1;
            let pair = part.windows(2).find(|w| (w[0].0 - x) * (w[1].0 - x) <= 0.0)?;
            Some(0.5 * (pair[0].1 + pair[1].1))
        };
        let Some(loading) = trace.parts.iter().rfind(|p| p.0) else { return Ok(()) };
        let Some((first, last)) = loading.1.first().zip(loading.1.last()) else { return Ok(()) };
        let at = |part: f64| first.0 + part * (last.0 - first.0);
        // Between the branches, and below the unloading one; somewhere in the middle there may be room.
        let parts = || (0..14).map(|i| 0.92 - 0.04 * f64::from(i));
        let between = parts().filter_map(|t| {
            Some((at(t), 0.5 * (height_at(true, at(t))? + height_at(false, at(t)).unwrap_or(0.0))))
        });
        labels.place_in(canvas, names[0], &between.map(|p| self.frame.at(p.0, p.1)).collect::<Vec<_>>())?;
        let below = parts().filter_map(|t| Some((at(t), 0.4 * height_at(false, at(t))?)));
        labels.place_in(canvas, names[1], &below.map(|p| self.frame.at(p.0, p.1)).collect::<Vec<_>>())
    }

    /// A dashed line from the top down to the axis at a thickness.
    fn drop_line(
        &self,
        canvas: &mut Canvas,
        trace: &Trace,
        parameter: Parameter,
        labels: &mut Labels,
    ) -> Result<(), ChartError> {
        let own = trace.values.get(&parameter).copied();
        let Some(value) = own.or_else(|| self.sheet.get(parameter, None).map(|e| e.mean)) else {
            return Ok(());
        };
        let x = value / self.axes.x_factor;
        let (top, bottom) = (self.frame.at(x, self.frame.y.to * 0.93), self.frame.at(x, 0.0));
        canvas.line(&[bottom, top], Stroke { color: GREY, width: 2.4, dash: Some([12.0, 8.0]) })?;
        sample(bottom, top, &mut labels.obstacles);
        labels.place(canvas, symbol(parameter), (top.0, top.1 + 30.0), 45.0)
    }
}

/// The colour of a direction, dark, so that a fit is told from the curve below it.
pub(super) fn reading_stroke(trace: &Trace) -> Stroke {
    Stroke::solid(darker(palette::direction(trace.direction, 1.0).color, 0.55), 3.6)
}

/// Whether a trace has windows that are drawn with [`reading_stroke`].
pub(super) fn has_readings(trace: &Trace) -> bool {
    trace.emphasised && trace.windows.iter().any(|w| !is_thickness(w))
}

/// Thicknesses are drawn as lines down to the axis instead.
fn is_thickness(window: &Window) -> bool {
    matches!(window.parameter, Parameter::T0 | Parameter::Tm)
}

/// Points between two ends, about 5 pixels apart.
fn sample(a: Point, b: Point, points: &mut Vec<Point>) {
    let length = (b.0 - a.0).hypot(b.1 - a.1);
    if length.is_finite() {
        let count = (length / 5.0).ceil().max(1.0);
        let at = |t: f64| (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1));
        points.extend((0..=count as usize).map(|i| at(i as f64 / count)));
    }
}

/// Symbols in the plot, each near what it names and over nothing else.
struct Labels<'a> {
    frame: &'a Frame,
    obstacles: Vec<Point>,
    /// Left, top, right, bottom of the symbols that have been set.
    taken: Vec<[f64; 4]>,
}

impl Labels<'_> {
    /// Sets a symbol at the first free place on growing circles around `anchor`, with a thin line to it.
    /// Where nothing is free it is left out: the column beside the plot has every value.
    fn place(
        &mut self,
        canvas: &mut Canvas,
        text: &str,
        anchor: Point,
        nearest: f64,
    ) -> Result<(), ChartError> {
        let kind = Type::new(LABEL, INK).bold().align(Align::Centre);
        let half = 0.5 * canvas.text_width(text, kind)? + 8.0;
        // Up and to the left first: rising curves leave room there; then down and to the right.
        const TURNS: [f64; 12] =
            [-135.0, -105.0, -165.0, 45.0, 75.0, 15.0, -75.0, 105.0, -45.0, 135.0, 0.0, 180.0];
        let around = (0..14).flat_map(|ring| {
            let radius = nearest + 28.0 * f64::from(ring);
            TURNS.map(|turn| {
                let (sin, cos) = turn.to_radians().sin_cos();
                (anchor.0 + radius * cos, anchor.1 + radius * sin)
            })
        });
        let place_of = |c: Point| [c.0 - half, c.1 - 22.0, c.0 + half, c.1 + 22.0];
        let Some(centre) = around.into_iter().find(|c| self.is_free(place_of(*c))) else { return Ok(()) };
        let place = place_of(centre);
        if (centre.0 - anchor.0).hypot(centre.1 - anchor.1) > 30.0 {
            let edge = (anchor.0.clamp(place[0], place[2]), anchor.1.clamp(place[1], place[3]));
            canvas.line(&[edge, anchor], Stroke::solid(GREY, 1.6))?;
            canvas.dot(anchor, 4.0, GREY)?;
        }
        self.taken.push(place);
        canvas.text((centre.0, centre.1 + 0.36 * LABEL), text, kind)
    }

    /// Sets the symbol of an area at the first of some inner points where it has room; else near the middle one.
    fn place_in(&mut self, canvas: &mut Canvas, text: &str, inner: &[Point]) -> Result<(), ChartError> {
        let half = 0.5 * canvas.text_width(text, Type::new(LABEL, INK).bold())? + 8.0;
        let roomy = inner.iter().find(|c| self.is_free([c.0 - half, c.1 - 22.0, c.0 + half, c.1 + 22.0]));
        match roomy.or(inner.get(inner.len() / 2)) {
            Some(anchor) => self.place(canvas, text, *anchor, 0.0),
            None => Ok(()),
        }
    }

    fn is_free(&self, place: [f64; 4]) -> bool {
        let [left, top, right, bottom] = place;
        let frame = self.frame;
        left > frame.left
            && top > frame.top
            && right < frame.right
            && bottom < frame.bottom
            && self.taken.iter().all(|t| right < t[0] || left > t[2] || bottom < t[1] || top > t[3])
            && !self.obstacles.iter().any(|p| p.0 > left && p.0 < right && p.1 > top && p.1 < bottom)
    }
}
