//! Bending tests of other laboratories, as shells in large rotations: cantilever, heart loop,
//! and the bend loop of FAB strips.

mod cantilever;
mod fab;
mod heart;
mod strip;

pub use cantilever::{CHORD_ANGLE_DEG, Cantilever, cantilever};
pub use fab::{Agreement, BendLoop, BendLoops, FabSettings, bend_loops};
pub use heart::{HeartLoop, heart_loop};
