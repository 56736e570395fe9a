//! Folders and files to fabrics, and batches that no bad file stops.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::about::{AboutGroup, BESIDE, about, fabric_folder, says_of_fabric, without_fabric_file};
use super::assembled::{Group, fabrics};
use super::content::ReadSettings;
use super::error::{ReadError, ReadProblem};
use super::own_results::{JOURNAL, MANIFEST, OwnResults};
use super::passed_by::{Beside, is_data, is_hidden, without_measurement};
use super::read::read;
use super::vocabulary::Vocabulary;
use super::words::normalised;
use super::{FabricInfo, FabricInput};
use crate::finding::{Finding, Place, UsageFact};
use crate::platform::{self, files};

/// The fabrics of a batch, and what could not be read.
#[derive(Clone, Debug, Default)]
pub struct FabricBatch {
    /// In name order of their folders and files.
    pub fabrics: Vec<FabricInput>,
    /// One for each file that was not read; the rest of its fabric is there.
    pub failures: Vec<ReadError>,
    /// What belongs to no fabric: results of this program that were passed by, folders without a measurement.
    pub findings: Vec<Finding>,
}

/// Files that are read by one thread: starting more takes longer.
const FEW: usize = 16;

/// The files of a batch, found and not yet read.
///
/// A folder with `fabric.toml` is a fabric; a folder without, that holds measurement files itself,
/// is one named after it, with a finding; other folders are searched, in name order, but not those of
/// results of this program. A single file belongs to the fabric of its folder or of one above it, if
/// there is a fabric.toml, and is read as that fabric with the others that are named; else it is a
/// fabric named by its sample or its stem. A result table of several fabrics makes several.
/// `dialect.toml` in a folder is tried first for its files. What this program wrote is never read, and what several inputs
/// name is read once, with a finding.
pub struct Library {
    groups: Vec<Group>,
    settings: ReadSettings,
    failures: Vec<ReadError>,
    findings: Vec<Finding>,
    own: OwnResults,
    /// True paths of the folders that are being searched, each below the one before.
    above: Vec<PathBuf>,
}

impl Library {
    /// Finds the measurement files among the inputs and below them.
    pub fn find(inputs: &[PathBuf], settings: &ReadSettings) -> Self {
        let mut library = Self {
            groups: Vec::new(),
            settings: settings.clone(),
            failures: Vec::new(),
            findings: Vec::new(),
            own: OwnResults::default(),
            above: Vec::new(),
        };
        let mut known = BTreeMap::new();
        for input in inputs {
            if files::is_folder(input) {
                walk(input, settings, &mut library);
            } else if library.own.wrote(input) {
                library
                    .findings
                    .push(Finding::new(UsageFact::OwnResults { files: 1 }).at(Place::file(input)));
            } else if says_of_fabric(input) {
                let found = input.file_name().unwrap_or_default().to_string_lossy().into_owned();
                let problem = ReadProblem::NoMeasurement { found };
                library.failures.push(ReadError::new(Place::file(input), problem));
            } else if let Some(folder) = fabric_folder(input) {
                library.add_to(folder, input, settings, &mut known);
            } else {
                library.groups.push(Group::of_files(input, vec![input.clone()]));
            }
        }
        if overlap(inputs) {
            library.leave_out_twice();
        }
        // Of a library of thousands of fabrics it knows as many folders.
        library.own = OwnResults::default();
        library.groups.shrink_to_fit();
        library
    }

    /// Leaves out what another input names too: it would count twice in every mean. What is named by its folder stays there, with
    /// the rest of its fabric.
    fn leave_out_twice(&mut self) {
        let (mut seen, mut twice) = (BTreeSet::new(), BTreeMap::new());
        let mut is_new = |path: &Path| files::canonicalize(path).map_or(true, |real| seen.insert(real));
        for named in [false, true] {
            self.groups.retain_mut(|group| {
                if group.named != named {
                    return true;
                }
                let (is_new_folder, before) = (named || is_new(&group.path), group.files.len());
                group.files.retain(|file| is_new(file));
                if group.files.len() < before {
                    twice.insert(group.path.clone(), before - group.files.len());
                }
                is_new_folder && (before == 0 || !group.files.is_empty())
            });
        }
        let told = twice.into_iter().map(|(path, files)| (Place::file(path), UsageFact::ReadOnce { files }));
        self.findings.extend(told.map(|(place, fact)| Finding::new(fact).at(place)));
        let mut said = BTreeSet::new();
        self.findings.retain(|finding| said.insert(finding.to_string()));
        self.failures.retain(|error| said.insert(error.to_string()));
    }

