//! Putting files in place: whole or not at all, and never over somebody else's work.

use crate::finding::{Place, as_text, errors, path_as_text};
use crate::platform::files;
use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Write as _};
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use tempfile::NamedTempFile;

pub(super) use super::file_list::{Digest32, FileList, from_hexadecimal, hexadecimal};

/// The list of files that this program wrote into a folder, with their hashes; readers of measurements pass by.
pub const MANIFEST: &str = crate::instrument::MANIFEST;

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
        /// O002: a file of that name is there, and nobody knows who wrote it.
        "O002" Exists {
            /// The file.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
        } at Place::file(path), = "exists, and holds something else than would be written"
            => "write elsewhere with -o, or overwrite it with --force";
        /// O006: a file of the results that are read.
        "O006" Read {
            /// The file.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
        } at Place::file(path), = "is one of the results that are read here, and would be lost"
            => "give another name with -o; without it the page is `report.html` in the folder";
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
        /// O007: results of a run that did not end.
        "O007" Unfinished {
            /// The folder.
            #[serde(serialize_with = "path_as_text")]
            path: PathBuf,
        } at Place::file(path), = "the run into this folder was broken off or is still going on, and its tables may be those of an earlier one"
            => "run it again, which keeps what is finished, or wait for its end";
    }
}

const SCHEMA: &str = "kesf.manifest/1";

/// What the names of temporary files begin with; [`LETTERS`] random ones follow.
const TEMPORARY: &str = ".kesf-";
const LETTERS: usize = 6;

/// What the names of parts end with that are being written.
const HALF: &str = ".half";

/// Writes a file under a temporary name beside it, lets the system put its bytes on the disk, and renames it: readers
/// see the old bytes or the new, also after the power has failed.
///
/// # Errors
/// [`OutputError::Write`], with nothing changed.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let failed = |source: io::Error| OutputError::Write { path: path.to_path_buf(), source };
    let mut file = temporary(path)?;
    file.write_all(bytes).map_err(failed)?;
    place(file, path)
}

/// A temporary file beside a path, to be renamed to it.
pub(super) fn temporary(path: &Path) -> Result<NamedTempFile, OutputError> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY).rand_bytes(LETTERS);
    // A temporary file is private by default; a result is as readable as any new file (less the umask).
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder
        .tempfile_in(folder)
        .map_err(|e| OutputError::Write { path: path.to_path_buf(), source: without_temporary_name(e) })
}

/// What the system said, without the name that nobody gave.
fn without_temporary_name(error: io::Error) -> io::Error {
    // The cause is in no field of what `tempfile` returns.
    let text = error.to_string();
    io::Error::new(error.kind(), text.split(" at path ").next().unwrap_or_default())
}

/// Whether a file was put in place.
static WROTE: AtomicBool = AtomicBool::new(false);

/// What is told of work that the user ends.
pub fn told_of_interruption() -> &'static str {
    if WROTE.load(Ordering::Relaxed) {
        "interrupted: what is written stays, and the same run goes on from there"
    } else {
        "interrupted: nothing was written"
    }
}

/// Lets the system put a temporary file on the disk and gives it its name.
pub(super) fn place(file: NamedTempFile, path: &Path) -> Result<(), OutputError> {
    let failed = |source: io::Error| OutputError::Write { path: path.to_path_buf(), source };
    file.as_file().sync_data().map_err(failed)?;
    file.persist(path).map_err(|e| failed(e.error))?;
    WROTE.store(true, Ordering::Relaxed);
    Ok(())
}

/// Writes a file that several programs may be making at once, such as a part of a batch that a scheduler gave away
/// twice: under a temporary name of its own, and renamed when it is whole. What programs that were killed left of the
/// same file is removed.
///
/// # Errors
/// [`OutputError::Write`], with nothing changed.
pub fn write_part(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let failed = |source: io::Error| OutputError::Write { path: path.to_path_buf(), source };
    let (folder, name) = (path.parent().unwrap_or(Path::new(".")), path.file_name().unwrap_or_default());
    let begins = format!(".{}.", name.to_string_lossy());
    fs::create_dir_all(folder).map_err(failed)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(&begins).suffix(HALF).rand_bytes(LETTERS);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder).map_err(failed)?;
    file.write_all(bytes).map_err(failed)?;
    place(file, path)?;
    for entry in fs::read_dir(folder).map_err(failed)?.flatten() {
        let other = entry.file_name();
        let other = other.to_string_lossy();
        if other.starts_with(&begins) && other.ends_with(HALF) {
            // One that cannot be removed does no harm.
            let _ = fs::remove_file(entry.path());
        }
    }
    Ok(())
}

/// Whether a name is that of a temporary file.
pub(super) fn is_temporary(name: &str) -> bool {
    let letters = name.strip_prefix(TEMPORARY);
    letters.is_some_and(|l| l.len() == LETTERS && l.bytes().all(|b| b.is_ascii_alphanumeric()))
}

/// Writes a single file unless another with other bytes is there (or `force` is set).
///
/// # Errors
/// [`OutputError::Exists`] or [`OutputError::Write`].
pub fn write_file(path: &Path, bytes: &[u8], force: bool) -> Result<(), OutputError> {
    match existing(path)? {
        Some(old) if old == bytes => Ok(()),
        Some(_) if !force => Err(OutputError::Exists { path: path.to_path_buf() }),
        _ => write_atomic(path, bytes),
    }
}

