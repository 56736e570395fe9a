//! Eqs. (4) and (5) of Nguyen-Trong, Ferreira and Gomes as they are printed, beside the section that this program makes of
//! the same measurements.

use nalgebra::{Matrix3, Vector3};
use serde::Deserialize;

use crate::characterise::{FabricSheet, Key};
use crate::constitutive::{Assumptions, Torsion, section};
use crate::instrument::{Direction, Parameter};
use crate::quantity::Estimate;

/// A number of the matrices of a cloth: E t = 10,000 and 6,000 N/m, ν = 0.2 in both directions, G t = 40 N/m, B = 8e-6 and
/// 4e-6 N·m, H = 0, t = 0.4 mm.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Printed {
    /// Whose matrices.
    form: Form,
    /// What is taken of them.
    measure: Measure,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Form {
    /// As printed, B being what KES-FB2 measures.
    Printed,
    /// As printed, with B read as a modulus, 12 B/t³.
    Modulus,
    /// The section of this program.
    Corrected,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Measure {
    /// `D12 / D21` of D_m.
    Reciprocity,
    /// The energy that a closed cycle of strains gives, over that of its first strain: ε1, then ε2, then ε1 back, then ε2 back.
    CycleEnergy,
    /// `D11` of D_b over B along the warp.
    RigidityWarp,
    /// `D22` of D_b over B along the weft.
    RigidityWeft,
}

/// E t along warp and weft (N/m).
const TENSILE: [f64; 2] = [1e4, 6e3];
const POISSON: f64 = 0.2;
/// G t (N/m).
const SHEAR: f64 = 40.0;
/// B along warp and weft (N·m).
const BENDING: [f64; 2] = [8e-6, 4e-6];
/// t (m).
const THICKNESS: f64 = 4e-4;

impl Printed {
    /// The number; not one if there is no section.
    pub fn value(&self) -> f64 {
        let Some([d_m, d_b]) = self.matrices() else { return f64::NAN };
        match self.measure {
            Measure::Reciprocity => d_m[(0, 1)] / d_m[(1, 0)],
            Measure::CycleEnergy => cycle_energy(&d_m),
            Measure::RigidityWarp => d_b[(0, 0)] / BENDING[0],
            Measure::RigidityWeft => d_b[(1, 1)] / BENDING[1],
        }
    }

    /// D_m and D_b.
    fn matrices(&self) -> Option<[Matrix3<f64>; 2]> {
        match self.form {
            Form::Printed => Some([membrane_as_printed(), bending(THICKNESS.powi(3) / 12.0)]),
            Form::Modulus => Some([membrane_as_printed(), bending(1.0)]),
            Form::Corrected => {
                let assumptions =
                    Assumptions { poisson: POISSON, torsion: Torsion::Neglect, ..Assumptions::default() };
                let made = section(&cloth(), &assumptions).ok()?.section;
                Some([made.d_m, made.d_b])
            }
        }
    }
}

/// Eq. (5) without torsion: a factor times what KES-FB2 measures.
fn bending(factor: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(factor * BENDING[0], factor * BENDING[1], 0.0))
}

/// Eq. (4), the stray `t` of its last row left out: one ν in both rows.
fn membrane_as_printed() -> Matrix3<f64> {
    let [e1, e2] = TENSILE.map(|e| e / (1.0 - POISSON * POISSON));
    Matrix3::new(e1, POISSON * e1, 0.0, POISSON * e2, e2, 0.0, 0.0, 0.0, SHEAR)
}

/// `∮ σ dε` around a square of unit strains over `½ D11`.
fn cycle_energy(d: &Matrix3<f64>) -> f64 {
    // ε1 rises, ε2 rises at ε1 = 1, ε1 falls at ε2 = 1, ε2 falls at ε1 = 0.
    let rise = 0.5 * d[(0, 0)] + d[(1, 0)] + 0.5 * d[(1, 1)];
    let fall = 0.5 * d[(0, 0)] + d[(0, 1)] + 0.5 * d[(1, 1)];
    (rise - fall) / (0.5 * d[(0, 0)])
}

/// The cloth as KES measures it.
fn cloth() -> FabricSheet {
    let mut sheet = FabricSheet { name: "cloth of the paper".into(), ..FabricSheet::default() };
    for (k, direction) in [Direction::Warp, Direction::Weft].into_iter().enumerate() {
        sheet.moduli.insert(("tangent_low".into(), direction), Estimate::single(TENSILE[k]));
        let bending = Key { parameter: Parameter::B, direction: Some(direction) };
        sheet.values.insert(bending, Estimate::single(BENDING[k]));
    }
    for (parameter, value) in [(Parameter::G, SHEAR), (Parameter::T0, THICKNESS), (Parameter::W, 0.15)] {
        sheet.values.insert(Key { parameter, direction: None }, Estimate::single(value));
    }
    sheet
}
