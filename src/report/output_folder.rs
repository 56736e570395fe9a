//! A folder of results on disk: what this program wrote there, and nobody else's work.

use std::fs::{self, File, TryLockError};
use std::io::{self, BufRead as _, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use sha2::{Digest, Sha256};
use tempfile::NamedTempFile;

use super::file_list::is_hidden;
use super::write::{
    Digest32, FileBytes, FileList, MANIFEST, OutputError, digest, existing, from_hexadecimal, hexadecimal,
    inside, is_temporary, manifest, place, temporary, write_manifest,
};

/// What a run is writing, until its manifest is there: a line for each file, ahead of it, so that a run that was
/// killed can be repeated.
const JOURNAL: &str = crate::instrument::JOURNAL;

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
    earlier: FileList,
    written: Mutex<Written>,
    finished: bool,
}

/// What this run wrote.
#[derive(Debug)]
struct Written {
    files: FileList,
    /// Locked as long as this run lasts.
    journal: File,
}

/// A file that is being written: under a temporary name until [`commit`](Self::commit).
#[derive(Debug)]
pub struct Pending<'f> {
    folder: &'f OutputFolder,
    name: String,
    path: PathBuf,
    file: BufWriter<NamedTempFile>,
    hasher: Sha256,
}

impl OutputFolder {
    /// Opens a folder, making it if needed, and tries that it can be written to, before the long run. Temporary files
    /// of runs that were killed are removed.
    ///
    /// # Errors
    /// [`OutputError::Write`] if it cannot be made or is read-only, [`OutputError::Manifest`] if its manifest
    /// is not one (unless `force`), [`OutputError::Busy`] if another run is writing into it.
    pub fn open(root: &Path, force: bool) -> Result<Self, OutputError> {
        fs::create_dir_all(root).map_err(|source| OutputError::Write { path: root.to_path_buf(), source })?;
        drop(temporary(&root.join(MANIFEST))?);
        let mut earlier = match manifest(root) {
            Err(OutputError::Manifest { .. }) if force => FileList::default(),
            files => files?,
        };
        let (journal, is_alone) = open_journal(root, &mut earlier)?;
        if is_alone {
            remove_orphans(root, earlier.folders());
        }
        let written = Mutex::new(Written { files: FileList::default(), journal });
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
        let path = self.path(name)?;
        let new = digest(bytes);
        if self.is_new(name, &path, &new)? {
            self.announce(name, &new)?;
            let mut file = below(&path)?;
            file.write_all(bytes).map_err(|source| OutputError::Write { path: path.clone(), source })?;
            place(file, &path)?;
        }
        self.written().files.set(name, new);
        Ok(())
    }

    /// Begins a file that is written piece by piece.
    ///
    /// # Errors
    /// [`OutputError::Name`] or [`OutputError::Write`].
    pub fn create(&self, name: &str) -> Result<Pending<'_>, OutputError> {
        let path = self.path(name)?;
        let file = BufWriter::new(below(&path)?);
        Ok(Pending { folder: self, name: name.to_string(), path, file, hasher: Sha256::new() })
    }

    /// The bytes of a file, if this run or an earlier one wrote it and left it so.
    ///
    /// # Errors
    /// [`OutputError::Write`] if it cannot be read.
    pub fn read(&self, name: &str) -> FileBytes {
        if !inside(name) {
            return Ok(None);
        }
        Ok(existing(&self.root.join(name))?.filter(|bytes| self.is_ours(name, &digest(bytes))))
    }

    /// Keeps a file of an earlier run as it is, if it is as that run left it: it then counts as written by this one.
    ///
    /// # Errors
    /// [`OutputError::Write`] if it cannot be read.
    pub fn keep(&self, name: &str) -> Result<bool, OutputError> {
        let Some(bytes) = self.read(name)? else { return Ok(false) };
        self.written().files.set(name, digest(&bytes));
        Ok(true)
    }

    fn path(&self, name: &str) -> Result<PathBuf, OutputError> {
        if !inside(name) || [MANIFEST, JOURNAL].contains(&name) || name.contains('\\') {
            return Err(OutputError::Name { name: name.to_string() });
        }
        Ok(self.root.join(name))
    }

    /// Refuses files of these names that are not ours, before the long run at whose end they would be refused.
    ///
    /// # Errors
    /// Those of [`write`](Self::write).
    pub fn refuse_foreign(&self, names: &[&str]) -> Result<(), OutputError> {
        names.iter().try_for_each(|name| {
            let path = self.path(name)?;
            match existing(&path)? {
                Some(bytes) if self.is_foreign(name, &digest(&bytes)) => Err(OutputError::NotOurs { path }),
                _ => Ok(()),
            }
        })
    }

    /// Whether a file with these bytes is yet to be written.
    fn is_new(&self, name: &str, path: &Path, new: &Digest32) -> Result<bool, OutputError> {
        match existing(path)?.as_deref().map(digest) {
            Some(old) if old == *new => Ok(false),
            Some(old) if self.is_foreign(name, &old) => {
                Err(OutputError::NotOurs { path: path.to_path_buf() })
            }
            _ => Ok(true),
        }
    }

    /// Whether a file is somebody else's, and to be left as it is.
    fn is_foreign(&self, name: &str, hash: &Digest32) -> bool {
        !self.force && !self.is_ours(name, hash)
    }

    /// Whether a file is as an earlier run left it, or written by this one.
    fn is_ours(&self, name: &str, hash: &Digest32) -> bool {
        self.earlier.of(name).any(|known| known == hash)
            || self.written().files.of(name).any(|known| known == hash)
    }

    fn written(&self) -> MutexGuard<'_, Written> {
        self.written.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Notes in the journal what will be written.
    fn announce(&self, name: &str, hash: &Digest32) -> Result<(), OutputError> {
        let line = format!("{}\n", serde_json::json!([name, hexadecimal(hash)]));
        self.written()
            .journal
            .write_all(line.as_bytes())
            .map_err(|source| OutputError::Write { path: self.root.join(JOURNAL), source })
    }

    /// Whether this run wrote a file of that name.
    pub fn wrote(&self, name: &str) -> bool {
        self.written().files.has(name)
    }

    /// Writes the manifest. Returns the names that earlier runs wrote, this one did not, and are still there:
    /// left-overs that a reader of the folder should know of.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn finish(mut self) -> Result<Vec<String>, OutputError> {
        let left_over = self.settle()?;
        self.remove_journal();
        Ok(left_over)
    }

    /// Takes the journal away. What is left of it does no harm: the manifest knows the same.
    fn remove_journal(&self) {
        let _ = fs::remove_file(self.root.join(JOURNAL));
    }

    /// Writes the manifest.
    fn settle(&mut self) -> Result<Vec<String>, OutputError> {
        self.finished = true;
        let mut files = std::mem::take(&mut self.written().files);
        let mut left_over = Vec::new();
        for (name, hashes) in self.earlier.iter() {
            if files.has(&name) {
                continue;
            }
            // Of a run that was killed, the file may be as it was before or after.
            let path = self.root.join(&name);
            let now = || existing(&path).ok().flatten().map(|bytes| digest(&bytes));
            let remaining = match &hashes[..] {
                [only] => path.exists().then_some(*only),
                several => now().filter(|now| several.contains(now)),
            };
            if let Some(remaining) = remaining {
                // What is ours alone is no left-over to anybody.
                if !is_hidden(&name) {
                    left_over.push(name.clone());
                }
                files.set(&name, remaining);
            }
        }
        write_manifest(&self.root, &files)?;
        Ok(left_over)
    }
}

