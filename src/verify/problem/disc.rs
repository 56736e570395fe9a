//! Circular plates on a mesh without right angles.

use nalgebra::Vector3;
use serde::Deserialize;

use super::setting::{CellLayout, DrillingChoice, Law, Statics, default_alpha, formulation};
use crate::mesh::disc;
use crate::model::{Load, Model, Support};
use crate::verify::error::VerifyError;

/// A clamped or simply supported disc of radius 1, rigidity 1, t = 1e-3, under unit pressure.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// Elements across the core; even.
    n: usize,
    /// Poisson's ratio.
    nu: f64,
    /// Whether the rim is clamped.
    clamped: bool,
    /// Whether a rim that is not clamped is held hard: no rotation about its normal.
    #[serde(default)]
    hard: bool,
    /// Smoothing cells.
    #[serde(default)]
    cells: CellLayout,
    /// Shear stabilisation.
    #[serde(default = "default_alpha")]
    alpha: f64,
}

impl Disc {
    /// `w D / (q R⁴)` at the centre.
    pub fn value(&self, statics: &mut Statics) -> Result<f64, VerifyError> {
        let mesh = disc(1.0, self.n)?;
        let support = if self.clamped {
            Support::clamped(mesh.set("outer")?)
        } else {
            Support::simple(&mesh, "outer", self.hard)?
        };
        let centre = mesh.set("centre")?[0] as usize;
        let model = Model {
            mesh,
            section: Law::Isotropic { nu: self.nu, thickness: 1e-3 }.section(),
            warp: Vector3::x(),
            formulation: formulation(self.cells, self.alpha, DrillingChoice::Scaled),
            supports: vec![support],
            loads: vec![Load::Pressure(1.0)],
            bodies: Vec::new(),
        };
        Ok(statics.solve(&model)?.displacement[6 * centre + 2])
    }
}
