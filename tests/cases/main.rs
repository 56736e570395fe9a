//! Cases, from their text to their results.

mod bending;
#[path = "../common/mod.rs"]
mod common;
#[cfg(feature = "outlines")]
mod drawings;
mod held;
mod large_cases;
mod points;
mod shipped;
mod step_kinds;
mod verify;
mod virtual_large;
mod virtual_loops;
