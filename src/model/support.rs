//! Where a sheet is held, and at which values.

use std::collections::HashMap;

use super::{Dof, ModelError};
use crate::mesh::QuadMesh;

/// Dofs held at a value on some nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    /// The nodes.
    pub nodes: Vec<u32>,
    /// The dofs held, each with its value (m or rad).
    pub held: Vec<(Dof, f64)>,
}

impl Support {
    /// All six dofs held at zero.
    pub fn clamped(nodes: &[u32]) -> Self {
        Self::fix(nodes, &Dof::ALL)
    }

    /// Dofs held at zero.
    pub fn fix(nodes: &[u32], dofs: &[Dof]) -> Self {
        Self { nodes: nodes.to_vec(), held: dofs.iter().map(|d| (*d, 0.0)).collect() }
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
    /// M007 for an unknown set; M009 for a hard support on an edge whose normal n is not along x, y or z.
    pub fn simple(mesh: &QuadMesh, set: &str, hard: bool) -> Result<Vec<Self>, ModelError> {
        let mut supports = vec![Self::fix(mesh.set(set)?, &[Dof::U, Dof::V, Dof::W])];
        if !hard {
            return Ok(supports);
        }
        let mut held: [Vec<u32>; 3] = Default::default();
        let edges = mesh.set_edges(set)?;
        for ([a, b], normal) in edges.iter().zip(mesh.edge_normals(&edges)) {
            let along = mesh.nodes[*b as usize] - mesh.nodes[*a as usize];
            // In a plane z = const: on an edge along x, w = 0 means w,x = -θy = 0; along y it is w,y = θx.
            let direction = along.cross(&normal).normalize();
            let Some(axis) = direction.iter().position(|c| c.abs() > 1.0 - 1e-9) else {
                return Err(ModelError::SkewHardSupport {
                    set: set.to_string(),
                    direction: direction.into(),
                });
            };
            held[axis].extend([a, b]);
        }
        let rotations = [Dof::ThetaX, Dof::ThetaY, Dof::ThetaZ];
        supports.extend(rotations.iter().zip(&held).map(|(dof, nodes)| Self::fix(nodes, &[*dof])));
        Ok(supports)
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
    use nalgebra::{Point3, Rotation3, Vector3};

    use super::*;
    use crate::mesh::rectangle;

    /// Nodes of a unit square whose rotation is held, by dof, after it was turned: its edge along x is `bottom`.
    fn held(turn: &Rotation3<f64>, set: &str) -> Result<Vec<Dof>, ModelError> {
        let mut mesh = rectangle(1.0, 1.0, 2, 2).unwrap();
        mesh.nodes.iter_mut().for_each(|p| *p = (turn * *p).map(|c: f64| (c * 1e15).round() / 1e15));
        let supports = Support::simple(&mesh, set, true)?;
        assert_eq!(supports[0].held, [(Dof::U, 0.0), (Dof::V, 0.0), (Dof::W, 0.0)]);
        Ok(supports[1..].iter().filter(|s| s.nodes.len() == 4).map(|s| s.held[0].0).collect())
    }

    /// On any sheet it is the rotation about the normal of the edge in the sheet, never that about the sheet's own.
    #[test]
    fn a_hard_support_holds_the_rotation_about_the_normal_of_the_edge() {
        let right = std::f64::consts::FRAC_PI_2;
        let flat = Rotation3::identity();
        assert_eq!(held(&flat, "bottom").unwrap(), [Dof::ThetaY]);
        assert_eq!(held(&flat, "left").unwrap(), [Dof::ThetaX]);
        // In the plane x-z: the edge `left` goes up.
        let upright = Rotation3::from_axis_angle(&Vector3::x_axis(), right);
        assert_eq!(held(&upright, "bottom").unwrap(), [Dof::ThetaZ]);
        assert_eq!(held(&upright, "left").unwrap(), [Dof::ThetaX]);
        // In the plane y-z: the edge `bottom` goes down.
        let aside = Rotation3::from_axis_angle(&Vector3::y_axis(), right);
        assert_eq!(held(&aside, "bottom").unwrap(), [Dof::ThetaY]);
        assert_eq!(held(&aside, "left").unwrap(), [Dof::ThetaZ]);
        // A roof that rises across x: edges along x have an oblique normal, the others do not.
        let roof = Rotation3::from_axis_angle(&Vector3::x_axis(), 0.5);
        assert_eq!(held(&roof, "left").unwrap(), [Dof::ThetaX]);
        let refused = held(&roof, "bottom").unwrap_err();
        assert_eq!(refused.code(), "M009");
        assert!(refused.to_string().contains("(0.000, -0.878, -0.479)"), "{refused}");
        let skew = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.5);
        assert!(held(&skew, "bottom").unwrap_err().to_string().contains("simply_supported_soft"));
    }

    #[test]
    fn two_values_of_one_dof_are_refused() {
        let mesh = rectangle(1.0, 1.0, 2, 2).unwrap();
        let moved = |set: &str, dof, value| Support {
            nodes: mesh.set(set).unwrap().to_vec(),
            held: vec![(dof, value)],
        };
        let agree = |second| Support::agree(&mesh, &[moved("left", Dof::W, 1e-3), second]);
        assert_eq!(agree(moved("bottom", Dof::W, 1e-3)), Ok(()));
        assert_eq!(agree(moved("bottom", Dof::U, 2e-3)), Ok(()));
        assert_eq!(agree(moved("right", Dof::W, 2e-3)), Ok(()));
        let refused = agree(moved("bottom", Dof::W, 2e-3)).unwrap_err();
        assert_eq!(refused.code(), "M014");
        assert_eq!(mesh.nodes[0], Point3::origin());
        assert!(refused.to_string().contains("w of the node at (0, 0, 0) m"), "{refused}");
        assert!(refused.to_string().contains("as 0.001 and as 0.002 m"), "{refused}");
    }
}
