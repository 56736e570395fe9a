//! Which names of files are those of measurements.

use std::path::Path;

/// File names that hold measurements; a folder's other files are none of ours.
pub(super) const EXTENSIONS: &[&str] = &[
    "csv", "tsv", "txt", "dat", "asc", "prn", "kes", "fb1", "fb2", "fb3", "fb4", "xlsx", "xlsm", "xls",
    "ods", "htm", "html", "zip", "json", "u3m",
];

/// Text files that are about the data.
pub(super) const ABOUT: &[&str] =
    &["readme", "license", "licence", "notes", "changelog", "citation", "copying"];

/// Whether a name, with `/` between its parts, is that of a file that may hold measurements.
pub fn is_data_name(name: &str) -> bool {
    let path = Path::new(name);
    let lower =
        |part: Option<&std::ffi::OsStr>| part.map(|p| p.to_string_lossy().to_lowercase()).unwrap_or_default();
    let hidden = name.split('/').any(|part| part.starts_with(['.', '~']) || part == "__MACOSX");
    !hidden
        && EXTENSIONS.contains(&lower(path.extension()).as_str())
        && !ABOUT.contains(&lower(path.file_stem()).as_str())
}
