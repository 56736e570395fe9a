//! Long work, watched from outside.

/// Told of every stage that is done, and asked before every step whether to go on.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    /// Called after each stage.
    pub stage: &'a (dyn Fn() + Sync),
    /// Whether the work is to stop: it then ends at the next step, with [`StudyError::Stopped`](super::StudyError).
    pub stopped: &'a (dyn Fn() -> bool + Sync),
}

impl Default for Watch<'_> {
    /// Nobody watches.
    fn default() -> Self {
        Self { stage: &|| (), stopped: &|| false }
    }
}
