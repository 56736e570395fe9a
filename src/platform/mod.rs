//! What depends on the machine below the program: threads, the clock, and files that are read.
//!
//! Nothing else in the computing layers names them, so that the library builds for targets that have
//! none: without the feature `threads` everything here runs on the calling thread, and on
//! WebAssembly without a system a [`Stopwatch`] measures nothing and [`files`] are in memory.

mod clock;
mod deadline;
pub mod files;
mod guard;
mod parallel;

pub use clock::Stopwatch;
pub use deadline::{over, within};
pub(crate) use guard::guarded;
pub use guard::is_guarded;
pub use parallel::{Items, in_pool, map, map_several, run_all, try_map};
