//! Rigid motions that no support resists.
//!
//! A factorisation cannot tell them: the last pivot of such a motion is rounding, of either sign. Here the motions of each connected
//! part of the sheet are held against its supports before anything is factorised.

use std::collections::BTreeMap;
use std::fmt;

use nalgebra::{DMatrix, Matrix6, Point3, SymmetricEigen, Vector3, Vector6};

use super::assemble::Pattern;
use super::sparse::BlockGraph;
use crate::model::{DofGroup, Links};

/// A motion is loose if the supports take less than this part of the squares of its displacements at them: supports that stand
/// within a millionth of the size of the sheet hold no turn about their line.
const LOOSE: f64 = 1e-12;

/// Components beside an axis that are rounding.
const AXIS: f64 = 1e-6;

/// A rigid motion of a connected part of the sheet, which no support resists.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LooseMotion {
    /// A node of the part.
    pub node: usize,
    middle: Vector3<f64>,
    along: Vector3<f64>,
    about: Vector3<f64>,
}

impl fmt::Display for LooseMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let turns = self.about.norm_squared();
        if turns == 0.0 {
            return write!(f, "a displacement along {}", direction(&self.along));
        }
        let foot = self.middle + self.about.cross(&self.along) / turns;
        let [x, y, z] = [foot.x, foot.y, foot.z].map(|v| if v.abs() < 5e-5 { 0.0 } else { v });
        write!(f, "a turn about the axis along {} through ({x:.4}, {y:.4}, {z:.4}) m", direction(&self.about))
    }
}

/// `x`, or `(0.600, 0.800, 0.000)`.
fn direction(v: &Vector3<f64>) -> String {
    let unit = v.normalize();
    let beside = |k: usize| (unit - Vector3::ith(k, unit[k])).norm();
    let named = ["x", "y", "z"].into_iter().enumerate().find(|(k, _)| beside(*k) < AXIS);
    named.map_or_else(
        || {
            let [x, y, z] = [unit.x, unit.y, unit.z].map(|v| if v.abs() < 5e-4 { 0.0 } else { v });
            format!("({x:.3}, {y:.3}, {z:.3})")
        },
        |(_, name)| name.to_string(),
    )
}

/// A connected part of the sheet with what holds it.
#[derive(Default)]
struct Part {
    node: usize,
    nodes: usize,
    sum: Vector3<f64>,
    /// Half the size of the part (m), from its middle.
    radius: f64,
    /// Held dofs: node and dof from 0 to 5.
    held: Vec<(usize, usize)>,
}

/// The first rigid motion in the dofs of a group that meets no resistance. `is_held` tells of each unknown of the group, node by
/// node; followers of rigid bodies, which are held as unknowns, hold nothing.
pub(super) fn motion(
    places: &[Point3<f64>],
    pattern: &Pattern,
    group: DofGroup,
    is_held: &[bool],
) -> Option<LooseMotion> {
    let parts = parts(places, pattern, group, is_held);
    parts.iter().find_map(|part| {
        let gram = part.resisted(places, &pattern.links);
        part.loose(group, &gram, 3).or_else(|| part.loose(group, &gram, 6))
    })
}

/// The first displacement of a connected part that meets no support, six dofs a node. One along `carried` meets something else.
pub(super) fn displacement(
    places: &[Point3<f64>],
    pattern: &Pattern,
    is_held: &[bool],
    carried: Option<Vector3<f64>>,
) -> Option<LooseMotion> {
    let group = DofGroup::Shell;
    let along = carried.and_then(|force| force.try_normalize(0.0)).unwrap_or_default();
    let parts = parts(places, pattern, group, is_held);
    parts.iter().find_map(|part| {
        let mut gram = part.resisted(places, &pattern.links);
        let mut displacements = gram.fixed_view_mut::<3, 3>(0, 0);
        displacements += along * along.transpose();
        part.loose(group, &gram, 3)
    })
}

fn parts(places: &[Point3<f64>], pattern: &Pattern, group: DofGroup, is_held: &[bool]) -> Vec<Part> {
    let labels = labels(&pattern.graph);
    let (dofs, leads) = (group.dofs(), &pattern.links.leads);
    let mut parts: BTreeMap<usize, Part> = BTreeMap::new();
    let of_parts =
        || labels.iter().zip(leads).enumerate().filter(|(node, (_, lead))| **lead as usize == *node);
    for (node, (label, _)) in of_parts() {
        let part = parts.entry(*label).or_insert_with(|| Part { node, ..Part::default() });
        part.nodes += 1;
        part.sum += places[node].coords;
        let held = dofs.iter().zip(&is_held[dofs.len() * node..]).filter(|(_, held)| **held);
        part.held.extend(held.map(|(dof, _)| (node, *dof as usize)));
    }
    for (node, (label, _)) in of_parts() {
        let Some(part) = parts.get_mut(label) else { continue };
        part.radius = part.radius.max((places[node].coords - part.middle()).norm());
    }
    // A node without an element is none of the sheet.
    parts.into_values().filter(|part| part.nodes > 1).collect()
}

impl Part {
    fn middle(&self) -> Vector3<f64> {
        self.sum / self.nodes as f64
    }

