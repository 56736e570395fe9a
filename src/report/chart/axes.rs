//! Axes: ranges, ticks at round numbers, and the frame that maps data to the page.

use super::canvas::{Align, Canvas, Point, Stroke, Type};
use super::error::ChartError;
use super::palette::{GREY, GRID, INK};
use crate::report::number::{fixed, power_of_ten};

const TICK: f64 = 9.0;
const TICK_TEXT: f64 = 26.0;
const AXIS_TEXT: f64 = 30.0;

/// Values with their texts, and the power of ten that was taken out of the texts.
pub(super) type Ticks = (Vec<(f64, String)>, Option<String>);

/// The range of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub from: f64,
    pub to: f64,
    /// Whether equal ratios are equally far apart.
    pub log: bool,
}

impl Range {
    /// The range of the finite values with a margin of 4 %; never empty.
    pub(super) fn around(values: impl IntoIterator<Item = f64>) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for v in values.into_iter().filter(|v| v.is_finite()) {
            (low, high) = (low.min(v), high.max(v));
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        if high - low <= 1e-9 * low.abs().max(high.abs()) {
            let half = if low == 0.0 { 1.0 } else { 0.5 * low.abs() };
            (low, high) = (low - half, high + half);
        }
        let margin = 0.04 * (high - low);
        Self { from: low - margin, to: high + margin, log: false }
    }

    /// A logarithmic range of positive values with a little margin.
    pub(super) fn logarithmic(low: f64, high: f64) -> Self {
        Self { from: low / 1.25, to: high * 1.25, log: true }
    }

    /// The same range in a unit of which one is `factor` of ours.
    pub(super) fn in_unit(self, factor: f64) -> Self {
        Self { from: self.from / factor, to: self.to / factor, ..self }
    }

    /// Position as a fraction of the range.
    pub(super) fn fraction(self, value: f64) -> f64 {
        if self.log {
            (value / self.from).ln() / (self.to / self.from).ln()
        } else {
            (value - self.from) / (self.to - self.from)
        }
    }

    /// About `count` ticks at 1, 2 or 5 times a power of ten, with their texts, and the power of ten that was
    /// taken out of the texts.
    pub(super) fn ticks(self, count: usize) -> Ticks {
        if self.log {
            return (self.log_ticks(), None);
        }
        let step = nice_step(self.to - self.from, count);
        let (first, last) = ((self.from / step).ceil() as i64, (self.to / step).floor() as i64);
        let largest = self.from.abs().max(self.to.abs());
        let exponent = largest.log10().floor() as i32;
        let exponent = if (-2..5).contains(&exponent) { 0 } else { exponent };
        let scale = 10f64.powi(exponent);
        // The step has one digit, so its decade says how many decimals tell two ticks apart.
        let decimals = usize::try_from(-(step / scale * 1.000_001).log10().floor() as i32).unwrap_or(0);
        let ticks = (first..=last)
            .map(|i| i as f64 * step)
            .map(|value| (value, fixed(value / scale, decimals)))
            .collect();
        (ticks, (exponent != 0).then(|| power_of_ten(exponent)))
    }

    fn log_ticks(self) -> Vec<(f64, String)> {
        let decades = (self.to / self.from).log10();
        let digits: &[f64] = if decades < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let (first, last) = (self.from.log10().floor() as i32, self.to.log10().ceil() as i32);
        (first..=last)
            .flat_map(|e| digits.iter().map(move |d| (e, d * 10f64.powi(e))))
            .filter(|(_, v)| (self.from..=self.to).contains(v))
            .map(|(e, v)| {
                let plain = fixed(v, usize::try_from(-e).unwrap_or(0));
                let digit = (v / 10f64.powi(e)).round();
                let text = match e {
                    -3..=4 => plain,
                    e if digit == 1.0 => power_of_ten(e),
                    e => format!("{digit}·{}", power_of_ten(e)),
                };
                (v, text)
            })
            .collect()
    }
}

/// The step 1, 2 or 5 times a power of ten that cuts `span` into about `count` pieces.
fn nice_step(span: f64, count: usize) -> f64 {
    let raw = span / count.max(1) as f64;
    let decade = 10f64.powf(raw.log10().floor());
    let digit = match raw / decade {
        d if d < 1.5 => 1.0,
        d if d < 3.5 => 2.0,
        d if d < 7.5 => 5.0,
        _ => 10.0,
    };
    digit * decade
}

