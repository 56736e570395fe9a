//! Files in memory, which answer as those of a system do.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Component, Path, PathBuf};
#[cfg(not(test))]
use std::sync::{Mutex, PoisonError};

/// Files by their absolute paths. There is a folder where there is a file below it; relative paths begin at the root.
#[derive(Debug, Default)]
pub struct FileTree(BTreeMap<PathBuf, Vec<u8>>);

#[cfg(not(test))]
static TREE: Mutex<FileTree> = Mutex::new(FileTree::new());

/// Puts files into the memory that stands for a system, or takes them out.
#[cfg(not(test))]
pub fn in_memory<T>(work: impl FnOnce(&mut FileTree) -> T) -> T {
    work(&mut TREE.lock().unwrap_or_else(PoisonError::into_inner))
}

impl FileTree {
    /// Without a file.
    pub const fn new() -> Self {
        Self(BTreeMap::new())
    }

    /// Puts a file there, in place of what was there.
    pub fn put(&mut self, path: &Path, bytes: Vec<u8>) {
        self.0.insert(absolute(path), bytes);
    }

    /// Takes out a file, or all files below a folder.
    pub fn remove(&mut self, path: &Path) {
        let path = absolute(path);
        self.0.retain(|file, _| !file.starts_with(&path));
    }

    /// The bytes of a file.
    ///
    /// # Errors
    /// Where there is none.
    pub fn read(&self, path: &Path) -> io::Result<&[u8]> {
        match self.0.get(&absolute(path)) {
            Some(bytes) => Ok(bytes),
            None if self.is_folder(path) => {
                Err(io::Error::new(io::ErrorKind::IsADirectory, "Is a directory"))
            }
            None => Err(nothing()),
        }
    }

    /// What stands in a folder, each by the path of the folder as it was named.
    ///
    /// # Errors
    /// Where there is none.
    pub fn entries(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        if self.is_file(folder) {
            return Err(io::Error::new(io::ErrorKind::NotADirectory, "Not a directory"));
        }
        let path = absolute(folder);
        let names: BTreeSet<_> = self
            .0
            .keys()
            .filter_map(|file| file.strip_prefix(&path).ok()?.components().next())
            .map(|name| folder.join(name))
            .collect();
        if names.is_empty() { Err(nothing()) } else { Ok(names.into_iter().collect()) }
    }

    /// The absolute path.
    ///
    /// # Errors
    /// Where it leads to nothing.
    pub fn canonicalize(&self, path: &Path) -> io::Result<PathBuf> {
        if self.is_file(path) || self.is_folder(path) { Ok(absolute(path)) } else { Err(nothing()) }
    }

    /// Whether there is a file.
    pub fn is_file(&self, path: &Path) -> bool {
        self.0.contains_key(&absolute(path))
    }

    /// Whether there is a folder; the root always is one.
    pub fn is_folder(&self, path: &Path) -> bool {
        let path = absolute(path);
        let is_root = path.parent().is_none();
        is_root || self.0.keys().any(|file| file.starts_with(&path) && *file != path)
    }
}

fn nothing() -> io::Error {
    io::Error::new(io::ErrorKind::NotFound, "No such file or directory")
}

/// The path from the root, without `.` and `..`.
fn absolute(path: &Path) -> PathBuf {
    let mut out = PathBuf::from("/");
    for component in path.components() {
        match component {
            Component::Normal(name) => out.push(name),
            Component::ParentDir => drop(out.pop()),
            Component::CurDir | Component::RootDir | Component::Prefix(_) => {}
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super as disk;
    use super::*;

    /// The same answers as those of a disk, for every question and every path.
    #[test]
    fn a_tree_answers_as_a_disk() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        let mut tree = FileTree::new();
        for name in ["poplin/fabric.toml", "poplin/raw/fb2.csv", "poplin.csv", "twill/a.csv", "a.toml"] {
            let path = root.join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, name).unwrap();
            tree.put(&path, name.into());
        }
        let paths = [
            "",
            ".",
            "poplin",
            "poplin/",
            "poplin/raw",
            "poplin/./raw/../fabric.toml",
            "poplin.csv",
            "pop",
            "twill/..",
            "poplin/raw/fb2.csv",
            "poplin/none.csv",
            "none/none.csv",
            "a.toml/b",
        ];
        for path in paths.map(|path| root.join(path)) {
            let text = path.display();
            assert_eq!(tree.is_file(&path), disk::is_file(&path), "{text}");
            assert_eq!(tree.is_folder(&path), disk::is_folder(&path), "{text}");
            assert_eq!(tree.canonicalize(&path).ok(), disk::canonicalize(&path).ok(), "{text}");
            assert_eq!(tree.read(&path).ok(), disk::read(&path).ok().as_deref(), "{text}");
            assert_eq!(tree.entries(&path).ok(), disk::entries(&path).ok(), "{text}");
        }
        let reason = |e: io::Error| e.to_string();
        let none = root.join("none.csv");
        let of_disk = reason(disk::read(&none).unwrap_err());
        assert!(of_disk.starts_with(&reason(tree.read(&none).unwrap_err())), "{of_disk}");
    }

    #[test]
    fn relative_paths_begin_at_the_root_and_files_come_out_again() {
        let mut tree = FileTree::new();
        tree.put(Path::new("poplin/a.csv"), b"1".to_vec());
        tree.put(Path::new("../poplin/b.csv"), b"2".to_vec());
        assert_eq!(
            tree.entries(Path::new("poplin")).unwrap(),
            ["poplin/a.csv", "poplin/b.csv"].map(PathBuf::from)
        );
        assert_eq!(tree.entries(Path::new(".")).unwrap(), [PathBuf::from("./poplin")]);
        assert_eq!(tree.canonicalize(Path::new("poplin/../poplin")).unwrap(), Path::new("/poplin"));
        tree.remove(Path::new("poplin/a.csv"));
        assert!(
            tree.read(Path::new("poplin/a.csv")).is_err() && tree.read(Path::new("/poplin/b.csv")).is_ok()
        );
        tree.remove(Path::new("poplin"));
        assert!(!tree.is_folder(Path::new("poplin")) && tree.is_folder(Path::new("")));
    }
}
