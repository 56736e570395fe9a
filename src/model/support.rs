//! Where a sheet is held, and at which values.

use std::collections::HashMap;

use super::{Dof, HardEdge, ModelError};
use crate::mesh::{MeshError, QuadMesh};

/// Dofs held at a value on some nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Support {
    /// The nodes.
    pub nodes: Vec<u32>,
    /// The dofs held, each with its value (m or rad).
    pub held: Vec<(Dof, f64)>,
    /// Edges that do not turn about their normals; where these are no axes, in linear analyses only.
    pub hard: Vec<HardEdge>,
}

impl Support {
    /// All six dofs held at zero.
    pub fn clamped(nodes: &[u32]) -> Self {
        Self::fix(nodes, &Dof::ALL)
    }

    /// Dofs held at zero.
    pub fn fix(nodes: &[u32], dofs: &[Dof]) -> Self {
        Self::at(nodes.to_vec(), dofs.iter().map(|d| (*d, 0.0)).collect())
    }

    /// Dofs held at values (m or rad).
    pub fn at(nodes: Vec<u32>, held: Vec<(Dof, f64)>) -> Self {
        Self { nodes, held, hard: Vec::new() }
    }

    /// The plane x = const through the nodes is one of symmetry.
    pub fn symmetry_x(nodes: &[u32]) -> Self {
        Self::fix(nodes, &[Dof::U, Dof::ThetaY, Dof::ThetaZ])
    }

    /// The plane y = const through the nodes is one of symmetry.
    pub fn symmetry_y(nodes: &[u32]) -> Self {
        Self::fix(nodes, &[Dof::V, Dof::ThetaX, Dof::ThetaZ])
    }

    /// A simple support of a boundary set: no displacement in any direction, whichever way the sheet lies; free
    /// rotation.
    ///
    /// `hard` also holds the rotation that would lift the edge line, `θ·n` with `n` the normal of each
    /// edge in the plane of its element, as a thin plate on a support does; soft leaves it free.
    ///
    /// # Errors
    /// M007 for an unknown set.
    pub fn simple(mesh: &QuadMesh, set: &str, hard: bool) -> Result<Self, MeshError> {
        let edges = if hard { mesh.set_edges(set)? } else { Vec::new() };
        let normals = mesh.edge_normals(&edges);
        Ok(Self {
            // In a plane z = const: on an edge along x, w = 0 means w,x = -θy = 0; along y it is w,y = θx.
            hard: edges.into_iter().zip(normals).map(|(nodes, up)| HardEdge { nodes, up }).collect(),
            ..Self::fix(mesh.set(set)?, &[Dof::U, Dof::V, Dof::W])
        })
    }

    /// Refuses supports that hold one dof of one node at different values, of which only the last would count.
    ///
    /// # Errors
    /// M014.
    pub fn agree(mesh: &QuadMesh, supports: &[Self]) -> Result<(), ModelError> {
        let mut values: HashMap<(u32, usize), f64> = HashMap::new();
        for support in supports {
            for node in &support.nodes {
                for &(dof, value) in &support.held {
                    let first = *values.entry((*node, dof as usize)).or_insert(value);
                    if first != value {
                        let at = mesh.nodes[*node as usize].coords.into();
                        return Err(ModelError::TwoValues { dof: dof.name(), values: [first, value], at });
                    }
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::mesh::rectangle;

    #[test]
    fn two_values_of_one_dof_are_refused() {
        let mesh = rectangle(1.0, 1.0, 2, 2).unwrap();
        let prescribed =
            |set: &str, dof, value| Support::at(mesh.set(set).unwrap().to_vec(), vec![(dof, value)]);
        let agree = |second| Support::agree(&mesh, &[prescribed("left", Dof::W, 1e-3), second]);
        assert_eq!(agree(prescribed("bottom", Dof::W, 1e-3)), Ok(()));
        assert_eq!(agree(prescribed("bottom", Dof::U, 2e-3)), Ok(()));
        assert_eq!(agree(prescribed("right", Dof::W, 2e-3)), Ok(()));
        let refused = agree(prescribed("bottom", Dof::W, 2e-3)).unwrap_err();
        assert_eq!(refused.code(), "M014");
        assert_eq!(mesh.nodes[0], Point3::origin());
        assert!(refused.to_string().contains("w of the node at (0, 0, 0) m"), "{refused}");
        assert!(refused.to_string().contains("as 0.001 and as 0.002 m"), "{refused}");
    }
}
