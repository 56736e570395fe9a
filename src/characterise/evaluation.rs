//! What every test's evaluation yields and tells.

use std::collections::BTreeMap;

use super::Settings;
use super::graph::LineFit;
use super::sheet::{Branch, Window};
use crate::finding::{EvaluationFact, Finding, Place};
use crate::instrument::{Measurement, Parameter};
use crate::kes::RecordName;

/// What a test's evaluation yields.
#[derive(Debug, Default)]
pub(super) struct Evaluation {
    pub branches: Vec<Branch>,
    pub correction: [f64; 2],
    pub windows: Vec<Window>,
    pub fits: Vec<LineFit>,
    pub values: BTreeMap<Parameter, f64>,
    pub moduli: BTreeMap<String, f64>,
}

/// What the way back gives.
pub(super) struct Regained {
    /// Work (J/m²) on what was recorded of it.
    pub work: f64,
    /// What a record that ends under load may lack of it at most.
    pub missing: f64,
}

/// Part of the work of loading that may be missing from the way back: RT and RC are then too low by less than one
/// percentage point. The noise and the drift of the zero that a complete record ends with, up to about 1 % of the maximum
/// in cloth that keeps half of its strain, make less.
const MISSING: f64 = 0.01;

/// Findings about one specimen: each names it and points at its file.
pub(super) struct Notes<'a> {
    pub measurement: &'a Measurement,
    pub findings: &'a mut Vec<Finding>,
}

impl Notes<'_> {
    pub fn add(&mut self, fact: EvaluationFact) {
        self.findings.push(Finding::new(fact).at(self.measurement.place()));
    }

    /// The same, about one sample.
    pub fn add_at(&mut self, sample: usize, fact: EvaluationFact) {
        let line = self.measurement.lines.get(sample).copied().unwrap_or(0);
        self.findings.push(Finding::new(fact).at(Place::at(&self.measurement.source.path, line, 0)));
    }

    /// The record that is spoken of.
    pub fn record(&self) -> RecordName {
        self.measurement.record_name()
    }

    /// K002: something of the record that a parameter needs is not there.
    pub fn missing(&mut self, what: &str, why: &str) {
        let (record, what, reason) = (self.record(), what.to_string(), why.to_string());
        self.add(EvaluationFact::Missing { record, what, reason });
    }

    /// The work regained on the way back, if it was recorded to its end; `loading` is the work of loading.
    pub fn regained(&mut self, what: &str, found: Option<Regained>, loading: f64) -> Option<f64> {
        let Some(found) = found else {
            self.missing(what, "there is no unloading branch");
            return None;
        };
        if found.missing > MISSING * loading {
            let part = 100.0 * found.missing / loading;
            self.missing(what, &format!("the unloading branch ends under load, so that up to {part:.0} % of the work of loading is not in it"));
            return None;
        }
        Some(found.work)
    }

    /// Checks the observed maximum against the set one and returns what the parameters are to be read at:
    /// the set maximum, or the observed one where the record ends short of it.
    pub fn maximum(&mut self, observed: f64, settings: &Settings) -> f64 {
        let set = self.measurement.conditions.maximum;
        let allowed = settings.maximum_difference.si();
        let (record, reached, maximum) = (self.record(), observed, set);
        if !(set.is_finite() && set > 0.0) {
            return observed;
        }
        if observed < (1.0 - allowed) * set {
            self.add(EvaluationFact::ShortOfMaximum { record, reached, maximum });
        } else if observed > (1.0 + 5.0 * allowed) * set && settings.maximum(record.test).is_none() {
            self.add(EvaluationFact::BeyondMaximum { record, reached, maximum });
        }
        set.min(observed)
    }

    /// Whether the record goes on beyond the maximum that was asked for, so that it unloads from a greater load than the
    /// parameters are read at (K002 for `what`).
    pub fn unloads_from_beyond(&mut self, what: &str, observed: f64, settings: &Settings) -> bool {
        let asked = settings.maximum(self.measurement.test);
        let is_beyond =
            asked.is_some_and(|asked| observed > (1.0 + settings.maximum_difference.si()) * asked);
        if is_beyond {
            self.missing(what, "the record unloads from beyond the maximum that the settings ask for");
        }
        is_beyond
    }

    /// K003, K004: how far a fitted slope can be trusted.
    pub fn judge(&mut self, fit: &LineFit, settings: &Settings) {
        let (record, slope, samples) = (self.record(), fit.name.clone(), fit.n);
        if fit.n < 5 {
            self.add(EvaluationFact::FewSamples { record, slope: slope.clone(), samples });
        }
        let difference = (fit.two_point - fit.slope).abs() / fit.slope.abs();
        if difference > settings.slope_difference.si() {
            let r_squared = fit.r_squared;
            self.add(EvaluationFact::SlopesDiffer { record, slope, difference, r_squared, samples });
        }
    }
}