/// What is written at an axis: the quantity, its unit, and a second unit for the opposite side.
#[derive(Clone, Debug)]
pub(super) struct Label {
    pub quantity: String,
    /// Unit text; empty for a pure number.
    pub unit: String,
    /// How many of our units one of the second unit is, and its text.
    pub second: Option<(f64, String)>,
}

impl Label {
    pub(super) fn new(quantity: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { quantity: quantity.into(), unit: unit.into(), second: None }
    }

    fn text(&self, unit: &str, power: Option<&str>) -> String {
        let inside: Vec<&str> = power.into_iter().chain((!unit.is_empty()).then_some(unit)).collect();
        if inside.is_empty() {
            return self.quantity.clone();
        }
        format!("{} ({})", self.quantity, inside.join(" "))
    }
}

/// A rectangle of the page with its two axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
    pub x: Range,
    pub y: Range,
}

impl Frame {
    /// Where a pair of values is on the page.
    pub(super) fn at(&self, x: f64, y: f64) -> Point {
        (
            self.left + self.x.fraction(x) * (self.right - self.left),
            self.bottom - self.y.fraction(y) * (self.bottom - self.top),
        )
    }

    /// Grid, ticks, numbers, labels and the frame itself. The grid is left out where colour fills the frame.
    pub(super) fn draw(
        &self,
        canvas: &mut Canvas,
        x: &Label,
        y: &Label,
        grid: bool,
    ) -> Result<(), ChartError> {
        let thin = Stroke::solid(GRID, 1.6);
        let x_ticks = self.x_ticks(canvas, self.x)?;
        let y_ticks = self.y.ticks(self.y_count());
        if grid {
            for (value, _) in &x_ticks.0 {
                let at = self.at(*value, self.y.from).0;
                canvas.line(&[(at, self.top), (at, self.bottom)], thin)?;
            }
            for (value, _) in &y_ticks.0 {
                let at = self.at(self.x.from, *value).1;
                canvas.line(&[(self.left, at), (self.right, at)], thin)?;
            }
            self.zero_lines(canvas)?;
        }
        self.x_axis(canvas, &x_ticks, x, false)?;
        self.y_axis(canvas, &y_ticks, y, false)?;
        if let Some((factor, _)) = x.second {
            let other = self.x.in_unit(factor);
            let mut ticks = self.x_ticks(canvas, other)?;
            ticks.0.iter_mut().for_each(|t| t.0 *= factor);
            self.x_axis(canvas, &ticks, x, true)?;
        }
        if let Some((factor, _)) = y.second {
            let mut ticks = self.y.in_unit(factor).ticks(self.y_count());
            ticks.0.iter_mut().for_each(|t| t.0 *= factor);
            self.y_axis(canvas, &ticks, y, true)?;
        }
        let corners = [
            (self.left, self.top),
            (self.right, self.top),
            (self.right, self.bottom),
            (self.left, self.bottom),
            (self.left, self.top),
        ];
        canvas.line(&corners, Stroke::solid(INK, 2.4))
    }

    fn zero_lines(&self, canvas: &mut Canvas) -> Result<(), ChartError> {
        let axis = Stroke::solid(GREY, 1.8);
        if !self.x.log && self.x.from < 0.0 && self.x.to > 0.0 {
            let at = self.at(0.0, self.y.from).0;
            canvas.line(&[(at, self.top), (at, self.bottom)], axis)?;
        }
        if !self.y.log && self.y.from < 0.0 && self.y.to > 0.0 {
            let at = self.at(self.x.from, 0.0).1;
            canvas.line(&[(self.left, at), (self.right, at)], axis)?;
        }
        Ok(())
    }

    fn y_count(&self) -> usize {
        (((self.bottom - self.top) / 110.0).round() as usize).max(2)
    }

    /// As many ticks as fit without touching.
    fn x_ticks(&self, canvas: &Canvas, range: Range) -> Result<Ticks, ChartError> {
        let width = self.right - self.left;
        let mut count = ((width / 110.0).round() as usize).max(2);
        loop {
            let ticks = range.ticks(count);
            let mut widest = 0f64;
            for (_, text) in &ticks.0 {
                widest = widest.max(canvas.text_width(text, Type::new(TICK_TEXT, INK))?);
            }
            if count == 2 || (widest + 24.0) * ticks.0.len() as f64 <= width {
                return Ok(ticks);
            }
            count -= 1;
        }
    }

