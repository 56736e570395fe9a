#![doc = include_str!("../README.md")]
//!
//! # Layers
//!
//! The order of `pub mod` in this file is the layering: a module may use the ones above it only
//! (`tests/architecture/rules.rs` holds the exact table). Two arms meet in one type:
//! [`instrument`] and [`characterise`] know cloth, [`mesh`] to [`fields`] know shells,
//! and [`constitutive`] turns a [`characterise::FabricSheet`] into a [`section::ShellSection`].
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod platform;

pub mod quantity;

pub mod kes;

pub mod finding;

pub mod law;

pub mod instrument;

pub mod characterise;

pub mod section;

pub mod analytical;

pub mod mesh;

pub mod element;

pub mod model;

pub mod solve;

pub mod fields;

pub mod constitutive;

pub mod case;

pub mod study;

pub mod verify;

pub mod report;

pub mod schema;

#[cfg(feature = "results")]
pub mod results;

#[cfg(feature = "results")]
pub mod run;

#[cfg(feature = "parquet")]
pub mod parts;

#[cfg(feature = "parquet")]
pub mod library;

#[cfg(feature = "results")]
pub mod documents;

#[cfg(feature = "cli")]
pub mod cli;

#[cfg(feature = "results")]
pub use run::{FieldFiles, RunReport, RunSettings, run};

#[cfg(test)]
#[path = "../tests/common/mod.rs"]
mod common;