/// Whether a name stays within its folder.
pub(super) fn inside(name: &str) -> bool {
    let mut parts = Path::new(name).components().peekable();
    parts.peek().is_some() && parts.all(|c| matches!(c, Component::Normal(_)))
}

pub(super) fn existing(path: &Path) -> Result<Option<Vec<u8>>, OutputError> {
    match fs::read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(OutputError::Write { path: path.to_path_buf(), source }),
    }
}

/// SHA-256.
pub(super) fn digest(bytes: &[u8]) -> Digest32 {
    Sha256::digest(bytes).into()
}

/// SHA-256 in hexadecimal digits.
pub fn hash(bytes: &[u8]) -> String {
    hexadecimal(&digest(bytes))
}

/// `kesf.manifest/1`: what this program wrote into a folder.
#[derive(Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct Manifest {
    #[cfg_attr(test, schemars(extend("const" = "kesf.manifest/1")))]
    schema: String,
    /// Name in the folder (with `/`) and SHA-256 of what was written.
    #[cfg_attr(test, schemars(with = "std::collections::BTreeMap<Box<str>, String>"))]
    files: FileList,
}

/// The list of our files in a folder; empty where there is none.
pub(super) fn manifest(root: &Path) -> Result<FileList, OutputError> {
    let path = root.join(MANIFEST);
    match File::open(&path) {
        Ok(file) => read_manifest(file).map_err(|problem| OutputError::Manifest { path, problem }),
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(FileList::default()),
        Err(source) => Err(OutputError::Write { path, source }),
    }
}

/// Writes the list of our files; of a large folder it is long, and never in memory as a text.
pub(super) fn write_manifest(root: &Path, files: &FileList) -> Result<(), OutputError> {
    let path = root.join(MANIFEST);
    let failed = |source: io::Error| OutputError::Write { path: path.clone(), source };
    let mut file = BufWriter::new(temporary(&path)?);
    serde_json::to_writer_pretty(&mut file, &ManifestOut { schema: SCHEMA, files })
        .map_err(|e| failed(e.into()))?;
    file.write_all(b"\n").map_err(failed)?;
    place(file.into_inner().map_err(|e| failed(e.into_error()))?, &path)
}

/// [`Manifest`] as it is written.
#[derive(Serialize)]
struct ManifestOut<'f> {
    schema: &'static str,
    files: &'f FileList,
}

/// Bytes of a file, if it is there as it should be.
pub type FileBytes = Result<Option<Vec<u8>>, OutputError>;

/// Refuses to read results that a run has not finished: its tables are written last, and until then those of an earlier
/// run are there.
///
/// # Errors
/// [`OutputError::Unfinished`].
pub fn refuse_unfinished(root: &Path) -> Result<(), OutputError> {
    match files::is_file(&root.join(crate::instrument::JOURNAL)) {
        true => Err(OutputError::Unfinished { path: root.to_path_buf() }),
        false => Ok(()),
    }
}

/// A reader of the files of a results folder: the bytes of a name, if they are as this program left them.
///
/// # Errors
/// [`OutputError::Unfinished`] while a run is writing or if it was broken off, [`OutputError::Manifest`] if the list of our files is none, [`OutputError::Write`] if a file cannot be read.
pub fn results_reader(root: &Path) -> Result<impl Fn(&str) -> FileBytes, OutputError> {
    refuse_unfinished(root)?;
    let files = manifest(root)?;
    Ok(move |name: &str| match files.of(name).next().filter(|_| inside(name)) {
        Some(known) => Ok(existing(&root.join(name))?.filter(|bytes| digest(bytes) == *known)),
        None => Ok(None),
    })
}

/// Refuses to write over a file of a folder of results, but for one of this name: `kesf report p -o p/index.html` would lose
/// the page that it reads.
///
/// # Errors
/// [`OutputError::Read`], and [`OutputError::Manifest`] if the list of our files is none.
pub fn refuse_part_of(root: &Path, output: &Path, but: &str) -> Result<(), OutputError> {
    let Some((root, real)) = root.canonicalize().ok().zip(output.canonicalize().ok()) else { return Ok(()) };
    let Ok(name) = real.strip_prefix(&root) else { return Ok(()) };
    let name = name.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/");
    if name != but && manifest(&root)?.has(&name) {
        return Err(OutputError::Read { path: output.to_path_buf() });
    }
    Ok(())
}

fn read_manifest(file: File) -> Result<FileList, String> {
    let manifest: Manifest = serde_json::from_reader(BufReader::new(file)).map_err(|e| e.to_string())?;
    if manifest.schema != SCHEMA {
        return Err(format!("its schema is `{}`, not `{SCHEMA}`", manifest.schema));
    }
    Ok(manifest.files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_file_is_not_overwritten_by_other_bytes_without_force() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("curves.csv");
        write_file(&path, b"1", false).unwrap();
        write_file(&path, b"1", false).unwrap();
        assert!(matches!(write_file(&path, b"2", false), Err(OutputError::Exists { .. })));
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
