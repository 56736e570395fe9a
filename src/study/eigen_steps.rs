//! Steps that look at a state, its vibrations and how it buckles, and buckling from rest.

use std::f64::consts::TAU;

use super::build::Actions;
use super::load_path::LoadStepEnd;
use super::result::Outcome;
use super::run::{fewer_modes, of_unit_size};
use super::{PreparedCase, StudyError};
use crate::case::MethodChoice;
use crate::element::Mass;
use crate::finding::{Finding, StudyFact};
use crate::model::Model;
use crate::solve::Solution;
use crate::solve::nonlinear::{Buckle, Carried, Settings, buckles, vibrations};

/// What a step finds that looks at a state.
pub(super) struct Looked {
    frequencies: Vec<f64>,
    load_factors: Vec<f64>,
    shapes: Vec<Vec<f64>>,
    /// What a reader must know.
    pub findings: Vec<Finding>,
}

/// Where the sheet is that a step looks at.
pub(super) struct State<'a> {
    pub prepared: &'a PreparedCase<'a>,
    /// With what the step holds, and what grows in it.
    pub model: &'a Model,
    pub carried: &'a Carried,
    pub settings: &'a Settings,
}

impl<'a> State<'a> {
    /// The model of a sheet with the actions of a step.
    pub fn model(model: &Model, actions: &Actions) -> Model {
        let supports = actions.supports.iter().chain(&actions.prescribed).cloned().collect();
        Model { supports, loads: actions.loads.clone(), ..model.clone() }
    }

    /// Its small vibrations.
    pub fn vibrations(&self, modes: usize, mass: Mass) -> Result<Looked, StudyError> {
        let Self { prepared, model, carried, settings } = self;
        let found = vibrations(carried, model, (modes, mass), settings, &prepared.plan, &prepared.options)?;
        let growing: Vec<f64> = found.iter().map(|v| -v.square).filter(|s| *s > 0.0).map(f64::sqrt).collect();
        let mut findings = self.fewer(found.len(), modes);
        if let Some(fastest) = growing.first() {
            findings.push(Finding::new(StudyFact::GrowingModes { modes: growing.len(), rate: *fastest }));
        }
        Ok(Looked {
            frequencies: found.iter().map(|v| v.square.max(0.0).sqrt() / TAU).collect(),
            load_factors: Vec::new(),
            shapes: found.iter().map(|v| of_unit_size(&v.shape)).collect(),
            findings,
        })
    }

    /// How it buckles.
    pub fn buckles(&self, factors: usize) -> Result<Looked, StudyError> {
        let Self { prepared, model, carried, settings } = self;
        let found = buckles(carried, model, factors, settings, &prepared.plan, &prepared.options)?;
        let mut findings = Vec::new();
        if found.len() < factors {
            findings.push(Finding::new(StudyFact::FewerFactors { found: found.len(), wanted: factors }));
        }
        if !found.is_empty() && found.iter().all(|b| b.factor < 0.0) {
            findings.push(Finding::new(StudyFact::BucklesTurnedRound { nearest: found[0].factor }));
        }
        Ok(Looked {
            frequencies: Vec::new(),
            load_factors: found.iter().map(|b: &Buckle| b.factor).collect(),
            shapes: found.iter().map(|b| of_unit_size(&b.shape)).collect(),
            findings,
        })
    }

    fn fewer(&self, found: usize, wanted: usize) -> Vec<Finding> {
        (found < wanted).then(|| fewer_modes(self.prepared.case, found, wanted)).into_iter().collect()
    }
}

impl Looked {
    /// The end of a step of a name after so many steps of the path, which leaves the sheet as it was.
    pub fn end(self, name: &str, steps: usize, carried: &Carried, reaction: &[f64]) -> LoadStepEnd {
        LoadStepEnd {
            name: name.to_string(),
            method: MethodChoice::Newton,
            steps: steps..steps,
            converged: true,
            frequencies: self.frequencies,
            load_factors: self.load_factors,
            shapes: self.shapes,
            stability: None,
            history: None,
            frames: Vec::new(),
            state: carried.state.clone(),
            reaction: reaction.to_vec(),
            contacts: Vec::new(),
        }
    }
}

/// How a sheet at rest buckles under loads that grow.
pub(super) fn buckling_of(
    prepared: &PreparedCase<'_>,
    model: &Model,
    factors: usize,
) -> Result<Outcome, StudyError> {
    let settings = Settings::default();
    let state = State { prepared, model, carried: &Carried::rest(model), settings: &settings };
    let Looked { load_factors, shapes, findings, .. } = state.buckles(factors)?;
    let mut solution = Solution { dofs: prepared.plan.rows(model), ..Solution::at_rest(model) };
    if let Some(first) = shapes.first() {
        solution.displacement.clone_from(first);
    }
    let place = crate::finding::Place::file(&prepared.case.path);
    let findings = findings.into_iter().map(|f| f.at(place.clone())).collect();
    Ok(Outcome { load_factors, modes: shapes, findings, ..Outcome::of(solution) })
}
