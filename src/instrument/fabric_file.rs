//! The files about a folder's data: `fabric.toml` and `dialect.toml`.

use std::path::Path;

use serde::Deserialize;

use super::conditions::StatedConditions;
use super::dialect::Dialect;
use super::error::{ReadError, ReadProblem};
use super::{FabricInfo, MeasuredResult, Origin};
use crate::finding::{Finding, Place, ReadFact, in_words, position};
use crate::platform::files;
use crate::quantity::{ArealDensity, Length};

/// `fabric.toml`: what people know of a fabric and no instrument writes.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub(crate) struct FabricFile {
    #[serde(alias = "title")]
    name: Option<String>,
    weave: Option<String>,
    composition: Option<String>,
    /// Without it, the data count as measured, and that is told.
    origin: Option<Origin>,
    source: Option<String>,
    climate: Option<String>,
    areal_density: Option<ArealDensity>,
    thickness: Option<Length>,
    notes: Vec<String>,
    conditions: StatedConditions,
    results: Vec<MeasuredResult>,
}

/// What `kesf drape-image` writes: measured results, to be laid beside the measurements of a fabric.
pub const DRAPE_FILE: &str = "drape.toml";

/// `drape.toml`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct DrapeFile {
    results: Vec<MeasuredResult>,
}

/// Whether a file holds the measured results of a drape test. A case may have the same name.
pub(crate) fn is_drape_file(path: &Path) -> bool {
    let is_named = path.file_name().is_some_and(|name| name == DRAPE_FILE);
    let table = |text: String| text.parse::<toml::Table>().ok();
    is_named && files::read_to_string(path).ok().and_then(table).is_some_and(|t| t.contains_key("results"))
}

/// The results of `drape.toml` in a folder, if it has one.
///
/// # Errors
/// `R001` and `R019`, with the position.
pub(super) fn read_drape_file(folder: &Path) -> Result<Vec<MeasuredResult>, ReadError> {
    let path = folder.join(DRAPE_FILE);
    if !files::is_file(&path) {
        return Ok(Vec::new());
    }
    let file: DrapeFile = from_toml(&path, |reason| ReadProblem::BadFabricFile { reason })?;
    Ok(file.results)
}

/// Results that cannot be compared with anything, each told with its file.
pub(super) fn unusable_results(results: &[MeasuredResult], path: &Path) -> Vec<Finding> {
    results.iter().filter_map(unusable).map(|fact| Finding::new(fact).at(Place::file(path))).collect()
}

/// What `fabric.toml` in a folder says: of the fabric, of the conditions of its tests, and what nothing can use;
/// with the results of a `drape.toml` beside it.
///
/// # Errors
/// `R001` and `R019`, with the position.
pub(super) fn read_fabric_file(
    folder: &Path,
) -> Result<(FabricInfo, StatedConditions, Vec<Finding>), ReadError> {
    let path = folder.join("fabric.toml");
    let file: FabricFile = from_toml(&path, |reason| ReadProblem::BadFabricFile { reason })?;
    let mut results = file.results;
    let mut findings = Vec::new();
    for result in read_drape_file(folder)? {
        if results.iter().any(|r| r.quantity == result.quantity) {
            let reason = Some("fabric.toml states it too, and is taken".into());
            let fact = ReadFact::Unusable { names: vec![result.quantity], reason };
            findings.push(Finding::new(fact).at(Place::file(folder.join(DRAPE_FILE))));
        } else {
            results.push(result);
        }
    }
    if file.origin.is_none() {
        findings.push(Finding::new(ReadFact::AssumedOrigin {}).at(Place::file(&path)));
    }
    let info = FabricInfo {
        title: file.name.unwrap_or_default(),
        weave: file.weave,
        composition: file.composition,
        origin: file.origin.unwrap_or_default(),
        source: file.source,
        climate: file.climate,
        areal_density: file.areal_density.map(ArealDensity::si),
        thickness: file.thickness.map(Length::si),
        notes: file.notes,
        results,
    };
    findings.extend(unusable_results(&info.results, &path));
    Ok((info, file.conditions, findings))
}

/// What keeps a measured result from being compared with anything.
fn unusable(result: &MeasuredResult) -> Option<ReadFact> {
    let reason = result.checked().err()?;
    Some(ReadFact::Unusable { names: vec![result.quantity.clone()], reason: Some(reason) })
}

/// Reads a dialect file.
///
/// # Errors
/// `R001` and `R020`, with the position.
pub fn read_dialect(path: &Path) -> Result<Dialect, ReadError> {
    from_toml(path, |reason| ReadProblem::BadDialect { reason })
}

fn from_toml<T: serde::de::DeserializeOwned>(
    path: &Path,
    problem: impl Fn(String) -> ReadProblem,
) -> Result<T, ReadError> {
    let text = files::read_to_string(path)
        .map_err(|e| ReadError::new(Place::file(path), ReadProblem::Unreadable { reason: e.to_string() }))?;
    toml::from_str(&text).map_err(|e: toml::de::Error| {
        let (line, column) = position(&text, e.span().map_or(0, |s| s.start));
        ReadError::new(Place::at(path, line, column), problem(in_words(&e)))
    })
}
