//! Where results may go: never among the files that they are made of.

use std::path::{Path, PathBuf};

use super::failure::Failure;
use super::inputs::Input;
use crate::finding::Place;
use crate::instrument::{JOURNAL, Library, MANIFEST, ReadSettings};
use crate::platform::files;

/// Refuses a folder of results that holds inputs, or files of measurements below an input: exports stay as the instrument
/// left them, and a folder that has both is an input of the next run. One that this program has written into before may be
/// written into again.
///
/// # Errors
/// O076.
pub fn refuse_inputs(root: &Path, inputs: &[Input]) -> Result<(), Failure> {
    let Ok(real) = files::canonicalize(root) else { return Ok(()) };
    if [MANIFEST, JOURNAL].iter().any(|name| files::is_file(&real.join(name))) {
        return Ok(());
    }
    // Cases are no exports: results may stand beside them.
    let is_export = |input: &&Input| matches!(input, Input::Path(path) if path.extension().is_none_or(|ending| ending != "toml"));
    let on_disk = inputs.iter().filter(is_export);
    let paths: Vec<PathBuf> = on_disk.filter_map(|input| files::canonicalize(input.path()).ok()).collect();
    let held = if paths.contains(&real) {
        "is itself an input"
    } else if paths.iter().any(|input| input.starts_with(&real)) {
        "holds inputs"
    } else if paths.iter().any(|input| real.starts_with(input))
        && Library::find(&[real], &ReadSettings::default()).files() > 0
    {
        "holds files of measurements that are read"
    } else {
        return Ok(());
    };
    Err(Failure::new("O076", format!("the folder of results {held}; nothing was written"))
        .at(Place::file(root))
        .hint("write into a folder of its own, such as `-o results`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_with_inputs_are_refused_and_those_of_results_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        for name in ["data/poplin", "data/results", "out"] {
            std::fs::create_dir_all(root.join(name)).unwrap();
        }
        std::fs::write(root.join("data/poplin/t.csv"), "fabric,LT\na,0.6\n").unwrap();
        let of = |output: &str, input: &str| {
            refuse_inputs(&root.join(output), &[Input::from(root.join(input))]).err().map(|e| e.message)
        };
        assert!(of("data", "data").is_some_and(|m| m.contains("is itself an input")));
        assert!(of("", "data").is_some_and(|m| m.contains("holds inputs")));
        assert!(of("data/poplin", "data/poplin/t.csv").is_some_and(|m| m.contains("holds inputs")));
        assert!(of("data/poplin", "data").is_some_and(|m| m.contains("files of measurements")));
        for output in ["out", "data/results", "nowhere"] {
            assert_eq!(of(output, "data"), None, "{output}");
        }
        std::fs::write(root.join("case.toml"), "").unwrap();
        assert_eq!(of("", "case.toml"), None, "beside a case");
        std::fs::write(root.join("data").join(MANIFEST), "{}").unwrap();
        assert_eq!(of("data", "data/poplin"), None);
    }
}
