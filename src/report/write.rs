//! Putting files in place: whole or not at all, and never over somebody else's work.

use crate::finding::{Place, as_text, errors, path_as_text};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File, TryLockError};
use std::io::{self, Read as _, Write as _};
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// The list of files that this program wrote into a folder, with their hashes; readers of measurements pass by.
pub const MANIFEST: &str = crate::instrument::MANIFEST;
/// What a run is writing, until its manifest is there: a line for each file, ahead of it, so that a run that was
/// killed can be repeated.
const JOURNAL: &str = crate::instrument::JOURNAL;
const SCHEMA: &str = "kesf.manifest/1";

errors! {
    /// Why a file was not written.
    #[derive(Debug)]
    pub enum OutputError {
        /// O001: the system refused.
        "O001" Write {
            /// The file or folder.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
            /// What the system said.
            #[serde(serialize_with = "as_text")]
            source: io::Error,
        } at Place::file(path), = "cannot be written: {source}"
            => "make the folder, free the place or its permissions, or write elsewhere with -o";
        /// O002: a file of that name is there, and is not (or no longer) the one that this program wrote.
        "O002" NotOurs {
            /// The file.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
        } at Place::file(path), = "exists and is not as this program left it"
            => "write elsewhere with -o, or overwrite it with --force";
        /// O003: a name that would leave the folder, or none.
        "O003" Name {
            /// The name.
            name: String,
        } = "`{name}` is not a name inside the output folder; rename the fabric or case it comes from";
        /// O004: the manifest is there but cannot be read.
        "O004" Manifest {
            /// The manifest.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
            /// What is wrong with it.
            problem: String,
        } at Place::file(path), = "the list of our own files cannot be read: {problem}"
            => "write elsewhere with -o, or overwrite it with --force";
        /// O005: another run is writing into the folder.
        "O005" Busy {
            /// The folder.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
        } at Place::file(path), = "another kesf is writing into this folder" => "wait for it, or write elsewhere with -o";
    }
}

/// What the names of temporary files begin with; [`LETTERS`] random ones follow.
const TEMPORARY: &str = ".kesf-";
const LETTERS: usize = 6;

/// Writes a file under a temporary name beside it, lets the system put its bytes on the disk, and renames it: readers
/// see the old bytes or the new, also after the power has failed.
///
/// # Errors
/// [`OutputError::Write`], with nothing changed.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let failed = |source: io::Error| OutputError::Write { path: path.to_path_buf(), source };
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY).rand_bytes(LETTERS);
    // A temporary file is private by default; a result is as readable as any new file (less the umask).
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder).map_err(failed)?;
    file.write_all(bytes).map_err(failed)?;
    file.as_file().sync_data().map_err(failed)?;
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
/// A file is overwritten only if it is as this program left it (the manifest or the journal of a run that was killed
/// knows its hash) or holds the same bytes already. What was written is noted in the manifest by
/// [`finish`](Self::finish), or when the folder is dropped.
#[derive(Debug)]
pub struct OutputFolder {
    root: PathBuf,
    force: bool,
    /// What earlier runs wrote; several hashes where one of them was killed.
    earlier: BTreeMap<String, Vec<String>>,
    written: Mutex<Written>,
    finished: bool,
}

/// What this run wrote.
#[derive(Debug)]
struct Written {
    /// Name and hash.
    files: BTreeMap<String, String>,
    /// Locked as long as this run lasts.
    journal: File,
}

