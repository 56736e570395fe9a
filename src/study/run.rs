//! Solving a case and reading its results.

use std::sync::{Arc, OnceLock};

use super::checked::check;
use super::contact::contacts;
use super::dynamics::{dynamics, is_out_of_time, rayleigh};
use super::eigen_steps::buckling_of;
use super::finite::finite;
use super::limits::{Beyond, buckles, findings, is_compressed, stretched};
use super::load_steps::load_steps;
use super::mesh_series::Convergence;
use super::nonlinear::{equilibrium, largest_w};
use super::of_fabric::OfFabric;
use super::result::{CaseResult, Kept, Outcome, Probe, Status};
use super::uncertainty::{linear_uncertainty, modal_uncertainty};
use super::{Case, PreparedCase, StudyError, Watch, build};
use crate::case::{Analysis, ProbePoint};
use crate::constitutive::{Constitutive, MeasuredInput};
use crate::fields::{Locator, Recovery};
use crate::finding::{Finding, Place, StudyFact};
use crate::model::Model;
use crate::quantity::Curve;
use crate::section::ShellSection;
use crate::solve::newmark;
use crate::solve::nonlinear::lost_directions;
use crate::solve::{self, Options, Solution};

/// Solves a case that has a `[sheet]`, for one section; many sections share a [`PreparedCase`].
///
/// # Errors
/// See [`StudyError`].
pub fn solve_case(case: &Case, section: ShellSection, options: &Options) -> Result<CaseResult, StudyError> {
    PreparedCase::new(case, options)?.solve(section)
}

