//! Element matrices into block matrices, in element order: the result does not depend on threads.

use std::sync::Arc;

use nalgebra::Point3;

use super::sparse::{BlockGraph, BlockMatrix};
use crate::element::{MaterialAxisError, Prepared};
use crate::model::{DofGroup, Model};

/// The node graph of a mesh and the place of every element's blocks in it: computed once per mesh.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// Neighbouring nodes.
    pub graph: Arc<BlockGraph>,
    /// Block index of each of the ten node pairs of every quad, in the order of [`PAIRS`].
    blocks: Vec<[u32; 10]>,
}

/// Pairs (i, j), i >= j, of local nodes.
const PAIRS: [(usize, usize); 10] =
    [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2), (3, 0), (3, 1), (3, 2), (3, 3)];

impl Pattern {
    /// The pattern of a mesh.
    pub fn new(nodes: usize, quads: &[[u32; 4]]) -> Self {
        let graph = BlockGraph::from_elements(nodes, quads);
        let blocks = quads
            .iter()
            .map(|quad| {
                PAIRS.map(|(i, j)| {
                    let (a, b) = (quad[i], quad[j]);
                    // Every pair of an element is in the graph that was made of the elements.
                    graph.find(a.max(b), a.min(b)).map_or(u32::MAX, |k| k as u32)
                })
            })
            .collect();
        Self { graph: Arc::new(graph), blocks }
    }
}

/// Element stiffness matrices of a model in one dof group; equal elements in a row are computed once.
pub struct ElementStiffness<'a> {
    model: &'a Model,
    group: DofGroup,
    last: Option<([Point3<f64>; 4], f64)>,
    matrix: Vec<f64>,
}

impl<'a> ElementStiffness<'a> {
    /// Element matrices of `model` restricted to `group`.
    pub fn new(model: &'a Model, group: DofGroup) -> Self {
        Self { model, group, last: None, matrix: Vec::new() }
    }

    /// The matrix of a quad, column-major, `4 b` square with `b` dofs a node.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to the element.
    pub fn of(&mut self, quad: usize) -> Result<&[f64], MaterialAxisError> {
        let corners = self.model.mesh.corners(quad);
        if !self.is_like_the_last(&corners) {
            let flat = self.group != DofGroup::Shell;
            let element: Prepared = self.model.element(quad, flat)?;
            self.matrix.clear();
            match self.group {
                DofGroup::Plate => self.matrix.extend_from_slice(element.plate_stiffness().as_slice()),
                DofGroup::Membrane => self.matrix.extend_from_slice(element.membrane_stiffness().as_slice()),
                DofGroup::Shell => self.matrix.extend_from_slice(element.stiffness().as_slice()),
            }
            let size = (corners[2] - corners[0]).norm();
            self.last = Some((corners, size));
        }
        Ok(&self.matrix)
    }

    /// Equal up to a translation, to the rounding of the coordinates.
    fn is_like_the_last(&self, corners: &[Point3<f64>; 4]) -> bool {
        let Some((last, size)) = &self.last else { return false };
        (1..4).all(|i| ((corners[i] - corners[0]) - (last[i] - last[0])).amax() <= 1e-12 * size)
    }
}

/// An assembled system in one dof group: held dofs are unit rows scaled to the diagonal.
#[derive(Clone, Debug)]
pub struct Assembly {
    /// The stiffness.
    pub matrix: BlockMatrix,
    /// Right-hand side: loads on free dofs less the forces of the prescribed values; the scaled
    /// prescribed value on held dofs.
    pub rhs: Vec<f64>,
}

impl Assembly {
    /// Assembles the stiffness of `model` for the group, with `held` values and `load` (both of
    /// the group, `b` a node).
    ///
    /// # Errors
    /// M008 if the warp direction is normal to an element.
    pub fn stiffness(
        model: &Model,
        group: DofGroup,
        pattern: &Pattern,
        held: &[Option<f64>],
        load: &[f64],
    ) -> Result<Self, MaterialAxisError> {
        let b = group.dofs().len();
        let mut matrix = BlockMatrix::zeros(Arc::clone(&pattern.graph), b);
        let mut rhs = load.to_vec();
        let mut elements = ElementStiffness::new(model, group);
        let mut copy = vec![0.0; 16 * b * b];
        for (quad, nodes) in model.mesh.quads.iter().enumerate() {
            let k = elements.of(quad)?;
            let is_held = |dof: usize| held[nodes[dof / b] as usize * b + dof % b];
            if nodes.iter().any(|n| held[*n as usize * b..][..b].iter().any(Option::is_some)) {
                copy.copy_from_slice(k);
                remove_held(&mut copy, 4 * b, &is_held, |dof, force| {
                    rhs[nodes[dof / b] as usize * b + dof % b] -= force;
                });
                scatter(&copy, b, nodes, &pattern.blocks[quad], &mut matrix);
            } else {
                scatter(k, b, nodes, &pattern.blocks[quad], &mut matrix);
            }
        }
        unit_rows(&mut matrix, &mut rhs, held);
        Ok(Self { matrix, rhs })
    }
}

/// Clears rows and columns of held dofs and hands the force of each prescribed value to `subtract`.
fn remove_held(
    k: &mut [f64],
    n: usize,
    held: &impl Fn(usize) -> Option<f64>,
    mut subtract: impl FnMut(usize, f64),
) {
    for j in 0..n {
        let Some(value) = held(j) else { continue };
        for i in 0..n {
            if value != 0.0 && held(i).is_none() {
                subtract(i, k[j * n + i] * value);
            }
            k[j * n + i] = 0.0;
            k[i * n + j] = 0.0;
        }
    }
}

/// Adds an element matrix to the blocks of the lower triangle.
fn scatter(k: &[f64], b: usize, nodes: &[u32; 4], blocks: &[u32; 10], matrix: &mut BlockMatrix) {
    let n = 4 * b;
    for (&(i, j), &block) in PAIRS.iter().zip(blocks) {
        // The stored block has the greater node as row; element matrices are symmetric.
        let (row, column) = if nodes[i] >= nodes[j] { (i, j) } else { (j, i) };
        let target = &mut matrix.values[block as usize * b * b..][..b * b];
        for c in 0..b {
            let source = &k[(column * b + c) * n + row * b..][..b];
            target[c * b..][..b].iter_mut().zip(source).for_each(|(t, s)| *t += s);
        }
    }
}

/// Puts the largest diagonal entry of its kind on the diagonal of each held dof.
fn unit_rows(matrix: &mut BlockMatrix, rhs: &mut [f64], held: &[Option<f64>]) {
    let b = matrix.block;
    let diagonal = |node: usize, dof: usize| matrix.graph.col_ptr[node] * b * b + dof * b + dof;
    let mut scale = vec![0.0f64; b];
    for node in 0..matrix.graph.nodes {
        for (dof, s) in scale.iter_mut().enumerate() {
            *s = s.max(matrix.values[diagonal(node, dof)]);
        }
    }
    for (k, value) in held.iter().enumerate() {
        let Some(value) = value else { continue };
        // A group with every dof of a kind held has no scale of its own.
        let s = if scale[k % b] > 0.0 { scale[k % b] } else { 1.0 };
        let at = matrix.graph.col_ptr[k / b] * b * b + (k % b) * b + k % b;
        matrix.values[at] = s;
        rhs[k] = s * value;
    }
}
