//! Mean and standard deviation of values that come one by one.

/// Mean and sum of squares of deviations, updated value by value (Welford, *Technometrics* 4 (1962) 419).
#[derive(Clone, Copy, Debug, Default)]
pub struct Moments {
    /// Number of values.
    pub n: u64,
    /// Their mean; 0 of none.
    pub mean: f64,
    squares: f64,
}

impl Moments {
    /// Counts a value.
    pub fn add(&mut self, value: f64) {
        self.n += 1;
        let before = value - self.mean;
        self.mean += before / self.n as f64;
        self.squares += before * (value - self.mean);
    }

    /// Sample standard deviation (divisor n - 1); nothing of fewer than two values.
    pub fn sd(&self) -> Option<f64> {
        (self.n > 1).then(|| (self.squares / (self.n - 1) as f64).sqrt())
    }
}