    /// Adds a file that was named to those of its folder that were; `known` are the folders met so far, with
    /// their groups. The error of a folder is told once.
    fn add_to(
        &mut self,
        folder: &Path,
        file: &Path,
        settings: &ReadSettings,
        known: &mut BTreeMap<PathBuf, Option<usize>>,
    ) {
        match known.get(folder) {
            Some(Some(at)) => {
                let group = &mut self.groups[*at];
                if let Err(place) = group.files.binary_search_by(|f| f.as_path().cmp(file)) {
                    group.files.insert(place, file.to_path_buf());
                    // Now it is the fabric of more than a file.
                    folder_path(folder).clone_into(&mut group.path);
                }
            }
            Some(None) => {}
            None => {
                let group = group(folder, vec![file.to_path_buf()], settings);
                known.insert(folder.to_path_buf(), group.is_ok().then_some(self.groups.len()));
                match group {
                    Ok(group) => self.groups.push(Group { path: file.to_path_buf(), named: true, ..group }),
                    Err(error) => self.failures.push(error),
                }
            }
        }
    }

    /// What belongs to no fabric: results of this program that were passed by, folders without a measurement.
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// Number of files that are to be read.
    pub fn files(&self) -> usize {
        self.groups.iter().map(|g| g.files.len()).sum()
    }

    /// The folder or file of each fabric, with the measurement files that belong to it: what can be divided among
    /// several machines. A file may turn out to hold several fabrics.
    pub fn fabrics(&self) -> impl Iterator<Item = (&Path, &[PathBuf])> {
        self.groups.iter().map(|group| (group.path.as_path(), group.files.as_slice()))
    }

    /// The folder or file of one of the [`groups`](Self::groups).
    pub fn path(&self, group: usize) -> Option<&Path> {
        self.groups.get(group).map(|group| group.path.as_path())
    }

    /// Every file that what is read of each fabric depends on, with the folder or file of the fabric: its measurements,
    /// and what is said of them beside it.
    pub fn sources(&self) -> impl Iterator<Item = (&Path, Vec<PathBuf>)> {
        self.groups.iter().map(|group| {
            let beside = group.folder().into_iter().flat_map(|folder| BESIDE.map(|name| folder.join(name)));
            let files = group.files.iter().cloned().chain(beside.filter(|file| files::is_file(file)));
            (group.path.as_path(), files.chain(group.beside.sources()).collect())
        })
    }

    /// The name of the fabric of one of the [`groups`](Self::groups) by its folder or file alone.
    pub fn name(&self, group: usize) -> Option<Cow<'_, str>> {
        self.groups.get(group).map(Group::own_name)
    }

    /// Names of the folders that are fabrics.
    pub fn names_of_folders(&self) -> impl Iterator<Item = &str> {
        self.groups.iter().filter_map(|group| group.name.as_deref())
    }

    /// Keeps the fabrics whose folder or file is wanted, by its path and the [name](Self::name) that it gives; with `alone`,
    /// nothing is said of the inputs as a whole.
    pub fn keep(&mut self, wanted: impl Fn(&Path, &str) -> bool, alone: bool) {
        self.groups.retain(|group| wanted(&group.path, &group.own_name()));
        if alone {
            self.findings.clear();
            self.failures.clear();
        }
    }

    /// Number of the folders and files that are read together.
    pub fn groups(&self) -> usize {
        self.groups.len()
    }

    /// What could not even be looked at, and belongs to none of the groups.
    pub fn failures(&self) -> &[ReadError] {
        &self.failures
    }

    /// Reads one of the [`groups`](Self::groups) (several readings give the same): its fabrics in name order, and an
    /// error for each file that was not read. `progress` is called after each file.
    pub fn read(
        &self,
        group: usize,
        progress: &(dyn Fn(&Path) + Sync),
    ) -> (Vec<FabricInput>, Vec<ReadError>) {
        self.groups
            .get(group)
            .map_or_else(Default::default, |group| group.read(&self.settings, false, progress))
    }

    /// Reads fabric by fabric, in parallel, and gives each to `work`; only what `work` returns is
    /// kept, so that memory does not grow with the library. Results are in name order, whatever
    /// the order of work, and so are the errors: one for each file that was not read.
    /// `progress` is called after each file.
    pub fn each<T: Send>(
        self,
        progress: &(dyn Fn(&Path) + Sync),
        work: impl Fn(FabricInput) -> T + Sync,
    ) -> (Vec<T>, Vec<ReadError>) {
        let few = self.files() <= FEW;
        let group = |group: &Group| {
            let (fabrics, failures) = group.read(&self.settings, few, progress);
            (fabrics.into_iter().map(&work).collect::<Vec<T>>(), failures)
        };
        // A few files are read before threads have started.
        let groups: Vec<_> =
            if few { self.groups.iter().map(group).collect() } else { platform::map(&self.groups, group) };
        let (mut all, mut failures) = (Vec::new(), self.failures);
        for (done, unread) in groups {
            all.extend(done);
            failures.extend(unread);
        }
        (all, failures)
    }
}

