//! The targets: each with its valid files, and what has to hold of a damaged one.

mod documents;
mod drawn;
mod exports;
mod tables;
mod toml_files;

use crate::Target;

pub use documents::{cards, documents};
pub use drawn::{drawing, gmsh, picture};
pub use exports::{archive, fab, ods, text, xls, xlsx};
pub use tables::{bounds, library, parts};
pub use toml_files::{case, dialect, fabric, settings};

/// Makes a target.
type Make = fn() -> Target;

/// Every target by its name.
pub const TARGETS: [(&str, Make); 18] = [
    ("archive", archive),
    ("bounds", bounds),
    ("cards", cards),
    ("case", case),
    ("dialect", dialect),
    ("documents", documents),
    ("drawing", drawing),
    ("fab", fab),
    ("fabric", fabric),
    ("gmsh", gmsh),
    ("library", library),
    ("ods", ods),
    ("parts", parts),
    ("picture", picture),
    ("settings", settings),
    ("text", text),
    ("xls", xls),
    ("xlsx", xlsx),
];
