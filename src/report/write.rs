//! Putting files in place: whole or not at all, and never over somebody else's work.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use thiserror::Error;

/// The list of files that this program wrote into a folder, with their hashes.
pub const MANIFEST: &str = ".kesf-manifest.json";
const SCHEMA: &str = "kesf.manifest/1";

/// Why a file was not written.
#[derive(Debug, Error)]
pub enum OutputError {
    /// O001: the system refused.
    #[error(
        "{}: O001 cannot be written: {source}; choose another place with -o or free this one",
        path.display()
    )]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// O002: a file of that name is there, and is not (or no longer) the one that this program wrote.
    #[error(
        "{}: O002 exists and is not as this program left it; move it away, write elsewhere with -o, \
         or overwrite it with --force",
        path.display()
    )]
    NotOurs {
        /// The file.
        path: PathBuf,
    },
    /// O003: a name that would leave the folder, or none.
    #[error("O003 `{name}` is not a name inside the output folder; rename the fabric or case it comes from")]
    Name {
        /// The name.
        name: String,
    },
    /// O004: the manifest is there but cannot be read.
    #[error(
        "{}: O004 the list of our own files cannot be read: {problem}; overwrite everything with --force \
         or write elsewhere with -o",
        path.display()
    )]
    Manifest {
        /// The manifest.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
}

/// Writes a file under a temporary name beside it and renames it: readers see the old bytes or the new.
///
/// # Errors
/// [`OutputError::Write`], with nothing changed.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let failed = |source: io::Error| OutputError::Write { path: path.to_path_buf(), source };
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".kesf-");
    // A temporary file is private by default; a result is as readable as any new file (less the umask).
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder).map_err(failed)?;
    file.write_all(bytes).map_err(failed)?;
    file.persist(path).map_err(|e| failed(e.error))?;
    Ok(())
}

/// Writes a single file unless another with other bytes is there (or `force` is set).
///
/// # Errors
/// [`OutputError::NotOurs`] or [`OutputError::Write`].
pub fn write_file(path: &Path, bytes: &[u8], force: bool) -> Result<(), OutputError> {
    match existing(path)? {
        Some(old) if old == bytes => Ok(()),
        Some(_) if !force => Err(OutputError::NotOurs { path: path.to_path_buf() }),
        _ => write_atomic(path, bytes),
    }
}

/// Whether a name stays within its folder.
fn inside(name: &str) -> bool {
    let mut parts = Path::new(name).components().peekable();
    parts.peek().is_some() && parts.all(|c| matches!(c, Component::Normal(_)))
}

fn existing(path: &Path) -> Result<Option<Vec<u8>>, OutputError> {
    match fs::read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(OutputError::Write { path: path.to_path_buf(), source }),
    }
}

