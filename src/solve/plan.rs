//! What depends on the mesh, its rigid bodies and its hard supports only, shared by every fabric on it.

use super::SolveError;
use super::assemble::Pattern;
use super::factor::{self, Path, SymbolicAnalysis};
use super::linear::{Method, Options};
use crate::model::{Dof, DofGroup, Model};
use crate::platform::Stopwatch;

/// Node pattern of a mesh, and ordering and symbolic factorisation for each dof group in use.
#[derive(Debug)]
pub struct Plan {
    pub(super) pattern: Pattern,
    pub(super) groups: Vec<(DofGroup, SymbolicAnalysis)>,
    /// Groups that are solved by iteration.
    pub(super) iterated: Vec<DofGroup>,
    /// Spent on pattern and order, and on the symbolic factorisations.
    pub(super) seconds: (f64, f64),
}

impl Plan {
    /// Whether any group is solved by iteration.
    pub fn iterates(&self) -> bool {
        !self.iterated.is_empty()
    }

    /// Rows of the equations of a model: those of all of its groups, held ones included.
    pub fn rows(&self, model: &Model) -> usize {
        self.groups.iter().map(|(group, _)| group.dofs().len() * model.mesh.nodes.len()).sum()
    }

    /// Analyses the mesh, the rigid bodies and the hard supports of a model for the dof groups that will be factorised.
    ///
    /// # Errors
    /// M009 and M010 for hard supports and bodies that cannot be; N002 when the ordering or symbolic phase fails (out of memory).
    pub fn new(model: &Model, groups: &[DofGroup], path: Path) -> Result<Self, SolveError> {
        Self::direct(model, groups, &Options { path, ..Options::default() })
    }

    /// The same with all that `options` say but the method.
    ///
    /// # Errors
    /// Those of [`new`](Self::new), and N011 for a factor that is too large.
    pub fn direct(model: &Model, groups: &[DofGroup], options: &Options) -> Result<Self, SolveError> {
        Self::chosen(model, groups, &Options { method: Method::Direct, ..*options })
    }

    /// Analyses a model for linear statics: [`groups`](Self::groups), each solved as `options` ask.
    ///
    /// # Errors
    /// M009, M010 and N002 as in [`new`](Self::new).
    pub fn of(model: &Model, options: &Options) -> Result<Self, SolveError> {
        Self::chosen(model, &Self::groups(model, options), options)
    }

    fn chosen(model: &Model, groups: &[DofGroup], options: &Options) -> Result<Self, SolveError> {
        let watch = Stopwatch::start();
        let mesh = &model.mesh;
        SolveError::in_time()?;
        let pattern = Pattern::new(mesh, model.links()?);
        let mut plan = Self { pattern, groups: Vec::new(), iterated: Vec::new(), seconds: (0.0, 0.0) };
        if options.method == Method::Iterative {
            plan.iterated = groups.to_vec();
            return Ok(plan);
        }
        let coordinates: Vec<[f64; 3]> = mesh.nodes.iter().map(|p| [p.x, p.y, p.z]).collect();
        let graph = &plan.pattern.graph;
        let order = factor::order(graph, Some(&coordinates)).map_err(SolveError::Factor)?;
        plan.seconds.0 = watch.seconds();
        for &group in groups {
            SolveError::in_time()?;
            let analysis = factor::analyse_ordered(graph, group.dofs().len(), &order, options.path)
                .map_err(SolveError::Factor)?;
            if options.method == Method::Auto && analysis.counts().bytes as u64 > options.factor_limit {
                plan.iterated.push(group);
            } else {
                SolveError::in_memory(analysis.counts().bytes as f64, options.memory_limit)?;
                plan.groups.push((group, analysis));
            }
        }
        plan.seconds.1 = watch.seconds() - plan.seconds.0;
        Ok(plan)
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
