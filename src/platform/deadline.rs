//! How long a piece of work may take.
//!
//! A limit goes with the work and not through the arguments of everything that does it: what [`within`] encloses asks
//! [`over`] between its steps, on the threads that [`map`](super::map) and its kin share the work over as well. No number
//! depends on a limit: work ends with an error, or is as it would be without one.

use std::cell::Cell;

use super::Stopwatch;

/// When work began, and how long it may take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Deadline {
    watch: Stopwatch,
    seconds: f64,
}

thread_local! {
    /// That of the work that this thread is doing.
    static CURRENT: Cell<Option<Deadline>> = const { Cell::new(None) };
}

/// Puts the deadline of the enclosing work back.
struct Restore(Option<Deadline>);

impl Drop for Restore {
    fn drop(&mut self) {
        CURRENT.set(self.0);
    }
}

/// Does work that may take so long (s); of limits within limits the nearest holds.
pub fn within<T>(seconds: f64, work: impl FnOnce() -> T) -> T {
    let nearer = current().filter(|outer| outer.seconds - outer.watch.seconds() <= seconds);
    under(Some(nearer.unwrap_or_else(|| Deadline { watch: Stopwatch::start(), seconds })), work)
}

/// The limit (s), if the work has taken longer.
pub fn over() -> Option<f64> {
    current().filter(|deadline| deadline.watch.seconds() > deadline.seconds).map(|deadline| deadline.seconds)
}

/// The deadline of the work that this thread is doing.
pub(super) fn current() -> Option<Deadline> {
    CURRENT.get()
}

/// Does work under a deadline, on whatever thread.
pub(super) fn under<T>(deadline: Option<Deadline>, work: impl FnOnce() -> T) -> T {
    let _restore = Restore(CURRENT.replace(deadline));
    work()
}

#[cfg(test)]
mod tests {
    use super::super::{map, run_all};
    use super::*;

    #[test]
    fn the_nearest_limit_holds_and_ends_with_its_work() {
        assert_eq!(over(), None);
        within(-1.0, || {
            assert_eq!(over(), Some(-1.0));
            within(60.0, || assert_eq!(over(), Some(-1.0), "a longer one does not lengthen it"));
        });
        within(60.0, || {
            assert_eq!(over(), None);
            within(-2.0, || assert_eq!(over(), Some(-2.0)));
            assert_eq!(over(), None);
        });
        assert_eq!(over(), None);
    }

    #[test]
    fn a_limit_goes_with_the_work_to_other_threads() {
        let of_items = within(-1.0, || map(0..100usize, |_| over()));
        assert!(of_items.iter().all(|limit| *limit == Some(-1.0)));
        assert!(map(0..100usize, |_| over()).iter().all(Option::is_none));
        within(-1.0, || run_all(2, 0..10, &|_| assert_eq!(over(), Some(-1.0))));
    }
}
