//! What a folder says of the measurements in it: `fabric.toml`, `dialect.toml` and `drape.toml`.

use std::path::Path;

use super::FabricInfo;
use super::content::ReadSettings;
use super::error::ReadError;
use super::fabric_file::{
    DRAPE_FILE, is_drape_file, read_dialect, read_drape_file, read_fabric_file, unusable_results,
};
use crate::finding::{Finding, Place, ReadFact};
use crate::platform::files;

/// Files beside the measurements of a fabric that are read with them.
pub(super) const BESIDE: [&str; 3] = ["fabric.toml", "dialect.toml", DRAPE_FILE];

/// What is known of a group before its files are read. A library of thousands of groups does not keep it.
pub(super) struct AboutGroup {
    pub info: FabricInfo,
    pub settings: ReadSettings,
    pub findings: Vec<Finding>,
}

/// Whether a file is read with the measurements beside it.
pub(super) fn says_of_fabric(file: &Path) -> bool {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    (BESIDE.contains(&&*name) && name != DRAPE_FILE) || is_drape_file(file)
}

/// The folder in which a file lies, or one above it, that has a fabric.toml; on the path as it is given.
pub(super) fn fabric_folder(file: &Path) -> Option<&Path> {
    let mut folder = file.parent()?;
    while !files::is_file(&folder.join("fabric.toml")) {
        // What stands before a `..` is not above it.
        folder = folder.parent().filter(|_| !folder.ends_with(".."))?;
    }
    Some(folder)
}

pub(super) fn without_fabric_file(path: &Path) -> Finding {
    Finding::new(ReadFact::NoFabricFile {}).at(Place::file(path))
}

/// Reads what the folder says of its data.
pub(super) fn about(folder: &Path, settings: &ReadSettings) -> Result<AboutGroup, ReadError> {
    let mut settings = settings.clone();
    let dialect = folder.join("dialect.toml");
    if files::is_file(&dialect) {
        settings.dialects.insert(0, read_dialect(&dialect)?);
    }
    if !files::is_file(&folder.join("fabric.toml")) {
        // A case may have the name of the file as well, where there is no fabric.toml.
        let drape = folder.join(DRAPE_FILE);
        let results = if is_drape_file(&drape) { read_drape_file(folder)? } else { Vec::new() };
        let mut findings = vec![without_fabric_file(folder)];
        findings.extend(unusable_results(&results, &drape));
        let info = FabricInfo { results, ..FabricInfo::default() };
        return Ok(AboutGroup { info, settings, findings });
    }
    let (info, conditions, findings) = read_fabric_file(folder)?;
    settings.conditions = conditions.or(&settings.conditions);
    Ok(AboutGroup { info, settings, findings })
}