/// SHA-256 in hexadecimal digits.
pub fn hash(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect()
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Manifest {
    schema: String,
    /// Name in the folder (with `/`) and SHA-256 of what was written.
    files: BTreeMap<String, String>,
}

/// Bytes of a file, if it is there as it should be.
pub type Bytes = Result<Option<Vec<u8>>, OutputError>;

/// A reader of the files of a results folder: the bytes of a name, if they are as this program left them.
///
/// # Errors
/// [`OutputError::Manifest`] if the list of our files is none, [`OutputError::Write`] if a file cannot be read.
pub fn left(root: &Path) -> Result<impl Fn(&str) -> Bytes, OutputError> {
    let path = root.join(MANIFEST);
    let files = match existing(&path)? {
        None => BTreeMap::new(),
        Some(bytes) => read_manifest(&bytes).map_err(|problem| OutputError::Manifest { path, problem })?,
    };
    Ok(move |name: &str| match files.get(name).filter(|_| inside(name)) {
        Some(known) => Ok(existing(&root.join(name))?.filter(|bytes| hash(bytes) == *known)),
        None => Ok(None),
    })
}

/// A folder of results. It may be written to from several threads.
///
/// A file is overwritten only if it is as this program left it (the manifest knows its hash) or holds the
/// same bytes already; so a run that was interrupted before [`finish`](Self::finish) can be repeated.
#[derive(Debug)]
pub struct OutputFolder {
    root: PathBuf,
    force: bool,
    /// What earlier runs wrote.
    earlier: BTreeMap<String, String>,
    /// What this run wrote.
    written: Mutex<BTreeMap<String, String>>,
}

impl OutputFolder {
    /// Opens a folder, making it if needed, and tries that it can be written to, before the long run.
    ///
    /// # Errors
    /// [`OutputError::Write`] if it cannot be made or is read-only, [`OutputError::Manifest`] if its manifest
    /// is not one (unless `force`).
    pub fn open(root: &Path, force: bool) -> Result<Self, OutputError> {
        let failed = |source: io::Error| OutputError::Write { path: root.to_path_buf(), source };
        fs::create_dir_all(root).map_err(failed)?;
        tempfile::Builder::new().prefix(".kesf-").tempfile_in(root).map_err(failed)?;
        let path = root.join(MANIFEST);
        let earlier = match existing(&path)? {
            None => BTreeMap::new(),
            Some(bytes) => match read_manifest(&bytes) {
                Ok(files) => files,
                Err(_) if force => BTreeMap::new(),
                Err(problem) => return Err(OutputError::Manifest { path, problem }),
            },
        };
        Ok(Self { root: root.to_path_buf(), force, earlier, written: Mutex::default() })
    }

    /// The folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Writes a file at `name`, a path relative to the folder with `/` between its parts.
    ///
    /// # Errors
    /// [`OutputError::Name`], [`OutputError::NotOurs`] or [`OutputError::Write`]; nothing is changed then.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), OutputError> {
        if !inside(name) || name == MANIFEST || name.contains('\\') {
            return Err(OutputError::Name { name: name.to_string() });
        }
        let path = self.root.join(name);
        let new = hash(bytes);
        let old = existing(&path)?;
        if old.as_deref() != Some(bytes) {
            let old = old.as_deref().map(hash);
            // Ours: as an earlier run left it, or written by this one.
            let written = self.written.lock().unwrap_or_else(PoisonError::into_inner).get(name).cloned();
            let known = [self.earlier.get(name), written.as_ref()];
            if old.is_some() && !self.force && !known.contains(&old.as_ref()) {
                return Err(OutputError::NotOurs { path });
            }
            if let Some(folder) = path.parent() {
                fs::create_dir_all(folder)
                    .map_err(|source| OutputError::Write { path: folder.to_path_buf(), source })?;
            }
            write_atomic(&path, bytes)?;
        }
        self.written.lock().unwrap_or_else(PoisonError::into_inner).insert(name.to_string(), new);
        Ok(())
    }

    /// Whether this run wrote a file of that name.
    pub fn wrote(&self, name: &str) -> bool {
        self.written.lock().unwrap_or_else(PoisonError::into_inner).contains_key(name)
    }

    /// Writes the manifest. Returns the names that earlier runs wrote, this one did not, and are still there:
    /// left-overs that a reader of the folder should know of.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn finish(self) -> Result<Vec<String>, OutputError> {
        let mut files = self.written.into_inner().unwrap_or_else(PoisonError::into_inner);
        let mut left_over = Vec::new();
        for (name, hash) in self.earlier {
            if !files.contains_key(&name) && self.root.join(&name).exists() {
                left_over.push(name.clone());
                files.insert(name, hash);
            }
        }
        let path = self.root.join(MANIFEST);
        let manifest = Manifest { schema: SCHEMA.into(), files };
        let mut text = serde_json::to_string_pretty(&manifest)
            .map_err(|e| OutputError::Manifest { path: path.clone(), problem: e.to_string() })?;
        text.push('\n');
        write_atomic(&path, text.as_bytes())?;
        Ok(left_over)
    }
}

