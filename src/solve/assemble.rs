//! Element matrices into block matrices, in element order: the result does not depend on threads.

use std::sync::Arc;

use nalgebra::{Point3, Vector3};

use super::sparse::{BlockGraph, BlockMatrix};
use crate::element::{Drilling, Mass, MaterialAxisError, Prepared};
use crate::mesh::{QuadMesh, is_translated};
use crate::model::{Dof, DofGroup, Links, Model};
use crate::section::ShellSection;

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
        Self::tied(mesh, links, &[])
    }

    /// The same with places for the forces between nodes that no element joins: the two quads of each of these eights.
    pub fn tied(mesh: &QuadMesh, links: Arc<Links>, tied: &[[u32; 8]]) -> Self {
        let quads: Vec<[u32; 4]> =
            mesh.quads.iter().map(|quad| quad.map(|n| links.leads[n as usize])).collect();
        let tied: Vec<[u32; 8]> = tied.iter().map(|all| all.map(|n| links.leads[n as usize])).collect();
        let elements = quads.iter().map(|quad| &quad[..]).chain(tied.iter().map(|all| &all[..]));
        let graph = BlockGraph::from_elements(mesh.nodes.len(), elements);
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
pub enum MatrixKind {
    /// Stiffness.
    Stiffness,
    /// Mass, Eq. (12).
    Mass(Mass),
}

/// Element matrices of a model in one dof group; equal elements in a row are computed once.
pub struct ElementMatrices<'a> {
    model: &'a Model,
    section: &'a ShellSection,
    /// The section whose matrices are taken off.
    less: Option<&'a ShellSection>,
    group: DofGroup,
    kind: MatrixKind,
    last: Option<[Point3<f64>; 4]>,
    matrix: Vec<f64>,
}

impl<'a> ElementMatrices<'a> {
    /// Matrices of one kind of `model` restricted to `group`.
    pub fn new(model: &'a Model, group: DofGroup, kind: MatrixKind) -> Self {
        Self { model, section: &model.section, less: None, group, kind, last: None, matrix: Vec::new() }
    }

