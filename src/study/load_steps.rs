//! The `[[steps]]` of a case, one after the other.

use super::contact::{contacts, surfaces, touching};
use super::load_path::LoadStepEnd;
use super::nonlinear::{Record, check_perturbation, conclude, helped, turned_about_more};
use super::of_fabric::OfFabric;
use super::result::Outcome;
use super::{PreparedCase, StudyError, Watch};
use crate::case::{MethodChoice, SheetStep};
use crate::finding::Finding;
use crate::model::Model;
use crate::solve::nonlinear::{Carried, LoadStep, Settings, continue_from};

/// Takes the sheet of a model through the steps of its case. The last one that has an equilibrium is the result; where
/// one has none, that is a finding, and the steps after it are not taken.
pub(super) fn load_steps(
    prepared: &PreparedCase<'_>,
    model: &Model,
    fabric: OfFabric<'_>,
    steps: &[SheetStep],
    watch: Watch<'_>,
) -> Result<Outcome, StudyError> {
    let method = steps.last().map_or(MethodChoice::Newton, |step| MethodChoice::of(&step.analysis.method));
    let mut record = Record::new(prepared, model, method, watch);
    let (mut carried, mut findings) = (Carried::rest(model), Vec::new());
    // Rotations that were held in every step, and how far.
    let mut held: Vec<Option<f64>> = vec![Some(0.0); 6 * model.mesh.nodes.len()];
    for (step, actions) in steps.iter().zip(&prepared.steps) {
        let model =
            Model { supports: actions.supports.clone(), loads: actions.loads.clone(), ..model.clone() };
        check_perturbation(prepared.case, &model, &step.analysis)?;
        let surfaces = surfaces(&prepared.problem.obstacles, fabric.friction);
        let settings = Settings { law: fabric.law.cloned(), surfaces, ..step.analysis.settings.clone() };
        let (moved, plan, options) = (&actions.moved, &prepared.plan, &prepared.options);
        let from = record.path.steps.len();
        let found = helped(
            &mut record,
            &step.analysis.method,
            |(solution, _)| solution,
            |method, record| {
                let way = LoadStep { model: &model, moved, settings: &settings, method };
                continue_from(&carried, &way, plan, options, |at| record.see(at))
            },
        );
        watch.not_stopped()?;
        let (found, next) = match found {
            Ok((solution, next)) => (Ok(solution), Some(next)),
            Err(error) => (Err(error), None),
        };
        let own = conclude(found, &mut record)?;
        record.path.load_steps.push(LoadStepEnd {
            name: step.name.value.clone(),
            method: record.path.method,
            steps: from..record.path.steps.len(),
            converged: record.path.converged,
            stability: record.path.stability,
            state: record.state.clone(),
            reaction: record.solution.reaction.clone(),
            contacts: contacts(&prepared.problem.obstacles, fabric.friction, &record.state),
        });
        if let Some(next) = next {
            held_throughout(&model, &actions.moved, next.turned(), &mut held);
            carried = next;
        }
        let touching = touching(&prepared.problem.obstacles, &model, fabric.friction, &record.state);
        let own = own.into_iter().chain(turned_about_more(&held, &record.state)).chain(touching);
        findings.extend(own.map(|finding: Finding| finding.at(prepared.case.place(&step.name))));
        if !record.path.converged {
            break;
        }
        record.done += 1;
    }
    let Record { mut solution, path, state, .. } = record;
    solution.dofs = model.constraints().iter().filter(|c| c.is_none()).count();
    Ok(Outcome { path: Some(path), state: Some(state), findings, ..Outcome::of(solution) })
}

/// Keeps of the rotations that were held in every step so far those that were held in this one too, and how far they were
/// turned.
fn held_throughout(model: &Model, moved: &[crate::model::Support], turned: &[f64], held: &mut [Option<f64>]) {
    let mut now = model.constraints();
    for support in moved {
        for node in &support.nodes {
            support
                .held
                .iter()
                .for_each(|(dof, value)| now[6 * *node as usize + *dof as usize] = Some(*value));
        }
    }
    for ((held, now), turned) in held.iter_mut().zip(now).zip(turned) {
        *held = held.and(now).map(|_| *turned);
    }
}
