//! Readers of other people that may panic on damaged files.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// What work gives, or `None` if it panics: a damaged file is to cost that file only. Work that has panicked is not
/// gone on with, so nothing half done is seen. Where panics end the program (a page in a browser), it does nothing.
pub(crate) fn guarded<T>(work: impl FnOnce() -> T) -> Option<T> {
    let before = GUARDED.replace(true);
    let done = catch_unwind(AssertUnwindSafe(work));
    GUARDED.set(before);
    done.ok()
}

/// Whether a panic on this thread is caught, and told as an error of the file that is being read.
pub fn is_guarded() -> bool {
    GUARDED.get()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_costs_its_work_only() {
        assert_eq!(guarded(|| 2), Some(2));
        let cells: Vec<u8> = Vec::new();
        assert_eq!(guarded(|| cells[cells.len()]), None);
        assert_eq!(guarded(is_guarded), Some(true));
        assert!(!is_guarded());
    }
}
