//! What there is to do: the cases and fabrics of the inputs, and which case is for which fabric.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::failure::Failure;
use super::inputs::{self, Fabric, Input, Reading};
use super::names::distinguish_cases;
use super::observer::Observer;
use super::section::fabrics_for_cases;
use super::shard::Share;
use super::task::{Limits, Shared, Task};
use crate::case::{Case, FabricMaterial, SolverChoice};
use crate::characterise::FabricSheet;
use crate::finding::{Finding, Place, StudyFact, UsageFact};
use crate::platform::files;

/// Inputs and how they are to be used.
#[derive(Clone, Debug, Default)]
pub struct Job {
    /// Fabrics and cases.
    pub inputs: Vec<Input>,
    /// How measurements are read and evaluated.
    pub reading: Reading,
    /// How linear cases are solved, whatever their `[solver]` says.
    pub solver: Option<SolverChoice>,
    /// Threads for all tasks together; results do not depend on it. 0 is one thread.
    pub threads: usize,
    /// What each task may take.
    pub limits: Limits,
    /// Which part of the batch is to be done; all of it when `None`. For [`run`](fn@crate::run) only.
    pub share: Option<Share>,
}

/// The cases and fabrics that inputs name, and what could not be read.
pub struct Work {
    /// In name order.
    pub cases: Vec<Case>,
    /// In name order; those that only a case names come last.
    pub fabrics: Vec<Fabric>,
    /// What could not be read. The observer has it already.
    pub failures: Vec<Failure>,
    threads: usize,
    limits: Limits,
}

impl Job {
    /// Reads everything that the inputs name, and the fabrics that only cases name.
    ///
    /// # Errors
    /// Those of [`Reading::sheets`]; what is wrong with one input is among the failures.
    pub fn read(&self, observer: &Observer) -> Result<Work, Failure> {
        let JobInputs { cases, fabrics, mut failures } = self.cases(observer);
        let moduli: Vec<_> = cases.iter().filter_map(|c| c.assumptions()).map(|a| a.modulus).collect();
        let assumptions = cases.iter().find_map(Case::assumptions).cloned().unwrap_or_default();
        let (fabrics, unread) =
            fabrics_for_cases(&fabrics, &self.reading, (&moduli, &assumptions), observer)?;
        failures.extend(unread);
        Ok(Work { cases, fabrics, failures, threads: self.threads.max(1), limits: self.limits })
    }

    /// The cases of the inputs, and what fabrics are to be read: those of the inputs, and those that only cases name.
    pub(crate) fn cases(&self, observer: &Observer) -> JobInputs {
        let (mut cases, mut failures) = inputs::cases(&self.inputs);
        for finding in distinguish_cases(&mut cases) {
            observer.found(None, &finding);
        }
        if let Some(solver) = self.solver {
            cases.iter_mut().for_each(|case| case.use_solver(solver));
        }
        failures.iter().for_each(|failure| observer.failed(failure));
        let mut fabrics = inputs::without_cases(&self.inputs);
        for case in &cases {
            match fabric_of_case(case, &fabrics) {
                Ok(Some((named, doubt))) => {
                    doubt.iter().for_each(|finding| observer.found(None, finding));
                    fabrics.extend(named);
                }
                Ok(None) => {}
                Err(failure) => {
                    observer.failed(&failure);
                    failures.push(failure);
                }
            }
        }
        JobInputs { cases, fabrics, failures }
    }
}

/// What a job names, yet without the data of fabrics.
pub(crate) struct JobInputs {
    /// In name order, each with a name of its own.
    pub cases: Vec<Case>,
    /// Fabrics.
    pub fabrics: Vec<Input>,
    /// What is wrong with cases. The observer has it already.
    pub failures: Vec<Failure>,
}

/// The fabric that a case names, unless it is among the inputs already, with what is doubtful about it; `None` for a
/// case that names none.
type Named = Option<(Option<Input>, Option<Finding>)>;

