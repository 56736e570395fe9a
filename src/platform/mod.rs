//! What depends on the machine below the program: threads and the clock.
//!
//! Nothing else in the computing layers names them, so that the library builds for targets that have
//! neither: without the feature `threads` everything here runs on the calling thread, and on
//! WebAssembly without a system a [`Stopwatch`] measures nothing.

mod clock;
mod deadline;
mod parallel;

pub use clock::Stopwatch;
pub use deadline::{over, within};
pub use parallel::{Items, map, map_several, run_all, try_map};
