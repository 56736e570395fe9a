//! `[[rigid]]`: nodes of a set that move as one body about a point of reference.

use nalgebra::{Point3, Vector3};
use serde::Deserialize;

use super::StudyError;
use super::case::Case;
use super::point::SheetPoint;
use crate::mesh::QuadMesh;
use crate::model::RigidBody;

/// `[[rigid]]`: a set whose nodes move as one rigid body: a stiff clamp, a bar sewn to an edge.
///
/// The body's point of reference becomes a node set of its own, `name`: supports, prescribed values and
/// loads on that set act on the body, and its reactions are those about the point.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigidTable {
    /// Name of the set that holds the point of reference alone.
    pub name: String,
    /// Node set that moves.
    pub set: String,
    /// The point of reference: `[x, y]` in the plane z = 0, or `[x, y, z]`; the mean of the set's nodes
    /// when left out.
    pub at: Option<SheetPoint>,
}

/// The rigid bodies of a case; their points of reference are added to the mesh as nodes and sets.
///
/// # Errors
/// S003 for a name that the mesh uses already; M007 for an unknown set.
pub(super) fn bodies(case: &Case, mesh: &mut QuadMesh) -> Result<Vec<RigidBody>, StudyError> {
    let mut bodies = Vec::with_capacity(case.rigid.len());
    for table in &case.rigid {
        if mesh.node_sets.contains_key(&table.name) {
            return Err(case.inconsistent(format!(
                "[[rigid]] name = \"{}\" is a set of the mesh already: choose another",
                table.name
            )));
        }
        let set = mesh.set(&table.set)?.to_vec();
        let places = set.iter().map(|n| mesh.nodes[*n as usize].coords);
        let mean = || Point3::from(places.sum::<Vector3<f64>>() / set.len() as f64);
        let lead = mesh.nodes.len() as u32;
        mesh.nodes.push(table.at.map_or_else(mean, SheetPoint::point));
        mesh.node_sets.insert(table.name.clone(), vec![lead]);
        bodies.push(RigidBody { nodes: [&[lead], &set[..]].concat() });
    }
    Ok(bodies)
}
