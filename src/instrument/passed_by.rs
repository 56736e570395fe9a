//! What of the inputs gives no measurement and may have been meant to: files that are passed by for their endings, folders
//! without a measurement, and links that lead nowhere.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::error::{ReadError, ReadProblem};
use super::fabric_file::is_drape_file;
use super::file_name::{ABOUT, EXTENSIONS, is_data_name};
use crate::finding::{Finding, Place, UsageFact};
use crate::platform::files;

/// Endings of what is no measurement of the instrument, whatever is in it: what is neither here nor read is judged by its
/// first bytes.
const OTHERS: &[&str] = &[
    // Pictures.
    "bmp", "eps", "gif", "heic", "ico", "jpeg", "jpg", "png", "svg", "tif", "tiff", "webp",
    // Documents.
    "bib", "doc", "docx", "eml", "epub", "md", "msg", "odg", "odp", "odt", "pdf", "ppt", "pptx", "rst", "rtf",
    "tex", // Geometry: meshes, patterns, scenes.
    "dxf", "fbx", "glb", "gltf", "inp", "mdpa", "msh", "mtl", "obj", "ply", "step", "stl", "stp", "usd",
    "usda", "usdc", "vtk", "vtp", "vtu", // Programs, their settings, and what they leave behind.
    "bat", "c", "cfg", "conf", "cpp", "css", "db", "exe", "h", "ini", "ipynb", "js", "m", "parquet", "ps1",
    "py", "r", "rs", "sh", "tmp", "toml", "ts", "yaml", "yml",
];

/// Bytes at the beginning of a file by which it is judged.
const START: usize = 4096;

/// Lines with numbers that make a text one that may hold a measurement.
const LINES: usize = 3;

/// Files that a finding names one by one.
const NAMED: usize = 3;

/// What was met beside the measurements of a group.
#[derive(Clone, Debug, Default)]
pub(super) struct Beside {
    /// Files that may hold numbers, and do not end as measurements do.
    others: Vec<PathBuf>,
    /// What could not be looked at.
    pub failures: Vec<ReadError>,
}

impl Beside {
    /// What is in a folder.
    pub fn of(paths: &[PathBuf]) -> Self {
        let mut beside = Self::default();
        beside.add(paths);
        beside
    }

    /// And what is in one below it.
    pub fn add(&mut self, paths: &[PathBuf]) {
        let dangling = paths.iter().filter(|path| leads_nowhere(path));
        self.failures
            .extend(dangling.map(|path| ReadError::new(Place::file(path), ReadProblem::DanglingLink)));
        self.others.extend(paths.iter().filter(|path| may_be_meant(path)).cloned());
    }

    /// Leaves out what this program wrote and, unless everything below is of the group, the links that are not named as
    /// measurements are: each may have led to the folder of another fabric, and is given back.
    pub fn settle(&mut self, is_whole: bool, mut is_own: impl FnMut(&Path) -> bool) -> Vec<ReadError> {
        self.others.retain(|path| !is_own(path));
        self.others.shrink_to_fit();
        let failures = std::mem::take(&mut self.failures);
        let (own, mut others): (Vec<_>, Vec<_>) =
            failures.into_iter().partition(|error| is_whole || is_data_name(&name(&error.place.path)));
        others.iter_mut().for_each(|error| error.about.fabric = Some(name(&error.place.path)));
        self.failures = own;
        others
    }

    /// Files and links that change what is said of the group.
    pub fn sources(&self) -> impl Iterator<Item = PathBuf> {
        let with_numbers = self.others.iter().filter(|path| holds_numbers(path)).cloned();
        with_numbers.chain(self.failures.iter().map(|error| error.place.path.clone()))
    }

    /// O080: in each folder, the files that hold numbers and were passed by.
    pub fn findings(&self) -> Vec<Finding> {
        let mut of_folder: BTreeMap<&Path, Vec<&PathBuf>> = BTreeMap::new();
        for path in self.others.iter().filter(|path| holds_numbers(path)) {
            of_folder.entry(path.parent().unwrap_or(Path::new("."))).or_default().push(path);
        }
        let told = of_folder.into_iter().map(|(folder, paths)| {
            let first = paths.iter().take(NAMED).map(|path| name(path)).collect();
            let fact = UsageFact::PassedBy { files: paths.len(), endings: endings(paths), first };
            Finding::new(fact).at(Place::file(folder))
        });
        told.collect()
    }
}

/// O081: a folder that looks like that of a fabric, and has no measurement; `paths` are what is in it. One with other folders
/// holds fabrics, and one with cases is none.
pub(super) fn without_measurement(folder: &Path, paths: &[PathBuf]) -> Option<Finding> {
    let (hidden, visible): (Vec<_>, Vec<_>) = paths.iter().partition(|path| is_hidden(path));
    if folder.ends_with("__MACOSX") || visible.iter().any(|path| is_something_else(path)) {
        return None;
    }
    let fact = UsageFact::NoMeasurement {
        files: visible.len(),
        endings: endings(visible),
        hidden: hidden.into_iter().filter(|path| files::is_file(path)).count(),
    };
    Some(Finding::new(fact).at(Place::file(folder)))
}

