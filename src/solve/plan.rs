//! What depends on the mesh and its rigid bodies only, shared by every fabric on it.

use super::SolveError;
use super::assemble::Pattern;
use super::factor::{self, Analysis, Path};
use super::linear::Options;
use crate::model::{Dof, DofGroup, Model};

/// Node pattern of a mesh, and ordering and symbolic factorisation for each dof group in use.
#[derive(Debug)]
pub struct Plan {
    pub(super) pattern: Pattern,
    pub(super) groups: Vec<(DofGroup, Analysis)>,
}

impl Plan {
    /// Analyses the mesh and the rigid bodies of a model for the dof groups that will be solved.
    ///
    /// # Errors
    /// M010 for bodies that cannot be; N002 when the ordering or symbolic phase fails (out of memory).
    pub fn new(model: &Model, groups: &[DofGroup], path: Path) -> Result<Self, SolveError> {
        let mesh = &model.mesh;
        let pattern = Pattern::new(mesh, model.links()?);
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
    pub fn all_groups(model: &Model, options: &Options) -> Vec<DofGroup> {
        if options.coupled || !model.mesh.is_flat() {
            return vec![DofGroup::Shell];
        }
        vec![DofGroup::Plate, DofGroup::Membrane]
    }
}
