//! (skeleton)

pub mod factor;
mod multifrontal;
pub mod ordering;
pub mod sparse;