impl OutputFolder {
    /// Opens a folder, making it if needed, and tries that it can be written to, before the long run.
    ///
    /// # Errors
    /// [`OutputError::Write`] if it cannot be made or is read-only, [`OutputError::Manifest`] if its manifest
    /// is not one (unless `force`), [`OutputError::Busy`] if another run is writing into it.
    pub fn open(root: &Path, force: bool) -> Result<Self, OutputError> {
        let failed = |source: io::Error| OutputError::Write { path: root.to_path_buf(), source };
        fs::create_dir_all(root).map_err(failed)?;
        tempfile::Builder::new().prefix(TEMPORARY).tempfile_in(root).map_err(failed)?;
        let path = root.join(MANIFEST);
        let files = match existing(&path)? {
            None => BTreeMap::new(),
            Some(bytes) => match read_manifest(&bytes) {
                Ok(files) => files,
                Err(_) if force => BTreeMap::new(),
                Err(problem) => return Err(OutputError::Manifest { path, problem }),
            },
        };
        let mut earlier: BTreeMap<String, Vec<String>> =
            files.into_iter().map(|(name, hash)| (name, vec![hash])).collect();
        let (journal, lines, is_alone) = open_journal(root)?;
        // The last line may have been cut short.
        for (name, hash) in
            lines.lines().filter_map(|line| serde_json::from_str::<(String, String)>(line).ok())
        {
            earlier.entry(name).or_default().push(hash);
        }
        if is_alone {
            remove_orphans(root, earlier.keys());
        }
        let written = Mutex::new(Written { files: BTreeMap::new(), journal });
        Ok(Self { root: root.to_path_buf(), force, earlier, written, finished: false })
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
        if !inside(name) || [MANIFEST, JOURNAL].contains(&name) || name.contains('\\') {
            return Err(OutputError::Name { name: name.to_string() });
        }
        let path = self.root.join(name);
        let new = hash(bytes);
        let old = existing(&path)?;
        if old.as_deref() != Some(bytes) {
            let old = old.as_deref().map(hash);
            if let Some(old) = old.filter(|_| !self.force) {
                // Ours: as an earlier run left it, or written by this one.
                let earlier = self.earlier.get(name).is_some_and(|hashes| hashes.contains(&old));
                if !earlier && self.written().files.get(name) != Some(&old) {
                    return Err(OutputError::NotOurs { path });
                }
            }
            self.announce(name, &new)?;
            if let Some(folder) = path.parent() {
                fs::create_dir_all(folder)
                    .map_err(|source| OutputError::Write { path: folder.to_path_buf(), source })?;
            }
            write_atomic(&path, bytes)?;
        }
        self.written().files.insert(name.to_string(), new);
        Ok(())
    }

    fn written(&self) -> MutexGuard<'_, Written> {
        self.written.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Notes in the journal what will be written.
    fn announce(&self, name: &str, hash: &str) -> Result<(), OutputError> {
        let line = format!("{}\n", serde_json::json!([name, hash]));
        self.written()
            .journal
            .write_all(line.as_bytes())
            .map_err(|source| OutputError::Write { path: self.root.join(JOURNAL), source })
    }

    /// Whether this run wrote a file of that name.
    pub fn wrote(&self, name: &str) -> bool {
        self.written().files.contains_key(name)
    }

    /// Writes the manifest. Returns the names that earlier runs wrote, this one did not, and are still there:
    /// left-overs that a reader of the folder should know of.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn finish(mut self) -> Result<Vec<String>, OutputError> {
        self.settle()
    }

    /// Writes the manifest and takes the journal away.
    fn settle(&mut self) -> Result<Vec<String>, OutputError> {
        self.finished = true;
        let mut files = std::mem::take(&mut self.written().files);
        let mut left_over = Vec::new();
        for (name, hashes) in std::mem::take(&mut self.earlier) {
            if files.contains_key(&name) {
                continue;
            }
            // Of a run that was killed, the file may be as it was before or after.
            let now = || existing(&self.root.join(&name)).ok().flatten().map(|bytes| hash(&bytes));
            let left = match &hashes[..] {
                [only] => self.root.join(&name).exists().then(|| only.clone()),
                several => now().filter(|now| several.contains(now)),
            };
            if let Some(left) = left {
                left_over.push(name.clone());
                files.insert(name, left);
            }
        }
        let path = self.root.join(MANIFEST);
        let manifest = Manifest { schema: SCHEMA.into(), files };
        let mut text = serde_json::to_string_pretty(&manifest)
            .map_err(|e| OutputError::Manifest { path: path.clone(), problem: e.to_string() })?;
        text.push('\n');
        write_atomic(&path, text.as_bytes())?;
        // What is left of it does no harm: the manifest knows the same.
        let _ = fs::remove_file(self.root.join(JOURNAL));
        Ok(left_over)
    }
}

impl Drop for OutputFolder {
    /// A run that ends early has left files as well.
    fn drop(&mut self) {
        if !self.finished {
            let _ = self.settle();
        }
    }
}

/// The journal, locked for this run, what is in it, and whether the lock says that no other run writes here.
fn open_journal(root: &Path) -> Result<(File, String, bool), OutputError> {
    let path = root.join(JOURNAL);
    let failed = |source: io::Error| OutputError::Write { path: path.clone(), source };
    let mut journal = File::options().create(true).read(true).append(true).open(&path).map_err(failed)?;
    // Some network folders know no locks: two runs at once are then not noticed.
    let is_alone = match journal.try_lock() {
        Ok(()) => true,
        Err(TryLockError::WouldBlock) => return Err(OutputError::Busy { path: root.to_path_buf() }),
        Err(TryLockError::Error(_)) => false,
    };
    let mut lines = Vec::new();
    journal.read_to_end(&mut lines).map_err(failed)?;
    if lines.last().is_some_and(|last| *last != b'\n') {
        // The run before was killed within a line: the next one is not to become a part of it.
        journal.write_all(b"\n").map_err(failed)?;
    }
    Ok((journal, String::from_utf8_lossy(&lines).into_owned(), is_alone))
}

