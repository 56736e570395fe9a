//! Rotations that are held about directions which are no axes: hard simple supports of oblique and curved edges.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Vector3};

use super::{Model, ModelError};

/// The rotations φ of a node about axes of its own, which stand in for `(θx, θy, θz)` among the unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnAxes {
    /// The node.
    pub node: u32,
    /// The axes as columns, orthonormal: `θ = axes φ`.
    pub axes: Matrix3<f64>,
    /// Which of the rotations φ are held at zero.
    pub held: [bool; 3],
}

/// Directions are one if what one has beside the other is below this.
const SAME: f64 = 1e-9;

impl OwnAxes {
    /// Of the nodes of a model that supports hold about directions of their own, by node.
    ///
    /// # Errors
    /// M009 if such a node is part of a rigid body, or is turned by another support.
    pub fn of(model: &Model) -> Result<Vec<Self>, ModelError> {
        let mut directions: BTreeMap<u32, Vec<Vector3<f64>>> = BTreeMap::new();
        for support in &model.supports {
            for (node, about) in &support.about {
                directions.entry(*node).or_default().push(*about);
            }
        }
        if directions.is_empty() {
            return Ok(Vec::new());
        }
        let held = model.constraints();
        let in_body = |node: &u32| model.bodies.iter().any(|b| b.nodes.contains(node));
        directions
            .into_iter()
            .map(|(node, mut about)| {
                let refuse = |clash| refused(model, node, &about[0], clash);
                if in_body(&node) {
                    return Err(refuse("it belongs to a rigid body"));
                }
                let rotations = &held[6 * node as usize + 3..][..3];
                if rotations.iter().flatten().any(|value| *value != 0.0) {
                    return Err(refuse("a prescribed value turns it"));
                }
                about.extend((0..3).filter(|k| rotations[*k].is_some()).map(|k| Vector3::ith(k, 1.0)));
                Ok(Self::new(node, &about))
            })
            .collect()
    }

    /// M009, for an analysis in which they have no meaning.
    pub fn in_large_rotations(&self, model: &Model) -> ModelError {
        let about =
            (0..3).find(|k| self.held[*k]).map_or_else(Vector3::zeros, |k| self.axes.column(k).into());
        refused(model, self.node, &about, "large rotations turn that direction away")
    }

    /// Of a node whose rotations about these directions, of length 1, are held. An axis that is normal to all of them
    /// stays one: in a flat sheet z, so that bending and membrane action do not couple.
    fn new(node: u32, directions: &[Vector3<f64>]) -> Self {
        let mut basis: Vec<Vector3<f64>> = Vec::with_capacity(3);
        let beside = |basis: &[Vector3<f64>], d: &Vector3<f64>| {
            basis.iter().fold(*d, |rest, b| rest - *b * b.dot(&rest))
        };
        for direction in directions {
            let rest = beside(&basis, direction);
            if rest.norm() > SAME {
                basis.push(rest.normalize());
            }
        }
        let held = basis.len();
        while basis.len() < 3 {
            let axes = [0, 1, 2].map(|k| beside(&basis, &Vector3::ith(k, 1.0)));
            basis.extend(
                axes.iter().max_by(|a, b| a.norm().total_cmp(&b.norm())).map(|rest| rest.normalize()),
            );
        }
        let is_axis = |v: &Vector3<f64>| v.iter().position(|c| c.abs() > 1.0 - SAME);
        let mut others = (0..3).filter(|k| is_axis(&basis[*k]).is_none());
        let columns = [0, 1, 2].map(|axis| {
            let same = (0..3).find(|k| is_axis(&basis[*k]) == Some(axis));
            same.or_else(|| others.next()).unwrap_or(axis)
        });
        Self {
            node,
            axes: Matrix3::from_columns(&columns.map(|k| basis[k])),
            held: columns.map(|k| k < held),
        }
    }
}

fn refused(model: &Model, node: u32, about: &Vector3<f64>, clash: &'static str) -> ModelError {
    ModelError::Oblique { at: model.mesh.nodes[node as usize].coords.into(), about: (*about).into(), clash }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn unit(x: f64, y: f64, z: f64) -> Vector3<f64> {
        Vector3::new(x, y, z).normalize()
    }

    #[test]
    fn an_edge_holds_one_rotation_and_leaves_the_axis_of_the_sheet() {
        let own = OwnAxes::new(0, &[unit(3.0, 4.0, 0.0)]);
        assert_eq!(own.held, [true, false, false]);
        assert_eq!(own.axes.column(2), Vector3::z());
        assert_relative_eq!(own.axes.column(0).into_owned(), Vector3::new(0.6, 0.8, 0.0));
        assert_relative_eq!(own.axes.transpose() * own.axes, Matrix3::identity(), epsilon = 1e-15);
        let own = OwnAxes::new(0, &[unit(0.0, 1.0, 2.0)]);
        assert_eq!(own.axes.column(0), Vector3::x());
        assert_eq!(own.held, [false, true, false]);
    }

    /// Two edges that meet hold both rotations in the plane, three directions all; an axis held besides stays one.
    #[test]
    fn corners_hold_the_rotations_about_all_directions_that_meet() {
        let own = OwnAxes::new(0, &[unit(3.0, 4.0, 0.0), unit(-1.0, 4.0, 0.0)]);
        assert_eq!((own.held, own.axes.column(2).into_owned()), ([true, true, false], Vector3::z()));
        let own = OwnAxes::new(0, &[unit(3.0, 4.0, 0.0), Vector3::z()]);
        assert_eq!((own.held, own.axes.column(2).into_owned()), ([true, false, true], Vector3::z()));
        let same = OwnAxes::new(0, &[unit(3.0, 4.0, 0.0), -unit(3.0, 4.0, 0.0)]);
        assert_eq!(same.held, [true, false, false]);
        let all = OwnAxes::new(0, &[unit(3.0, 4.0, 0.0), unit(-1.0, 4.0, 0.0), unit(1.0, 1.0, 1.0)]);
        assert_eq!(all.held, [true; 3]);
    }
}
