//! Hard simple supports: edges that do not turn about their normals in the plane of the sheet.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Vector3};

use super::{Model, ModelError};

/// An edge on a hard simple support, which holds the rotation that would lift it: that about its normal in the plane
/// of its element.
#[derive(Clone, Debug, PartialEq)]
pub struct HardEdge {
    /// Its ends.
    pub nodes: [u32; 2],
    /// Normal of the element.
    pub up: Vector3<f64>,
}

/// The rotations φ of a node about axes of its own, which stand in for `(θx, θy, θz)` among the unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnAxes {
    /// The node.
    pub node: u32,
    /// The axes as columns, orthonormal: `θ = axes φ`.
    pub axes: Matrix3<f64>,
    /// Which of the rotations φ are held.
    pub held: [bool; 3],
    /// The directions that hard edges hold, of length 1.
    pub about: Vec<Vector3<f64>>,
}

/// Edges that meet at less than this (50°) are a line, straight or curved, of which one direction is held where they
/// meet; at a corner two are. A curve of straight edges held as corners would be clamped (Babuška and Pitkäranta,
/// *SIAM J. Math. Anal.* 21 (1990) 551), and a corner held as a line loses little in a thin sheet, in which the shear
/// strain along each edge holds the rotations of its ends.
///
/// A line that ends where another support holds the rotation about an axis this close to its normal goes on there,
/// as across a line of symmetry.
const CORNER: f64 = 50.0 * RADIAN;

/// Directions closer than this (5°) are one where a line does not end: meshes of curves are no better.
const CLOSE: f64 = 5.0 * RADIAN;

const RADIAN: f64 = std::f64::consts::PI / 180.0;

/// A direction with less than this beside an axis (1e-4 rad) is the axis: coordinates of files have few digits.
const AXIS: f64 = 1e-4;

/// Directions are one if what one has beside the other is below this.
const SAME: f64 = 1e-9;

/// What the hard edges of a model come to: dofs that are held, and nodes that need axes of their own. `held` are the
/// rotations that supports hold otherwise (six dofs a node).
pub(super) fn rotations(model: &Model, held: &[Option<f64>]) -> (Vec<usize>, Vec<OwnAxes>) {
    let (mut dofs, mut own) = (Vec::new(), Vec::new());
    for (node, (normals, close)) in normals(model) {
        let first = 6 * node as usize + 3;
        let axes = (0..3).filter(|k| held[first + k].is_some()).map(|k| Vector3::ith(k, 1.0));
        let axes: Vec<Vector3<f64>> = axes.collect();
        let along_axis = |n: &Vector3<f64>| axes.iter().any(|axis| between(axis, n) < close);
        let remaining: Vec<Vector3<f64>> =
            normals.into_iter().filter(|n| !along_axis(n)).map(snapped).collect();
        if axes.len() == 3 || remaining.iter().all(|n| axis_of(n).is_some()) {
            dofs.extend(remaining.iter().filter_map(axis_of).map(|axis| first + axis));
        } else {
            own.push(OwnAxes::new(node, &axes, remaining));
        }
    }
    (dofs, own)
}

/// The directions about which each node on hard edges does not turn, of length 1, and how close to them a held axis is
/// the same (rad).
fn normals(model: &Model) -> BTreeMap<u32, (Vec<Vector3<f64>>, f64)> {
    let mut around: BTreeMap<u32, Vec<(u32, Vector3<f64>)>> = BTreeMap::new();
    for HardEdge { nodes: [a, b], up } in model.supports.iter().flat_map(|s| &s.hard) {
        for (node, other) in [(a, b), (b, a)] {
            let edges = around.entry(*node).or_default();
            if edges.iter().all(|(known, _)| known != other) {
                edges.push((*other, *up));
            }
        }
    }
    let place = |n: u32| model.mesh.nodes[n as usize];
    let of_node = |node: u32, edges: &[(u32, Vector3<f64>)]| -> Vec<Vector3<f64>> {
        let away = |(other, up): &(u32, Vector3<f64>)| (place(*other) - place(node)).cross(up);
        let [a, b] = edges else {
            return edges.iter().fold(Vec::new(), |lines: Vec<Vector3<f64>>, edge| {
                let normal = away(edge).normalize();
                let known = lines.iter().any(|line| between(line, &normal) < CORNER);
                if known { lines } else { [lines, vec![normal]].concat() }
            });
        };
        // Both seen on the way through the node: towards it along one edge, away from it along the other.
        let (towards, on) = (-away(a), away(b) * a.1.dot(&b.1).signum());
        if towards.angle(&on) < CORNER {
            // That of the circle through the three nodes: the shorter edge is the closer to it.
            let ratio = on.norm() / towards.norm();
            vec![(towards * ratio + on / ratio).normalize()]
        } else {
            vec![towards.normalize(), on.normalize()]
        }
    };
    let close = |edges: &[_]| if edges.len() == 1 { CORNER } else { CLOSE };
    around.iter().map(|(node, edges)| (*node, (of_node(*node, edges), close(edges)))).collect()
}

