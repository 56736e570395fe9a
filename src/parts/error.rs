//! What is wrong with a folder of parts.

use std::path::PathBuf;

use crate::finding::{Place, errors, path_as_text};

errors! {
    /// Why parts are not merged, or a part is not made.
    #[derive(Clone, Debug, PartialEq)]
    pub enum PartError {
        /// O065: there is none.
        "O065" None {
            /// The folder.
            #[serde(serialize_with = "path_as_text")]
            folder: PathBuf,
        } at Place::file(folder), = "there is no part"
            => "name a folder of results, or the one that was given to `kesf run --shard K/N -o`";
        /// O065: some are missing.
        "O065" Missing {
            /// The folder.
            #[serde(serialize_with = "path_as_text")]
            folder: PathBuf,
            /// How many there should be.
            count: usize,
            /// Numbers of those that are not there.
            missing: Vec<usize>,
        } at Place::file(folder), = "{} of {count} parts are missing, number {} first", missing.len(), missing[0]
            => "run again: finished parts are kept";
        /// O066: of runs with different numbers of shards.
        "O066" Counts {
            /// The folder.
            #[serde(serialize_with = "path_as_text")]
            folder: PathBuf,
            /// The numbers.
            counts: Vec<usize>,
        } at Place::file(folder), = "there are parts of runs with {} shards", as_list(counts)
            => "remove those of one run, or write each run to a folder of its own";
        /// O066: of a run with other inputs, cases or settings.
        "O066" SetUp {
            /// The part.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
            /// One that it does not belong to.
            other: String,
        } at Place::file(path), = "the part is of other inputs, cases or settings, or of another version, than {other}"
            => "make all parts by the same command: those that are of it are kept";
        /// O067: not as this program writes it.
        "O067" Part {
            /// The file.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
            /// What is wrong.
            problem: String,
        } at Place::file(path), = "the part cannot be read: {problem}"
            => "remove it and run again: the other parts are kept";
        /// O068: of one name.
        "O068" Twice {
            /// The second part.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
            /// Name of the fabric.
            fabric: String,
            /// What its findings name of it first.
            here: Option<String>,
            /// The first part.
            other: String,
            /// What the findings there name of it first.
            there: Option<String>,
        } at Place::file(path), = "{fabric} is in {other} too{}", of_both(here.as_deref(), there.as_deref())
            => "give the fabrics folders or sample names of their own, or make one shard of them";
    }
}

/// Where a fabric is in two parts, as far as their findings say it.
fn of_both(here: Option<&str>, there: Option<&str>) -> String {
    match (here, there) {
        (None, None) => String::new(),
        (Some(here), None) => format!(": here of {here}"),
        (None, Some(there)) => format!(": there of {there}"),
        (Some(here), Some(there)) => format!(": here of {here}, there of {there}"),
    }
}

fn as_list(counts: &[usize]) -> String {
    counts.iter().map(ToString::to_string).collect::<Vec<_>>().join(" and ")
}