/// What is in no folder of a fabric without measurements: folders, cases, parts of a batch; and links that are told.
fn is_something_else(path: &Path) -> bool {
    let ending = lower(path.extension());
    let is_case = ending == "toml" && lower(path.file_name()) != "dialect.toml" && !is_drape_file(path);
    is_case || ending == "parquet" || files::is_folder(path) || leads_nowhere(path)
}

/// The endings of files, each once; `none` of those without.
fn endings<'p>(paths: impl IntoIterator<Item = &'p PathBuf>) -> Vec<String> {
    let all: BTreeSet<String> = paths.into_iter().map(|path| ending(path)).collect();
    all.into_iter().collect()
}

fn ending(path: &Path) -> String {
    path.extension().map_or_else(|| "none".into(), |ending| format!(".{}", lower(Some(ending))))
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn lower(part: Option<&std::ffi::OsStr>) -> String {
    part.map(|p| p.to_string_lossy().to_lowercase()).unwrap_or_default()
}

pub(super) fn is_hidden(path: &Path) -> bool {
    // `~$` is the lock file of an open workbook.
    path.file_name().is_none_or(|n| n.to_string_lossy().starts_with(['.', '~']))
}

pub(super) fn is_data(path: &Path) -> bool {
    let ending = lower(path.extension());
    // JSON is used for everything: only FAB records are ours.
    EXTENSIONS.contains(&ending.as_str())
        && !is_about(path)
        && files::is_file(path)
        && (ending != "json" || files::read(path).is_ok_and(|b| b.windows(10).any(|w| w == b"\"raw_data\"")))
}

fn is_about(path: &Path) -> bool {
    ABOUT.contains(&lower(path.file_stem()).as_str())
}

/// A link among what is visible that is neither a file nor a folder.
fn leads_nowhere(path: &Path) -> bool {
    !is_hidden(path) && files::is_link(path) && !files::exists(path)
}

/// Whether a file is no measurement by its ending, and perhaps by that alone. `~` ends what editors keep of a file.
fn may_be_meant(path: &Path) -> bool {
    let ending = lower(path.extension());
    let is_known = EXTENSIONS.contains(&ending.as_str()) || OTHERS.contains(&ending.as_str());
    !is_known && !is_hidden(path) && !is_about(path) && !name(path).ends_with('~') && files::is_file(path)
}

/// Whether a file begins as a text with lines of numbers.
fn holds_numbers(path: &Path) -> bool {
    let Ok(mut start) = files::start(path, START) else { return false };
    if start.starts_with(&[0xff, 0xfe]) || start.starts_with(&[0xfe, 0xff]) {
        // Numbers in UTF-16 are their digits with zeros between them.
        start.drain(..2);
        start.retain(|byte| *byte != 0);
    }
    if start.iter().any(|byte| *byte < b' ' && !b"\t\n\r\x0c\x1a".contains(byte)) {
        return false;
    }
    String::from_utf8_lossy(&start)
        .split(['\n', '\r'])
        .filter(|line| has_numbers(line))
        .nth(LINES - 1)
        .is_some()
}

/// Whether a line has several cells, and a third of them are numbers, as `B,gf·cm²/cm,0.1` has.
fn has_numbers(line: &str) -> bool {
    let cells = line.split([',', ';', '|', ' ', '\t']).map(|cell| cell.trim_matches('"'));
    let [mut all, mut numbers] = [0, 0];
    for cell in cells.filter(|cell| !cell.is_empty()) {
        all += 1;
        numbers += usize::from(cell.contains(|c: char| c.is_ascii_digit()) && cell.parse::<f64>().is_ok());
    }
    all > 1 && numbers > 0 && 3 * numbers >= all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_with_lines_of_numbers_may_be_a_measurement() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("record.003");
        let holds = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            holds_numbers(&path)
        };
        assert!(holds(b"strain,force\n0,0\n1,0.5\n2,1.5\n"));
        assert!(holds(
            b"parameter,unit,warp\r\nB,gf.cm2/cm,0.1\r\n2HB,gf.cm/cm,0.05\r\nG,gf/(cm.deg),0.6\r\n"
        ));
        assert!(holds("\u{feff}0;0,5\n1;0,6\n2;0,7\n".as_bytes()));
        let utf16: Vec<u8> = "\u{feff}0 1\n1 2\n2 3\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert!(holds(&utf16));
        assert!(!holds(b"") && !holds(b"0 1\n1 2\n"));
        assert!(!holds(
            b"Washed in 1998 and measured by two people.\nSo it was in 1999.\nAnd later too, but 5 times.\n"
        ));
        assert!(!holds(b"0 1\n1 2\n2 3\n\x00\x01"));
    }

    #[test]
    fn endings_of_other_kinds_are_not_looked_into() {
        let folder = tempfile::tempdir().unwrap();
        for (name, wanted) in [
            ("a.003", true),
            ("a", true),
            ("a.csv.bak", true),
            ("a.csv", false),
            ("a.csv~", false),
            (".a", false),
            ("README", false),
            ("scan.PDF", false),
            ("fabric.toml", false),
        ] {
            let path = folder.path().join(name);
            std::fs::write(&path, "0 1\n1 2\n2 3\n").unwrap();
            assert_eq!(may_be_meant(&path), wanted, "{name}");
        }
    }
}
