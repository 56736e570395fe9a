//! The same case elsewhere: turned, mirrored, in another order; and what becomes of its answer.

use kesf::mesh::QuadMesh;
use kesf::model::{Dof, Load, Model, Support};
use nalgebra::{Matrix3, Rotation3, Vector3};
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// A map of space, and of the numbers of nodes.
pub struct Transform {
    /// Of displacements and forces.
    polar: Matrix3<f64>,
    /// Of rotations and moments.
    axial: Matrix3<f64>,
    /// The new number of each node.
    number: Vec<usize>,
}

impl Transform {
    fn new(polar: Matrix3<f64>, number: Vec<usize>) -> Self {
        Self { axial: polar * polar.determinant(), polar, number }
    }

    /// The mirror at x = 0, with the image of each node.
    pub fn mirror(image: Vec<usize>) -> Self {
        Self::new(Matrix3::from_diagonal(&Vector3::new(-1.0, 1.0, 1.0)), image)
    }

    /// What becomes of vectors over a model, six numbers a node.
    pub fn of(&self, vectors: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; vectors.len()];
        for (node, v) in vectors.chunks_exact(6).enumerate() {
            let [u, r] = [(self.polar, 0), (self.axial, 3)]
                .map(|(map, at)| map * Vector3::from_column_slice(&v[at..at + 3]));
            out[6 * self.number[node]..][..6].copy_from_slice(&[u.x, u.y, u.z, r.x, r.y, r.z]);
        }
        out
    }

    fn support(&self, support: &Support) -> Support {
        // Supports hold all displacements of a node, and all of its rotations or none.
        let value = |dof: Dof| support.held.iter().find(|(d, _)| *d == dof).map_or(0.0, |(_, v)| *v);
        let held = |dofs: [Dof; 3], map: &Matrix3<f64>| {
            let mapped = map * Vector3::from(dofs.map(value));
            let is_held = support.held.iter().any(|(d, _)| *d == dofs[0]);
            (0..if is_held { 3 } else { 0 }).map(move |i| (dofs[i], mapped[i]))
        };
        let mut transformed = support.clone();
        transformed.held = held([Dof::U, Dof::V, Dof::W], &self.polar)
            .chain(held([Dof::ThetaX, Dof::ThetaY, Dof::ThetaZ], &self.axial))
            .collect();
        transformed.nodes = self.nodes(&support.nodes);
        for edge in &mut transformed.hard {
            edge.nodes = edge.nodes.map(|n| self.number[n as usize] as u32);
            edge.up = self.polar * edge.up;
        }
        transformed
    }

    fn load(&self, load: &Load) -> Load {
        match load {
            Load::Pressure(_) | Load::FollowerPressure(_) => load.clone(),
            Load::Gravity(g) => Load::Gravity(self.polar * g),
            Load::Point { nodes, force, moment } => Load::Point {
                nodes: self.nodes(nodes),
                force: self.polar * force,
                moment: self.axial * moment,
            },
            Load::Edge { edges, force, moment } => Load::Edge {
                edges: edges.iter().map(|e| e.map(|n| self.number[n as usize] as u32)).collect(),
                force: self.polar * force,
                moment: self.axial * moment,
            },
        }
    }

    fn nodes(&self, nodes: &[u32]) -> Vec<u32> {
        nodes.iter().map(|n| self.number[*n as usize] as u32).collect()
    }

    /// A model elsewhere, with its quads as `quads` makes them.
    fn model(&self, model: &Model, quads: impl Fn([u32; 4]) -> [u32; 4]) -> Model {
        let mut nodes = model.mesh.nodes.clone();
        for (n, p) in model.mesh.nodes.iter().enumerate() {
            nodes[self.number[n]] = (self.polar * p.coords).into();
        }
        let renamed = |q: &[u32; 4]| quads(q.map(|n| self.number[n as usize] as u32));
        Model {
            mesh: QuadMesh {
                nodes,
                quads: model.mesh.quads.iter().map(renamed).collect(),
                ..QuadMesh::default()
            },
            warp: self.polar * model.warp,
            supports: model.supports.iter().map(|s| self.support(s)).collect(),
            loads: model.loads.iter().map(|l| self.load(l)).collect(),
            ..model.clone()
        }
    }
}

fn in_order(model: &Model) -> Vec<usize> {
    (0..model.mesh.nodes.len()).collect()
}

/// Turned about the origin.
pub fn turned(model: &Model, turn: &Rotation3<f64>) -> (Model, Transform) {
    let transform = Transform::new(*turn.matrix(), in_order(model));
    (transform.model(model, |q| q), transform)
}

/// Mirrored at x = 0; quads go round the other way, so that they have the mirrored normals.
pub fn mirrored(model: &Model) -> (Model, Transform) {
    let transform = Transform::mirror(in_order(model));
    (transform.model(model, |[a, b, c, d]| [a, d, c, b]), transform)
}

/// The same sheet with its nodes and quads in another order, and quads that begin at another corner.
pub fn renumbered(model: &Model, seed: u64) -> (Model, Transform) {
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut number = in_order(model);
    number.shuffle(&mut rng);
    let transform = Transform::new(Matrix3::identity(), number);
    let mut shuffled = transform.model(model, |q| q);
    shuffled.mesh.quads.shuffle(&mut rng);
    for quad in &mut shuffled.mesh.quads {
        quad.rotate_left(rng.random_range(0..4));
    }
    (shuffled, transform)
}
