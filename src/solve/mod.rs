//! (skeleton)

pub mod factor;
pub mod ordering;
pub mod sparse;
