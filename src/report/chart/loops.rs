//! What is drawn of a test: traces of specimens in the units of the chart.

use std::collections::BTreeMap;

use crate::characterise::{FabricSheet, SpecimenResult, Window};
use crate::instrument::{Direction, Parameter, Test};
use crate::quantity::{Curve, Unit};

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
        // quantity, KES unit, SI unit and the SI value of that unit; for x and y.
        let (x, y) = match test {
            Test::Tensile => {
                (("Strain ε", "%", Some(("m/m", 1.0))), ("Force per width F", "gf/cm", ("N/m", 1.0)))
            }
            Test::Shear => {
                (("Shear angle φ", "deg", Some(("rad", 1.0))), ("Shear force F", "gf/cm", ("N/m", 1.0)))
            }
            Test::Bending => (
                ("Curvature K", "1/cm", Some(("m⁻¹", 1.0))),
                ("Moment per width M", "gf·cm/cm", ("mN·m/m", 1e-3)),
            ),
            Test::Compression => (("Thickness T", "mm", None), ("Pressure P", "gf/cm²", ("kPa", 1e3))),
        };
        let (x_factor, y_factor) = (factor(x.1), factor(y.1));
        let second = |si: f64, text: &str, factor: f64| Some((si / factor, text.to_string()));
        Self {
            x_factor,
            y_factor,
            y_unit: y.1,
            x: Label {
                quantity: x.0.into(),
                unit: match x.1 {
                    "deg" => "°".into(),
                    "1/cm" => "cm⁻¹".into(),
                    unit => unit.into(),
                },
                second: x.2.and_then(|(text, si)| second(si, text, x_factor)),
            },
            y: Label { quantity: y.0.into(), unit: y.1.into(), second: second(y.2.1, y.2.0, y_factor) },
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

fn factor(unit: &str) -> f64 {
    // The four tests name units of the table in `quantity`; the tests of this module read them all.
    Unit::parse(unit).map_or(f64::NAN, |u| u.factor)
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

/// The parameter whose middle specimen is emphasised, per test.
pub(super) fn leading(test: Test) -> Parameter {
    match test {
        Test::Tensile => Parameter::Wt,
        Test::Shear => Parameter::G,
        Test::Bending => Parameter::B,
        Test::Compression => Parameter::Wc,
    }
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
        let mean = sheet.get(leading(test), direction).map(|e| e.mean);
        let distance = |s: &SpecimenResult| match (mean, s.values.get(&leading(test))) {
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
            assert!(axes.y.second.is_some());
        }
        // 1 gf·cm/cm = 9.80665 mN·m/m: one mN·m/m is 1/9.80665 of our unit.
        let second = TestAxes::of(Test::Bending).y.second.unwrap();
        approx::assert_relative_eq!(second.0, 1.0 / 9.80665, max_relative = 1e-12);
    }
}
