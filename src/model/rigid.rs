//! Nodes that move as one rigid body: a clamp that is free to follow the sheet.

use nalgebra::{Point3, Vector3};
use thiserror::Error;

/// Nodes that move together as a rigid body.
///
/// The first one leads: supports on its dofs hold the body, and the body's reactions are those of
/// the lead, about its place. Loads may act on any node.
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
    /// A support holds a node that is not the lead.
    #[error("M010 node {node} of a rigid body is held: hold node {lead}, which leads the body")]
    Held {
        /// The node.
        node: u32,
        /// The node that may be held.
        lead: u32,
    },
}

/// The lead of every node; a node without a body leads itself.
///
/// # Errors
/// M010 if a node is in two bodies, or a node that does not lead is held (`held`: six a node).
pub fn leads(nodes: usize, bodies: &[RigidBody], held: &[Option<f64>]) -> Result<Vec<u32>, RigidBodyError> {
    let mut leads: Vec<u32> = (0..nodes as u32).collect();
    let mut taken = vec![false; nodes];
    for body in bodies {
        let Some(&lead) = body.nodes.first() else { continue };
        for &node in &body.nodes {
            if std::mem::replace(&mut taken[node as usize], true) {
                return Err(RigidBodyError::Shared { node });
            }
            if node != lead && held[6 * node as usize..][..6].iter().any(Option::is_some) {
                return Err(RigidBodyError::Held { node, lead });
            }
            leads[node as usize] = lead;
        }
    }
    Ok(leads)
}

/// Where a node stands relative to its lead.
pub fn lever(position: &[Point3<f64>], leads: &[u32], node: usize) -> Vector3<f64> {
    position[node] - position[leads[node] as usize]
}