fn fabric_of_case(case: &Case, inputs: &[Input]) -> Result<Named, Failure> {
    let Some(path) = named_fabric(case) else { return Ok(None) };
    if !files::exists(&path) {
        return Err(no_such_fabric(case));
    }
    let doubt = two_fabrics(case, &path);
    let known = inputs.iter().any(|input| is_within(&path, input.path()));
    Ok(Some(((!known).then_some(Input::Path(path)), doubt)))
}

/// The folder that a case names: as it stands, else beside the case file.
pub fn named_fabric(case: &Case) -> Option<PathBuf> {
    let path = PathBuf::from(case.fabric().map(|f| &f.name.value).filter(|f| *f != "*")?);
    let beside = beside_case(case, &path);
    Some(if files::exists(&path) { path } else { beside.unwrap_or(path) })
}

/// A path beside the case file, if it is there.
fn beside_case(case: &Case, path: &Path) -> Option<PathBuf> {
    case.path.parent().map(|p| p.join(path)).filter(|p| files::exists(p))
}

/// O055: a case whose fabric is nowhere.
pub fn no_such_fabric(case: &Case) -> Failure {
    let name = case.fabric().map(|f| f.name.clone()).unwrap_or_default();
    let text = format!("there is no fabric `{}`, neither from here nor beside the case", name.value);
    let place = case.place(&name);
    Failure::new("O055", text)
        .at(place)
        .hint("correct the name in the case, or write fabric = \"*\" and name a fabric beside it")
}

/// O060: a case whose fabric is there twice, and which one was taken.
fn two_fabrics(case: &Case, taken: &Path) -> Option<Finding> {
    let FabricMaterial { name, .. } = case.fabric()?;
    let other = beside_case(case, Path::new(&name.value)).filter(|p| !is_within(p, taken))?;
    let fact = UsageFact::FabricTwice {
        fabric: name.value.clone(),
        taken: std::path::absolute(taken).unwrap_or_else(|_| taken.to_path_buf()).display().to_string(),
        other: std::path::absolute(&other).unwrap_or(other).display().to_string(),
    };
    Some(Finding::new(fact).at(case.place(name)))
}

pub(crate) fn is_within(path: &Path, folder: &Path) -> bool {
    match (files::canonicalize(path), files::canonicalize(folder)) {
        (Ok(path), Ok(folder)) => path.starts_with(folder),
        _ => path == folder,
    }
}

impl Work {
    /// Whether there is neither a fabric nor a case.
    pub fn is_empty(&self) -> bool {
        self.fabrics.is_empty() && self.cases.is_empty()
    }

    /// Every case with every fabric it is for, cases in order; a case that finds none is a failure.
    pub fn tasks<'w>(&'w self) -> (Vec<Task<'w, 'w>>, Vec<Failure>) {
        let (mut tasks, mut failures) = (Vec::new(), Vec::new());
        // Tasks share the threads; one that is alone has them all.
        let alone = self.cases.len() == 1 && self.fabrics.len() < 2;
        let threads = if alone { self.threads } else { 1 };
        for case in &self.cases {
            let shared = Arc::new(Shared::new(threads, self.limits));
            if case.section().is_some() {
                tasks.push(Task::new(case, None, shared));
                continue;
            }
            if named_fabric(case).is_some_and(|path| !files::exists(&path)) {
                continue; // The failure of it is there already.
            }
            let before = tasks.len();
            let suitable = self.fabrics_of(case).filter(|f| case.suits(&f.sheet));
            tasks.extend(suitable.map(|fabric| Task::new(case, Some(fabric), Arc::clone(&shared))));
            if tasks.len() == before {
                failures.push(without_fabric(case, self.without_law(case).is_some()));
            }
        }
        (tasks, failures)
    }

    /// The fabrics that a case is for, whether or not they have what it needs.
    fn fabrics_of(&self, case: &Case) -> impl Iterator<Item = &Fabric> {
        let named = named_fabric(case);
        self.fabrics.iter().filter(move |f| named.as_ref().is_none_or(|n| is_within(&f.path, n)))
    }

    /// S118: the fabrics that a case with friction is for, and that have no law; `None` without such.
    pub fn without_law(&self, case: &Case) -> Option<Finding> {
        let without = self.fabrics_of(case).filter(|f| case.lacks_law(&f.sheet));
        without_law(case, without.map(|f| f.sheet.name.clone()).collect())
    }

    /// What to say of fabrics that no task is for because every case brings or names its own.
    pub(super) fn idle(&self, tasks: &[Task]) -> Option<String> {
        let has_own = |case: &Case| case.section().is_some() || named_fabric(case).is_some();
        if self.cases.is_empty() || !self.cases.iter().all(has_own) {
            return None;
        }
        let is_used = |fabric: &Fabric| tasks.iter().any(|task| task.is_for(fabric));
        let idle: Vec<&str> =
            self.fabrics.iter().filter(|f| !is_used(f)).map(|f| f.sheet.name.as_str()).collect();
        (!idle.is_empty()).then(|| {
            format!("not used, as every case names its own fabric or has a [section]: {}", idle.join(", "))
        })
    }
}

