//! Laboratory files in, typed measurements in SI out.
//!
//! `raw` keeps every cell with its line and column, `dialect` knows layouts as data, and the
//! instrument modules turn cells into [`Measurement`]s. Nothing here computes a parameter.

mod measurement;
mod parameter;

pub use measurement::{
    Conditions, FabricInfo, FabricInput, MeasuredResult, Measurement, Origin, ResultValue, Source, Test,
};
pub use parameter::{Direction, Parameter};
