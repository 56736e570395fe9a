//! The sheet at one moment.

use nalgebra::{Point3, UnitQuaternion};

use super::contact::Touch;
use crate::law;
use crate::mesh::QuadMesh;

/// Places and rotations of the nodes under a part of the load.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Where the nodes are (m).
    pub position: Vec<Point3<f64>>,
    /// How they have turned since the rest.
    pub rotation: Vec<UnitQuaternion<f64>>,
    /// Factor of the loads and held values.
    pub factor: f64,
    /// What a law with friction remembers.
    pub memory: Memory,
}

/// What a sheet with friction remembers of the equilibria that it has been through.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Memory {
    /// That of the laws of each smoothing cell, in the order of elements and cells; empty for new
    /// cloth, and without a law.
    pub cells: Vec<[law::State; 6]>,
    /// Energy that the laws lost since the rest (J).
    pub dissipated: f64,
    /// What nodes touch, for each node as many as there are surfaces; empty before the first equilibrium, and without.
    pub touches: Vec<Touch>,
}

impl State {
    /// The sheet at rest.
    pub fn rest(mesh: &QuadMesh) -> Self {
        Self {
            position: mesh.nodes.clone(),
            rotation: vec![UnitQuaternion::identity(); mesh.nodes.len()],
            factor: 0.0,
            memory: Memory::default(),
        }
    }

    /// Displacements and rotation vectors, six a node (m, rad); a rotation vector is at most π long.
    pub fn displacement(&self, mesh: &QuadMesh) -> Vec<f64> {
        let nodes = self.position.iter().zip(&mesh.nodes).zip(&self.rotation);
        nodes
            .flat_map(|((now, rest), turn)| {
                let (u, r) = (now - rest, turn.scaled_axis());
                [u.x, u.y, u.z, r.x, r.y, r.z]
            })
            .collect()
    }
}
