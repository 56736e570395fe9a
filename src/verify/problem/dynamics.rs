//! Newmark's method against the superposition of all modes of the same model.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector, SymmetricEigen, Vector3};
use serde::Deserialize;

use super::setting::Law;
use crate::element::{Formulation, Mass};
use crate::mesh::rectangle;
use crate::model::{DofGroup, Load, Model, Support};
use crate::solve::assemble::{Kind, Pattern, assemble};
use crate::solve::factor::FactorError;
use crate::solve::newmark::{LoadHistory, Rayleigh, Settings, newmark};
use crate::solve::{Options, SolveError};
use crate::verify::error::VerifyError;

/// A clamped unit square of 8 x 8 elements under a step of pressure, from rest, over two periods of the
/// first mode; consistent mass.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NewmarkProblem {
    /// Steps per period of the first mode.
    steps: f64,
    /// Damping ratio of the first and fourth mode (Rayleigh).
    #[serde(default)]
    damping: f64,
    /// What is taken.
    measure: Measure,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Measure {
    /// Largest error of the central deflection over the static one.
    Error,
    /// `log2` of the ratio of that error to the one with half the step.
    Slope,
    /// Largest imbalance of the energies over the largest work.
    Imbalance,
}

const CELLS: usize = 8;
/// The dof of the central deflection.
const CENTRE: usize = 6 * ((CELLS / 2) * (CELLS + 1) + CELLS / 2) + 2;

fn plate() -> Result<Model, VerifyError> {
    let mesh = rectangle(1.0, 1.0, CELLS, CELLS)?;
    let supports = vec![Support::clamped(mesh.set("boundary")?)];
    Ok(Model {
        mesh,
        section: Law::Isotropic { nu: 0.3, thickness: 1e-2 }.section(),
        warp: Vector3::x(),
        formulation: Formulation::default(),
        supports,
        loads: vec![Load::Pressure(1.0)],
        bodies: Vec::new(),
    })
}

impl NewmarkProblem {
    /// The value.
    pub fn value(&self) -> Result<f64, VerifyError> {
        let model = plate()?;
        let modes = Superposition::new(&model)?;
        let (error, imbalance) = self.errors(&model, &modes, self.steps)?;
        Ok(match self.measure {
            Measure::Error => error,
            Measure::Slope => (error / self.errors(&model, &modes, 2.0 * self.steps)?.0).log2(),
            Measure::Imbalance => imbalance,
        })
    }

    fn errors(&self, model: &Model, modes: &Superposition, steps: f64) -> Result<(f64, f64), VerifyError> {
        let damping = if self.damping > 0.0 {
            Rayleigh::from_ratios([self.damping; 2], [modes.omega[0], modes.omega[3]])
        } else {
            Rayleigh::default()
        };
        let period = TAU / modes.omega[0];
        let settings = Settings {
            duration: 2.0 * period,
            step: period / steps,
            tolerance: None,
            damping,
            load: LoadHistory::Step,
            mass: Mass::Consistent,
        };
        let (mut error, mut imbalance, mut work) = (0.0f64, 0.0f64, 0.0f64);
        newmark(model, &settings, &Options::default(), |at| {
            error = error.max((at.displacement[CENTRE] - modes.at(at.time, damping)).abs());
            imbalance = imbalance.max(at.energy.imbalance().abs());
            work = work.max(at.energy.work.abs());
            ControlFlow::Continue(())
        })?;
        Ok((error / modes.static_value(), imbalance / work))
    }
}

/// Every mode of the plate, from dense matrices: angular frequency, and share in the central deflection
/// under the load.
struct Superposition {
    omega: Vec<f64>,
    share: Vec<f64>,
}

impl Superposition {
    fn new(model: &Model) -> Result<Self, VerifyError> {
        let group = DofGroup::Plate;
        let full = |part: usize| 6 * (part / 3) + group.dofs()[part % 3] as usize;
        let constraints = model.constraints();
        let held: Vec<bool> = (0..constraints.len() / 2).map(|k| constraints[full(k)].is_some()).collect();
        let free: Vec<usize> = (0..held.len()).filter(|k| !held[*k]).collect();
        let pattern = Pattern::new(&model.mesh, model.links()?);
        let dense = |kind| -> Result<DMatrix<f64>, VerifyError> {
            let matrix = assemble(model, group, &pattern, &[(kind, 1.0)], &held)?;
            let mut columns = DMatrix::zeros(free.len(), free.len());
            let (mut unit, mut image) = (vec![0.0; held.len()], vec![0.0; held.len()]);
            for (j, k) in free.iter().enumerate() {
                unit[*k] = 1.0;
                matrix.mul(&unit, &mut image);
                unit[*k] = 0.0;
                free.iter().enumerate().for_each(|(i, row)| columns[(i, j)] = image[*row]);
            }
            Ok(columns)
        };
        let (k, m) = (dense(Kind::Stiffness)?, dense(Kind::Mass(Mass::Consistent))?);
        let singular =
            || SolveError::Factor(FactorError::NotPositiveDefinite { node: 0, dof: 0, pivot: 0.0 });
        let lower = m.cholesky().ok_or_else(singular)?.l();
        let half = lower.solve_lower_triangular(&k).ok_or_else(singular)?;
        let reduced = lower.solve_lower_triangular(&half.transpose()).ok_or_else(singular)?;
        let eigen = SymmetricEigen::new(0.5 * (&reduced + reduced.transpose()));
        let shapes = lower.tr_solve_lower_triangular(&eigen.eigenvectors).ok_or_else(singular)?;
        let load = model.load_vector();
        let force = DVector::from_iterator(free.len(), free.iter().map(|k| load[full(*k)]));
        let centre = free.iter().position(|k| full(*k) == CENTRE).unwrap_or(0);
        let mut pairs: Vec<(f64, f64)> = eigen
            .eigenvalues
            .iter()
            .zip(shapes.column_iter())
            .map(|(value, shape)| (value.sqrt(), shape[centre] * shape.dot(&force)))
            .collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (omega, share) = pairs.into_iter().unzip();
        Ok(Self { omega, share })
    }

    fn at(&self, t: f64, damping: Rayleigh) -> f64 {
        self.omega.iter().zip(&self.share).map(|(w, share)| share * step_response(*w, damping, t)).sum()
    }

    fn static_value(&self) -> f64 {
        self.omega.iter().zip(&self.share).map(|(w, share)| share / (w * w)).sum()
    }
}

/// Displacement of the oscillator of unit mass after a unit step of force.
fn step_response(w: f64, damping: Rayleigh, t: f64) -> f64 {
    let zeta = 0.5 * (damping.alpha / w + damping.beta * w);
    let decay = zeta * w;
    if zeta < 1.0 {
        let wd = w * (1.0 - zeta * zeta).sqrt();
        let (s, c) = (wd * t).sin_cos();
        return (1.0 - (-decay * t).exp() * (c + decay / wd * s)) / (w * w);
    }
    // Overdamped: the two real roots -r1, -r2; r1 by the product of the roots, free of cancellation.
    let r2 = decay + w * (zeta * zeta - 1.0).sqrt();
    let r1 = w * w / r2;
    (1.0 - (r2 * (-r1 * t).exp() - r1 * (-r2 * t).exp()) / (r2 - r1)) / (w * w)
}
