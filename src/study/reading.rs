//! What is read of a solution.

/// A result of one solution.
pub(super) struct Reading {
    pub quantity: String,
    pub unit: &'static str,
    pub value: f64,
}

impl Reading {
    pub(super) fn new(quantity: impl Into<String>, value: f64, unit: &'static str) -> Self {
        Self { quantity: quantity.into(), unit, value }
    }
}