impl PreparedCase<'_> {
    /// Solves the case for one section.
    ///
    /// # Errors
    /// See [`StudyError`].
    pub fn solve(&self, section: ShellSection) -> Result<CaseResult, StudyError> {
        self.solve_measured(section, &[])
    }

    /// Solves the case for a section that was made of `inputs`: their spread becomes the
    /// uncertainty of a linear result.
    ///
    /// # Errors
    /// See [`StudyError`].
    pub fn solve_measured(
        &self,
        section: ShellSection,
        inputs: &[MeasuredInput],
    ) -> Result<CaseResult, StudyError> {
        self.solve_of(section, OfFabric::default(), inputs, Watch::default())
    }

    /// Solves the case for what was made of a fabric: its section, its friction and the spread of its
    /// inputs.
    ///
    /// # Errors
    /// See [`StudyError`].
    pub fn solve_fabric(&self, made: &Constitutive) -> Result<CaseResult, StudyError> {
        self.solve_watched(made, Watch::default())
    }

    /// The same, watched: it may be stopped between the steps of a search and between two instants. It has no stages.
    ///
    /// # Errors
    /// See [`StudyError`]; O054 if it was stopped.
    pub fn solve_watched(&self, made: &Constitutive, watch: Watch<'_>) -> Result<CaseResult, StudyError> {
        self.solve_of(made.section.clone(), OfFabric::of(made), &made.inputs, watch)
    }

    /// [`solve`](Self::solve), watched like [`solve_watched`](Self::solve_watched).
    ///
    /// # Errors
    /// See [`StudyError`]; O054 if it was stopped.
    pub fn solve_section_watched(
        &self,
        section: ShellSection,
        watch: Watch<'_>,
    ) -> Result<CaseResult, StudyError> {
        self.solve_of(section, OfFabric::default(), &[], watch)
    }

    fn solve_of(
        &self,
        section: ShellSection,
        fabric: OfFabric<'_>,
        inputs: &[MeasuredInput],
        watch: Watch<'_>,
    ) -> Result<CaseResult, StudyError> {
        let case = self.case;
        let (mut result, finer) = match self.problem.analysis.adaptive() {
            Some(to) => self.adapted(to, &section, (fabric, inputs), watch)?,
            None => (self.results(section, fabric, inputs, watch)?, None),
        };
        finer.as_ref().unwrap_or(self).examine(&mut result)?;
        let stretched = stretched(&result)?;
        result.findings.extend(stretched.map(|fact| Finding::new(fact).at(Place::file(&case.path))));
        if !self.coarser.is_empty() && result.status != Status::NotConverged {
            self.compare_meshes(&mut result, fabric, watch)?;
        }
        finite(&result)?;
        let checks = &self.problem.checks;
        result.checks = checks.iter().map(|c| check(case, c, &result)).collect::<Result<_, _>>()?;
        let failed = result.checks.iter().zip(checks).filter(|(result, _)| !result.passed);
        let failed = failed.map(|(result, check)| result.finding(case.place(&check.quantity)));
        result.findings.extend(failed);
        if result.status != Status::NotConverged && result.checks.iter().any(|c| !c.passed) {
            result.status = Status::CheckFailed;
        }
        Ok(result)
    }

    /// Tells of a linear result whether the sheet would have buckled before.
    fn examine(&self, result: &mut CaseResult) -> Result<(), StudyError> {
        // A mesh that is too large to factorise is not examined, and the result stands where that cannot be done.
        let examined = matches!(self.problem.analysis, Analysis::Linear(_)) && !self.plan.iterates();
        if result.status == Status::Ok && examined && is_compressed(result, &self.extent)? {
            let lost = lost_directions(&result.model, &result.solution.displacement, &self.options);
            if let Some(lost) = lost.ok().filter(|n| *n > 0) {
                result.status = Status::BeyondLinear;
                result.findings.push(buckles(self.case, lost));
            }
        }
        Ok(())
    }

    /// Solves the case on its coarser meshes, and adds what they tell. One on which no equilibrium is found tells nothing.
    fn compare_meshes(
        &self,
        result: &mut CaseResult,
        fabric: OfFabric<'_>,
        watch: Watch<'_>,
    ) -> Result<(), StudyError> {
        let section = &result.model.section;
        let coarser = self.coarser.iter().map(|mesh| mesh.results(section.clone(), fabric, &[], watch));
        let coarser = coarser.collect::<Result<Vec<_>, _>>()?;
        self.tell_meshes(result, &coarser)
    }

    /// Adds what the results on coarser meshes tell, coarsest first.
    pub(super) fn tell_meshes(
        &self,
        result: &mut CaseResult,
        coarser: &[CaseResult],
    ) -> Result<(), StudyError> {
        if let Some(lost) = coarser.iter().position(|r| r.status == Status::NotConverged) {
            let sheets = self.problem.analysis.coarser().map_or(&[][..], |meshes| &meshes.value);
            let cells = sheets.get(lost).and_then(|sheet| sheet.outline.cells()).unwrap_or_default();
            let fact = StudyFact::CoarserNotConverged { cells };
            result.findings.push(Finding::new(fact).at(Place::file(&self.case.path)));
            return Ok(());
        }
        let meshes: Vec<&CaseResult> = coarser.iter().chain([&*result]).collect();
        let convergence = Convergence::of(self.problem, &meshes)?;
        result.findings.extend(convergence.finding(self.case));
        result.convergence = Some(convergence);
        Ok(())
    }

    /// What the mesh of this case gives, not yet checked.
    pub(super) fn results(
        &self,
        section: ShellSection,
        fabric: OfFabric<'_>,
        inputs: &[MeasuredInput],
        watch: Watch<'_>,
    ) -> Result<CaseResult, StudyError> {
        let case = self.case;
        let model = self.model(section);
        build::weighed(&model)?;
        let outcome = analyse(self, &model, fabric, watch)?;
        let Outcome {
            solution,
            frequencies,
            load_factors,
            modes: shapes,
            history,
            path,
            state,
            kept,
            findings: own,
        } = outcome;
        let uncertainty = match kept {
            _ if inputs.is_empty() => None,
            Kept::Nothing => None,
            Kept::Modes(modes, mass) => Some(modal_uncertainty(&model, (&modes, mass), inputs)?),
            Kept::Factors(factors) => {
                let names = self.problem.probes.iter().map(|p| p.name.as_str());
                let named: Vec<_> = names.zip(self.probes.iter().copied()).collect();
                let recovery = self.recovery.get_or_init(|| Recovery::new(&model.mesh));
                Some(linear_uncertainty(&model, (&solution, &factors), inputs, &named, recovery)?)
            }
        };
        let w = |n: usize| solution.displacement[6 * n + 2];
        let w_max =
            history.as_ref().map_or_else(|| largest_w(&model.mesh, &solution.displacement), |h| h.w_max);
        let deflection = match &history {
            Some(_) => w_max.abs(),
            None => self.extent.deflection(&model.mesh, &solution.displacement, w_max),
        };
        let w_over_thickness = deflection / model.section.bending_thickness_squared().sqrt();
        let is_linear = frequencies.is_empty() && load_factors.is_empty() && state.is_none();
        let ratio = [deflection, w_over_thickness];
        let beyond =
            is_linear.then(|| Beyond::of(&model, &self.extent, &solution.displacement, ratio)).flatten();
        let in_plane = |u: &Vec<f64>| self.extent.moves_in_plane(u);
        let in_plane = shapes.iter().any(in_plane) || in_plane(&solution.displacement);
        let mut findings = findings((case, self.problem), &model, &self.extent, beyond.as_ref(), in_plane);
        findings.extend(own);
        let status = match &path {
            Some(path) if !path.converged => Status::NotConverged,
            _ if findings.iter().any(is_out_of_time) => Status::NotConverged,
            _ if beyond.is_some() => Status::BeyondLinear,
            _ => Status::Ok,
        };
        let contacts = state.as_ref().map(|state| contacts(&self.problem.obstacles, fabric.friction, state));
        let contacts = contacts.unwrap_or_default();
        let along = self.middle.profile(&model.mesh, w);
        let start = model.mesh.bounds()[0].x;
        let profile = Curve { x: along.x.iter().map(|x| start + x).collect(), y: along.y };
        let mut result = CaseResult {
            case: case.name.clone(),
            status,
            model,
            solution,
            w_max,
            w_over_thickness,
            probes: Vec::new(),
            checks: Vec::new(),
            profile,
            frequencies,
            load_factors,
            modes: shapes,
            history,
            path,
            state,
            law: fabric.law.cloned(),
            uncertainty,
            convergence: None,
            adapted: None,
            contacts,
            findings,
            modal: matches!(self.problem.analysis, Analysis::Modal(_) | Analysis::Buckling(_)),
            recovery: Arc::clone(&self.recovery),
            nodal: OnceLock::new(),
            error: OnceLock::new(),
        };
        result.probes = probes(&self.problem.probes, &self.probes, &result)?;
        Ok(result)
    }
}

