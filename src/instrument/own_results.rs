//! Files that this program wrote itself: results, and no measurements.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::platform::files;

/// The list of files that this program wrote into a folder: results, and no measurements.
pub const MANIFEST: &str = ".kesf-manifest.json";
/// What stands for it as long as a run is writing, or where one was killed.
pub const JOURNAL: &str = ".kesf-journal";
/// What says that a folder holds the results of a run, where both lists were left behind (`cp results/* elsewhere`).
const RUN: &str = "run.json";
const RUN_SCHEMA: &str = "kesf.run/1";
/// The tables of such a folder.
const TABLES: [&str; 4] = ["fabrics.csv", "predictions.csv", "problems.csv", "index.html"];

/// What is known of the folders that were asked about.
#[derive(Debug, Default)]
pub(super) struct OwnResults {
    /// Names that this program wrote into a folder, relative to it with `/`; by its true path.
    known: BTreeMap<PathBuf, BTreeSet<String>>,
}

#[derive(Deserialize)]
struct Manifest {
    files: BTreeMap<String, IgnoredAny>,
}

#[derive(Deserialize)]
struct Run {
    schema: String,
}

impl OwnResults {
    /// Whether this program wrote the file, by the lists in its folder and in those above it.
    pub fn wrote(&mut self, file: &Path) -> bool {
        let Some((folder, name)) = file.parent().zip(file.file_name()) else { return false };
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let Ok(real) = files::canonicalize(folder) else { return false };
        let real = real.join(name);
        real.ancestors().skip(1).any(|above| {
            let Ok(name) = real.strip_prefix(above) else { return false };
            let name: Vec<_> = name.iter().map(|part| part.to_string_lossy()).collect();
            self.names(above).contains(&name.join("/"))
        })
    }

    fn names(&mut self, folder: &Path) -> &BTreeSet<String> {
        self.known.entry(folder.to_path_buf()).or_insert_with(|| names(folder))
    }
}

/// Names that the lists of a folder hold.
fn names(folder: &Path) -> BTreeSet<String> {
    let read = |name: &str| files::read(&folder.join(name)).unwrap_or_default();
    let manifest = serde_json::from_slice::<Manifest>(&read(MANIFEST));
    let mut names: BTreeSet<String> =
        manifest.map_or_else(|_| BTreeSet::new(), |m| m.files.into_keys().collect());
    let journal = read(JOURNAL);
    // The last line of a run that was killed may have been cut short.
    let lines = journal.split(|byte| *byte == b'\n');
    names.extend(
        lines.filter_map(|line| serde_json::from_slice::<(String, IgnoredAny)>(line).ok()).map(|l| l.0),
    );
    if names.is_empty() && serde_json::from_slice::<Run>(&read(RUN)).is_ok_and(|run| run.schema == RUN_SCHEMA)
    {
        names.extend(TABLES.map(String::from));
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_in_the_lists_are_ours_and_others_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        std::fs::create_dir(root.join("poplin")).unwrap();
        std::fs::write(root.join(MANIFEST), r#"{"schema":"kesf.manifest/1","files":{"fabrics.csv":"00"}}"#)
            .unwrap();
        std::fs::write(root.join(JOURNAL), "[\"poplin/strip.csv\",\"00\"]\n[\"pop").unwrap();
        let mut own = OwnResults::default();
        let ours = ["fabrics.csv", "poplin/strip.csv"].map(|name| own.wrote(&root.join(name)));
        assert_eq!(ours, [true, true]);
        let others = ["mine.csv", "poplin/fabrics.csv", "strip.csv"].map(|name| own.wrote(&root.join(name)));
        assert_eq!(others, [false; 3]);
    }

    #[test]
    fn tables_of_a_run_that_were_copied_without_the_lists_are_known_by_its_document() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("fabrics.csv");
        assert!(!OwnResults::default().wrote(&file));
        std::fs::write(folder.path().join(RUN), r#"{"schema":"kesf.run/1","version":"0.1.0"}"#).unwrap();
        assert!(OwnResults::default().wrote(&file));
        assert!(!OwnResults::default().wrote(&folder.path().join("mine.csv")));
    }
}
