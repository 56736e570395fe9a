//! Files by their paths, as they are dropped: the folders that the engine reads.

use std::path::{Path, PathBuf};

use kesf::instrument::{is_data_name, unpacked};
use kesf::platform::files::{exists, in_memory};

mod shipped {
    include!(concat!(env!("OUT_DIR"), "/files.rs"));
}

/// Where the texts of the form are.
pub const FORM: &str = "form";
/// Where the cases are that the page brings with it.
pub const CASES: &str = "cases of the page";

/// Forgets all files.
pub fn clear() {
    in_memory(|tree| tree.remove(Path::new("/")));
}

/// Takes a file; what is dropped without a folder is one fabric, that of the folder `loose`. What is not named like a
/// file of a fabric is kept beside it, so that it is read by its name and says why it cannot be used.
pub fn put(path: &str, bytes: Vec<u8>, loose: &str) {
    if path.contains('/') {
        return keep(path, bytes);
    }
    if let Some(files) = unpacked(&bytes) {
        let folder = folder_of(path, &files);
        for (inner, bytes) in files {
            in_memory(|tree| tree.put(&folder.join(inner), bytes));
        }
        return;
    }
    let of_fabric = ["fabric.toml", "dialect.toml"].contains(&path) || (is_data_name(path) && !is_zip(path));
    if of_fabric { keep(&format!("{loose}/{path}"), bytes) } else { keep(path, bytes) }
}

/// Takes the two fabrics of the example.
pub fn put_example() {
    for (path, bytes) in shipped::EXAMPLE {
        keep(path, bytes.to_vec());
    }
}

/// Takes the cases that the page brings with it; their folder.
pub fn put_cases() -> PathBuf {
    for (path, bytes) in shipped::CASES {
        let name = path.rsplit('/').next().unwrap_or(path);
        keep(&format!("{CASES}/{name}"), bytes.to_vec());
    }
    CASES.into()
}

/// Keeps a text of the form; its path unless it is blank.
pub fn put_text(name: &str, text: &str) -> Option<PathBuf> {
    let path = Path::new(FORM).join(name);
    in_memory(|tree| tree.remove(&path));
    if text.trim().is_empty() {
        return None;
    }
    in_memory(|tree| tree.put(&path, text.as_bytes().to_vec()));
    Some(path)
}

/// What was dropped: folders, and files that stand in none.
pub fn dropped() -> Vec<PathBuf> {
    let ours = [FORM, CASES].map(|name| Path::new("/").join(name));
    let all = kesf::platform::files::entries(Path::new("/")).unwrap_or_default();
    let names = all.iter().filter(|path| !ours.contains(path));
    names.filter_map(|path| path.strip_prefix("/").ok().map(Path::to_path_buf)).collect()
}

/// Every file that was dropped.
pub fn all() -> Vec<PathBuf> {
    let mut folders = dropped();
    let mut files = Vec::new();
    while let Some(path) = folders.pop() {
        match kesf::platform::files::entries(&path) {
            Ok(inner) => folders.extend(inner),
            Err(_) => files.push(path),
        }
    }
    files.sort();
    files
}

fn keep(path: &str, bytes: Vec<u8>) {
    in_memory(|tree| tree.put(Path::new(path), bytes));
}

/// The folder that an archive stands for: the one that it holds, else one of its name that is free.
fn folder_of(archive: &str, files: &[(PathBuf, Vec<u8>)]) -> PathBuf {
    let first = |path: &PathBuf| path.components().next().map(|c| c.as_os_str().to_os_string());
    let tops: Vec<_> = files.iter().map(|(path, _)| first(path)).collect();
    let is_folder = files.iter().all(|(path, _)| path.components().count() > 1);
    let one = tops.first().cloned().flatten().filter(|top| tops.iter().all(|t| t.as_ref() == Some(top)));
    match one {
        Some(top) if is_folder && !exists(Path::new(&top)) => PathBuf::new(),
        _ => Path::new(archive).file_stem().unwrap_or_default().into(),
    }
}

fn is_zip(name: &str) -> bool {
    name.to_lowercase().ends_with(".zip")
}