impl Drop for OutputFolder {
    /// A run that ends early has left files as well, and tables that may not be theirs: of one that has changed something the
    /// journal stays, which says so until the next run has ended.
    fn drop(&mut self) {
        if self.finished {
            return;
        }
        let has_changed = self.written().journal.metadata().is_ok_and(|journal| journal.len() > 0);
        if self.settle().is_ok() && !has_changed {
            self.remove_journal();
        }
    }
}

impl Write for Pending<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Pending<'_> {
    /// Gives the file its name.
    ///
    /// # Errors
    /// [`OutputError::NotOurs`] or [`OutputError::Write`]; nothing is changed then.
    pub fn commit(self) -> Result<(), OutputError> {
        let Self { folder, name, path, file, hasher } = self;
        let new: Digest32 = hasher.finalize().into();
        let failed = |e: io::IntoInnerError<BufWriter<NamedTempFile>>| OutputError::Write {
            path: path.clone(),
            source: e.into_error(),
        };
        let file = file.into_inner().map_err(failed)?;
        if folder.is_new(&name, &path, &new)? {
            folder.announce(&name, &new)?;
            place(file, &path)?;
        }
        folder.written().files.set(&name, new);
        Ok(())
    }
}

/// A temporary file beside a path, in its folder, which is made if needed.
fn below(path: &Path) -> Result<NamedTempFile, OutputError> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)
            .map_err(|source| OutputError::Write { path: folder.to_path_buf(), source })?;
    }
    temporary(path)
}

/// The journal, locked for this run, and whether the lock says that no other run writes here; what it says of files joins
/// those of the manifest.
fn open_journal(root: &Path, files: &mut FileList) -> Result<(File, bool), OutputError> {
    let path = root.join(JOURNAL);
    let failed = |source: io::Error| OutputError::Write { path: path.clone(), source };
    let mut journal = File::options().create(true).read(true).append(true).open(&path).map_err(failed)?;
    // Some network folders know no locks: two runs at once are then not noticed.
    let is_alone = match journal.try_lock() {
        Ok(()) => true,
        Err(TryLockError::WouldBlock) => return Err(OutputError::Busy { path: root.to_path_buf() }),
        Err(TryLockError::Error(_)) => false,
    };
    let mut reader = BufReader::new(&journal);
    let mut line = Vec::new();
    let mut is_cut_short = false;
    while reader.read_until(b'\n', &mut line).map_err(failed)? > 0 {
        is_cut_short = line.last() != Some(&b'\n');
        // The last line may have been cut short.
        if let Ok((name, hash)) = serde_json::from_slice::<(String, String)>(&line)
            && let Some(digest) = from_hexadecimal(&hash)
        {
            files.add(&name, digest);
        }
        line.clear();
    }
    if is_cut_short {
        // The run before was killed within a line: the next one is not to become a part of it.
        journal.write_all(b"\n").map_err(failed)?;
    }
    Ok((journal, is_alone))
}

/// Removes the temporary files that runs left which were killed: in the folder, and in those of their files.
fn remove_orphans<'a>(root: &Path, folders: impl Iterator<Item = &'a str>) {
    let inner = folders.filter(|folder| inside(folder)).map(|folder| root.join(folder));
    for folder in inner.chain([root.to_path_buf()]) {
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        for entry in entries.flatten().filter(|entry| is_temporary(&entry.file_name().to_string_lossy())) {
            // One that cannot be removed does no harm.
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests;
