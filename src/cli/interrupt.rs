//! Ctrl-C and SIGTERM: the work in hand has a moment to end, then the program ends without it.
//!
//! Nothing is lost by that: files are whole or not there, a run that was ended knows by its journal what it wrote, and the
//! next one goes on from there.

use std::io::Write as _;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use super::exit::Exit;
use crate::report::write::told_of_interruption;
use crate::results::Failure;

/// Set by the signal, read between items of work.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// What the work in hand has to end by itself; the system then needs its own time to take the memory back.
const MOMENT: Duration = Duration::from_millis(25);

/// Whether the user wants the work to end.
pub fn is_set() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// Catches Ctrl-C and SIGTERM from now on; says so on standard error unless `silent`.
pub fn catch(silent: bool) -> Result<(), Failure> {
    ctrlc::set_handler(move || {
        if !INTERRUPTED.swap(true, Ordering::Relaxed) {
            if !silent {
                let _ = writeln!(std::io::stderr(), "{}", told_of_interruption());
            }
            // A step of a solver may take minutes, and the user has waited already.
            std::thread::sleep(MOMENT);
        }
        std::process::exit(Exit::Interrupted as i32);
    })
    .map_err(|e| Failure::new("O053", format!("Ctrl-C cannot be caught: {e}")))
}
