//! Inputs that were read and checked, and nothing more.

use std::borrow::Cow;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::columns::Columns;
use super::failure::Failure;
use super::inputs::{self, Input, Read, Reading};
use super::observer::Observer;
use super::work::{named_fabric, no_such_fabric};
use crate::finding::{Finding, Place};
use crate::instrument::{FabricInput, Inference, Source};
use crate::platform::files;
use crate::report::number::counted;
use crate::solve::Options;
use crate::study::{Case, StudyError, validate};

/// What is in the inputs.
pub struct Checked {
    /// In name order.
    pub fabrics: Vec<FabricInput>,
    /// In name order.
    pub cases: Vec<Case>,
    /// What cannot be read or makes no problem.
    pub failures: Vec<Failure>,
    inference_of_failures: Vec<Inference>,
}

/// `kesf.check/1`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct CheckDocument {
    #[cfg_attr(test, schemars(extend("const" = "kesf.check/1")))]
    schema: Cow<'static, str>,
    fabrics: Vec<FabricEntry>,
    cases: Vec<CaseEntry>,
    errors: usize,
    inference: Vec<Inference>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct FabricEntry {
    name: String,
    path: String,
    files: Vec<Source>,
    curves: usize,
    values: usize,
    findings: Vec<Finding>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct CaseEntry {
    name: String,
    path: String,
    title: String,
}

/// Reads every fabric and builds every case of the inputs, and computes nothing: a case that would need more `memory`
/// (bytes) fails. What fails and what is found goes to the observer.
///
/// # Errors
/// O055 if there is nothing in the inputs, and those of [`Reading::each`].
pub fn check(
    inputs: &[Input],
    reading: &Reading,
    memory: u64,
    observer: &Observer,
) -> Result<Checked, Failure> {
    let (read, mut failures) = inputs::cases(inputs);
    let options = Options { memory_limit: memory, ..Options::default() };
    let mut cases = Vec::new();
    for case in read {
        match validate(&case, &options) {
            Ok(_) => cases.push(case),
            Err(error) => failures.push(located(&case, error)),
        }
    }
    let without_fabric = |case: &&Case| named_fabric(case).is_some_and(|path| !files::exists(&path));
    failures.extend(cases.iter().filter(without_fabric).map(no_such_fabric));
    failures.iter().for_each(|failure| observer.failed(failure));
    let others = inputs::without_cases(inputs);
    let Read { done: fabrics, failures: unread, inference_of_failures, .. } =
        reading.each(&others, "reading", |fabric| fabric, observer)?;
    failures.extend(unread);
    fabrics.iter().flat_map(|f| &f.findings).for_each(|finding| observer.found(None, finding));
    if fabrics.is_empty() && cases.is_empty() && failures.is_empty() {
        return Err(Failure::new("O055", "there is neither a measurement nor a case in the inputs")
            .hint("name a fabric folder, a measurement file or a case file"));
    }
    Ok(Checked { fabrics, cases, failures, inference_of_failures })
}

fn located(case: &Case, error: StudyError) -> Failure {
    let failure = Failure::from(error);
    if failure.place.is_some() {
        return failure;
    }
    failure.at(Place::file(&case.path))
}

impl Checked {
    fn inference(&self) -> impl Iterator<Item = &Inference> {
        self.fabrics.iter().flat_map(|f| &f.inference).chain(&self.inference_of_failures)
    }

    /// The files behind what was read and what could not be, in name order.
    pub fn files(&self) -> Vec<PathBuf> {
        let unread =
            self.failures.iter().filter(|f| f.code.starts_with('R')).filter_map(|f| f.place.as_ref());
        let paths = self.inference().map(|i| i.path.clone()).chain(unread.map(|place| place.path.clone()));
        paths.filter(|path| files::is_file(path)).collect::<BTreeSet<_>>().into_iter().collect()
    }

    /// The document.
    pub fn document(&self) -> CheckDocument {
        let fabric = |f: &FabricInput| FabricEntry {
            name: f.name.clone(),
            path: f.path.to_string_lossy().into_owned(),
            files: f.sources.clone(),
            curves: f.measurements.len(),
            values: f.results.len(),
            findings: f.findings.clone(),
        };
        let case = |c: &Case| CaseEntry {
            name: c.name.clone(),
            path: c.path.to_string_lossy().into_owned(),
            title: c.title.clone(),
        };
        CheckDocument {
            schema: "kesf.check/1".into(),
            fabrics: self.fabrics.iter().map(fabric).collect(),
            cases: self.cases.iter().map(case).collect(),
            errors: self.failures.len(),
            inference: self.inference().cloned().collect(),
        }
    }

    /// The row of what cannot be read or makes no problem: the fabric or the case, and the code of the error.
    fn failed(&self, failure: &Failure) -> [String; 7] {
        let known: Vec<(&Path, &str)> =
            self.fabrics.iter().map(|f| (f.path.as_path(), f.name.as_str())).collect();
        let stem = || failure.place.as_ref().and_then(|p| p.path.file_stem()).map(|s| s.to_string_lossy());
        let fabric = inputs::fabric_of(&known, failure);
        let kind = if fabric.is_some() { "fabric" } else { "case" };
        let name = fabric.unwrap_or_else(|| stem().map_or("-".into(), |stem| stem.into_owned()));
        let [files, curves, values, findings] = [const { String::new() }; 4];
        [name, kind.into(), files, curves, values, findings, failure.code.to_string()]
    }

    /// One line an input; with `verbose`, before it, how each file was understood.
    pub fn text(&self, verbose: bool) -> String {
        let mut text = String::new();
        if verbose {
            for inference in self.inference() {
                let decisions: Vec<String> = inference.decisions.iter().map(|d| format!("  {d}\n")).collect();
                text += &format!("{}\n{}\n", inference.path.display(), decisions.concat());
            }
        }
        let mut columns = Columns::new(["input", "kind", "files", "curves", "values", "findings", "status"]);
        for f in &self.fabrics {
            let curves = f.measurements.len() + f.fab.iter().map(|fab| fab.tests.len()).sum::<usize>();
            let numbers = [f.sources.len(), curves, f.results.len(), f.findings.len()];
            let name = [f.name.clone(), "fabric".to_string()];
            columns.row(name.into_iter().chain(numbers.map(|n| n.to_string())).chain(["ok".to_string()]));
        }
        for case in &self.cases {
            columns.row([case.name.as_str(), "case", "", "", "", "", "ok"]);
        }
        for failure in &self.failures {
            columns.row(self.failed(failure));
        }
        let [fabrics, cases, errors] = [
            counted(self.fabrics.len(), "fabric"),
            counted(self.cases.len(), "case"),
            counted(self.failures.len(), "error"),
        ];
        text + &format!("{}{fabrics}, {cases}, {errors}\n", columns.text())
    }
}
