//! A case on meshes that the estimate of their error refines.

use super::adapted::{AdaptedMesh, AdaptedMeshes, AdaptedQuantity};
use super::checked::lookup;
use super::convergence::{ROUNDING, Sizes, names};
use super::of_fabric::OfFabric;
use super::result::{CaseResult, Status};
use super::{PreparedCase, StudyError, Watch, build};
use crate::case::{Adaptive, Outline, SheetProblem, unit_of};
use crate::constitutive::MeasuredInput;
use crate::finding::{Finding, Located, RefinementEnd, StudyFact};
use crate::mesh::{GridLines, Refinement};
use crate::section::ShellSection;
use crate::solve::SolveError;

/// Part of the energy of the error whose cells are divided: the half that is usual. Less makes more meshes; much more divides cells
/// that did not need it where the error is in few (Dörfler).
const SHARE: f64 = 0.5;

/// What is kept of the meshes while they are refined.
struct Record {
    names: Vec<String>,
    meshes: Vec<AdaptedMesh>,
    /// Of each mesh the values of the names.
    values: Vec<Vec<Option<f64>>>,
}

impl Record {
    fn new(problem: &SheetProblem) -> Self {
        Self { names: names(problem), meshes: Vec::new(), values: Vec::new() }
    }

    fn add(&mut self, result: &CaseResult, error: f64) {
        let mesh = &result.model.mesh;
        self.meshes.push(AdaptedMesh {
            elements: mesh.quads.len(),
            triangles: mesh.triangles(),
            dofs: result.solution.dofs,
            error,
        });
        self.values.push(self.names.iter().map(|name| lookup(name, result)).collect());
    }

    /// The results of all meshes; those of the last tell how large each kind of them is.
    fn quantities(
        &self,
        problem: &SheetProblem,
        last: &CaseResult,
    ) -> Result<Vec<AdaptedQuantity>, StudyError> {
        let sizes = Sizes::of(last)?;
        let mut quantities = Vec::new();
        for (k, name) in self.names.iter().enumerate() {
            let values: Option<Vec<f64>> = self.values.iter().map(|of_mesh| of_mesh[k]).collect();
            let unit = unit_of(name, &problem.analysis, &problem.probes);
            let (Some(values), Some(unit)) = (values, unit) else { continue };
            let finest = values.last().map_or(0.0, |value| value.abs());
            if finest > ROUNDING * sizes.like(name).unwrap_or(finest) {
                quantities.push(AdaptedQuantity { quantity: name.clone(), unit: unit.into(), values });
            }
        }
        Ok(quantities)
    }
}

impl<'a> PreparedCase<'a> {
    /// Solves the case on its mesh and on finer ones until the estimate of the error is small enough: the result on the last, not
    /// yet checked, and the case on that mesh if it is not its own.
    pub(super) fn adapted(
        &self,
        to: &Located<Adaptive>,
        section: &ShellSection,
        (fabric, inputs): (OfFabric<'_>, &[MeasuredInput]),
        watch: Watch<'_>,
    ) -> Result<(CaseResult, Option<Self>), StudyError> {
        let Adaptive { error: goal, meshes, elements } = to.value;
        let sheet = &self.problem.sheet;
        let mut refinement = Refinement::new(&build::plain_mesh(self.case, sheet)?, lines(&sheet.outline))?;
        let mut refined = refinement.mesh();
        let (mut result, mut on) = (self.results(section.clone(), fabric, inputs, watch)?, None);
        if result.status == Status::NotConverged {
            return Ok((result, on));
        }
        let mut record = Record::new(self.problem);
        let mut error;
        let end = loop {
            // A sheet with a law is refused where the case is read, and so there is an estimate.
            let estimate = result.error_estimate()?.cloned().unwrap_or_default();
            error = estimate.relative();
            record.add(&result, error);
            if error <= goal {
                break None;
            }
            if record.meshes.len() == meshes {
                break Some(RefinementEnd::Meshes);
            }
            refinement.divide_largest(&refined, &estimate.elements, SHARE);
            refined = refinement.mesh();
            if refined.mesh.quads.len() > elements {
                break Some(RefinementEnd::Elements);
            }
            watch.not_stopped()?;
            SolveError::in_time()?;
            let finer = self.on_finer(refined.mesh.clone())?;
            let found = finer.results(section.clone(), fabric, inputs, watch)?;
            if found.status == Status::NotConverged {
                break Some(RefinementEnd::Search);
            }
            (result, on) = (found, Some(finer));
        };
        if let Some(end) = end {
            let fact = StudyFact::NotRefined { goal, error, end };
            result.findings.push(Finding::new(fact).at(self.case.place(to)));
        }
        let quantities = record.quantities(self.problem, &result)?;
        let reached = end.is_none();
        result.adapted = Some(AdaptedMeshes { goal, reached, meshes: record.meshes, quantities });
        Ok((result, on))
    }
}

/// Where the lines of the mesh of an outline run.
fn lines(outline: &Outline) -> GridLines {
    match outline {
        Outline::Rectangle { .. } | Outline::File { .. } | Outline::Drawn(_) => GridLines::Straight,
        Outline::Disc { .. } => GridLines::RoundEdge,
        Outline::Annulus(_) => GridLines::Rings,
    }
}