    fn x_axis(
        &self,
        canvas: &mut Canvas,
        ticks: &Ticks,
        label: &Label,
        second: bool,
    ) -> Result<(), ChartError> {
        let color = if second { GREY } else { INK };
        let number = Type::new(TICK_TEXT, color).align(Align::Centre);
        let title = Type::new(AXIS_TEXT, color).align(Align::Centre);
        let (edge, out) = if second { (self.top, -1.0) } else { (self.bottom, 1.0) };
        for (value, text) in &ticks.0 {
            let at = self.at(*value, self.y.from).0;
            canvas.line(&[(at, edge), (at, edge + out * TICK)], Stroke::solid(color, 2.0))?;
            let baseline = if second { edge - TICK - 8.0 } else { edge + TICK + 28.0 };
            canvas.text((at, baseline), text, number)?;
        }
        let unit = if second { label.second.as_ref().map_or("", |s| s.1.as_str()) } else { &label.unit };
        let baseline = if second { edge - TICK - 46.0 } else { edge + TICK + 74.0 };
        let middle = 0.5 * (self.left + self.right);
        canvas.text((middle, baseline), &label.text(unit, ticks.1.as_deref()), title)
    }

    fn y_axis(
        &self,
        canvas: &mut Canvas,
        ticks: &Ticks,
        label: &Label,
        second: bool,
    ) -> Result<(), ChartError> {
        let color = if second { GREY } else { INK };
        let number = Type::new(TICK_TEXT, color).align(if second { Align::Left } else { Align::Right });
        let title = Type::new(AXIS_TEXT, color).align(Align::Centre);
        let (edge, out) = if second { (self.right, 1.0) } else { (self.left, -1.0) };
        let mut widest = 0f64;
        for (value, text) in &ticks.0 {
            let at = self.at(self.x.from, *value).1;
            canvas.line(&[(edge, at), (edge + out * TICK, at)], Stroke::solid(color, 2.0))?;
            canvas.text((edge + out * (TICK + 7.0), at + 0.36 * TICK_TEXT), text, number)?;
            widest = widest.max(canvas.text_width(text, number)?);
        }
        let unit = if second { label.second.as_ref().map_or("", |s| s.1.as_str()) } else { &label.unit };
        let gap = TICK + 7.0 + widest + 18.0;
        let baseline = if second { edge + gap + AXIS_TEXT * 0.75 } else { edge - gap };
        let middle = 0.5 * (self.top + self.bottom);
        canvas.text_upwards((baseline, middle), &label.text(unit, ticks.1.as_deref()), title)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(from: f64, to: f64, count: usize) -> Vec<String> {
        Range { from, to, log: false }.ticks(count).0.into_iter().map(|t| t.1).collect()
    }

    #[test]
    fn ticks_are_round_numbers_without_stray_digits() {
        assert_eq!(texts(-0.26, 0.26, 5), ["−0.2", "−0.1", "0.0", "0.1", "0.2"]);
        assert_eq!(texts(0.0, 520.0, 5), ["0", "100", "200", "300", "400", "500"]);
        assert_eq!(texts(0.98, 1.02, 4), ["0.98", "0.99", "1.00", "1.01", "1.02"]);
        let (ticks, power) = Range { from: 0.0, to: 3.1e-6, log: false }.ticks(3);
        assert_eq!(ticks.iter().map(|t| t.1.as_str()).collect::<Vec<_>>(), ["0", "1", "2", "3"]);
        assert_eq!(power.as_deref(), Some("10⁻⁶"));
    }

    #[test]
    fn a_range_is_never_empty() {
        for values in [vec![], vec![3.0], vec![0.0, 0.0], vec![f64::NAN, 2.0, 2.0]] {
            let r = Range::around(values);
            assert!(r.to > r.from);
            assert!(!r.ticks(5).0.is_empty());
        }
    }

    #[test]
    fn logarithmic_ticks_are_1_2_5() {
        let texts: Vec<String> =
            Range { from: 0.008, to: 0.3, log: true }.ticks(5).0.into_iter().map(|t| t.1).collect();
        assert_eq!(texts, ["0.01", "0.02", "0.05", "0.1", "0.2"]);
        let r = Range { from: 0.01, to: 1.0, log: true };
        assert!((r.fraction(0.1) - 0.5).abs() < 1e-12);
    }
}
