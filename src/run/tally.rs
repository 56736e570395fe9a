//! What the fabrics of a share of a batch are to its cases, and what it comes to for the batch.

use serde::{Deserialize, Serialize};

use crate::finding::{Finding, Place, StudyFact};
use crate::results::{Failure, without_fabric_named};

/// What the fabrics of a share are to a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseTally {
    /// Name of the case.
    pub name: String,
    /// Its file.
    pub place: Place,
    /// Whether it is for fabrics with FAB bend tests.
    pub is_for_fab_records: bool,
    /// Whether the fabric that it names, if it names one, is there.
    pub is_there: bool,
    /// Whether a fabric has what it needs.
    pub suits_any: bool,
    /// Whether a fabric misses a law of friction.
    pub lacked_by_any: bool,
    /// Number of fabrics that it was solved for.
    pub tasks: usize,
    /// Fabrics that it is for, and that have no law.
    pub without: Vec<String>,
}

#[cfg_attr(not(feature = "parquet"), allow(dead_code, reason = "only parts are put together"))]
impl CaseTally {
    fn add(&mut self, other: &Self) {
        self.suits_any |= other.suits_any;
        self.lacked_by_any |= other.lacked_by_any;
        self.tasks += other.tasks;
        self.without.extend(other.without.iter().cloned());
    }

    fn finding(&self) -> Option<Finding> {
        let fabrics = self.without.clone();
        (!fabrics.is_empty()).then(|| Finding::new(StudyFact::WithoutLaw { fabrics }).at(self.place.clone()))
    }

    fn failure(&self) -> Option<Failure> {
        let is_left_out = (self.is_for_fab_records || self.lacked_by_any) && !self.suits_any;
        let lacks_law = !self.without.is_empty();
        (self.is_there && self.tasks == 0 && !is_left_out)
            .then(|| without_fabric_named(&self.name, &self.place.path, self.is_for_fab_records, lacks_law))
    }
}

/// What is to be said of a batch of which these are the shares: the fabrics that miss a law, and the cases that found
/// no fabric.
#[cfg_attr(not(feature = "parquet"), allow(dead_code, reason = "only parts are put together"))]
pub(crate) fn of_batch(shares: &[Vec<CaseTally>]) -> (Vec<Finding>, Vec<Failure>) {
    let mut whole = shares.first().cloned().unwrap_or_default();
    for share in shares.iter().skip(1) {
        whole.iter_mut().zip(share).for_each(|(case, other)| case.add(other));
    }
    whole.iter_mut().for_each(|case| case.without.sort());
    (
        whole.iter().filter_map(CaseTally::finding).collect(),
        whole.iter().filter_map(CaseTally::failure).collect(),
    )
}