    /// Sum of `m mᵀ` over what is held, where `m` is the motion of a held dof by a displacement of the middle and a turn about it,
    /// whose three numbers count with the radius.
    fn resisted(&self, places: &[Point3<f64>], links: &Links) -> Matrix6<f64> {
        let mut gram = Matrix6::zeros();
        for &(node, dof) in &self.held {
            let mut m = Vector6::zeros();
            if dof < 3 {
                let axis = Vector3::ith(dof, 1.0);
                let lever = places[node].coords - self.middle();
                m.fixed_rows_mut::<3>(0).copy_from(&axis);
                m.fixed_rows_mut::<3>(3).copy_from(&(lever.cross(&axis) / self.radius));
            } else {
                m.fixed_rows_mut::<3>(3).copy_from(&links.rotation_axis(node as u32, dof - 3));
            }
            gram += m * m.transpose();
        }
        gram
    }

    /// The motion in the first `upto` dofs of a group that is resisted least, if it is not resisted at all.
    fn loose(&self, group: DofGroup, gram: &Matrix6<f64>, upto: usize) -> Option<LooseMotion> {
        let dofs: Vec<usize> =
            group.dofs().iter().map(|dof| *dof as usize).filter(|dof| *dof < upto).collect();
        let of_group = DMatrix::from_fn(dofs.len(), dofs.len(), |i, j| gram[(dofs[i], dofs[j])]);
        let largest = gram.diagonal().max().max(1.0);
        let eigen = SymmetricEigen::new(of_group);
        let least = eigen.eigenvalues.imin();
        if eigen.eigenvalues[least] > LOOSE * largest {
            return None;
        }
        let mut motion = Vector6::zeros();
        dofs.iter().zip(&eigen.eigenvectors.column(least)).for_each(|(dof, v)| motion[*dof] = *v);
        let about = motion.fixed_rows::<3>(3).into_owned() / self.radius;
        Some(LooseMotion {
            node: self.node,
            middle: self.middle(),
            along: motion.fixed_rows::<3>(0).into_owned(),
            about,
        })
    }
}

/// For each node the lowest one that it is connected with.
fn labels(graph: &BlockGraph) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..graph.nodes).collect();
    for node in 0..graph.nodes {
        for neighbour in graph.column(node) {
            let (a, b) = (root(&mut parent, node), root(&mut parent, *neighbour as usize));
            parent[a.max(b)] = a.min(b);
        }
    }
    (0..graph.nodes).map(|node| root(&mut parent, node)).collect()
}

/// The root of a node; the path to it is halved.
fn root(parent: &mut [usize], mut node: usize) -> usize {
    while parent[node] != node {
        parent[node] = parent[parent[node]];
        node = parent[node];
    }
    node
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::rectangle;
    use crate::model::{Dof, OwnAxes, RigidBody, Support};
    use Dof::{U, V, W};

    /// What is loose in a sheet of 4 by 2 cells over 20 by 10 cm with these supports, in the dofs of a group.
    fn found(group: DofGroup, supports: &[Support], bodies: &[RigidBody]) -> Option<String> {
        let mesh = rectangle(0.2, 0.1, 4, 2).unwrap();
        let links = Links::new(&mesh.nodes, bodies, Vec::<OwnAxes>::new()).unwrap();
        let pattern = Pattern::new(&mesh, links);
        let held = |node: usize, dof: Dof| {
            supports.iter().any(|s| s.nodes.contains(&(node as u32)) && s.held.iter().any(|(d, _)| *d == dof))
        };
        let is_held: Vec<bool> = (0..mesh.nodes.len())
            .flat_map(|node| group.dofs().iter().map(move |dof| held(node, *dof)))
            .collect();
        motion(&mesh.nodes, &pattern, group, &is_held).map(|motion| motion.to_string())
    }

    #[test]
    fn motions_that_nothing_resists_are_named() {
        let left = [0, 5, 10];
        let text = |group, supports: &[Support]| found(group, supports, &[]);
        assert_eq!(text(DofGroup::Membrane, &[Support::fix(&left, &[U])]).unwrap(), "a displacement along y");
        assert_eq!(
            text(DofGroup::Membrane, &[Support::fix(&[0], &[U, V])]).unwrap(),
            "a turn about the axis along z through (0.0000, 0.0000, 0.0000) m"
        );
        assert_eq!(
            text(DofGroup::Plate, &[Support::fix(&left, &[W])]).unwrap(),
            "a turn about the axis along y through (0.0000, 0.0500, 0.0000) m"
        );
        assert_eq!(text(DofGroup::Plate, &[]).unwrap(), "a displacement along z");
        assert_eq!(text(DofGroup::Plate, &[Support::clamped(&[7])]), None);
        assert_eq!(text(DofGroup::Membrane, &[Support::fix(&left, &[U]), Support::fix(&[0], &[V])]), None);
        assert_eq!(text(DofGroup::Shell, &[Support::fix(&[0, 4, 10], &[U, V, W])]), None);
        let diagonal = text(DofGroup::Shell, &[Support::fix(&[0, 14], &[U, V, W])]).unwrap();
        assert!(diagonal.starts_with("a turn about the axis along (0.894, 0.447, 0.000)"), "{diagonal}");
    }

    /// What follows a body holds nothing, and its lead holds all that follows.
    #[test]
    fn a_lead_holds_its_body() {
        let bodies = [RigidBody { nodes: vec![0, 5, 10] }];
        assert_eq!(found(DofGroup::Shell, &[Support::clamped(&[0])], &bodies), None);
        assert!(found(DofGroup::Shell, &[Support::fix(&[5, 10], &Dof::ALL)], &bodies).is_some());
    }
}