/// Angle between lines (rad).
fn between(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    a.dot(b).abs().min(1.0).acos()
}

/// The axis that a direction is, if it is one.
fn axis_of(n: &Vector3<f64>) -> Option<usize> {
    (0..3).find(|k| n[*k].abs() == 1.0)
}

/// A direction that is an axis but for rounding.
fn snapped(n: Vector3<f64>) -> Vector3<f64> {
    let near = (0..3).map(|k| Vector3::ith(k, 1.0)).find(|axis| n.cross(axis).norm() < AXIS);
    near.unwrap_or(n)
}

impl OwnAxes {
    /// Of the nodes of a model that need them, by node.
    ///
    /// # Errors
    /// M009 if such a node is part of a rigid body, or if a prescribed rotation turns it about such a direction.
    pub fn of(model: &Model) -> Result<Vec<Self>, ModelError> {
        if model.supports.iter().all(|s| s.hard.is_empty()) {
            return Ok(Vec::new());
        }
        let held = model.held_by_name();
        let (_, own) = rotations(model, &held);
        for node in &own {
            let values = &held[6 * node.node as usize + 3..][..3];
            let leans = |k: usize| node.about.iter().any(|about| about[k].abs() > AXIS);
            if model.bodies.iter().any(|b| b.nodes.contains(&node.node)) {
                return Err(node.refused(model, "it belongs to a rigid body"));
            }
            if (0..3).any(|k| values[k].is_some_and(|v| v != 0.0) && leans(k)) {
                return Err(node.refused(model, "a prescribed value turns it"));
            }
        }
        Ok(own)
    }

    /// M009, for an analysis in which they have no meaning.
    pub fn in_large_rotations(&self, model: &Model) -> ModelError {
        self.refused(model, "large rotations turn that direction away")
    }

    fn refused(&self, model: &Model, clash: &'static str) -> ModelError {
        let about = self.about.first().copied().unwrap_or_default();
        let at = model.mesh.nodes[self.node as usize].coords;
        ModelError::Oblique { at: at.into(), about: about.into(), clash }
    }

    /// Of a node whose rotations about some axes and about other directions `about`, of length 1, are held. An axis that
    /// is held or is normal to all directions stays one: in a flat sheet z, so that bending and membrane action do not
    /// couple.
    fn new(node: u32, axes: &[Vector3<f64>], about: Vec<Vector3<f64>>) -> Self {
        let mut basis: Vec<Vector3<f64>> = Vec::with_capacity(3);
        for direction in axes.iter().chain(&about) {
            let rest = normal_part(&basis, direction);
            if rest.norm() > SAME {
                basis.push(rest.normalize());
            }
        }
        let held = basis.len();
        while basis.len() < 3 {
            let rests = [0, 1, 2].map(|k| normal_part(&basis, &Vector3::ith(k, 1.0)));
            basis.extend(rests.iter().max_by(|a, b| a.norm().total_cmp(&b.norm())).map(|r| r.normalize()));
        }
        let mut others = (0..3).filter(|k| axis_of(&basis[*k]).is_none());
        let columns = [0, 1, 2].map(|axis| {
            let same = (0..3).find(|k| axis_of(&basis[*k]) == Some(axis));
            same.or_else(|| others.next()).unwrap_or(axis)
        });
        let axes = Matrix3::from_columns(&columns.map(|k| basis[k]));
        Self { node, axes, held: columns.map(|k| k < held), about }
    }
}

