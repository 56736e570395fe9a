//! Ctrl-C: the first ends the work at the next item, the second at once.

use std::io::Write as _;
use std::sync::atomic::{AtomicBool, Ordering};

use super::exit::Exit;
use crate::results::Failure;

/// Set by Ctrl-C, read between items of work.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Whether Ctrl-C was pressed.
pub fn is_set() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// Catches Ctrl-C from now on; says so on standard error unless `silent`.
pub fn catch(silent: bool) -> Result<(), Failure> {
    ctrlc::set_handler(move || {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            std::process::exit(Exit::Interrupted as i32);
        }
        if !silent {
            let text = "interrupted: the work in hand ends; Ctrl-C again stops at once";
            let _ = writeln!(std::io::stderr(), "{text}");
        }
    })
    .map_err(|e| Failure::new("O053", format!("Ctrl-C cannot be caught: {e}")))
}
