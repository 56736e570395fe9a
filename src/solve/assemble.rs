//! Element matrices into block matrices, in element order: the result does not depend on threads.

use std::sync::Arc;

use nalgebra::Point3;

use super::sparse::{BlockGraph, BlockMatrix};
use crate::element::{Mass, MaterialAxisError, Prepared};
use crate::mesh::QuadMesh;
use crate::model::{DofGroup, Links, Model};

/// The node graph of a model and the place of every element's blocks in it: computed once per mesh.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// Neighbouring nodes.
    pub graph: Arc<BlockGraph>,
    /// What rigid bodies tie together.
    pub links: Arc<Links>,
    /// Nodes of each quad, followers replaced by their leads.
    pub(super) quads: Vec<[u32; 4]>,
    /// Block index of each of the ten node pairs of every quad, in the order of [`PAIRS`].
    pub(super) blocks: Vec<[u32; 10]>,
}

/// Pairs (i, j), i >= j, of local nodes.
const PAIRS: [(usize, usize); 10] =
    [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2), (3, 0), (3, 1), (3, 2), (3, 3)];

impl Pattern {
    /// The pattern of a mesh with these links.
    pub fn new(mesh: &QuadMesh, links: Arc<Links>) -> Self {
        let quads: Vec<[u32; 4]> =
            mesh.quads.iter().map(|quad| quad.map(|n| links.leads[n as usize])).collect();
        let graph = BlockGraph::from_elements(mesh.nodes.len(), &quads);
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
        Self { graph: Arc::new(graph), links, quads, blocks }
    }
}

/// Which matrix of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Stiffness.
    Stiffness,
    /// Mass, Eq. (12).
    Mass(Mass),
}

/// Element matrices of a model in one dof group; equal elements in a row are computed once.
pub struct ElementMatrices<'a> {
    model: &'a Model,
    group: DofGroup,
    kind: Kind,
    last: Option<([Point3<f64>; 4], f64)>,
    matrix: Vec<f64>,
}

