//! Solving: block matrices and their factorisation, and the analyses on top.

pub mod assemble;
mod compensated;
mod error;
pub mod factor;
mod group;
pub mod iterative;
pub mod linear;
mod loose;
pub mod modal;
mod multifrontal;
pub mod newmark;
pub mod nonlinear;
pub mod ordering;
pub mod plan;
pub mod sparse;

pub use error::{SolveError, StepLimit};
pub use linear::{
    Factors, MEMORY_LIMIT, Method, Options, Solution, System, Timings, solve, solve_keeping, solve_with,
};
pub use modal::{VibrationMode, modes, modes_with};
pub use plan::Plan;
