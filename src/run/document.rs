//! `run.json`: version, options and the hashes of what was read.

use std::cell::RefCell;

use serde::ser::SerializeSeq;
use serde::{Serialize, Serializer};

use super::settings::{Drapes, RunSettings};
use crate::case::{Case, SolverChoice};
use crate::instrument::Source;
use crate::results::{Failure, FileEntry, Job, ReadingEntry, readable};

/// `kesf.run/1`. The lists of files are written as they come: of a large library they are long.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct RunDocument<'d> {
    #[cfg_attr(test, schemars(extend("const" = "kesf.run/1")))]
    schema: &'static str,
    version: &'static str,
    options: OptionsEntry,
    /// Files of measurements.
    #[cfg_attr(test, schemars(with = "Vec<Source>"))]
    inputs: Streamed<'d, Source>,
    /// Files about fabrics.
    #[cfg_attr(test, schemars(with = "Vec<FileEntry>"))]
    fabrics: Streamed<'d, FileEntry>,
    cases: Vec<CaseEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    date: Option<String>,
    /// Where the data of each fabric come from.
    origins: Vec<OriginEntry>,
}

/// Where the data of a fabric come from.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct OriginEntry {
    pub fabric: String,
    /// `measured`, `published` or `synthetic`; `null` of a fabric that could not be read.
    pub origin: Option<&'static str>,
}

#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct OptionsEntry {
    inputs: Vec<String>,
    charts: bool,
    /// Of charts.
    formats: Vec<&'static str>,
    /// Source of the population that the page compares fabrics with.
    #[serde(skip_serializing_if = "Option::is_none")]
    population: Option<String>,
    /// Whether all drapes were hung as their cases say.
    drape: bool,
    drapes: Drapes,
    strict: bool,
    solver: Option<SolverChoice>,
    evaluation: ReadingEntry,
}

#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct CaseEntry {
    name: String,
    #[serde(flatten)]
    file: FileEntry,
}

/// A list whose entries are made while they are written; once.
struct Streamed<'d, T>(RefCell<Option<Entries<'d, T>>>);

/// The entries of a list, one after the other.
type Entries<'d, T> = Box<dyn Iterator<Item = Result<T, Failure>> + 'd>;

impl<T: Serialize> Serialize for Streamed<'_, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(None)?;
        for entry in self.0.take().into_iter().flatten() {
            list.serialize_element(&entry.map_err(serde::ser::Error::custom)?)?;
        }
        list.end()
    }
}

/// The document of a run.
pub(super) fn document<'d>(
    job: &Job,
    settings: &RunSettings,
    cases: impl Iterator<Item = &'d Case>,
    sources: impl Iterator<Item = Result<Source, Failure>> + 'd,
    stated: impl Iterator<Item = Result<FileEntry, Failure>> + 'd,
    origins: Vec<OriginEntry>,
) -> RunDocument<'d> {
    let case = |c: &Case| CaseEntry { name: c.name.clone(), file: FileEntry::of(&c.path) };
    let inputs = readable(job.inputs.iter().map(|input| input.path()));
    RunDocument {
        schema: "kesf.run/1",
        version: env!("CARGO_PKG_VERSION"),
        options: OptionsEntry {
            inputs: inputs.into_iter().map(|path| path.into_owned()).collect(),
            charts: settings.charts,
            formats: settings.formats.iter().map(|format| format.ending()).collect(),
            population: settings.population.as_ref().map(|population| population.source.clone()),
            drape: settings.drapes == Drapes::Always,
            drapes: settings.drapes,
            strict: settings.strict,
            solver: job.solver,
            evaluation: job.reading.entry(),
        },
        inputs: Streamed(RefCell::new(Some(Box::new(sources)))),
        fabrics: Streamed(RefCell::new(Some(Box::new(stated)))),
        cases: cases.map(case).collect(),
        date: settings.stamp.clone(),
        origins,
    }
}