impl Group {
    /// Its fabrics, and what could not be read; `few` files are not worth more than this thread.
    fn read(
        &self,
        settings: &ReadSettings,
        few: bool,
        progress: &(dyn Fn(&Path) + Sync),
    ) -> (Vec<FabricInput>, Vec<ReadError>) {
        let mut failures = self.beside.failures.clone();
        let mut about = match self.about(settings) {
            Ok(about) => about,
            Err(error) => return (Vec::new(), [vec![error], failures].concat()),
        };
        about.findings.extend(self.beside.findings());
        let file = |file: &PathBuf| {
            let content = read(file, &about.settings);
            progress(file);
            content
        };
        let read: Vec<_> =
            if few { self.files.iter().map(file).collect() } else { platform::map(&self.files, file) };
        let mut contents = Vec::new();
        for content in read {
            match content {
                Ok(content) => contents.push(content),
                Err(error) => failures.push(error),
            }
        }
        failures.extend(contents.iter().flat_map(|c| c.failures.iter().cloned()));
        (fabrics(self, &about, contents), failures)
    }

    /// The folder that may say something of its data.
    fn folder(&self) -> Option<&Path> {
        if self.name.is_none() {
            None
        } else if files::is_file(&self.path) {
            fabric_folder(&self.path)
        } else {
            Some(self.path.as_path())
        }
    }

    /// What the folder says of its data, or the one above a single file.
    fn about(&self, settings: &ReadSettings) -> Result<AboutGroup, ReadError> {
        match self.folder() {
            Some(folder) => about(folder, settings),
            None => Ok(AboutGroup {
                info: FabricInfo::default(),
                settings: settings.clone(),
                findings: vec![without_fabric_file(&self.path)],
            }),
        }
    }
}

/// Whether one of the inputs is another one, or lies in it.
fn overlap(inputs: &[PathBuf]) -> bool {
    let mut real: Vec<PathBuf> = inputs.iter().filter_map(|path| files::canonicalize(path).ok()).collect();
    // What lies in a folder comes right behind it.
    real.sort();
    real.windows(2).any(|pair| pair[1].starts_with(&pair[0]))
}

/// Reads folders and files as fabrics, in parallel, and keeps them all: see [`Library`].
/// `progress` is called after each file.
pub fn read_fabrics(
    inputs: &[PathBuf],
    settings: &ReadSettings,
    progress: &(dyn Fn(&Path) + Sync),
) -> FabricBatch {
    let mut library = Library::find(inputs, settings);
    let findings = std::mem::take(&mut library.findings);
    let (fabrics, failures) = library.each(progress, |fabric| fabric);
    FabricBatch { fabrics, failures, findings }
}

