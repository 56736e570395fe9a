//! Valid files: those that ship with the program, and a few in `corpus/` that do not.

use std::fs;
use std::path::{Path, PathBuf};

/// A longer file is thinned: damage to a short one is read in microseconds.
const LINES: usize = 40;

/// The folder of this package.
pub fn package() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The files below a folder of `corpus/`, by name; none without the folder.
pub fn folder(name: &str) -> Vec<Vec<u8>> {
    below(&package().join("corpus").join(name), &|_| true)
}

/// The shipped files below a folder of the repository whose names end so, by name.
pub fn shipped(folder: &str, endings: &[&str]) -> Vec<Vec<u8>> {
    let is_wanted = |path: &Path| endings.iter().any(|ending| path.to_string_lossy().ends_with(ending));
    below(&package().join("..").join(folder), &is_wanted)
}

/// The folder of a test that is removed when it ends.
///
/// # Panics
/// Where there can be none.
pub fn scratch() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder for files")
}

/// Its first lines and some of the others.
pub fn thinned(bytes: Vec<u8>) -> Vec<u8> {
    let lines: Vec<&[u8]> = bytes.split_inclusive(|b| *b == b'\n').collect();
    if lines.len() <= LINES {
        return bytes;
    }
    let step = lines.len().div_ceil(LINES / 2);
    let kept = lines.iter().enumerate().filter(|(i, _)| *i < LINES / 2 || i % step == 0);
    kept.flat_map(|(_, line)| line.iter().copied()).collect()
}

fn below(folder: &Path, is_wanted: &dyn Fn(&Path) -> bool) -> Vec<Vec<u8>> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry of a folder").path()).collect();
    paths.sort();
    let mut found = Vec::new();
    for path in paths {
        if path.is_dir() {
            // Files that once did not hold are no valid ones.
            if !path.ends_with("once") {
                found.extend(below(&path, is_wanted));
            }
        } else if is_wanted(&path) {
            found.push(fs::read(&path).expect("a file of the corpus"));
        }
    }
    found
}