/// Removes the temporary files that runs left which were killed: in the folder, and in those of their files.
fn remove_orphans<'a>(root: &Path, names: impl Iterator<Item = &'a String>) {
    let inner =
        names.filter(|name| inside(name)).filter_map(|name| root.join(name).parent().map(Path::to_path_buf));
    let folders: BTreeSet<PathBuf> = inner.chain([root.to_path_buf()]).collect();
    for folder in folders {
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        for entry in entries.flatten().filter(|entry| is_temporary(&entry.file_name().to_string_lossy())) {
            // One that cannot be removed does no harm.
            let _ = fs::remove_file(entry.path());
        }
    }
}

fn is_temporary(name: &str) -> bool {
    let letters = name.strip_prefix(TEMPORARY);
    letters.is_some_and(|l| l.len() == LETTERS && l.bytes().all(|b| b.is_ascii_alphanumeric()))
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
    fn a_run_that_ends_early_can_be_repeated_with_other_inputs() {
        let folder = tempfile::tempdir().unwrap();
        let out = OutputFolder::open(folder.path(), false).unwrap();
        out.write("a.csv", b"1").unwrap();
        drop(out);
        let out = OutputFolder::open(folder.path(), false).unwrap();
        out.write("a.csv", b"2").unwrap();
        out.finish().unwrap();
        assert_eq!(names(folder.path()), [MANIFEST, "a.csv"]);
    }

    #[test]
    fn a_run_that_was_killed_can_be_repeated_with_other_inputs() {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in [("a.csv", "1"), ("b.csv", "1"), ("mine.csv", "mine")] {
            fs::write(folder.path().join(name), text).unwrap();
        }
        // Before `a.csv` there was another; `b.csv` was announced and not written; the last line is cut short.
        let lines = format!("{:?}\n{:?}\n[\"c.c", ["a.csv", &hash(b"1")], ["b.csv", &hash(b"2")]);
        fs::write(folder.path().join(JOURNAL), lines).unwrap();
        let out = OutputFolder::open(folder.path(), false).unwrap();
        out.write("a.csv", b"3").unwrap();
        assert!(matches!(out.write("b.csv", b"3"), Err(OutputError::NotOurs { .. })));
        assert!(matches!(out.write("mine.csv", b"3"), Err(OutputError::NotOurs { .. })));
        out.finish().unwrap();
        assert_eq!(names(folder.path()), [MANIFEST, "a.csv", "b.csv", "mine.csv"]);
    }

    #[test]
    fn runs_that_were_killed_one_after_the_other_can_be_repeated() {
        let folder = tempfile::tempdir().unwrap();
        // The first was killed within a line of its journal, the second at once after a file.
        fs::write(folder.path().join(JOURNAL), "[\"a.c").unwrap();
        let out = OutputFolder::open(folder.path(), false).unwrap();
        out.write("b.csv", b"1").unwrap();
        std::mem::forget(out);
        // In one process the lock would outlive the run: the journal alone is what a kill leaves.
        let journal = fs::read(folder.path().join(JOURNAL)).unwrap();
        fs::remove_file(folder.path().join(JOURNAL)).unwrap();
        fs::write(folder.path().join(JOURNAL), journal).unwrap();
        let out = OutputFolder::open(folder.path(), false).unwrap();
        out.write("b.csv", b"2").unwrap();
    }

    #[test]
    fn temporary_files_of_a_run_that_was_killed_are_removed_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("poplin")).unwrap();
        let orphans = [".kesf-a1B2c3", "poplin/.kesf-Zz9Zz9"];
        let others = [".kesf-notes.txt", "poplin/.kesf-mine", "poplin/a1B2c3"];
        for name in orphans.into_iter().chain(others) {
            fs::write(folder.path().join(name), "").unwrap();
        }
        fs::write(folder.path().join(JOURNAL), "[\"poplin/sheet.json\",\"00\"]\n").unwrap();
        OutputFolder::open(folder.path(), false).unwrap().finish().unwrap();
        assert!(orphans.iter().all(|name| !folder.path().join(name).exists()));
        assert!(others.iter().all(|name| folder.path().join(name).exists()));
    }

    #[test]
    fn two_runs_at_once_are_kept_apart() {
        let folder = tempfile::tempdir().unwrap();
        let first = OutputFolder::open(folder.path(), false).unwrap();
        assert!(matches!(OutputFolder::open(folder.path(), true), Err(OutputError::Busy { .. })));
        first.finish().unwrap();
        assert!(OutputFolder::open(folder.path(), false).is_ok());
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
