//! Elapsed time.

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
use std::time::Instant;

/// A target without a clock: the standard library's `Instant::now` panics there.
#[cfg(all(target_family = "wasm", target_os = "unknown"))]
#[derive(Clone, Copy, Debug)]
struct Instant;

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
impl Instant {
    fn now() -> Self {
        Self
    }

    fn elapsed(self) -> std::time::Duration {
        std::time::Duration::ZERO
    }
}

/// Measures how long something takes.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    start: Instant,
}

impl Stopwatch {
    /// Starts now.
    pub fn start() -> Self {
        Self { start: Instant::now() }
    }

    /// Seconds since the start; 0 where the target has no clock.
    pub fn seconds(self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }
}
