//! Names of fabrics and cases in a folder of results, where none takes the place of another.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::file_name::{file_name, is_device, on_disk};
use super::inputs::Fabric;
use crate::finding::{Finding, Place, Renaming, UsageFact};
use crate::kes::Test;
use crate::study::Case;

/// What two names of fabrics share that are one folder of results somewhere: fabrics for which it is the same are told
/// apart by numbers.
pub(super) fn key_of_name(name: &str) -> String {
    on_disk(&folder_name(name))
}

/// A name that the folder of a fabric can have: nothing of it leads into another, and no file or device is called so.
fn folder_name(name: &str) -> String {
    let bare = file_name(name);
    if bare.is_empty() {
        return "fabric".into();
    }
    let lower = bare.to_lowercase();
    let page = lower.starts_with("fabrics-") && lower.ends_with(".html");
    let chart = lower.rsplit_once('.').is_some_and(|(stem, ending)| {
        CHARTS_OF_RUN.contains(&stem) && ["png", "svg", "pdf"].contains(&ending)
    });
    if is_device(&bare)
        || page
        || chart
        || FILES.contains(&lower.as_str())
        || OF_RUN.contains(&lower.as_str())
    {
        format!("fabric-{bare}")
    } else {
        bare
    }
}

/// The charts that `run` puts beside the folders of the fabrics, without their endings.
const CHARTS_OF_RUN: [&str; 4] = ["drape_parity", "friction_energy", "friction_stiffness", "parity"];

/// Tables, page and account, which every run writes.
pub const FILES: [&str; 5] = ["fabrics.csv", "index.html", "predictions.csv", "problems.csv", "run.json"];

/// What else it puts there.
const OF_RUN: [&str; 3] = ["cases", "fabrics.parquet", "predictions.parquet"];

/// Whether a fabric has files of its own of that name.
fn is_reserved(name: &str) -> bool {
    let name = name.to_lowercase();
    ["sheet", "section"].contains(&name.as_str())
        || Test::ALL.iter().any(|test| test.name() == name)
        || name.starts_with("friction_")
}

/// A name that the files of a case can begin with.
fn case_name(name: &str) -> String {
    let bare = file_name(name);
    if bare.is_empty() || is_device(&bare) { format!("case-{bare}") } else { bare }
}

/// Numbers cases that share a name, so that the files of none take the place of another's, and names those anew whose
/// name no file can have.
pub(super) fn distinguish_cases(cases: &mut [Case]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for case in &mut *cases {
        let name = case_name(&case.name);
        if name != case.name {
            findings.push(rename_case(case, name, Renaming::CaseFile));
        }
    }
    let own: BTreeSet<String> = cases.iter().map(|c| on_disk(&c.name)).collect();
    let mut seen = BTreeSet::new();
    for case in cases {
        let reserved = case.fabric().is_some() && is_reserved(&case.name);
        if !reserved && seen.insert(on_disk(&case.name)) {
            continue;
        }
        let numbered = |n: usize| format!("{}-{n}", case.name);
        let free = |name: &String| {
            let name = on_disk(name);
            !own.contains(&name) && !seen.contains(&name)
        };
        let Some(name) = (2..).map(numbered).find(free) else { continue };
        seen.insert(on_disk(&name));
        let because = if reserved { Renaming::CaseReserved } else { Renaming::CaseTwice };
        findings.push(rename_case(case, name, because));
    }
    findings
}

fn rename_case(case: &mut Case, renamed: String, because: Renaming) -> Finding {
    let fact = UsageFact::Renamed { name: case.name.clone(), renamed: renamed.clone(), because };
    case.name = renamed;
    Finding::new(fact).at(Place::file(&case.path))
}

/// The name of a fabric before and after it was made one that no other has.
#[derive(Clone, Debug)]
pub(super) struct Named {
    /// Its name.
    pub name: String,
    /// What was said of it.
    pub findings: Vec<Finding>,
}

impl Named {
    /// A fabric as it was named.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), findings: Vec::new() }
    }

    fn rename(&mut self, path: &Path, renamed: String, because: Renaming) {
        let fact = UsageFact::Renamed { name: self.name.clone(), renamed: renamed.clone(), because };
        self.findings.push(Finding::new(fact).at(Place::file(path)));
        self.name = renamed;
    }
}

/// Numbers fabrics that share a name, so that none hides another: the invented names are nobody else's. `path` gives
/// the folder or file of the fabric at a place of the list, and `taken` the [keys](key_of_name) of names that fabrics
/// elsewhere have.
pub(super) fn distinguish<'p>(
    fabrics: &mut [Named],
    path: impl Fn(usize) -> &'p Path,
    taken: &BTreeSet<String>,
) {
    for (at, fabric) in fabrics.iter_mut().enumerate() {
        let name = folder_name(&fabric.name);
        if name != fabric.name {
            fabric.rename(path(at), name, Renaming::FabricFolder);
        }
    }
    // Names that differ in case only, or in how their accents are written, are one folder under Windows or macOS.
    let mut own: BTreeMap<String, usize> = BTreeMap::new();
    for fabric in fabrics.iter() {
        *own.entry(on_disk(&fabric.name)).or_default() += 1;
    }
    if own.len() == fabrics.len() {
        return;
    }
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for (at, fabric) in fabrics.iter_mut().enumerate() {
        let count = seen.entry(on_disk(&fabric.name)).or_default();
        *count += 1;
        if *count > 1 {
            let mut name = format!("{}-{count}", fabric.name);
            while own.contains_key(&on_disk(&name)) || taken.contains(&on_disk(&name)) {
                *count += 1;
                name = format!("{}-{count}", fabric.name);
            }
            fabric.rename(path(at), name, Renaming::FabricTwice);
        }
    }
}

/// Numbers fabrics that share a name, so that none hides another: the invented names are nobody else's. A name that
/// no folder can have is changed too. Each sheet has a finding of its new name.
pub fn distinguish_fabrics(fabrics: &mut [Fabric]) {
    let mut named: Vec<Named> = fabrics.iter().map(|f| Named::new(f.sheet.name.as_str())).collect();
    distinguish(&mut named, |at| &fabrics[at].path, &BTreeSet::new());
    for (fabric, named) in fabrics.iter_mut().zip(named) {
        fabric.sheet.name = named.name;
        fabric.sheet.findings.extend(named.findings);
    }
}