/// A direction without its parts along those of a basis.
fn normal_part(basis: &[Vector3<f64>], direction: &Vector3<f64>) -> Vector3<f64> {
    basis.iter().fold(*direction, |rest, b| rest - *b * b.dot(&rest))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use approx::assert_relative_eq;

    use super::*;
    use crate::element::Formulation;
    use crate::mesh::{QuadMesh, disc, rectangle};
    use crate::model::{Dof, Support};
    use crate::section::ShellSection;
    use nalgebra::{Matrix2, Point3, Rotation3};

    fn unit(x: f64, y: f64, z: f64) -> Vector3<f64> {
        Vector3::new(x, y, z).normalize()
    }

    fn model(mesh: QuadMesh, supports: Vec<Support>) -> Model {
        Model {
            mesh,
            section: ShellSection {
                d_m: Matrix3::identity(),
                d_b: Matrix3::identity(),
                d_s: Matrix2::identity(),
                areal_density: 1.0,
                thickness: 1.0,
            },
            warp: Vector3::x(),
            formulation: Formulation::default(),
            supports,
            loads: Vec::new(),
            bodies: Vec::new(),
        }
    }

    /// The model of a mesh with hard supports on some sets.
    fn hard(mesh: QuadMesh, sets: &[&str]) -> Model {
        let supports = sets.iter().map(|set| Support::simple(&mesh, set, true).unwrap()).collect();
        model(mesh, supports)
    }

    #[test]
    fn an_edge_holds_one_rotation_and_leaves_the_axis_of_the_sheet() {
        let own = OwnAxes::new(0, &[], vec![unit(3.0, 4.0, 0.0)]);
        assert_eq!(own.held, [true, false, false]);
        assert_eq!(own.axes.column(2), Vector3::z());
        assert_relative_eq!(own.axes.column(0).into_owned(), Vector3::new(0.6, 0.8, 0.0));
        assert_relative_eq!(own.axes.transpose() * own.axes, Matrix3::identity(), epsilon = 1e-15);
        let own = OwnAxes::new(0, &[], vec![unit(0.0, 1.0, 2.0)]);
        assert_eq!(own.axes.column(0), Vector3::x());
        assert_eq!(own.held, [false, true, false]);
        let own = OwnAxes::new(0, &[Vector3::z()], vec![unit(3.0, 4.0, 0.0)]);
        assert_eq!((own.held, own.axes.column(2).into_owned()), ([true, false, true], Vector3::z()));
    }

    /// On any sheet it is the rotation about the normal of the edge in the sheet, never that about the sheet's own.
    #[test]
    fn a_hard_support_holds_the_rotation_about_the_normal_of_the_edge() {
        // Rotations held by dof, and nodes with axes of their own, of a unit square whose edge along x is `bottom`.
        let held = |turn: &Rotation3<f64>, set: &str| {
            let mut mesh = rectangle(1.0, 1.0, 2, 2).unwrap();
            mesh.nodes.iter_mut().for_each(|p| *p = turn * *p);
            let model = hard(mesh, &[set]);
            let all = model.constraints();
            let is_held = |d: &Dof| all.chunks_exact(6).filter(|n| n[*d as usize].is_some()).count() == 3;
            (Dof::ALL[3..].iter().copied().find(is_held), OwnAxes::of(&model).unwrap())
        };
        let right = 0.5 * PI;
        let flat = Rotation3::identity();
        // In the plane x-z the edge `left` goes up, in the plane y-z `bottom` goes down.
        let upright = Rotation3::from_axis_angle(&Vector3::x_axis(), right);
        let aside = Rotation3::from_axis_angle(&Vector3::y_axis(), right);
        // A roof that rises across x: edges along x have an oblique normal, the others do not.
        let roof = Rotation3::from_axis_angle(&Vector3::x_axis(), 0.5);
        for (turn, set, dof) in [
            (&flat, "bottom", Dof::ThetaY),
            (&flat, "left", Dof::ThetaX),
            (&upright, "bottom", Dof::ThetaZ),
            (&upright, "left", Dof::ThetaX),
            (&aside, "bottom", Dof::ThetaY),
            (&aside, "left", Dof::ThetaZ),
            (&roof, "left", Dof::ThetaX),
        ] {
            assert_eq!(held(turn, set), (Some(dof), Vec::new()), "{set}");
        }
        let (dof, own) = held(&roof, "bottom");
        assert!(dof.is_none() && own.iter().map(|o| o.node).eq([0, 1, 2]), "{own:?}");
        let normal = Vector3::new(0.0, 0.5_f64.cos(), 0.5_f64.sin());
        assert!(own.iter().all(|o| between(&o.about[0], &normal) < 1e-7), "{own:?}");
    }

    /// An edge is hard beside a rotation that is held by name, however close that is to its normal.
    #[test]
    fn rotations_held_by_name_leave_an_edge_hard() {
        let mut mesh = rectangle(1.0, 1.0, 4, 4).unwrap();
        let wall = Rotation3::from_axis_angle(&Vector3::x_axis(), 70.0 * RADIAN);
        mesh.nodes.iter_mut().for_each(|p| *p = wall * *p);
        let mut model = hard(mesh, &["bottom"]);
        let all = model.mesh.set("all").unwrap().to_vec();
        model.supports.push(Support::fix(&all, &[Dof::ThetaZ]));
        let own = OwnAxes::of(&model).unwrap();
        assert!(own.iter().map(|o| o.node).eq([1, 2, 3]), "{own:?}");
        assert!(own.iter().all(|o| o.held.iter().filter(|h| **h).count() == 2 && o.held[2]), "{own:?}");
    }

    /// The corners of a rhombus are held about both normals where it is acute; of its obtuse ones the mean will do.
    #[test]
    fn acute_corners_hold_both_rotations_in_the_plane() {
        let mut mesh = rectangle(1.0, 1.0, 3, 3).unwrap();
        mesh.nodes.iter_mut().for_each(|p| *p = Point3::new(p.x + p.y * 0.5, 0.8 * p.y, 0.0));
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.3);
        mesh.nodes.iter_mut().for_each(|p| *p = turn * *p);
        for sets in [&["boundary"][..], &["left", "bottom", "right", "top"]] {
            let own = OwnAxes::of(&hard(mesh.clone(), sets)).unwrap();
            assert_eq!(own.len(), 12);
            let both: Vec<u32> =
                own.iter().filter(|o| o.held == [true, true, false]).map(|o| o.node).collect();
            assert_eq!(both, [0, 3, 12, 15]);
        }
    }

    /// A rim is one line that turns, whichever sets it is given in, however coarse it is, and where it ends on a line of
    /// symmetry: it is not clamped.
    #[test]
    fn a_rim_is_held_about_one_direction_a_node() {
        for cells in [2, 4, 8] {
            let mut mesh = disc(1.0, cells).unwrap();
            let rim = mesh.set("outer").unwrap().to_vec();
            // Seven digits, as of a file, and four arcs that share their ends.
            mesh.nodes.iter_mut().for_each(|p| *p = p.map(|c: f64| (c * 1e7).round() / 1e7));
            for (name, [x, y]) in
                [("a", [1.0, 1.0]), ("b", [-1.0, 1.0]), ("c", [-1.0, -1.0]), ("d", [1.0, -1.0])]
            {
                let in_quadrant = |n: &u32| {
                    let p = mesh.nodes[*n as usize];
                    p.x * x > -1e-6 && p.y * y > -1e-6
                };
                let arc: Vec<u32> = rim.iter().copied().filter(in_quadrant).collect();
                mesh.node_sets.insert(name.into(), arc);
            }
            for sets in [&["outer"][..], &["a", "b", "c", "d"]] {
                let model = hard(mesh.clone(), sets);
                let (all, own) = (model.constraints(), OwnAxes::of(&model).unwrap());
                let axes: usize = (0..rim.len())
                    .map(|k| all[6 * rim[k] as usize + 3..][..3].iter().flatten().count())
                    .sum();
                assert_eq!(axes + own.len(), rim.len(), "{cells} {sets:?}");
                for node in &own {
                    let p = mesh.nodes[node.node as usize].coords;
                    assert_eq!(node.held.iter().filter(|h| **h).count(), 1);
                    assert!(p.cross(&node.about[0]).norm() < 0.02, "{p} {:?}", node.about);
                }
            }
            // One quarter of the rim, which ends on two lines of symmetry.
            let ends: Vec<u32> =
                rim.iter().copied().filter(|n| mesh.nodes[*n as usize].x.abs() < 1e-6).collect();
            let mut supports = vec![Support::simple(&mesh, "a", true).unwrap()];
            supports.push(Support::symmetry_x(&ends));
            let quarter = model(mesh, supports);
            assert!(OwnAxes::of(&quarter).unwrap().iter().all(|own| !ends.contains(&own.node)));
        }
    }
}
