//! The axes of the tests, as charts and the page label them.

use crate::instrument::Test;
use crate::quantity::Unit;

/// What stands beside an axis, in KES units and in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis {
    /// E.g. `Curvature K`.
    pub quantity: &'static str,
    /// The customary unit of the KES literature.
    pub kes_unit: &'static str,
    /// SI value of one KES unit.
    pub kes_factor: f64,
    /// The SI unit and its SI value, where charts name it beside the other.
    pub si: Option<(&'static str, f64)>,
}

/// Abscissa and ordinate of a test.
pub(crate) fn axes(test: Test) -> [Axis; 2] {
    match test {
        Test::Tensile => [
            axis("Strain ε", "%", Some(("m/m", 1.0))),
            axis("Force per width F", "gf/cm", Some(("N/m", 1.0))),
        ],
        Test::Shear => [
            axis("Shear angle φ", "deg", Some(("rad", 1.0))),
            axis("Shear force F", "gf/cm", Some(("N/m", 1.0))),
        ],
        Test::Bending => [
            axis("Curvature K", "1/cm", Some(("m⁻¹", 1.0))),
            axis("Moment per width M", "gf·cm/cm", Some(("mN·m/m", 1e-3))),
        ],
        Test::Compression => {
            [axis("Thickness T", "mm", None), axis("Pressure P", "gf/cm²", Some(("kPa", 1e3)))]
        }
        Test::Friction => [axis("Position x", "cm", None), axis("Coefficient of friction µ", "1", None)],
        Test::Roughness => [axis("Position x", "cm", None), axis("Height of the surface", "um", None)],
    }
}

fn axis(quantity: &'static str, kes_unit: &'static str, si: Option<(&'static str, f64)>) -> Axis {
    // The tests name units of the table in `quantity`; a test of the charts reads them all.
    let kes_factor = Unit::parse(kes_unit).map_or(f64::NAN, |u| u.factor);
    Axis { quantity, kes_unit, kes_factor, si }
}
