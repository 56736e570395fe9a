//! Strips of the corotational shell: along x, one element wide in cylindrical bending, or as wide as
//! they are cut.

use std::ops::ControlFlow;

use nalgebra::Vector3;

use crate::element::Formulation;
use crate::instrument::Direction;
use crate::mesh;
use crate::model::{Dof, Load, Model, Support};
use crate::quantity::{Curve, STANDARD_GRAVITY};
use crate::section::ShellSection;
use crate::solve::Options;
use crate::solve::nonlinear::{Settings, Solution, solve};
use crate::study::StudyError;

/// Elements along a strip where a case says nothing.
pub(super) const CELLS: usize = 32;

/// A strip under its own weight, at rest from x = 0 to x = length in z = 0.
#[derive(Clone, Debug)]
pub(super) struct Strip {
    /// Held against leaving the plane of bending, and nowhere else.
    pub model: Model,
    /// Nodes of the end x = 0.
    pub start: Vec<u32>,
    /// Nodes of the end x = length.
    pub end: Vec<u32>,
    /// Nodes along the middle, from start to end.
    pub line: Vec<u32>,
}

impl Strip {
    /// `cells` elements along a strip cut along `direction`. With a `width` its edges are free, and half of
    /// it is meshed with elements that are about square, but no narrower than those of 32 along; without, it is one
    /// square element wide and bends to a cylinder.
    ///
    /// # Errors
    /// M006 for a size that is not positive.
    pub fn new(
        section: &ShellSection,
        direction: Direction,
        length: f64,
        width: Option<f64>,
        cells: usize,
    ) -> Result<Self, StudyError> {
        let side = length / cells.max(1) as f64;
        let (width, across) = match width {
            Some(width) => {
                let across = side.max(length / CELLS as f64);
                (0.5 * width, (0.5 * width / across).round().max(1.0) as usize)
            }
            None => (side, 1),
        };
        let mesh = mesh::rectangle(length, width, cells, across)?;
        let nodes = |set: &str| mesh.set(set).map(<[u32]>::to_vec);
        let (start, end, line) = (nodes("left")?, nodes("right")?, nodes("bottom")?);
        let planar = if across == 1 { nodes("all")? } else { line.clone() };
        Ok(Self {
            model: Model {
                mesh,
                section: section.clone(),
                warp: warp(direction),
                formulation: Formulation::default(),
                supports: vec![Support::fix(&planar, &[Dof::V, Dof::ThetaX, Dof::ThetaZ])],
                loads: vec![Load::Gravity(Vector3::new(0.0, 0.0, -STANDARD_GRAVITY))],
                bodies: Vec::new(),
            },
            start,
            end,
            line,
        })
    }

    /// The middle of the strip in a state: x and z (m), from start to end.
    pub fn shape(&self, solution: &Solution) -> Curve {
        Curve::from_points(self.line.iter().map(|n| {
            let p = solution.state.position[*n as usize];
            (p.x, p.z)
        }))
    }

    /// The equilibrium under the whole load.
    ///
    /// # Errors
    /// N002, N007.
    pub fn solve(&self, settings: &Settings) -> Result<Solution, StudyError> {
        Ok(solve(&self.model, settings, &Options::default(), |_| ControlFlow::Continue(()))?)
    }
}

/// The warp of a strip that runs along x.
fn warp(direction: Direction) -> Vector3<f64> {
    match direction {
        Direction::Warp => Vector3::x(),
        Direction::Weft => Vector3::y(),
        Direction::Bias => Vector3::new(1.0, 1.0, 0.0),
    }
}

/// Rigidity of a strip in cylindrical bending along a direction (N·m).
pub(super) fn rigidity(section: &ShellSection, direction: Direction) -> f64 {
    let warp = warp(direction);
    section.rotated(warp.y.atan2(warp.x)).d_b[(0, 0)]
}
