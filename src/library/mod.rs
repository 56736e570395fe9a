//! A library of fabrics that answers: which of them are like this one, and which are within these bounds.
//!
//! A library is one Parquet file, a row a fabric: a column for each parameter in a direction in its customary KES unit
//! (`B_warp`, `T0`, `E_secant_weft`), with the unit in the metadata of the field, and `thickness` (mm) and `mass`
//! (mg/cm²) beside `T0` and `W`; beside each of them, in `B_warp_status`, is how the value was had: measured, inferred,
//! assumed or doubtful. It is asked without being held in memory: only the columns that a question names are
//! read, piece by piece.
//!
//! Likeness is the distance in the space of the sixteen KES parameters: each the mean of warp and weft, or the one
//! direction that both fabrics have if one of them lacks the other, log10 for those that Kawabata takes logarithms of, in
//! standard deviations of the library; the distance is the root mean square over the parameters in which the two can be
//! compared. An answer says in which they were not, and which of the values are doubtful.

mod bounds;
mod build;
mod census;
mod error;
mod file;
mod find;
mod grammar;
mod space;
mod text;

pub use bounds::Bounds;
pub use build::{Shelf, Stored};
pub use census::NoSuchText;
pub use error::LibraryError;
pub use file::LibraryFile;
pub use find::{Answer, Like, Question};
pub use space::{Axis, FEWEST};
