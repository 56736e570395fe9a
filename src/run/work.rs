//! What a run is to do.

use std::path::Path;

use crate::case::Case;
use crate::platform::files;
use crate::results::{Catalogue, Failure, Limits, Share, fabric_of, named_fabric, without_fabric};

/// What a run is to do: its cases, and its fabrics by name and hash.
pub struct RunWork {
    pub(super) cases: Vec<Case>,
    pub(super) catalogue: Catalogue,
    /// What could not be read. The observer has it already.
    pub failures: Vec<Failure>,
    pub(super) threads: usize,
    pub(super) limits: Limits,
    pub(super) share: Option<Share>,
}

impl RunWork {
    /// Whether there is neither a fabric nor a case.
    pub fn is_empty(&self) -> bool {
        self.catalogue.len() == 0 && self.cases.is_empty()
    }

    /// Without a fabric, takes out the cases that are for one, each with its failure: a run that can do nothing writes nothing.
    /// A case of which the fabric is not where it says has its failure already.
    pub(super) fn leave_out_idle_cases(&mut self) -> Vec<Failure> {
        if self.catalogue.len() > 0 || self.catalogue.left_out || self.share.is_some() {
            return Vec::new();
        }
        if self.cases.iter().any(|case| case.fabric().is_none()) {
            return Vec::new();
        }
        let mut idle = std::mem::take(&mut self.cases);
        idle.retain(|case| named_fabric(case).is_none_or(|path| files::exists(&path)));
        idle.iter().map(|case| without_fabric(case, false)).collect()
    }

    /// Folders or files of the fabrics, and their names.
    pub(super) fn known(&self) -> Vec<(&Path, &str)> {
        let fabrics = &self.catalogue;
        (0..fabrics.len()).map(|at| (fabrics.path(at), fabrics.name(at))).collect()
    }

    /// What could not be read, with the fabric that each belongs to.
    pub(super) fn failures_of_fabrics(&self) -> Vec<Failure> {
        if self.failures.is_empty() {
            return Vec::new();
        }
        let known = self.known();
        let named = self.failures.iter().map(|failure| {
            let fabric = fabric_of(&known, failure);
            Failure { fabric: fabric.map(Into::into).or(failure.fabric.clone()), ..failure.clone() }
        });
        named.collect()
    }

    /// Tasks share the threads; one that is alone has them all.
    pub(super) fn threads_of_task(&self) -> usize {
        if self.cases.len() == 1 && self.catalogue.len() < 2 { self.threads } else { 1 }
    }
}
