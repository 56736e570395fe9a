//! What several facts have as fields.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::kes::{Direction, Parameter, RecordName};

/// What was evaluated: a record, or a strip of a FAB file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Subject {
    /// The record of one specimen.
    Record(RecordName),
    /// A strip of a FAB file.
    Strip {
        /// Its key in the file, such as `S1`.
        strip: String,
        /// Direction of the strip.
        direction: Direction,
    },
}

impl Subject {
    /// What people call it.
    pub(super) fn noun(&self) -> &'static str {
        match self {
            Self::Record(_) => "specimen",
            Self::Strip { .. } => "strip",
        }
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Record(record) => record.fmt(f),
            Self::Strip { strip, direction } => write!(f, "strip {strip} {direction}"),
        }
    }
}

/// A statement of a file that another one contradicts.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Contradiction {
    /// What is stated: `width`, `unit of "M"`.
    pub what: String,
    /// What the file says.
    pub file: String,
    /// What is said elsewhere.
    pub elsewhere: String,
}

/// An axis of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RecordAxis {
    /// Strain, angle, curvature or thickness.
    Abscissa,
    /// Force, moment or pressure.
    Ordinate,
}

/// Samples of a record. Their text is `line 57`, or `lines 57, 91, 92 ...`, or the same of samples.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Samples {
    /// Their lines in the file, or their numbers (from 1) where lines are not known.
    pub numbers: Vec<usize>,
    /// Whether the numbers are those of lines.
    pub lines: bool,
}

/// Samples that a message names one by one.
const NAMED_SAMPLES: usize = 3;

impl fmt::Display for Samples {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list: Vec<String> = self.numbers.iter().take(NAMED_SAMPLES).map(usize::to_string).collect();
        let noun = if self.lines { "line" } else { "sample" };
        let plural = if self.numbers.len() > 1 { "s" } else { "" };
        let more = if self.numbers.len() > NAMED_SAMPLES { " ..." } else { "" };
        write!(f, "{noun}{plural} {}{more}", list.join(", "))
    }
}

/// The strip from which moduli of a direction were taken.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StripLength {
    /// Direction of the strip.
    pub direction: Direction,
    /// Its length at the onset of load (m).
    pub length: f64,
    /// The cycle, from 1.
    pub cycle: usize,
}

/// A value that a law does not give back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Missed {
    /// Which parameter.
    pub parameter: Parameter,
    /// The value of the law over that of the sheet, minus 1.
    pub relative_error: f64,
}

/// A line of a table that was left out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LeftOutLine {
    /// The line, from 1.
    pub line: usize,
    /// Its text that says why, such as `mean`.
    pub word: String,
}

/// How a linear result is beyond its meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Excess {
    /// Normal to the sheet, to be compared with its bending thickness.
    Deflection,
    /// In any direction, to be compared with its size.
    Displacement,
}

/// A result that the mesh leaves open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CoarseQuantity {
    /// Its name.
    pub quantity: String,
    /// What is left of it, as a part of its value.
    pub left: f64,
}

/// Why a mesh is not refined any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RefinementEnd {
    /// As many meshes as the case allows.
    Meshes,
    /// The next mesh would have more elements than the case allows.
    Elements,
    /// On the next mesh the search came to no equilibrium.
    Search,
}

/// Why something has another name than it was given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Renaming {
    /// No file can have the name of the case.
    CaseFile,
    /// A case: a file of every fabric has that name.
    CaseReserved,
    /// A case: another one has that name.
    CaseTwice,
    /// A fabric: no folder can have that name.
    FabricFolder,
    /// A fabric: another one has that name.
    FabricTwice,
}
