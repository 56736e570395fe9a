//! What is drawn of a test: traces of specimens in the units of the chart.

use std::collections::BTreeMap;

use crate::characterise::{FabricSheet, SpecimenResult, Window};
use crate::instrument::{Direction, Parameter, Test};
use crate::kes::{AxisSpec, TestSpec};
use crate::quantity::Curve;
use crate::report::number::unit_text;

use super::axes::Label;

/// The axes of a test: SI value of one unit of the chart, and what is written beside them.
pub(super) struct TestAxes {
    pub x_factor: f64,
    pub y_factor: f64,
    /// The unit of ordinates.
    pub y_unit: &'static str,
    pub x: Label,
    pub y: Label,
}

impl TestAxes {
    pub(super) fn of(test: Test) -> Self {
        let TestSpec { x, y, .. } = test.spec();
        Self {
            x_factor: x.kes_factor(),
            y_factor: y.kes_factor(),
            y_unit: y.kes,
            x: Label {
                quantity: x.label.into(),
                unit: match x.kes {
                    "deg" => "°".into(),
                    "1/cm" => "cm⁻¹".into(),
                    unit => unit_text(unit),
                },
                second: second(x),
            },
            y: Label { quantity: y.label.into(), unit: unit_text(y.kes), second: second(y) },
        }
    }

    /// A curve in the units of the chart.
    pub(super) fn convert(&self, curve: &Curve) -> Vec<(f64, f64)> {
        curve
            .points()
            .map(|(x, y)| (x / self.x_factor, y / self.y_factor))
            .filter(|(x, y)| x.is_finite() && y.is_finite())
            .collect()
    }
}

/// One specimen on the chart.
pub(super) struct Trace {
    pub direction: Option<Direction>,
    /// Specimen number; 0 for a schematic.
    pub specimen: usize,
    /// Whether it is drawn in full strength, with its windows.
    pub emphasised: bool,
    /// Its branches in order, in chart units, and whether each is outgoing.
    pub parts: Vec<(bool, Vec<(f64, f64)>)>,
    /// Windows and readings (SI).
    pub windows: Vec<Window>,
    /// Parameters of the specimen (SI).
    pub values: BTreeMap<Parameter, f64>,
}

/// The unit beside that of an axis: its size in the KES unit, and its text.
fn second(axis: &AxisSpec) -> Option<(f64, String)> {
    axis.beside.map(|(text, factor)| (factor / axis.kes_factor(), text.to_string()))
}

/// All specimens of a test; per direction the one nearest to the mean is emphasised.
pub(super) fn traces(sheet: &FabricSheet, test: Test, axes: &TestAxes) -> Vec<Trace> {
    let specimens: Vec<&SpecimenResult> =
        sheet.specimens.iter().filter(|s| s.measurement.test == test).collect();
    let mut traces: Vec<Trace> = specimens.iter().map(|s| trace(s, axes)).collect();
    let mut directions: Vec<Option<Direction>> = traces.iter().map(|t| t.direction).collect();
    directions.sort();
    directions.dedup();
    for direction in directions {
        let leading = test.spec().leading;
        let mean = sheet.get(leading, direction).map(|e| e.mean);
        let distance = |s: &SpecimenResult| match (mean, s.values.get(&leading)) {
            (Some(mean), Some(value)) => (value - mean).abs(),
            _ => f64::INFINITY,
        };
        let nearest = (0..specimens.len())
            .filter(|&i| traces[i].direction == direction)
            .min_by(|&a, &b| distance(specimens[a]).total_cmp(&distance(specimens[b])));
        if let Some(i) = nearest {
            traces[i].emphasised = true;
        }
    }
    traces
}

fn trace(specimen: &SpecimenResult, axes: &TestAxes) -> Trace {
    let parts = if specimen.branches.is_empty() {
        vec![(true, axes.convert(&specimen.measurement.curve))]
    } else {
        specimen.branches.iter().map(|b| (b.outgoing, axes.convert(&b.curve))).collect()
    };
    Trace {
        direction: specimen.measurement.direction,
        specimen: specimen.measurement.specimen,
        emphasised: false,
        parts,
        windows: specimen.windows.clone(),
        values: specimen.values.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_axis_has_a_finite_factor_and_si_beside() {
        for test in Test::ALL {
            let axes = TestAxes::of(test);
            assert!(axes.x_factor.is_finite() && axes.y_factor.is_finite(), "{test:?}");
            assert_eq!(axes.y.second.is_some(), test.shape() != crate::instrument::Shape::Sweep);
        }
        // 1 gf·cm/cm = 9.80665 mN·m/m: one mN·m/m is 1/9.80665 of our unit.
        let second = TestAxes::of(Test::Bending).y.second.unwrap();
        approx::assert_relative_eq!(second.0, 1.0 / 9.80665, max_relative = 1e-12);
    }
}
