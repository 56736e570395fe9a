//! How a caller follows long work and ends it.

use super::failure::Failure;
use crate::finding::Finding;
use crate::study::Watch;

/// What happens while work goes on.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// A part of the work begins: what it does, and how many steps it has.
    Started(&'static str, usize),
    /// A step of the part is done.
    Step,
    /// The part is done.
    Finished,
    /// An input or a task gives no result. The others go on.
    Failed(&'a Failure),
    /// Something that a reader of the results must know.
    Found(Found<'a>),
    /// A remark that is neither.
    Note(&'a str),
}

/// A finding with what it belongs to.
#[derive(Clone, Copy, Debug)]
pub struct Found<'a> {
    /// The finding.
    pub finding: &'a Finding,
    /// The fabric that it is about, where its place does not say so.
    pub fabric: Option<&'a str>,
    /// Whether it is one of a batch, which a caller shows on request and only counts otherwise.
    pub of_batch: bool,
}

/// Who follows the work. Both functions are called from the threads that work.
#[derive(Clone, Copy)]
pub struct Observer<'a> {
    /// Called with every event.
    pub event: &'a (dyn Fn(Event<'_>) + Sync),
    /// Whether the work is to end at its next step.
    pub cancelled: &'a (dyn Fn() -> bool + Sync),
}

impl Default for Observer<'_> {
    /// Nobody follows, and the work is never cancelled.
    fn default() -> Self {
        Self { event: &|_| (), cancelled: &|| false }
    }
}

impl Observer<'_> {
    /// A failure.
    pub(crate) fn failed(&self, failure: &Failure) {
        (self.event)(Event::Failed(failure));
    }

    /// A finding.
    pub(crate) fn found(&self, fabric: Option<&str>, finding: &Finding) {
        (self.event)(Event::Found(Found { finding, fabric, of_batch: false }));
    }

    /// A finding that is one of a batch.
    pub(crate) fn found_in_batch(&self, finding: &Finding) {
        (self.event)(Event::Found(Found { finding, fabric: None, of_batch: true }));
    }

    /// A remark.
    pub(crate) fn note(&self, text: &str) {
        (self.event)(Event::Note(text));
    }

    /// One step.
    pub(crate) fn step(&self) {
        (self.event)(Event::Step);
    }

    /// Does a part of the work between its two events.
    ///
    /// # Errors
    /// O054 if the work was cancelled meanwhile.
    pub(crate) fn part<T>(
        &self,
        what: &'static str,
        steps: usize,
        work: impl FnOnce() -> T,
    ) -> Result<T, Failure> {
        (self.event)(Event::Started(what, steps));
        let result = work();
        (self.event)(Event::Finished);
        self.go_on()?;
        Ok(result)
    }

    /// O054 if the work was cancelled.
    pub(crate) fn go_on(&self) -> Result<(), Failure> {
        if (self.cancelled)() { Err(Failure::interrupted()) } else { Ok(()) }
    }

    /// The same for one study; `stage` is called after each of its stages.
    pub(super) fn watch<'w>(&'w self, stage: &'w (dyn Fn() + Sync)) -> Watch<'w> {
        Watch { stage, stopped: self.cancelled }
    }
}
