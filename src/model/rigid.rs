//! Nodes that move as one rigid body: a clamp that is free to follow the sheet, a plate that is much
//! stiffer than the rest.

use std::sync::Arc;

use nalgebra::{DMatrix, DMatrixViewMut, Matrix6, Point3, Vector3};
use thiserror::Error;

use super::{Dof, DofGroup};

/// Nodes that move together as a rigid body.
///
/// The first one leads: supports on its dofs hold the body, forces and moments on it act on the body,
/// and the body's reactions are those of the lead, about its place. It may be a node that no element
/// uses: a point of reference anywhere. Loads may act on any node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RigidBody {
    /// The nodes, the lead first.
    pub nodes: Vec<u32>,
}

/// M010: what makes no rigid body.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum RigidBodyError {
    /// A node follows two bodies.
    #[error("M010 node {node} belongs to two rigid bodies: join them to one")]
    Shared {
        /// The node.
        node: u32,
    },
    /// A support holds a node that is not the lead, in a way that does not follow from the lead's own.
    #[error(
        "M010 {dof} of node {node} is held, which belongs to a rigid body that is free to move it: hold node {lead}, \
         which leads the body"
    )]
    Held {
        /// The node.
        node: u32,
        /// Name of its dof.
        dof: &'static str,
        /// The node that may be held.
        lead: u32,
    },
}

/// The constraints of all rigid bodies of a model, for small displacements:
/// `u = u_lead + θ_lead × r`, `θ = θ_lead`, with the lever r from the lead to the node.
#[derive(Clone, Debug, PartialEq)]
pub struct Links {
    /// The lead of each node; a node without a body leads itself.
    pub leads: Vec<u32>,
    /// Node, lead and lever (m), by node.
    followers: Vec<(u32, u32, Vector3<f64>)>,
}

impl Links {
    /// The links between the nodes at these places.
    ///
    /// # Errors
    /// M010 if a node is in two bodies.
    pub fn new(places: &[Point3<f64>], bodies: &[RigidBody]) -> Result<Arc<Self>, RigidBodyError> {
        let mut leads: Vec<u32> = (0..places.len() as u32).collect();
        let mut taken = vec![false; places.len()];
        for body in bodies {
            let Some(&lead) = body.nodes.first() else { continue };
            for &node in &body.nodes {
                if std::mem::replace(&mut taken[node as usize], true) {
                    return Err(RigidBodyError::Shared { node });
                }
                leads[node as usize] = lead;
            }
        }
        let followers = (0..places.len() as u32)
            .filter(|n| leads[*n as usize] != *n)
            .map(|n| (n, leads[n as usize], lever(places, &leads, n as usize)))
            .collect();
        Ok(Arc::new(Self { leads, followers }))
    }

    /// The nodes that follow others.
    pub fn followers(&self) -> impl Iterator<Item = usize> {
        self.followers.iter().map(|(node, ..)| *node as usize)
    }

    /// Holds every dof of followers, whose motion is the lead's, at zero (`held`: six a node).
    ///
    /// # Errors
    /// M010 if a follower is held itself, unless at zero where the lead's dofs that move it are held
    /// at zero as well.
    pub fn hold_followers(&self, held: &mut [Option<f64>]) -> Result<(), RigidBodyError> {
        for &(node, lead, lever) in &self.followers {
            let t = transform(&lever);
            for dof in Dof::ALL {
                let moves =
                    |d: &usize| t[(dof as usize, *d)] != 0.0 && held[6 * lead as usize + d] != Some(0.0);
                let own = held[6 * node as usize + dof as usize];
                if own.is_some_and(|value| value != 0.0 || (0..6).any(|d| moves(&d))) {
                    return Err(RigidBodyError::Held { node, dof: dof.name(), lead });
                }
            }
        }
        for node in self.followers() {
            held[6 * node..][..6].fill(Some(0.0));
        }
        Ok(())
    }

    /// Gives followers the motion of their leads. `u` holds the dofs of the group, node by node.
    pub fn expand(&self, group: DofGroup, u: &mut [f64]) {
        let b = group.dofs().len();
        for &(node, lead, lever) in &self.followers {
            let t = of_group(&lever, group);
            let (from, to) = (b * lead as usize, b * node as usize);
            for i in 0..b {
                u[to + i] = (0..b).map(|j| t[(i, j)] * u[from + j]).sum();
            }
        }
    }

