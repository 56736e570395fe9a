//! What depends on the mesh only, shared by every fabric on it.

use super::SolveError;
use super::assemble::Pattern;
use super::factor::{self, Analysis, Path};
use super::linear::Options;
use crate::mesh::QuadMesh;
use crate::model::{Dof, DofGroup, Model};

/// Node pattern of a mesh, and ordering and symbolic factorisation for each dof group in use.
#[derive(Debug)]
pub struct Plan {
    pub(super) pattern: Pattern,
    pub(super) groups: Vec<(DofGroup, Analysis)>,
}

impl Plan {
    /// Analyses the mesh for the dof groups that will be solved.
    ///
    /// # Errors
    /// N002 when the ordering or symbolic phase fails (out of memory).
    pub fn new(mesh: &QuadMesh, groups: &[DofGroup], path: Path) -> Result<Self, SolveError> {
        Self::of_quads(mesh, &mesh.quads, groups, path)
    }

    /// The same for elements whose nodes are not those of the mesh: those of rigid bodies are their leads.
    pub(super) fn of_quads(
        mesh: &QuadMesh,
        quads: &[[u32; 4]],
        groups: &[DofGroup],
        path: Path,
    ) -> Result<Self, SolveError> {
        let pattern = Pattern::new(mesh.nodes.len(), quads);
        let coordinates: Vec<[f64; 3]> = mesh.nodes.iter().map(|p| [p.x, p.y, p.z]).collect();
        let groups = groups
            .iter()
            .map(|&group| {
                factor::analyse(&pattern.graph, group.dofs().len(), Some(&coordinates), path)
                    .map(|analysis| (group, analysis))
            })
            .collect::<Result<_, _>>()
            .map_err(SolveError::Factor)?;
        Ok(Self { pattern, groups })
    }

    /// The groups of a model that its loads and prescribed values set in motion.
    pub fn groups(model: &Model, options: &Options) -> Vec<DofGroup> {
        if options.coupled || !model.mesh.is_flat() {
            return vec![DofGroup::Shell];
        }
        let (load, held) = (model.load_vector(), model.constraints());
        let moves = |dof: &Dof| {
            load.iter().skip(*dof as usize).step_by(6).any(|f| *f != 0.0)
                || held.iter().skip(*dof as usize).step_by(6).any(|h| h.is_some_and(|v| v != 0.0))
        };
        [DofGroup::Plate, DofGroup::Membrane]
            .into_iter()
            .filter(|group| group.dofs().iter().any(moves))
            .collect()
    }

    /// Every group that a model has, in motion or not: what a modal analysis needs.
    pub fn all_groups(model: &Model) -> Vec<DofGroup> {
        if model.mesh.is_flat() { vec![DofGroup::Plate, DofGroup::Membrane] } else { vec![DofGroup::Shell] }
    }
}
