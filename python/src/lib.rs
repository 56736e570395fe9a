//! The native half of the Python package `kesf`: the library's objects and functions, with plain data at the border.
//!
//! Python code in `python/kesf` makes of them what its users see. What crosses is text (JSON documents of the
//! library), bytes (arrays) and Arrow tables; nothing is computed here.
//!
//! | file | what crosses |
//! |---|---|
//! | `error.rs` | failures of the library, as `KesfError` |
//! | `work.rs` | long work: threads, signals, progress |
//! | `messages.rs` | findings and failures as JSON |
//! | `table.rs` | tables, as Arrow streams |
//! | `fabric.rs` | measurements |
//! | `sheet.rs` | parameters of fabrics |
//! | `section.rs` | shell sections and material cards |
//! | `simulate.rs` | cases and their outcomes |
//! | `run.rs` | a folder of results; the verification suite |
//! | `parts.rs` | parts of a batch, their merge, libraries |
// Not `forbid`: what PyO3 generates allows it again.
#![deny(unsafe_code)]

mod error;
mod fabric;
mod messages;
mod parts;
mod run;
mod section;
mod sheet;
mod simulate;
mod table;
mod work;

use kesf::instrument::Parameter;
use kesf::report::table::UnitSystem;
use pyo3::prelude::*;

/// The native half of kesf; use the package `kesf`.
#[pymodule]
mod _kesf {
    #[pymodule_export]
    use crate::fabric::{Fabric, find, read};
    #[pymodule_export]
    use crate::parts::{
        complete, evaluate, key_in, key_of, library_build, library_find, make_part, merge, merge_file,
        part_files, shard_of,
    };
    #[pymodule_export]
    use crate::run::{run, verify};
    #[pymodule_export]
    use crate::section::{Section, export, targets};
    #[pymodule_export]
    use crate::sheet::{Sheet, characterise};
    #[pymodule_export]
    use crate::simulate::{case_text, simulate};
    #[pymodule_export]
    use crate::table::Table;
    #[pymodule_export]
    use crate::{explain, units_of_parameters, version};
}

/// Version of the library.
#[pyfunction]
fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

/// Symbol, customary unit and its SI value of every parameter, and of tensile moduli as `E`.
#[pyfunction]
fn units_of_parameters() -> Vec<(&'static str, &'static str, f64)> {
    let (unit, factor) = UnitSystem::Kes.of_modulus();
    let parameters = Parameter::ALL.iter().map(|p| (p.symbol(), p.kes_unit(), p.kes_factor()));
    parameters.chain([("E", unit, factor)]).collect()
}

/// The explanation of a code as JSON (`code`, `kind`, `title`, `cause`, `example`, `cure`), or None.
#[pyfunction]
fn explain(code: &str) -> PyResult<Option<String>> {
    kesf::finding::explain(code).map(messages::json).transpose()
}