/// O055 of a fabric that has not what the case is about: FAB records, or a law of friction.
pub fn unsuitable(case: &Case, sheet: &FabricSheet) -> Option<Failure> {
    let lacks_law = case.lacks_law(sheet);
    let lacks_records = case.is_for_fab_records() && sheet.bend_tests.is_empty();
    (lacks_law || lacks_records).then(|| without_fabric(case, lacks_law))
}

/// O055: no fabric has what a case needs; `lacks_law` of one for which a law of friction is all that is missing.
pub(crate) fn without_fabric(case: &Case, lacks_law: bool) -> Failure {
    without_fabric_named(&case.name, &case.path, case.is_for_fab_records(), lacks_law)
}

/// The same of a case by its name and file.
pub(crate) fn without_fabric_named(
    name: &str,
    path: &Path,
    is_for_fab_records: bool,
    lacks_law: bool,
) -> Failure {
    let (text, hint) = if is_for_fab_records {
        (
            format!("{name} is for a fabric with FAB bend tests, and none is there"),
            "name a U3M file with `raw_data`, as in `kesf compare cases/fab_bend_loop.toml FABRIC.u3m`",
        )
    } else if lacks_law {
        (
            format!(
                "{name} is for fabrics with a friction law of bending for warp and weft, and none has both"
            ),
            "add FB2 loops of both directions, or 2HB beside B in a result table, or compute without friction (`law = \"elastic\"` in the case)",
        )
    } else {
        (
            format!("{name} is for a fabric, and none is there"),
            "name one behind the case, such as `kesf_data/poplin`",
        )
    };
    Failure::new("O055", text).at(Place::file(path)).hint(hint)
}

/// S118: the fabrics that a case with friction is for, and that have no law; `None` without such.
pub(crate) fn without_law(case: &Case, fabrics: Vec<String>) -> Option<Finding> {
    (!fabrics.is_empty()).then(|| Finding::new(StudyFact::WithoutLaw { fabrics }).at(Place::file(&case.path)))
}

/// What is known of the fabrics of tasks, and of the sections that were made of them, each thing once.
pub(super) fn findings<'a, 'f: 'a, 'c: 'a>(
    tasks: impl Iterator<Item = &'a Task<'f, 'c>>,
) -> Vec<(String, Finding)> {
    let mut seen = BTreeSet::new();
    let mut all = Vec::new();
    for task in tasks {
        let Some(sheet) = task.fabric else { continue };
        let made =
            if task.case.needs_section() { task.section().ok().and_then(|(_, made)| made) } else { None };
        for finding in sheet.findings.iter().chain(made.iter().flat_map(|c| &c.findings)) {
            let mut finding = finding.clone();
            finding.place = finding.place.or_else(|| task.path.map(Place::file));
            if seen.insert((sheet.name.clone(), finding.to_string())) {
                all.push((sheet.name.clone(), finding));
            }
        }
    }
    all
}
