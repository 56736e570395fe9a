//! What a run is to do.

use crate::case::Case;
use crate::results::{Catalogue, Failure, Limits, Share};

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

    /// Tasks share the threads; one that is alone has them all.
    pub(super) fn threads_of_task(&self) -> usize {
        if self.cases.len() == 1 && self.catalogue.len() < 2 { self.threads } else { 1 }
    }
}
