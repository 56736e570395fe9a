//! Files that are read: those of the system, and on WebAssembly without one those of a tree in memory.
//!
//! The computing layers read through these functions only, so that folders mean the same wherever the program runs.

use std::io;
use std::path::{Path, PathBuf};

// Clippy looks at the page (web/) as code of the system that it runs on.
#[cfg(any(test, clippy, all(target_family = "wasm", target_os = "unknown")))]
mod tree;

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
mod system {
    use std::io::Read as _;

    use super::{Path, PathBuf, io};

    pub use std::fs::{canonicalize, read};

    pub fn start(path: &Path, most: usize) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        std::fs::File::open(path)?.take(most as u64).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    pub fn entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
        std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect()
    }

    pub fn is_file(path: &Path) -> bool {
        path.is_file()
    }

    pub fn is_folder(path: &Path) -> bool {
        path.is_dir()
    }

    pub fn is_link(path: &Path) -> bool {
        path.is_symlink()
    }
}

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
mod system {
    use super::{Path, PathBuf, in_memory, io};

    pub fn canonicalize(path: &Path) -> io::Result<PathBuf> {
        in_memory(|tree| tree.canonicalize(path))
    }

    pub fn read(path: &Path) -> io::Result<Vec<u8>> {
        in_memory(|tree| tree.read(path).map(<[u8]>::to_vec))
    }

    pub fn start(path: &Path, most: usize) -> io::Result<Vec<u8>> {
        in_memory(|tree| tree.read(path).map(|bytes| bytes[..most.min(bytes.len())].to_vec()))
    }

    pub fn entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
        in_memory(|tree| tree.entries(folder))
    }

    pub fn is_file(path: &Path) -> bool {
        in_memory(|tree| tree.is_file(path))
    }

    pub fn is_folder(path: &Path) -> bool {
        in_memory(|tree| tree.is_folder(path))
    }

    pub fn is_link(_path: &Path) -> bool {
        false
    }
}

#[cfg(any(test, clippy, all(target_family = "wasm", target_os = "unknown")))]
pub use tree::FileTree;
#[cfg(all(not(test), any(clippy, all(target_family = "wasm", target_os = "unknown"))))]
pub use tree::in_memory;

/// The bytes of a file.
///
/// # Errors
/// Those of the system.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    system::read(path)
}

/// The first bytes of a file, not more than `most`.
///
/// # Errors
/// Those of the system.
pub fn start(path: &Path, most: usize) -> io::Result<Vec<u8>> {
    system::start(path, most)
}

#[cfg(feature = "parquet")]
pub use std::fs::File;

/// A file that is read in pieces.
///
/// # Errors
/// Those of the system.
#[cfg(feature = "parquet")]
pub fn open(path: &Path) -> io::Result<File> {
    File::open(path)
}

/// The text of a file.
///
/// # Errors
/// Those of the system, and one for bytes that are no UTF-8.
pub fn read_to_string(path: &Path) -> io::Result<String> {
    let no_text = |_| io::Error::new(io::ErrorKind::InvalidData, "stream did not contain valid UTF-8");
    String::from_utf8(read(path)?).map_err(no_text)
}

/// Paths of what stands in a folder, in name order.
///
/// # Errors
/// Those of the system.
pub fn entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut paths = system::entries(folder)?;
    paths.sort();
    Ok(paths)
}

/// The absolute path without links.
///
/// # Errors
/// Those of the system, one for a path that leads nowhere among them.
pub fn canonicalize(path: &Path) -> io::Result<PathBuf> {
    system::canonicalize(path)
}

/// Whether the path leads to a file.
pub fn is_file(path: &Path) -> bool {
    system::is_file(path)
}

/// Whether the path leads to a folder.
pub fn is_folder(path: &Path) -> bool {
    system::is_folder(path)
}

/// Whether the path leads to anything.
pub fn exists(path: &Path) -> bool {
    is_file(path) || is_folder(path) || canonicalize(path).is_ok()
}

/// Whether the path is a link, wherever it leads.
pub fn is_link(path: &Path) -> bool {
    system::is_link(path)
}
