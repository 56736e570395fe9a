//! Everything that people see as files.

mod number;

#[cfg(feature = "charts")]
pub mod chart;
