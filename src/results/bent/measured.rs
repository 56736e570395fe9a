//! What a strip is compared with.

use crate::results::task::Task;
use crate::study::bending::{BendLoop, Cantilever, measured_bending_length};

/// Whether a loop was fitted or predicted.
pub(super) fn role(l: &BendLoop) -> &'static str {
    if l.fitted { "fitted" } else { "predicted" }
}

/// The measured bending length (m) in the direction of a cantilever.
pub(super) fn measured(task: &Task, c: &Cantilever) -> Option<f64> {
    measured_bending_length(task.fabric?, c.direction)
}