    /// Moves the forces on followers to their leads. `f` holds the dofs of the group, node by node.
    pub fn reduce(&self, group: DofGroup, f: &mut [f64]) {
        let b = group.dofs().len();
        for &(node, lead, lever) in &self.followers {
            let t = of_group(&lever, group);
            let (from, to) = (b * node as usize, b * lead as usize);
            for i in 0..b {
                let moved: f64 = (0..b).map(|j| t[(j, i)] * f[from + j]).sum();
                f[to + i] += moved;
            }
            f[from..][..b].fill(0.0);
        }
    }

    /// Whether any of an element's nodes follows another.
    pub fn touch(&self, nodes: &[u32; 4]) -> bool {
        !self.followers.is_empty() && nodes.iter().any(|n| self.leads[*n as usize] != *n)
    }

    /// Turns a matrix of an element (column-major, the group's dofs of `nodes`) into one over the
    /// motions of the leads: `Tᵀ K T`.
    pub fn constrain(&self, group: DofGroup, nodes: &[u32; 4], matrix: &mut [f64]) {
        let b = group.dofs().len();
        let mut k = DMatrixViewMut::from_slice(matrix, 4 * b, 4 * b);
        for (i, node) in nodes.iter().enumerate() {
            let Ok(at) = self.followers.binary_search_by_key(node, |f| f.0) else { continue };
            let t = of_group(&self.followers[at].2, group);
            let columns = k.columns(i * b, b) * &t;
            k.columns_mut(i * b, b).copy_from(&columns);
            let rows = t.tr_mul(&k.rows(i * b, b));
            k.rows_mut(i * b, b).copy_from(&rows);
        }
    }
}

/// The motion of a node per motion of its lead.
fn transform(lever: &Vector3<f64>) -> Matrix6<f64> {
    let mut t = Matrix6::identity();
    t.fixed_view_mut::<3, 3>(0, 3).copy_from(&-lever.cross_matrix());
    t
}

/// The part of it in a group of dofs: in a flat sheet the lever lies in the plane, and the groups do
/// not couple.
fn of_group(lever: &Vector3<f64>, group: DofGroup) -> DMatrix<f64> {
    let (t, dofs) = (transform(lever), group.dofs());
    DMatrix::from_fn(dofs.len(), dofs.len(), |i, j| t[(dofs[i] as usize, dofs[j] as usize)])
}

/// Where a node stands relative to its lead.
pub fn lever(position: &[Point3<f64>], leads: &[u32], node: usize) -> Vector3<f64> {
    position[node] - position[leads[node] as usize]
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn body() -> Arc<Links> {
        let places = [[0.0, 0.0, 0.0], [1.0, 2.0, -1.0], [3.0, 0.0, 0.5]].map(Point3::from);
        Links::new(&places, &[RigidBody { nodes: vec![1, 2] }]).unwrap()
    }

    /// A rotation moves the follower as `θ × r`, and forces keep their work on every motion.
    #[test]
    fn followers_move_rigidly_and_forces_keep_their_work() {
        let links = body();
        let mut u: Vec<f64> = (0..18).map(|k| (k as f64).sin()).collect();
        let mut f: Vec<f64> = (0..18).map(|k| (k as f64).cos()).collect();
        links.expand(DofGroup::Shell, &mut u);
        let (theta, r) = (Vector3::new(u[9], u[10], u[11]), Vector3::new(2.0, -2.0, 1.5));
        let moved = Vector3::new(u[6], u[7], u[8]) + theta.cross(&r);
        assert_relative_eq!(moved, Vector3::new(u[12], u[13], u[14]), max_relative = 1e-14);
        let work = |f: &[f64]| f.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>();
        let before = work(&f);
        links.reduce(DofGroup::Shell, &mut f);
        assert!(f[12..].iter().all(|v| *v == 0.0));
        assert_relative_eq!(work(&f), before, max_relative = 1e-13);
    }

    #[test]
    fn a_follower_may_be_held_only_where_its_lead_holds_it_already() {
        let links = body();
        let mut held = vec![None; 18];
        held[6 * 2 + 4] = Some(0.0);
        let refused = links.hold_followers(&mut held.clone()).unwrap_err();
        assert_eq!(refused, RigidBodyError::Held { node: 2, dof: "theta_y", lead: 1 });
        held[6 + 4] = Some(0.0);
        links.hold_followers(&mut held).unwrap();
        assert!(held[12..].iter().all(|h| *h == Some(0.0)));
        assert_eq!(held[6..12].iter().flatten().count(), 1);
    }
}
