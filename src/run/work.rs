//! What a run is to do.

use crate::case::Case;
use crate::platform::files;
use crate::results::{Catalogue, Failure, Limits, Share, named_fabric, without_fabric};

/// What a run is to do: its cases, and its fabrics by name and hash.
pub struct RunWork {
    pub(super) cases: Vec<Case>,
    pub(super) catalogue: Catalogue,
    /// What could not be read, with the fabrics that it is of, and what is wrong with cases. The observer has it already.
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

    /// What could not be read, with the fabric that each is of.
    pub(super) fn unread(&self) -> impl Iterator<Item = (&str, &Failure)> {
        self.failures.iter().filter_map(|failure| Some((failure.fabric.as_deref()?, failure)))
    }

    /// Tasks share the threads; one that is alone has them all.
    pub(super) fn threads_of_task(&self) -> usize {
        if self.cases.len() == 1 && self.catalogue.len() < 2 { self.threads } else { 1 }
    }
}
