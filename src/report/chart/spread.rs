//! Bands of 95 %: where the mean of the measured repeats lies, and the simulated curve of the mean fabric.

use crate::characterise::MeanBranch;
use crate::quantity::Curve;

use super::axes::Frame;
use super::canvas::{Canvas, Point, Stroke};
use super::error::ChartError;
use super::fabric::SimulatedCurve;
use super::loops::TestAxes;
use super::palette::{self, GREY, darker, lighter};
use super::panel::Row;

/// Bands in the units of a chart.
pub(super) struct Spread {
    /// Of each measured branch.
    measured: Vec<(MeanBranch, [Vec<Point>; 2])>,
    /// Both edges of each simulated curve that has a band, with their stroke.
    simulated: Vec<(Stroke, [Vec<Point>; 2])>,
}

impl Spread {
    pub fn of(measured: Vec<MeanBranch>, simulated: &[SimulatedCurve], axes: &TestAxes) -> Self {
        let edges = |low: &Curve, high: &Curve| [axes.convert(low), axes.convert(high)];
        let simulated = simulated.iter().filter_map(|s| {
            let [low, high] = s.band.as_ref()?;
            Some((simulated_edge(s), edges(low, high)))
        });
        Self {
            simulated: simulated.collect(),
            measured: measured
                .into_iter()
                .map(|m| {
                    let ends = edges(&m.low, &m.high);
                    (m, ends)
                })
                .collect(),
        }
    }

    /// Every point, for the ranges of the axes.
    pub fn points(&self) -> impl Iterator<Item = &Point> {
        let measured = self.measured.iter().flat_map(|(_, edges)| edges);
        measured.chain(self.simulated.iter().flat_map(|(_, edges)| edges)).flatten()
    }

    /// The bands of the measured means, below the curves.
    pub fn draw_measured(&self, canvas: &mut Canvas, frame: &Frame) -> Result<(), ChartError> {
        for (branch, [low, high]) in &self.measured {
            let around: Vec<Point> =
                low.iter().chain(high.iter().rev()).map(|p| frame.at(p.0, p.1)).collect();
            canvas.polygon(&around, measured_color(branch))?;
        }
        Ok(())
    }

    /// The edges of the simulated bands, over the curves.
    pub fn draw_simulated(&self, canvas: &mut Canvas, frame: &Frame) -> Result<(), ChartError> {
        for (stroke, edges) in &self.simulated {
            for edge in edges {
                let points: Vec<Point> = edge.iter().map(|p| frame.at(p.0, p.1)).collect();
                canvas.line(&points, *stroke)?;
            }
        }
        Ok(())
    }

    /// What the bands are, one line a direction.
    pub fn rows(&self, simulated: &[SimulatedCurve]) -> Vec<Row> {
        let mut rows = Vec::new();
        let mut named = Vec::new();
        for (branch, _) in &self.measured {
            if !named.contains(&branch.direction) {
                named.push(branch.direction);
                let who = branch.direction.map_or("mean".to_string(), |d| format!("{d} mean"));
                let text = format!("{who}, n = {}", branch.n);
                rows.push(Row::Sample(Stroke::solid(measured_color(branch), 24.0), text));
            }
        }
        for curve in simulated.iter().filter(|s| s.band.is_some()) {
            let who = curve.direction.map_or("simulated".to_string(), |d| format!("{d} simul."));
            let n = curve.repeats.map_or(String::new(), |n| format!(", n ≥ {n}"));
            rows.push(Row::Sample(simulated_edge(curve), format!("{who}{n}")));
        }
        let text = match (self.measured.is_empty(), self.simulated.is_empty()) {
            (true, true) => return rows,
            (false, true) => "Pale: 95 % interval of the mean.",
            (true, false) => "Dotted: 95 % band for the mean fabric.",
            (false, false) => "Pale and dotted: 95 % intervals of the mean.",
        };
        rows.push(Row::Remark(text.into(), GREY));
        rows
    }
}

fn measured_color(branch: &MeanBranch) -> plotters::prelude::RGBColor {
    lighter(palette::direction(branch.direction, 1.0).color, 0.72)
}

fn simulated_edge(curve: &SimulatedCurve) -> Stroke {
    let color = darker(palette::direction(curve.direction, 1.0).color, 0.55);
    Stroke { color, width: 2.0, dash: Some([6.0, 6.0]) }
}
