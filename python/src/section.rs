//! Shell sections, and the material cards of other programs that are made of them.

use std::path::PathBuf;
use std::sync::Arc;

use kesf::constitutive::{Assumptions, section};
use kesf::finding::Place;
use kesf::law::Mode;
use kesf::report::cards::{EXPORTERS, named};
use kesf::report::json::{section_document, text};
use kesf::report::read_back::{self, ReadDocument};
use kesf::results::{FabricCard, Failure, Sectioned, cards};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error::OrRaise;
use crate::messages;
use crate::sheet::Sheet;
use crate::work::{Follower, follow, free};

/// What a section was made of.
enum Made {
    /// Of a sheet and of assumptions (JSON).
    Assumed { sheet: Sheet, assumptions: String },
    /// Of a document `kesf.section/1`.
    Written { text: String },
}

/// The section of a fabric.
#[pyclass(frozen, module = "kesf._kesf")]
pub struct Section {
    made: Made,
    sectioned: Arc<Sectioned>,
}

impl Section {
    /// The section with its sheet.
    pub fn sectioned(&self) -> &Arc<Sectioned> {
        &self.sectioned
    }

    fn of_sheet(sheet: Sheet, text: String) -> Result<Self, Failure> {
        let assumed = assumed(&text)?;
        let fabric = sheet.with_modulus(assumed.modulus)?;
        let made = section(&fabric.sheet, &assumed).map_err(|error| {
            let failure = Failure::of_fabric(error, &fabric.sheet.name);
            if fabric.path.as_os_str().is_empty() { failure } else { failure.at(Place::file(&fabric.path)) }
        })?;
        let sectioned = Sectioned { path: fabric.path.clone(), sheet: fabric.sheet.clone(), made };
        Ok(Self { made: Made::Assumed { sheet, assumptions: text }, sectioned: Arc::new(sectioned) })
    }

    fn written(text: &str) -> Result<Vec<Self>, Failure> {
        let Some(ReadDocument::Sections(sections)) = read_back::read(text.as_bytes())? else {
            return Err(Failure::new("O042", "the document is no kesf.section/1")
                .hint("give what Section.to_json() or `kesf section -o section.json` wrote"));
        };
        let with_text = |(sheet, made)| {
            let sectioned = Sectioned { path: PathBuf::new(), sheet, made };
            Self { made: Made::Written { text: text.to_string() }, sectioned: Arc::new(sectioned) }
        };
        Ok(sections.into_iter().map(with_text).collect())
    }
}

/// The choices of a JSON object with the keys of `[assumptions]` of a case.
fn assumed(text: &str) -> Result<Assumptions, Failure> {
    let assumptions: Assumptions = serde_json::from_str(text).map_err(|error| {
        // What the parser says of the place is about a text that nobody wrote.
        let text = error.to_string();
        let reason = text.split(" at line ").next().unwrap_or_default();
        Failure::new("O050", format!("the assumptions cannot be used: {reason}"))
            .hint("the keys and choices are those of [assumptions] in a case")
    })?;
    if assumptions.law == Mode::Elastic && assumptions.residual_curvature.is_some() {
        return Err(Failure::new("O050", "residual_curvature belongs to friction".to_string())
            .hint("add law=\"friction\", or leave it out"));
    }
    Ok(assumptions)
}

#[pymethods]
impl Section {
    /// The section of a sheet with assumptions, a JSON object with the keys of `[assumptions]`.
    #[staticmethod]
    fn of(py: Python<'_>, sheet: &Sheet, assumptions: String) -> PyResult<Self> {
        let sheet = sheet.clone();
        free(py, 1, || Self::of_sheet(sheet, assumptions))
    }

    /// The sections of a document `kesf.section/1`.
    #[staticmethod]
    fn of_document(py: Python<'_>, text: &str) -> PyResult<Vec<Self>> {
        Self::written(text).or_raise(py)
    }

    /// The document `kesf.section/1`.
    fn document(&self) -> PyResult<String> {
        let Sectioned { sheet, made, .. } = &*self.sectioned;
        text(&section_document([(sheet, made)])).map_err(|e| PyValueError::new_err(e.to_string()))
    }

    /// Findings of the section as JSON; those of the sheet are the sheet's.
    fn findings(&self) -> PyResult<String> {
        messages::findings(self.sectioned.made.findings.iter().map(|finding| (None, finding)))
    }

    /// Whether bending and shear have friction.
    #[getter]
    fn has_law(&self) -> bool {
        self.sectioned.made.law.is_some()
    }

    fn __eq__(&self, other: &Self) -> bool {
        let (a, b) = (&*self.sectioned, &*other.sectioned);
        std::ptr::eq(a, b) || (a.path == b.path && a.sheet == b.sheet && a.made == b.made)
    }

    /// What the section was made of, as bytes for a pickle.
    fn packed(&self) -> PyResult<Vec<u8>> {
        match &self.made {
            Made::Assumed { sheet, assumptions } => messages::packed(&(Some(sheet.packed()?), assumptions)),
            Made::Written { text } => {
                messages::packed(&(None::<Vec<u8>>, (text, &self.sectioned.sheet.name)))
            }
        }
    }

    /// The section of [`packed`](Self::packed) bytes: it is made again, of the same sheet.
    #[staticmethod]
    fn unpacked(py: Python<'_>, version: &str, bytes: &[u8]) -> PyResult<Self> {
        messages::same_version(version)?;
        let (sheet, rest): (Option<Vec<u8>>, ciborium::Value) = messages::unpacked(bytes)?;
        let broken = |e: ciborium::value::Error| PyValueError::new_err(e.to_string());
        if let Some(sheet) = sheet {
            let sheet = Sheet::unpacked(py, version, &sheet)?;
            return Self::of(py, &sheet, rest.deserialized().map_err(broken)?);
        }
        let (text, name): (String, String) = rest.deserialized().map_err(broken)?;
        let sections = Self::written(&text).or_raise(py)?;
        sections
            .into_iter()
            .find(|section| section.sectioned.sheet.name == name)
            .ok_or_else(|| PyValueError::new_err(format!("the pickle has no fabric {name}")))
    }
}

/// The material card of a section for another program: its text and findings as JSON.
#[pyfunction]
pub fn export(py: Python<'_>, section: &Section, to: &str) -> PyResult<(String, String)> {
    let target = named(to).ok_or_else(|| {
        let names: Vec<_> = EXPORTERS.iter().map(|target| target.name).collect();
        Failure::new("O050", format!("`{to}` is no program that fabrics are exported to"))
            .hint(format!("take one of {}", names.join(", ")))
    });
    let (target, sectioned) = (target.or_raise(py)?, Arc::clone(section.sectioned()));
    let follower = Follower { progress: None, threads: Some(1) };
    let (card, messages) = follow(py, &follower, move |observer| {
        let (cards, failures) = cards(std::slice::from_ref(&*sectioned), &[target], None, observer);
        match (cards.into_iter().next(), failures.into_iter().next()) {
            (Some(FabricCard { text, .. }), _) => Ok(text),
            (None, failure) => Err(failure.unwrap_or_else(Failure::interrupted)),
        }
    })?;
    let findings = messages::findings(messages.findings.iter().map(|(fabric, f)| (fabric.as_deref(), f)))?;
    Ok((card, findings))
}

/// Name, ending of files, title and what it holds, of every program that fabrics are exported to.
#[pyfunction]
pub fn targets() -> Vec<(&'static str, &'static str, &'static str, &'static str)> {
    EXPORTERS.iter().map(|target| (target.name, target.ending, target.title, target.holds)).collect()
}
