//! What is made of the results of a run.

use crate::report::chart::Format;
use crate::report::population::Population;

/// Fabrics up to which fields are written where nobody says anything: they are nine tenths of a large folder.
const WITH_FIELDS: usize = 100;

/// When the fields of sheets are written for ParaView (`<case>.vtu`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FieldFiles {
    /// In runs of up to 100 fabrics.
    #[default]
    Auto,
    /// Of every fabric.
    Always,
    /// Of none.
    Never,
}

impl FieldFiles {
    /// Whether they are written in a run of so many fabrics.
    pub(super) fn are_written(self, fabrics: usize) -> bool {
        match self {
            Self::Auto => fabrics <= WITH_FIELDS,
            Self::Always => true,
            Self::Never => false,
        }
    }
}

/// What is made of the results.
#[derive(Clone, Debug)]
pub struct RunSettings {
    /// Whether charts are drawn.
    pub charts: bool,
    /// What kinds of files charts become.
    pub formats: Vec<Format>,
    /// What the page compares fabrics with; none for themselves.
    pub population: Option<Population>,
    /// When fields are written.
    pub fields: FieldFiles,
    /// Whether drape cases are solved too: a minute or so for each fabric.
    pub drape: bool,
    /// Whether every fabric is computed, also those that an earlier run has computed of the same inputs.
    pub fresh: bool,
    /// What else than the version tells this program from another that computes otherwise.
    pub program: Option<String>,
    /// Date and time for `run.json`; without it the same input gives the same bytes.
    pub stamp: Option<String>,
    /// Whether CSV tables begin with the mark (BOM) by which Excel knows UTF-8.
    pub bom: bool,
    /// Whether all tables are written as a workbook too (`results.xlsx`); their rows are then all in memory.
    #[cfg(feature = "workbook")]
    pub workbook: bool,
    /// Whether the caller takes a finding for a failure; noted in `run.json`.
    pub strict: bool,
}

impl Default for RunSettings {
    fn default() -> Self {
        Self {
            charts: true,
            formats: vec![Format::Png],
            population: None,
            fields: FieldFiles::Auto,
            drape: false,
            fresh: false,
            program: None,
            stamp: None,
            bom: false,
            #[cfg(feature = "workbook")]
            workbook: false,
            strict: false,
        }
    }
}
