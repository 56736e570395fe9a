//! Findings and failures as JSON, with the same keys: `code`, `message`, `fields`, `fabric`, `path`, `line`, `column`;
//! failures have `hint` too.

use kesf::finding::{Fields, Finding, Place};
use kesf::results::Failure;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::Serialize;

/// What was said of the work while it went on.
#[derive(Default)]
pub struct Messages {
    /// Findings, each with its fabric where its place does not say so.
    pub findings: Vec<(Option<String>, Finding)>,
    /// What gave no result.
    pub failures: Vec<Failure>,
    /// Remarks that are neither.
    pub notes: Vec<String>,
}

#[derive(Serialize)]
struct Entry<'a> {
    code: &'a str,
    message: String,
    fields: Fields,
    fabric: Option<&'a str>,
    path: Option<String>,
    line: Option<usize>,
    column: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    hint: Option<&'a str>,
}

impl<'a> Entry<'a> {
    fn of(finding: &'a Finding, fabric: Option<&'a str>) -> Self {
        let (code, message, fields) = (finding.code(), finding.message(), finding.fields());
        Self { fabric, ..Self::at(finding.place.as_ref(), code, message, fields) }
    }

    fn of_failure(failure: &'a Failure) -> Self {
        let place = failure.place.as_ref();
        let entry = Self::at(place, &failure.code, failure.message.clone(), (*failure.fields).clone());
        Self { fabric: failure.fabric.as_deref(), hint: failure.hint.as_deref(), ..entry }
    }

    fn at(place: Option<&Place>, code: &'a str, message: String, fields: Fields) -> Self {
        let known = |number: usize| (number > 0).then_some(number);
        Self {
            code,
            message,
            fields,
            fabric: None,
            path: place.map(|p| p.path.to_string_lossy().into_owned()),
            line: place.and_then(|p| known(p.line)),
            column: place.and_then(|p| known(p.column)),
            hint: None,
        }
    }
}

/// JSON of findings.
pub fn findings<'a>(all: impl IntoIterator<Item = (Option<&'a str>, &'a Finding)>) -> PyResult<String> {
    json(&all.into_iter().map(|(fabric, finding)| Entry::of(finding, fabric)).collect::<Vec<_>>())
}

/// JSON of failures.
pub fn failures<'a>(all: impl IntoIterator<Item = &'a Failure>) -> PyResult<String> {
    json(&all.into_iter().map(Entry::of_failure).collect::<Vec<_>>())
}

impl Messages {
    /// Findings, failures and notes, as JSON each.
    pub fn json(&self) -> PyResult<(String, String, String)> {
        let found = findings(self.findings.iter().map(|(fabric, finding)| (fabric.as_deref(), finding)))?;
        Ok((found, failures(&self.failures)?, json(&self.notes)?))
    }
}

/// The JSON text of a document; numbers that are not finite become `null`.
pub fn json(document: &(impl Serialize + ?Sized)) -> PyResult<String> {
    serde_json::to_string(document).map_err(|e| PyValueError::new_err(e.to_string()))
}

/// Bytes of a value that keep every number, for pickles: CBOR.
pub fn packed(value: &impl Serialize) -> PyResult<Vec<u8>> {
    let mut bytes = Vec::new();
    ciborium::into_writer(value, &mut bytes).map_err(|e| PyValueError::new_err(e.to_string()))?;
    Ok(bytes)
}

/// A value of [`packed`] bytes.
pub fn unpacked<T: serde::de::DeserializeOwned>(bytes: &[u8]) -> PyResult<T> {
    ciborium::from_reader(bytes).map_err(|e| PyValueError::new_err(e.to_string()))
}

/// Refuses the pickle of another version: its numbers might be others here.
pub fn same_version(version: &str) -> PyResult<()> {
    let own = env!("CARGO_PKG_VERSION");
    if version == own {
        return Ok(());
    }
    let text = format!(
        "the pickle was written by kesf {version} and this is {own}; make the object again from its inputs"
    );
    Err(PyValueError::new_err(text))
}