fn analyse(
    prepared: &PreparedCase<'_>,
    model: &Model,
    fabric: OfFabric<'_>,
    watch: Watch<'_>,
) -> Result<Outcome, StudyError> {
    let (case, options) = (prepared.case, &prepared.options);
    match &prepared.problem.analysis {
        Analysis::Linear(_) => {
            let (solution, factors) = solve::solve_keeping(model, Some(&prepared.plan), options)?;
            Ok(Outcome { kept: Kept::Factors(factors), ..Outcome::of(solution) })
        }
        Analysis::Modal(modal) => {
            let modes = solve::modes_with(model, &prepared.plan, modal.modes, modal.mass, options)?;
            let mut solution = Solution { dofs: prepared.plan.rows(model), ..Solution::at_rest(model) };
            let shapes: Vec<Vec<f64>> = modes.iter().map(|m| of_unit_size(&m.shape)).collect();
            if let Some(first) = shapes.first() {
                solution.displacement.clone_from(first);
            }
            let frequencies = modes.iter().map(solve::VibrationMode::frequency).collect();
            let findings = (modes.len() < modal.modes).then(|| fewer_modes(case, modes.len(), modal.modes));
            Ok(Outcome {
                frequencies,
                modes: shapes,
                kept: Kept::Modes(modes, modal.mass),
                findings: findings.into_iter().collect(),
                ..Outcome::of(solution)
            })
        }
        Analysis::Buckling(buckling) => buckling_of(prepared, model, buckling.factors),
        Analysis::Newmark(newmark) => {
            let settings = newmark::Settings {
                duration: newmark.duration.si(),
                step: newmark.step.si(),
                tolerance: newmark.tolerance,
                damping: rayleigh(prepared, model, newmark.damping.as_ref(), newmark.mass)?,
                load: newmark.history,
                mass: newmark.mass,
                scheme: newmark.scheme,
                beginning: newmark.beginning,
            };
            dynamics(prepared, model, fabric, &settings, newmark.rotations, watch)
        }
        Analysis::Nonlinear(nonlinear) => equilibrium(prepared, model, fabric, nonlinear, watch),
        Analysis::Steps(steps) => load_steps(prepared, model, fabric, steps, watch),
    }
}

/// A mode with a largest displacement of 1 m; of 1 rad if it has rotations only.
pub(super) fn of_unit_size(shape: &[f64]) -> Vec<f64> {
    let size = |part: std::ops::Range<usize>| {
        shape.chunks_exact(6).flat_map(|node| &node[part.clone()]).fold(0.0f64, |m, v| m.max(v.abs()))
    };
    let largest = if size(0..3) > 0.0 { size(0..3) } else { size(3..6) };
    shape.iter().map(|v| v / largest).collect()
}

pub(super) fn fewer_modes(case: &Case, found: usize, wanted: usize) -> Finding {
    Finding::new(StudyFact::FewerModes { found, wanted }).at(Place::file(&case.path))
}

fn probes(
    points: &[ProbePoint],
    locators: &[Locator],
    result: &CaseResult,
) -> Result<Vec<Probe>, StudyError> {
    if locators.is_empty() {
        return Ok(Vec::new());
    }
    let nodal = result.nodal()?;
    let value = |at: &Locator| at.value(&result.model.mesh, &result.solution.displacement, nodal);
    let probe = |(p, at): (&ProbePoint, &Locator)| Probe {
        name: p.name.clone(),
        at: p.at.value.coordinates(),
        value: value(at),
    };
    Ok(points.iter().zip(locators).map(probe).collect())
}
