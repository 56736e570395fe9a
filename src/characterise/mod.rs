//! Measurements in, KES parameters with statistics out.

mod sheet;

pub use sheet::{Branch, FabricSheet, Key, SpecimenResult, Window};