fn read_manifest(bytes: &[u8]) -> Result<BTreeMap<String, String>, String> {
    let manifest: Manifest = serde_json::from_slice(bytes).map_err(|e| e.to_string())?;
    if manifest.schema != SCHEMA {
        return Err(format!("its schema is `{}`, not `{SCHEMA}`", manifest.schema));
    }
    Ok(manifest.files)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(root: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(root).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn our_own_files_are_replaced_and_others_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().join("new/results");
        let out = OutputFolder::open(&root, false).unwrap();
        out.write("a.csv", b"1").unwrap();
        out.write("poplin/sheet.json", b"{}").unwrap();
        out.write("a.csv", b"2").unwrap();
        assert!(out.finish().unwrap().is_empty());
        assert_eq!(names(&root), [MANIFEST, "a.csv", "poplin"]);

        fs::write(root.join("mine.csv"), b"mine").unwrap();
        fs::write(root.join("poplin/sheet.json"), b"{ edited }").unwrap();
        let out = OutputFolder::open(&root, false).unwrap();
        out.write("a.csv", b"3").unwrap();
        assert!(matches!(out.write("mine.csv", b"x"), Err(OutputError::NotOurs { .. })));
        assert!(matches!(out.write("poplin/sheet.json", b"x"), Err(OutputError::NotOurs { .. })));
        assert_eq!(fs::read(root.join("mine.csv")).unwrap(), b"mine");
        assert_eq!(out.finish().unwrap(), ["poplin/sheet.json"], "left over from the first run");

        let out = OutputFolder::open(&root, true).unwrap();
        out.write("mine.csv", b"x").unwrap();
        out.write("poplin/sheet.json", b"x").unwrap();
        assert_eq!(fs::read(root.join("mine.csv")).unwrap(), b"x");
    }

    #[test]
    fn an_interrupted_run_can_be_repeated_without_a_manifest() {
        let folder = tempfile::tempdir().unwrap();
        let out = OutputFolder::open(folder.path(), false).unwrap();
        out.write("a.csv", b"1").unwrap();
        drop(out);
        let out = OutputFolder::open(folder.path(), false).unwrap();
        out.write("a.csv", b"1").unwrap();
        out.finish().unwrap();
    }

    #[test]
    fn the_manifest_is_the_same_for_the_same_files() {
        let folder = tempfile::tempdir().unwrap();
        let manifest = || {
            let out = OutputFolder::open(folder.path(), false).unwrap();
            out.write("b", b"1").unwrap();
            out.write("a", b"1").unwrap();
            out.finish().unwrap();
            fs::read_to_string(folder.path().join(MANIFEST)).unwrap()
        };
        let first = manifest();
        assert_eq!(first, manifest());
        // SHA-256 of "1" (FIPS 180-4; sha256sum).
        assert!(first.contains("6b86b273ff34fce19d6b804eff5a3f5747ada4eaa22f1d49c01e52ddb7875b4b"));
    }

    #[test]
    fn names_that_leave_the_folder_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let out = OutputFolder::open(folder.path(), false).unwrap();
        for name in ["", "../x", "/etc/x", "a/../../x", "..\\x", MANIFEST] {
            assert!(matches!(out.write(name, b"x"), Err(OutputError::Name { .. })), "{name}");
        }
    }

    #[test]
    fn a_broken_manifest_and_a_file_in_place_of_the_folder_are_errors() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(MANIFEST), b"not json").unwrap();
        assert!(matches!(OutputFolder::open(folder.path(), false), Err(OutputError::Manifest { .. })));
        assert!(OutputFolder::open(folder.path(), true).is_ok());
        let file = folder.path().join("file");
        fs::write(&file, b"").unwrap();
        assert!(matches!(OutputFolder::open(&file, false), Err(OutputError::Write { .. })));
        assert!(matches!(write_atomic(&file.join("x"), b""), Err(OutputError::Write { .. })));
    }

    #[test]
    fn a_single_file_is_not_overwritten_by_other_bytes_without_force() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("curves.csv");
        write_file(&path, b"1", false).unwrap();
        write_file(&path, b"1", false).unwrap();
        assert!(matches!(write_file(&path, b"2", false), Err(OutputError::NotOurs { .. })));
        write_file(&path, b"2", true).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"2");
    }

    #[cfg(unix)]
    #[test]
    fn results_are_as_readable_as_any_new_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("plain"), b"").unwrap();
        write_atomic(&folder.path().join("ours"), b"").unwrap();
        let mode = |name: &str| fs::metadata(folder.path().join(name)).unwrap().permissions().mode();
        assert_eq!(mode("ours"), mode("plain"));
    }
}
