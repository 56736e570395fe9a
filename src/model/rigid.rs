//! Nodes that move as one rigid body: a clamp that is free to follow the sheet, a plate that is much
//! stiffer than the rest.

use crate::finding::errors;
use std::sync::Arc;

use nalgebra::{DMatrix, DMatrixViewMut, DVector, Matrix3, Matrix6, Point3, Vector3};

use super::{Dof, DofGroup, OwnAxes};

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

errors! {
    /// M010: what makes no rigid body.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum RigidBodyError {
        /// A node follows two bodies.
        "M010" Shared {
            /// The node.
            node: u32,
        } = "node {node} belongs to two rigid bodies: join them to one";
        /// A support holds a node that is not the lead, in a way that does not follow from the lead's own.
        "M010" Held {
            /// The node.
            node: u32,
            /// Name of its dof.
            dof: &'static str,
            /// The node that may be held.
            lead: u32,
        } = "{dof} of node {node} is held, which belongs to a rigid body that is free to move it: hold node {lead}, \
             which leads the body";
    }
}

/// What ties the motion of nodes to the unknowns, for small displacements. A node of a rigid body follows its
/// lead: `u = u_lead + θ_lead × r`, `θ = θ_lead`, with the lever r from the lead to the node. A node with
/// [`OwnAxes`] turns about them: `θ = axes φ`.
#[derive(Clone, Debug, PartialEq)]
pub struct Links {
    /// The lead of each node; a node without a body leads itself.
    pub leads: Vec<u32>,
    /// By node.
    ties: Vec<Tie>,
    /// Nodes that turn about axes of their own, and which of these rotations are held.
    own_axes: Vec<OwnAxes>,
}

/// A node whose motion is that of its lead, or of its own unknowns, times a matrix.
#[derive(Clone, Debug, PartialEq)]
struct Tie {
    node: u32,
    lead: u32,
    transform: Matrix6<f64>,
}

impl Tie {
    fn follows(&self) -> bool {
        self.lead != self.node
    }

    /// The part in a group of dofs: in a flat sheet levers lie in the plane and own axes keep z, and the groups do not
    /// couple.
    fn of_group(&self, group: DofGroup) -> DMatrix<f64> {
        let dofs = group.dofs();
        DMatrix::from_fn(dofs.len(), dofs.len(), |i, j| self.transform[(dofs[i] as usize, dofs[j] as usize)])
    }
}

impl Links {
    /// The links between the nodes at these places.
    ///
    /// `own_axes` are of nodes without a body, in their order.
    ///
    /// # Errors
    /// M010 if a node is in two bodies.
    pub fn new(
        places: &[Point3<f64>],
        bodies: &[RigidBody],
        own_axes: Vec<OwnAxes>,
    ) -> Result<Arc<Self>, RigidBodyError> {
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
        let followers = (0..places.len() as u32).filter(|n| leads[*n as usize] != *n).map(|node| {
            let lever = lever(places, &leads, node as usize);
            Tie { node, lead: leads[node as usize], transform: carried(&lever) }
        });
        let turned =
            own_axes.iter().map(|own| Tie { node: own.node, lead: own.node, transform: turned(&own.axes) });
        let mut ties: Vec<Tie> = followers.chain(turned).collect();
        ties.sort_by_key(|tie| tie.node);
        Ok(Arc::new(Self { leads, ties, own_axes }))
    }

    /// The nodes that follow others.
    pub fn followers(&self) -> impl Iterator<Item = usize> {
        self.ties.iter().filter(|tie| tie.follows()).map(|tie| tie.node as usize)
    }

    /// The first node that turns about axes of its own.
    pub fn first_own_axes(&self) -> Option<&OwnAxes> {
        self.own_axes.first()
    }

