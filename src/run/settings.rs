//! What is made of the results of a run.

use serde::Serialize;

use crate::case::Case;
use crate::report::chart::Format;
use crate::report::population::Population;
use crate::results::Observer;

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

/// Fabrics up to which drapes are hung where nobody says anything: each takes some seconds.
const WITH_DRAPES: usize = 20;

/// Which drape cases are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Drapes {
    /// In runs of up to 20 fabrics, of the fabrics with measured curves: on coarse cells, without friction and bands.
    #[default]
    Auto,
    /// All, as their cases say: a minute or so for each fabric.
    Always,
    /// None.
    Never,
}

impl From<Option<bool>> for Drapes {
    /// All, none, or as the program decides.
    fn from(answer: Option<bool>) -> Self {
        answer.map_or(Self::Auto, Self::asked)
    }
}

impl From<Option<bool>> for FieldFiles {
    /// Always, never, or as the program decides.
    fn from(answer: Option<bool>) -> Self {
        answer.map_or(Self::Auto, |always| if always { Self::Always } else { Self::Never })
    }
}

impl Drapes {
    /// All or none.
    pub fn asked(all: bool) -> Self {
        if all { Self::Always } else { Self::Never }
    }

    /// The cases of a run of so many fabrics; none are known of a share of a batch. What is left out is told.
    pub(super) fn choose(self, cases: Vec<Case>, fabrics: Option<usize>, observer: &Observer) -> Vec<Case> {
        let few = fabrics.is_some_and(|count| count <= WITH_DRAPES);
        let mut chosen = Vec::with_capacity(cases.len());
        for mut case in cases {
            let is_in = match self {
                _ if !case.is_drape() => true,
                Self::Always => true,
                Self::Auto => few && case.make_quick(),
                Self::Never => false,
            };
            if is_in {
                chosen.push(case);
            } else if self == Self::Auto {
                let why = if few { "with friction or [uncertainty] a drape" } else { "a drape" };
                observer
                    .note(&format!("{}: left out, {why} takes minutes; add --drape", case.path.display()));
            }
        }
        chosen
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
    /// Which drape cases are solved.
    pub drapes: Drapes,
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
            drapes: Drapes::Auto,
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