    /// What they change by from one section to another.
    pub fn change(
        model: &'a Model,
        [from, to]: [&'a ShellSection; 2],
        group: DofGroup,
        kind: MatrixKind,
    ) -> Self {
        Self { section: to, less: Some(from), ..Self::new(model, group, kind) }
    }

    /// The matrix of a quad, column-major, `4 b` square with `b` dofs a node.
    ///
    /// # Errors
    /// M008 if the warp direction is normal to the element.
    pub fn of(&mut self, quad: usize) -> Result<&[f64], MaterialAxisError> {
        let corners = self.model.mesh.corners(quad);
        if !self.last.is_some_and(|last| is_translated(&last, &corners)) {
            self.matrix.clear();
            self.append(self.section, quad)?;
            if let Some(less) = self.less {
                let matrix = std::mem::take(&mut self.matrix);
                self.append(less, quad)?;
                self.matrix.iter_mut().zip(matrix).for_each(|(off, k)| *off = k - *off);
            }
            self.last = Some(corners);
        }
        Ok(&self.matrix)
    }

    fn append(&mut self, section: &ShellSection, quad: usize) -> Result<(), MaterialAxisError> {
        let element: Prepared = self.model.element_of(section, quad, self.group != DofGroup::Shell)?;
        let matrix = &mut self.matrix;
        match (self.kind, self.group) {
            (MatrixKind::Stiffness, DofGroup::Plate) => {
                matrix.extend_from_slice(element.plate_stiffness().as_slice());
            }
            (MatrixKind::Stiffness, DofGroup::Membrane) => {
                matrix.extend_from_slice(element.membrane_stiffness().as_slice());
            }
            (MatrixKind::Stiffness, DofGroup::Shell) => {
                matrix.extend_from_slice(element.stiffness().as_slice())
            }
            (MatrixKind::Mass(mass), group) => {
                let mass = mass.matrix(&element.frame, section);
                of_group(mass.as_slice(), group, matrix);
            }
        }
        Ok(())
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
    terms: &[(MatrixKind, f64)],
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
    match b {
        3 => scatter_blocks::<3>(k, nodes, blocks, matrix),
        _ => scatter_blocks::<6>(k, nodes, blocks, matrix),
    }
}

fn scatter_blocks<const B: usize>(k: &[f64], nodes: &[u32; 4], blocks: &[u32; 10], matrix: &mut BlockMatrix) {
    // Column-major: the parts of a column that belong to the four nodes.
    let columns = k.as_chunks::<B>().0.as_chunks::<4>().0.as_chunks::<B>().0;
    let targets = matrix.values.as_chunks_mut::<B>().0.as_chunks_mut::<B>().0;
    let mut add = |row: usize, column: usize, block: u32| {
        for (target, source) in targets[block as usize].iter_mut().zip(&columns[column]) {
            target.iter_mut().zip(source[row]).for_each(|(t, s)| *t += s);
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

/// The sum of the element matrices times a vector of the group, without the matrix of the whole: held dofs
/// included; followers of rigid bodies are nodes like any other.
///
/// # Errors
/// M008 if the warp direction is normal to an element.
pub fn multiply(elements: ElementMatrices, u: &[f64]) -> Result<Vec<f64>, MaterialAxisError> {
    match elements.group.dofs().len() {
        3 => products::<3>(elements, |nodes| nodes.map(|n| of_node(u, n))),
        _ => products::<6>(elements, |nodes| nodes.map(|n| of_node(u, n))),
    }
}

/// The forces of the elements under the displacements `u + low`, where `low` holds the digits below
/// those of `u`.
///
/// The rigid motion of its first node is taken off each element before its matrix is applied: it
/// costs no energy, is thousands of times larger than what does on a fine mesh, and its rounding
/// would drown the rest.
///
/// # Errors
/// M008 if the warp direction is normal to an element.
pub fn internal_forces(
    model: &Model,
    group: DofGroup,
    u: &[f64],
    low: &[f64],
) -> Result<Vec<f64>, MaterialAxisError> {
    let turns = rigid_rotations(model, group);
    let elements = ElementMatrices::new(model, group, MatrixKind::Stiffness);
    match group.dofs().len() {
        3 => products::<3>(elements, |nodes| deformation(model, group, turns, nodes, u, low)),
        _ => products::<6>(elements, |nodes| deformation(model, group, turns, nodes, u, low)),
    }
}

/// Whether rigid rotations cost no energy: the spring of Nguyen-Trong et al. acts on the drilling rotation itself.
pub(super) fn rigid_rotations(model: &Model, group: DofGroup) -> bool {
    group == DofGroup::Plate || !matches!(model.formulation.drilling, Drilling::Seed(_))
}

/// The `B` numbers of a node.
fn of_node<const B: usize>(u: &[f64], node: u32) -> [f64; B] {
    u.as_chunks::<B>().0[node as usize]
}

/// Displacements of an element's nodes less the displacement and, if `turns`, the rotation of the first.
fn deformation<const B: usize>(
    model: &Model,
    group: DofGroup,
    turns: bool,
    nodes: [u32; 4],
    u: &[f64],
    low: &[f64],
) -> [[f64; B]; 4] {
    let points = &model.mesh.nodes;
    let (u, low) = (nodes.map(|n| of_node::<B>(u, n)), nodes.map(|n| of_node::<B>(low, n)));
    let first: [f64; B] = std::array::from_fn(|k| u[0][k] + low[0][k]);
    let mut rotation = Vector3::zeros();
    for (dof, value) in group.dofs().iter().zip(first).filter(|(d, _)| turns && **d >= Dof::ThetaX) {
        rotation[*dof as usize - 3] = value;
    }
    std::array::from_fn(|i| {
        let turned = rotation.cross(&(points[nodes[i] as usize] - points[nodes[0] as usize]));
        std::array::from_fn(|k| {
            let dof = group.dofs()[k] as usize;
            match dof {
                0..3 => (u[i][k] - u[0][k]) + (low[i][k] - low[0][k]) - turned[dof],
                _ if turns => (u[i][k] - u[0][k]) + (low[i][k] - low[0][k]),
                _ => u[i][k] + low[i][k],
            }
        })
    })
}

/// Sum over the elements of their matrix times what `local` gives for their nodes.
fn products<const B: usize>(
    mut elements: ElementMatrices,
    local: impl Fn([u32; 4]) -> [[f64; B]; 4],
) -> Result<Vec<f64>, MaterialAxisError> {
    let mesh = &elements.model.mesh;
    let mut product = vec![0.0; mesh.nodes.len() * B];
    for (quad, nodes) in mesh.quads.iter().enumerate() {
        let columns = elements.of(quad)?.as_chunks::<B>().0.as_chunks::<4>().0;
        let mut forces = [[0.0; B]; 4];
        for (column, value) in columns.iter().zip(local(*nodes).as_flattened()) {
            for (f, k) in forces.as_flattened_mut().iter_mut().zip(column.as_flattened()) {
                *f += k * value;
            }
        }
        for (node, forces) in nodes.iter().zip(forces) {
            let sum = &mut product.as_chunks_mut::<B>().0[*node as usize];
            sum.iter_mut().zip(forces).for_each(|(sum, f)| *sum += f);
        }
    }
    Ok(product)
}
