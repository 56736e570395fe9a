//! What a reader may be told, and what it makes of a file.

use super::conditions::StatedConditions;
use super::dialect::Dialect;
use super::error::ReadError;
use super::fab::FabFile;
use super::result_table::Values;
use super::{Measurement, Source, StatedStiffness};
use crate::finding::Finding;

/// What a reader may be told beforehand. The default infers everything and assumes no unit.
#[derive(Clone, Debug, Default)]
pub struct ReadSettings {
    /// Dialects of the user, tried first.
    pub dialects: Vec<Dialect>,
    /// Cell delimiter, instead of the inferred one.
    pub delimiter: Option<char>,
    /// Decimal mark, instead of the inferred one.
    pub decimal: Option<char>,
    /// Takes numbers without a unit as being in the customary KES unit, instead of refusing them.
    pub kes_units: bool,
    /// Conditions that files leave out.
    pub conditions: StatedConditions,
}

/// What one file holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FileContent {
    /// Curves, in file order.
    pub measurements: Vec<Measurement>,
    /// Values of result tables, each with the fabric that the table names.
    pub results: Values,
    /// Tensile stiffnesses of result tables, each with the fabric that the table names.
    pub stiffnesses: Vec<(Option<String>, StatedStiffness)>,
    /// Whether the curves stand below one another in rows that name their fabrics: [`Measurement::sample`] is one then.
    pub rows_name_fabrics: bool,
    /// A FAB record.
    pub fab: Option<FabFile>,
    /// What a reader of the data must know.
    pub findings: Vec<Finding>,
    /// Fabrics of a result table that cannot be read, an error each; the others are there.
    pub failures: Vec<ReadError>,
    /// The file.
    pub source: Source,
    /// What was inferred and why, for people (`kesf check -v`).
    pub inference: Vec<String>,
}
