//! Strips with a part that moves as one rigid body.

use nalgebra::{Point3, Vector3};
use serde::Deserialize;

use super::setting::{Law, Statics};
use crate::element::{Formulation, Mass};
use crate::mesh::rectangle;
use crate::model::{Dof, Load, Model, RigidBody, Support};
use crate::solve::{Options, modes};
use crate::verify::error::VerifyError;

/// A cantilever strip of length 1 and rigidity D = 1 (ν = 0), 2 cm wide, unit mass per area.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Rigid {
    /// Its end in a rigid clamp that is turned and free to follow: moment per width over D κ.
    Clamp {
        /// Elements along the strip.
        n: usize,
    },
    /// Its end in a rigid clamp, with a force at a point of reference half a length beyond: the deflection
    /// of that point over `F (L³/3 + 2 L² c/2 + L c²)/(D b)`, c = 1/2.
    Lever {
        /// Elements along the strip.
        n: usize,
    },
    /// A rigid plate of length 1/2 and the same mass per area beyond its end: `ω L² √(ρ/D)` of a mode.
    Plate {
        /// Elements along the strip, an even number.
        n: usize,
        /// Which mode, from 1.
        frequency: usize,
        /// The mass matrix.
        #[serde(default)]
        mass: Mass,
    },
}

const WIDTH: f64 = 0.02;

impl Rigid {
    /// The value.
    pub fn value(&self, statics: &mut Statics) -> Result<f64, VerifyError> {
        match *self {
            Self::Clamp { n } => {
                let (mut model, reference) = strip(n, 0.0)?;
                model.supports.push(Support::at(vec![reference], vec![(Dof::ThetaY, 0.1)]));
                let solution = statics.solve(&model)?;
                Ok(solution.reaction[6 * reference as usize + Dof::ThetaY as usize] / (0.1 * WIDTH))
            }
            Self::Lever { n } => {
                let (mut model, reference) = strip(n, 0.0)?;
                let (force, moment) = (Vector3::z(), Vector3::zeros());
                model.loads.push(Load::Point { nodes: vec![reference], force, moment });
                let w = statics.solve(&model)?.displacement[6 * reference as usize + Dof::W as usize];
                let c = 0.5;
                Ok(w * WIDTH / (1.0 / 3.0 + c + c * c))
            }
            Self::Plate { n, frequency, mass } => {
                let (model, _) = strip(n, 0.5)?;
                let found = modes(&model, frequency, mass, &Options::default())?;
                Ok(found.get(frequency - 1).map_or(f64::NAN, |m| m.angular_frequency))
            }
        }
    }
}

/// The strip with `n` elements along its length and a rigid plate of length `beyond`, and the point of
/// reference of the rigid part, at x = 1.5. The strip bends as a beam: θx, v and θz are held there.
fn strip(n: usize, beyond: f64) -> Result<(Model, u32), VerifyError> {
    let cells = n + (beyond * n as f64) as usize;
    let mut mesh = rectangle(1.0 + beyond, WIDTH, cells, 1)?;
    let rigid: Vec<u32> =
        (0..mesh.nodes.len() as u32).filter(|k| mesh.nodes[*k as usize].x > 1.0 - 1e-9).collect();
    let reference = mesh.nodes.len() as u32;
    mesh.nodes.push(Point3::new(1.5, 0.5 * WIDTH, 0.0));
    let supports = vec![
        Support::clamped(mesh.set("left")?),
        Support::fix(&[reference], &[Dof::V, Dof::ThetaX, Dof::ThetaZ]),
    ];
    let model = Model {
        mesh,
        section: Law::Isotropic { nu: 0.0, thickness: 1e-3 }.section(),
        warp: Vector3::x(),
        formulation: Formulation::default(),
        supports,
        loads: Vec::new(),
        bodies: vec![RigidBody { nodes: [&[reference], &rigid[..]].concat() }],
    };
    Ok((model, reference))
}
