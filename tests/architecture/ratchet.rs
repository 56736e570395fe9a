//! Figures that may only fall: today's are the most that is accepted.

use std::collections::{BTreeMap, BTreeSet};

use crate::source::Crate;

/// Most lines of code of the command, comments and blank lines left out.
pub const COMMAND_LINES: usize = 2000;
/// Local variables that are closures: most of them are functions that have no name of their own.
pub const CLOSURES: usize = 958;
/// Of those, the ones called `of`, which says nothing.
pub const CLOSURES_OF: usize = 0;
/// Names that more than one public type has.
pub const SHARED_NAMES: usize = 5;

/// Lines of code below `src/cli`.
pub fn command_lines(source: &Crate, files: &BTreeMap<String, String>) -> usize {
    let command = source.modules.values().filter(|m| m.path.first().is_some_and(|name| name == "cli"));
    let paths: BTreeSet<_> = command.map(|m| &m.file).collect();
    let is_code = |line: &&str| !line.trim().is_empty() && !line.trim().starts_with("//");
    paths.into_iter().map(|file| files[file].lines().filter(is_code).count()).sum()
}

/// Closures that are local variables.
pub fn closures(source: &Crate) -> usize {
    source.modules.values().map(|m| m.closures.len()).sum()
}

/// Those called `of`.
pub fn closures_called_of(source: &Crate) -> usize {
    source.modules.values().flat_map(|m| &m.closures).filter(|name| *name == "of").count()
}

/// Names of public types that several modules have.
pub fn shared_names(source: &Crate) -> BTreeSet<&str> {
    let (mut seen, mut shared) = (BTreeSet::new(), BTreeSet::new());
    // A type that a module has once with a feature and once without is one.
    let of_modules = source.modules.values().map(|m| m.public_types.iter().map(String::as_str));
    for name in of_modules.flat_map(|names| names.collect::<BTreeSet<_>>()) {
        if !seen.insert(name) {
            shared.insert(name);
        }
    }
    shared
}
