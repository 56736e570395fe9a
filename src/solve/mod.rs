//! Solving: block matrices and their factorisation, and the analyses on top.

pub mod assemble;
pub mod factor;
pub mod linear;
pub mod ordering;
pub mod sparse;

pub use linear::{Options, Plan, Solution, SolveError, Timings, solve, solve_with};