/// The working directory is above every relative path, and has no text there.
fn folder_path(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, ReadError> {
    let unreadable = |e: std::io::Error| {
        ReadError::new(Place::file(folder), ReadProblem::Unreadable { reason: e.to_string() })
    };
    files::entries(folder).map_err(unreadable)
}

/// Whether a folder holds results of this program and nothing else to read: charts and tables of fabrics are none
/// themselves. One that the user names is read all the same, and one into which results were put beside measurements.
fn is_results(folder: &Path) -> bool {
    let read = |name: &&str| files::read_to_string(&folder.join(name)).ok();
    let ours: String = [MANIFEST, JOURNAL].iter().filter_map(read).collect();
    if ours.is_empty() || files::is_file(&folder.join("fabric.toml")) {
        return false;
    }
    // Both lists hold names as JSON texts, those in a folder of results with it: `"poplin/sheet.json"`.
    let is_ours = |path: &PathBuf| {
        let name = path.file_name().map(|n| n.to_string_lossy()).and_then(|n| serde_json::to_string(&n).ok());
        name.is_some_and(|n| match files::is_folder(path) {
            true => ours.contains(&format!("{}/", n.strip_suffix('"').unwrap_or(&n))),
            false => ours.contains(&n),
        })
    };
    let to_read = |p: &PathBuf| !is_hidden(p) && (files::is_folder(p) || is_data(p));
    entries(folder).is_ok_and(|all| all.iter().filter(|p| to_read(p)).all(is_ours))
}

impl Library {
    /// Takes what this program wrote out of the files of a folder, and says so.
    fn pass_by_own(&mut self, folder: &Path, files: &mut Vec<PathBuf>) {
        let before = files.len();
        files.retain(|file| !self.own.wrote(file));
        files.shrink_to_fit();
        let left_out = before - files.len();
        if left_out > 0 {
            let fact = UsageFact::OwnResults { files: left_out };
            self.findings.push(Finding::new(fact).at(Place::file(folder)));
        }
    }
}

fn walk(folder: &Path, settings: &ReadSettings, library: &mut Library) {
    // A link to a folder above would be followed without end.
    let Ok(real) = files::canonicalize(folder).map(|real| (!library.above.contains(&real)).then_some(real))
    else {
        return library.failures.extend(entries(folder).err());
    };
    let Some(real) = real else { return };
    library.above.push(real);
    search(folder, settings, library);
    library.above.pop();
}

fn search(folder: &Path, settings: &ReadSettings, library: &mut Library) {
    let paths = match entries(folder) {
        Ok(paths) => paths,
        Err(error) => return library.failures.push(error),
    };
    let mut beside = Beside::of(&paths);
    let visible = || paths.iter().filter(|p| !is_hidden(p));
    let mut files: Vec<PathBuf> = visible().filter(|p| is_data(p)).cloned().collect();
    let has_fabric_file = files::is_file(&folder.join("fabric.toml"));
    let is_whole = has_fabric_file || (files.is_empty() && holds_tests(&paths, settings));
    let mut below = Vec::new();
    if is_whole {
        // Everything below belongs to this fabric.
        let is_inner = |p: &PathBuf| !is_hidden(p) && files::is_folder(p) && !is_results(p);
        let mut folders: Vec<PathBuf> = paths.iter().filter(|p| is_inner(p)).cloned().collect();
        let mut seen = BTreeSet::from_iter(files::canonicalize(folder));
        while let Some(folder) = folders.pop() {
            if files::canonicalize(&folder).is_ok_and(|real| !seen.insert(real)) {
                continue;
            }
            match entries(&folder) {
                Ok(inner) => {
                    beside.add(&inner);
                    below.extend(inner.iter().filter(|p| !files::is_folder(p)).cloned());
                    files.extend(inner.iter().filter(|p| !is_hidden(p) && is_data(p)).cloned());
                    folders.extend(inner.into_iter().filter(is_inner));
                }
                Err(error) => beside.failures.push(error),
            }
        }
        files.sort();
    }
    if files.is_empty() && !has_fabric_file {
        library.findings.extend(without_measurement(folder, if is_whole { &below } else { &paths }));
    }
    library.pass_by_own(folder, &mut files);
    library.failures.extend(beside.settle(is_whole, |file| library.own.wrote(file)));
    if has_fabric_file || !files.is_empty() {
        match group(folder, files, settings) {
            Ok(group) => library.groups.push(Group { beside, ..group }),
            Err(error) => library.failures.extend([vec![error], beside.failures].concat()),
        }
    } else {
        library.findings.extend(beside.findings());
        library.failures.extend(beside.failures);
    }
    if !is_whole {
        for inner in visible().filter(|p| files::is_folder(p) && !is_results(p)) {
            walk(inner, settings, library);
        }
    }
}

/// Whether the folders below are those of tests, `bending` and `shear` or `FB1` and `FB2`, with the records of one fabric.
fn holds_tests(paths: &[PathBuf], settings: &ReadSettings) -> bool {
    let vocabulary = Vocabulary::new(&settings.dialects);
    let mut folders = 0;
    for folder in paths.iter().filter(|p| !is_hidden(p) && files::is_folder(p) && !is_results(p)) {
        let name = folder.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
        let instrument = normalised(&name);
        let is_instrument =
            matches!(instrument.strip_prefix("kes").unwrap_or(&instrument), "fb1" | "fb2" | "fb3" | "fb4");
        // Folders of fabrics below those of tests are theirs.
        let is_last = entries(folder)
            .is_ok_and(|inner| !inner.iter().any(|p| files::is_folder(p) && !is_hidden(p) && !is_results(p)));
        if !(is_instrument || vocabulary.test_exactly(&name).is_some())
            || !is_last
            || files::is_file(&folder.join("fabric.toml"))
        {
            return false;
        }
        folders += 1;
    }
    folders > 1
}

/// The fabric of a folder; the error of its fabric.toml or dialect.toml names it.
fn group(folder: &Path, files: Vec<PathBuf>, settings: &ReadSettings) -> Result<Group, ReadError> {
    // "." and ".." have a name only on disk.
    let real = files::canonicalize(folder_path(folder)).unwrap_or_else(|_| folder.to_path_buf());
    let name = real.file_name().map_or_else(|| "fabric".into(), |n| n.to_string_lossy().into_owned());
    match about(folder, settings) {
        Ok(_) => {
            let group = Group::of_files(folder_path(folder), files);
            Ok(Group { name: Some(name), named: false, ..group })
        }
        Err(mut error) => {
            error.about.fabric = Some(name);
            Err(error)
        }
    }
}