    /// From dofs held (six a node) to unknowns held: the rotations of nodes with axes of their own are those about
    /// these, and every dof of a follower, whose motion is its lead's, is held at zero.
    ///
    /// # Errors
    /// M010 if a follower is held itself, unless at zero where the lead's dofs that move it are held
    /// at zero as well.
    pub fn hold(&self, held: &mut [Option<f64>]) -> Result<(), RigidBodyError> {
        for own in &self.own_axes {
            // A rotation that a support holds by name keeps its axis and its value.
            for k in (0..3).filter(|k| own.held[*k]) {
                held[6 * own.node as usize + 3 + k].get_or_insert(0.0);
            }
        }
        for &Tie { node, lead, transform } in self.ties.iter().filter(|tie| tie.follows()) {
            for dof in Dof::ALL {
                let moves = |d: &usize| {
                    transform[(dof as usize, *d)] != 0.0 && held[6 * lead as usize + d] != Some(0.0)
                };
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

    /// From unknowns to the motion of nodes. `u` holds the dofs of the group, node by node.
    pub fn expand(&self, group: DofGroup, u: &mut [f64]) {
        let b = group.dofs().len();
        for tie in &self.ties {
            let t = tie.of_group(group);
            let lead = DVector::from_column_slice(&u[b * tie.lead as usize..][..b]);
            u[b * tie.node as usize..][..b].copy_from_slice((t * lead).as_slice());
        }
    }

    /// From forces on nodes to those on unknowns: those on followers go to their leads. `f` holds the dofs of the
    /// group, node by node.
    pub fn reduce(&self, group: DofGroup, f: &mut [f64]) {
        let b = group.dofs().len();
        for tie in &self.ties {
            let own = &mut f[b * tie.node as usize..][..b];
            let transferred = tie.of_group(group).tr_mul(&DVector::from_column_slice(own));
            own.fill(0.0);
            f[b * tie.lead as usize..][..b].iter_mut().zip(&transferred).for_each(|(f, m)| *f += m);
        }
    }

    /// From forces on unknowns to those on leads and nodes of their own: moments about own axes become moments about
    /// x, y and z. `f` holds the dofs of the group, node by node.
    pub fn turn_back(&self, group: DofGroup, f: &mut [f64]) {
        self.turn(f, group, |tie, own| tie.of_group(group) * own);
    }

    /// The other way round, of forces or of motions.
    pub fn turn_to_own(&self, group: DofGroup, f: &mut [f64]) {
        self.turn(f, group, |tie, own| tie.of_group(group).tr_mul(&own));
    }

    fn turn(&self, f: &mut [f64], group: DofGroup, by: impl Fn(&Tie, DVector<f64>) -> DVector<f64>) {
        let b = group.dofs().len();
        for tie in self.ties.iter().filter(|tie| !tie.follows()) {
            let own = &mut f[b * tie.node as usize..][..b];
            let turned = by(tie, DVector::from_column_slice(own));
            own.copy_from_slice(turned.as_slice());
        }
    }

    /// Whether any of an element's nodes is tied.
    pub fn touch(&self, nodes: &[u32; 4]) -> bool {
        !self.ties.is_empty() && nodes.iter().any(|n| self.tie(*n).is_some())
    }

    /// The direction about which rotation `k` of the unknowns of a node turns it.
    pub fn rotation_axis(&self, node: u32, k: usize) -> Vector3<f64> {
        match self.tie(node) {
            Some(tie) => tie.transform.fixed_view::<3, 1>(3, 3 + k).into_owned(),
            None => Vector3::ith(k, 1.0),
        }
    }

    fn tie(&self, node: u32) -> Option<&Tie> {
        Some(&self.ties[self.ties.binary_search_by_key(&node, |tie| tie.node).ok()?])
    }

    /// Turns a matrix of an element (column-major, the group's dofs of `nodes`) into one over the
    /// unknowns: `Tᵀ K T`.
    pub fn constrain(&self, group: DofGroup, nodes: &[u32; 4], matrix: &mut [f64]) {
        let b = group.dofs().len();
        let mut k = DMatrixViewMut::from_slice(matrix, 4 * b, 4 * b);
        for (i, node) in nodes.iter().enumerate() {
            let Some(tie) = self.tie(*node) else { continue };
            let t = tie.of_group(group);
            let columns = k.columns(i * b, b) * &t;
            k.columns_mut(i * b, b).copy_from(&columns);
            let rows = t.tr_mul(&k.rows(i * b, b));
            k.rows_mut(i * b, b).copy_from(&rows);
        }
    }
}

/// The motion of a node per motion of its lead.
fn carried(lever: &Vector3<f64>) -> Matrix6<f64> {
    let mut t = Matrix6::identity();
    t.fixed_view_mut::<3, 3>(0, 3).copy_from(&-lever.cross_matrix());
    t
}

/// The motion of a node per displacement and rotation about its own axes.
fn turned(axes: &Matrix3<f64>) -> Matrix6<f64> {
    let mut t = Matrix6::identity();
    t.fixed_view_mut::<3, 3>(3, 3).copy_from(axes);
    t
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
        Links::new(&places, &[RigidBody { nodes: vec![1, 2] }], Vec::new()).unwrap()
    }

    /// A rotation moves the follower as `θ × r`, and forces keep their work on every motion.
    #[test]
    fn followers_move_rigidly_and_forces_keep_their_work() {
        let links = body();
        let mut u: Vec<f64> = (0..18).map(|k| (k as f64).sin()).collect();
        let mut f: Vec<f64> = (0..18).map(|k| (k as f64).cos()).collect();
        links.expand(DofGroup::Shell, &mut u);
        let (theta, r) = (Vector3::new(u[9], u[10], u[11]), Vector3::new(2.0, -2.0, 1.5));
        let expected = Vector3::new(u[6], u[7], u[8]) + theta.cross(&r);
        assert_relative_eq!(expected, Vector3::new(u[12], u[13], u[14]), max_relative = 1e-14);
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
        let refused = links.hold(&mut held.clone()).unwrap_err();
        assert_eq!(refused, RigidBodyError::Held { node: 2, dof: "theta_y", lead: 1 });
        held[6 + 4] = Some(0.0);
        links.hold(&mut held).unwrap();
        assert!(held[12..].iter().all(|h| *h == Some(0.0)));
        assert_eq!(held[6..12].iter().flatten().count(), 1);
    }
}