impl<'a> ElementMatrices<'a> {
    /// Matrices of one kind of `model` restricted to `group`.
    pub fn new(model: &'a Model, group: DofGroup, kind: Kind) -> Self {
        Self { model, group, kind, last: None, matrix: Vec::new() }
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
            match (self.kind, self.group) {
                (Kind::Stiffness, DofGroup::Plate) => {
                    self.matrix.extend_from_slice(element.plate_stiffness().as_slice());
                }
                (Kind::Stiffness, DofGroup::Membrane) => {
                    self.matrix.extend_from_slice(element.membrane_stiffness().as_slice());
                }
                (Kind::Stiffness, DofGroup::Shell) => {
                    self.matrix.extend_from_slice(element.stiffness().as_slice());
                }
                (Kind::Mass(mass), group) => {
                    let mass = mass.matrix(&element.frame, &self.model.section);
                    of_group(mass.as_slice(), group, &mut self.matrix);
                }
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

/// The part of a 24 x 24 matrix that belongs to a group.
fn of_group(full: &[f64], group: DofGroup, part: &mut Vec<f64>) {
    let dofs = group.dofs();
    let place = |k: usize| 6 * (k / dofs.len()) + dofs[k % dofs.len()] as usize;
    let n = 4 * dofs.len();
    part.extend((0..n * n).map(|k| full[24 * place(k / n) + place(k % n)]));
}

/// The sum of `factor` times each kind of matrix, with rows and columns of held dofs empty; those
/// of followers of rigid bodies are added to their leads.
///
/// `held` says of each dof of the group (`b` a node) whether it is held; followers count as held.
///
/// # Errors
/// M008 if the warp direction is normal to an element.
pub fn assemble(
    model: &Model,
    group: DofGroup,
    pattern: &Pattern,
    terms: &[(Kind, f64)],
    held: &[bool],
) -> Result<BlockMatrix, MaterialAxisError> {
    let b = group.dofs().len();
    let mut matrix = BlockMatrix::zeros(Arc::clone(&pattern.graph), b);
    let mut copy = vec![0.0; 16 * b * b];
    for &(kind, factor) in terms {
        let mut elements = ElementMatrices::new(model, group, kind);
        for (quad, nodes) in pattern.quads.iter().enumerate() {
            let k = elements.of(quad)?;
            let is_held = |dof: usize| held[nodes[dof / b] as usize * b + dof % b];
            let linked = pattern.links.touch(&model.mesh.quads[quad]);
            if factor == 1.0 && !linked && !(0..4 * b).any(is_held) {
                scatter(k, b, nodes, &pattern.blocks[quad], &mut matrix);
                continue;
            }
            copy.iter_mut().zip(k).for_each(|(c, k)| *c = factor * k);
            if linked {
                pattern.links.constrain(group, &model.mesh.quads[quad], &mut copy);
            }
            for j in (0..4 * b).filter(|j| is_held(*j)) {
                for i in 0..4 * b {
                    copy[j * 4 * b + i] = 0.0;
                    copy[i * 4 * b + j] = 0.0;
                }
            }
            scatter(&copy, b, nodes, &pattern.blocks[quad], &mut matrix);
        }
    }
    Ok(matrix)
}

/// Adds an element matrix to the blocks of the lower triangle. Nodes of the element may coincide.
pub(super) fn scatter(k: &[f64], b: usize, nodes: &[u32; 4], blocks: &[u32; 10], matrix: &mut BlockMatrix) {
    let n = 4 * b;
    let mut add = |row: usize, column: usize, block: u32| {
        let target = &mut matrix.values[block as usize * b * b..][..b * b];
        for c in 0..b {
            let source = &k[(column * b + c) * n + row * b..][..b];
            target[c * b..][..b].iter_mut().zip(source).for_each(|(t, s)| *t += s);
        }
    };
    for (&(i, j), &block) in PAIRS.iter().zip(blocks) {
        // The stored block has the greater node as row; element matrices are symmetric.
        let (row, column) = if nodes[i] >= nodes[j] { (i, j) } else { (j, i) };
        add(row, column, block);
        if i != j && nodes[i] == nodes[j] {
            // On the diagonal both halves are stored.
            add(column, row, block);
        }
    }
}

/// Puts the largest diagonal entry of its kind on the diagonal of each held dof, so that the
/// factorisation sees a unit row of ordinary size.
pub fn unit_rows(matrix: &mut BlockMatrix, held: &[bool]) {
    let b = matrix.block;
    let mut scale = vec![0.0f64; b];
    for k in 0..matrix.rows() {
        scale[k % b] = scale[k % b].max(matrix.values[matrix.diagonal(k)]);
    }
    for k in (0..held.len()).filter(|k| held[*k]) {
        // A kind of dof that is held everywhere has no scale of its own.
        let s = if scale[k % b] > 0.0 { scale[k % b] } else { 1.0 };
        let at = matrix.diagonal(k);
        matrix.values[at] = s;
    }
}

/// A matrix of the model times a vector of the group, by a loop over the elements: independent of
/// the assembled matrix, held dofs included; followers of rigid bodies are nodes like any other.
///
/// # Errors
/// M008 if the warp direction is normal to an element.
pub fn multiply(
    model: &Model,
    group: DofGroup,
    kind: Kind,
    u: &[f64],
) -> Result<Vec<f64>, MaterialAxisError> {
    let b = group.dofs().len();
    let n = 4 * b;
    let mut elements = ElementMatrices::new(model, group, kind);
    let mut product = vec![0.0; u.len()];
    let (mut local, mut f) = (vec![0.0; n], vec![0.0; n]);
    for (quad, nodes) in model.mesh.quads.iter().enumerate() {
        let k = elements.of(quad)?;
        for (i, node) in nodes.iter().enumerate() {
            local[i * b..][..b].copy_from_slice(&u[*node as usize * b..][..b]);
        }
        f.fill(0.0);
        for (j, value) in local.iter().enumerate() {
            f.iter_mut().zip(&k[j * n..][..n]).for_each(|(f, k)| *f += k * value);
        }
        for (i, node) in nodes.iter().enumerate() {
            product[*node as usize * b..][..b].iter_mut().zip(&f[i * b..]).for_each(|(a, f)| *a += f);
        }
    }
    Ok(product)
}
