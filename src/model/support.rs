//! Where a sheet is held, and at which values.

use std::collections::{BTreeMap, HashMap, HashSet};

use nalgebra::Vector3;

use super::{Dof, ModelError};
use crate::mesh::{MeshError, QuadMesh};

/// Dofs held at a value on some nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Support {
    /// The nodes.
    pub nodes: Vec<u32>,
    /// The dofs held, each with its value (m or rad).
    pub held: Vec<(Dof, f64)>,
    /// Nodes that do not turn about a direction of length 1 which is no axis; linear analyses only.
    pub about: Vec<(u32, Vector3<f64>)>,
}

/// Edges that meet at less than this (30°) are a line, straight or curved, and their common node is held about the mean
/// of their normals; at a corner it is held about both. A curve of straight edges held as corners would be clamped
/// (Babuška and Pitkäranta, *SIAM J. Math. Anal.* 21 (1990) 551).
const CORNER: f64 = std::f64::consts::FRAC_PI_6;

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
        Self { nodes, held, about: Vec::new() }
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
    pub fn simple(mesh: &QuadMesh, set: &str, hard: bool) -> Result<Vec<Self>, MeshError> {
        let mut supports = vec![Self::fix(mesh.set(set)?, &[Dof::U, Dof::V, Dof::W])];
        if !hard {
            return Ok(supports);
        }
        let mut normals: BTreeMap<u32, Vec<Vector3<f64>>> = BTreeMap::new();
        let mut edges = mesh.set_edges(set)?;
        // Edges of a mesh file may run either way.
        let counter_clockwise: HashSet<[u32; 2]> = mesh.boundary_edges().into_iter().collect();
        edges.iter_mut().filter(|[a, b]| counter_clockwise.contains(&[*b, *a])).for_each(|e| e.reverse());
        for ([a, b], up) in edges.iter().zip(mesh.edge_normals(&edges)) {
            let along = mesh.nodes[*b as usize] - mesh.nodes[*a as usize];
            // In a plane z = const: on an edge along x, w = 0 means w,x = -θy = 0; along y it is w,y = θx.
            let normal = along.cross(&up).normalize();
            for node in [a, b] {
                let of_node = normals.entry(*node).or_default();
                match of_node.iter_mut().find(|n| n.angle(&normal) < CORNER) {
                    Some(line) => *line = (*line + normal).normalize(),
                    None => of_node.push(normal),
                }
            }
        }
        let mut held: [Vec<u32>; 3] = Default::default();
        let mut about = Vec::new();
        for (node, normal) in normals.iter().flat_map(|(node, all)| all.iter().map(|n| (*node, *n))) {
            match normal.iter().position(|c| c.abs() > 1.0 - 1e-9) {
                Some(axis) => held[axis].push(node),
                None => about.push((node, normal)),
            }
        }
        let rotations = [Dof::ThetaX, Dof::ThetaY, Dof::ThetaZ];
        supports.extend(rotations.iter().zip(&held).map(|(dof, nodes)| Self::fix(nodes, &[*dof])));
        supports.push(Self { about, ..Self::default() });
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
    fn held(turn: &Rotation3<f64>, set: &str) -> (Vec<Dof>, Vec<(u32, Vector3<f64>)>) {
        let mut mesh = rectangle(1.0, 1.0, 2, 2).unwrap();
        mesh.nodes.iter_mut().for_each(|p| *p = (turn * *p).map(|c: f64| (c * 1e15).round() / 1e15));
        let supports = Support::simple(&mesh, set, true).unwrap();
        assert_eq!(supports[0].held, [(Dof::U, 0.0), (Dof::V, 0.0), (Dof::W, 0.0)]);
        let about = supports.iter().flat_map(|s| s.about.clone()).collect();
        (supports[1..].iter().filter(|s| !s.nodes.is_empty()).map(|s| s.held[0].0).collect(), about)
    }

    /// On any sheet it is the rotation about the normal of the edge in the sheet, never that about the sheet's own.
    #[test]
    fn a_hard_support_holds_the_rotation_about_the_normal_of_the_edge() {
        let right = std::f64::consts::FRAC_PI_2;
        let flat = Rotation3::identity();
        assert_eq!(held(&flat, "bottom"), (vec![Dof::ThetaY], vec![]));
        assert_eq!(held(&flat, "left"), (vec![Dof::ThetaX], vec![]));
        // In the plane x-z: the edge `left` goes up.
        let upright = Rotation3::from_axis_angle(&Vector3::x_axis(), right);
        assert_eq!(held(&upright, "bottom"), (vec![Dof::ThetaZ], vec![]));
        assert_eq!(held(&upright, "left"), (vec![Dof::ThetaX], vec![]));
        // In the plane y-z: the edge `bottom` goes down.
        let aside = Rotation3::from_axis_angle(&Vector3::y_axis(), right);
        assert_eq!(held(&aside, "bottom"), (vec![Dof::ThetaY], vec![]));
        assert_eq!(held(&aside, "left"), (vec![Dof::ThetaZ], vec![]));
        // A roof that rises across x: edges along x have an oblique normal, the others do not.
        let roof = Rotation3::from_axis_angle(&Vector3::x_axis(), 0.5);
        assert_eq!(held(&roof, "left"), (vec![Dof::ThetaX], vec![]));
        let (axes, about) = held(&roof, "bottom");
        assert!(axes.is_empty() && about.iter().map(|a| a.0).eq([0, 1, 2]), "{about:?}");
        assert!(
            about.iter().all(|a| (a.1 - Vector3::new(0.0, -0.5_f64.cos(), -0.5_f64.sin())).norm() < 1e-14)
        );
    }

    /// The rim of a disc is one line that turns, not corners, which would clamp it.
    #[test]
    fn the_rim_of_a_disc_is_held_about_one_direction_a_node() {
        let mesh = crate::mesh::disc(1.0, 4).unwrap();
        let supports = Support::simple(&mesh, "outer", true).unwrap();
        let about = &supports[4].about;
        let on_axes: usize = supports[1..4].iter().map(|s| s.nodes.len()).sum();
        assert_eq!((on_axes, about.len() + on_axes), (4, mesh.set("outer").unwrap().len()));
        assert!(
            about.iter().all(|(n, normal)| (mesh.nodes[*n as usize].coords.cross(normal)).norm() < 1e-12)
        );
    }

    #[test]
    fn two_values_of_one_dof_are_refused() {
        let mesh = rectangle(1.0, 1.0, 2, 2).unwrap();
        let moved = |set: &str, dof, value| Support::at(mesh.set(set).unwrap().to_vec(), vec![(dof, value)]);
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
