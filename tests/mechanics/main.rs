//! Shells, solvers and laws: models made in Rust against closed forms, books and other programs' numbers.

mod adaptive;
mod contact;
mod corotational;
mod dynamics;
mod friction;
mod impact;
mod iterative;
mod large_dynamics;
mod large_rigid_dynamics;
mod layers;
mod load_steps;
mod modal;
mod nonlinear;
mod nonlinear_shells;
mod oblique;
mod plates;
mod properties;
mod recovery;
mod rigid;
mod solver;
mod triangles;
