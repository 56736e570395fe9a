//! Names of fabrics and cases in a folder of results, where none takes the place of another.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::inputs::Fabric;
use crate::finding::{Finding, Place, Renaming, UsageFact};
use crate::kes::Test;
use crate::study::Case;

/// A name that a folder can have, here and under Windows: nothing of it leads into another, and no file or device
/// is called so.
fn folder_name(name: &str) -> String {
    let flat = name.replace(['/', '\\'], "-");
    let bare = flat.trim_matches('.').trim();
    if bare.is_empty() {
        return "fabric".into();
    }
    let lower = bare.to_lowercase();
    let stem = lower.split('.').next().unwrap_or_default();
    let port =
        |kind| stem.strip_prefix(kind).is_some_and(|n| n.len() == 1 && n.as_bytes()[0].is_ascii_digit());
    let device = ["con", "prn", "aux", "nul"].contains(&stem) || port("com") || port("lpt");
    let page = lower.starts_with("fabrics-") && lower.ends_with(".html");
    if device || page || OF_RUN.contains(&lower.as_str()) { format!("fabric-{bare}") } else { bare.into() }
}

/// What `run` puts beside the folders of the fabrics.
const OF_RUN: [&str; 12] = [
    "cases",
    "drape_parity.png",
    "fabrics.csv",
    "fabrics.parquet",
    "friction_energy.png",
    "friction_stiffness.png",
    "index.html",
    "parity.png",
    "predictions.csv",
    "predictions.parquet",
    "problems.csv",
    "run.json",
];

/// Whether a fabric has files of its own of that name.
fn is_reserved(name: &str) -> bool {
    let name = name.to_lowercase();
    ["sheet", "section"].contains(&name.as_str())
        || Test::ALL.iter().any(|test| test.name() == name)
        || name.starts_with("friction_")
}

/// Numbers cases that share a name, so that the files of none take the place of another's.
pub(super) fn distinguish_cases(cases: &mut [Case]) -> Vec<Finding> {
    let own: BTreeSet<String> = cases.iter().map(|c| c.name.to_lowercase()).collect();
    let (mut seen, mut findings) = (BTreeSet::new(), Vec::new());
    for case in cases {
        let reserved = case.fabric().is_some() && is_reserved(&case.name);
        if !reserved && seen.insert(case.name.to_lowercase()) {
            continue;
        }
        let numbered = |n: usize| format!("{}-{n}", case.name);
        let free = |name: &String| {
            let name = name.to_lowercase();
            !own.contains(&name) && !seen.contains(&name)
        };
        let Some(name) = (2..).map(numbered).find(free) else { continue };
        let because = if reserved { Renaming::CaseReserved } else { Renaming::CaseTwice };
        let fact = UsageFact::Renamed { name: case.name.clone(), renamed: name.clone(), because };
        findings.push(Finding::new(fact).at(Place::file(&case.path)));
        seen.insert(name.to_lowercase());
        case.name = name;
    }
    findings
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
/// the folder or file of the fabric at a place of the list.
pub(super) fn distinguish<'p>(fabrics: &mut [Named], path: impl Fn(usize) -> &'p Path) {
    for (at, fabric) in fabrics.iter_mut().enumerate() {
        let name = folder_name(&fabric.name);
        if name != fabric.name {
            fabric.rename(path(at), name, Renaming::FabricFolder);
        }
    }
    // Names that differ in case only are one folder under Windows and macOS.
    let mut own: BTreeMap<String, usize> = BTreeMap::new();
    for fabric in fabrics.iter() {
        *own.entry(fabric.name.to_lowercase()).or_default() += 1;
    }
    if own.len() == fabrics.len() {
        return;
    }
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for (at, fabric) in fabrics.iter_mut().enumerate() {
        let count = seen.entry(fabric.name.to_lowercase()).or_default();
        *count += 1;
        if *count > 1 {
            let mut name = format!("{}-{count}", fabric.name);
            while own.contains_key(&name.to_lowercase()) {
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
    distinguish(&mut named, |at| &fabrics[at].path);
    for (fabric, named) in fabrics.iter_mut().zip(named) {
        fabric.sheet.name = named.name;
        fabric.sheet.findings.extend(named.findings);
    }
}
