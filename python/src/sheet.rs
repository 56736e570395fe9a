//! Sheets: the parameters of fabrics.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use kesf::characterise::{Branch, FabricSheet, Modulus, Settings, characterise as evaluate, mean_branches};
use kesf::finding::Finding;
use kesf::instrument::{Direction, FabricInput, Parameter, Test};
use kesf::report::chart;
use kesf::report::json::{sheet_document, text};
use kesf::report::read_back::{self, ReadDocument};
use kesf::report::table::{UnitSystem, Values, curve_units, fabric_rows};
use kesf::results::{Fabric as Evaluated, Failure, Reading, distinguish_fabrics};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::json;

use crate::error::OrRaise;
use crate::fabric::{self, Fabric, units};
use crate::messages;
use crate::table::{Column, Table};
use crate::work::{Follower, follow, free};

/// What a sheet was made of: enough to make it again to the last digit.
#[derive(Clone)]
enum Made {
    /// Of measurements; with the findings of a new name, where it got one.
    Measured { input: Arc<FabricInput>, how: How, name: String, renamed: Vec<Finding> },
    /// Of a document `kesf.sheet/1`.
    Written { text: String },
}

/// How curves are evaluated.
#[derive(Clone, Default)]
pub struct How {
    /// Name and text of a settings file.
    settings: Option<(PathBuf, String)>,
    /// Moduli beside those of the settings.
    moduli: Vec<String>,
}

impl How {
    fn settings(&self) -> Result<Settings, Failure> {
        let mut settings = match &self.settings {
            Some((path, text)) => Reading::evaluation_of(path, text)?,
            None => Settings::default(),
        };
        for modulus in &self.moduli {
            let modulus = self::modulus(modulus)?;
            if !settings.moduli.contains(&modulus) {
                settings.moduli.push(modulus);
            }
        }
        Ok(settings)
    }
}

fn modulus(text: &str) -> Result<Modulus, Failure> {
    text.parse().map_err(|error| Failure::new("O050", format!("the modulus cannot be used: {error}")))
}

/// The parameters of a fabric.
#[pyclass(frozen, module = "kesf._kesf")]
#[derive(Clone)]
pub struct Sheet {
    made: Made,
    evaluated: Arc<Evaluated>,
}

impl Sheet {
    fn measured(input: Arc<FabricInput>, how: &How, settings: &Settings) -> Self {
        let sheet = evaluate(&input, settings);
        let (path, name) = (input.path.clone(), sheet.name.clone());
        let made = Made::Measured { input, how: how.clone(), name, renamed: Vec::new() };
        Self { made, evaluated: Arc::new(Evaluated::of_sheet(path, sheet)) }
    }

    fn written(text: String) -> Result<Vec<Self>, Failure> {
        let document = read_back::read(text.as_bytes())?;
        let Some(ReadDocument::Sheets(sheets)) = document else {
            return Err(Failure::new("O042", "the document is no kesf.sheet/1")
                .hint("give what Sheet.to_json() or `kesf characterise -o sheet.json` wrote"));
        };
        let made = Made::Written { text };
        let with_origin = |sheet| Self {
            made: made.clone(),
            evaluated: Arc::new(Evaluated::of_sheet(PathBuf::new(), sheet)),
        };
        Ok(sheets.into_iter().map(with_origin).collect())
    }

    /// The sheet with its path.
    pub fn fabric(&self) -> &Arc<Evaluated> {
        &self.evaluated
    }

    /// The sheet with a modulus that it was not made with; one of a document has what it has.
    pub fn with_modulus(&self, modulus: Modulus) -> Result<Arc<Evaluated>, Failure> {
        let Made::Measured { input, how, name, renamed } = &self.made else {
            return Ok(Arc::clone(&self.evaluated));
        };
        if self.evaluated.sheet.settings.moduli.contains(&modulus) {
            return Ok(Arc::clone(&self.evaluated));
        }
        let mut how = how.clone();
        how.moduli.push(modulus.to_string());
        let mut sheet = evaluate(input, &how.settings()?);
        sheet.name.clone_from(name);
        sheet.findings.extend(renamed.iter().cloned());
        Ok(Arc::new(Evaluated::of_sheet(input.path.clone(), sheet)))
    }

    fn sheet(&self) -> &FabricSheet {
        &self.evaluated.sheet
    }
}

/// The test of a name.
fn test(name: &str) -> PyResult<Test> {
    Test::ALL.into_iter().find(|test| test.name() == name).ok_or_else(|| {
        let known: Vec<&str> = Test::ALL.iter().map(|test| test.name()).collect();
        PyValueError::new_err(format!("`{name}` is no test; there are {}", known.join(", ")))
    })
}

#[pymethods]
impl Sheet {
    /// The document `kesf.sheet/1`.
    fn document(&self) -> PyResult<String> {
        let sheet = self.sheet();
        text(&sheet_document([sheet], Some(&sheet.settings)))
            .map_err(|e| PyValueError::new_err(e.to_string()))
    }

    /// What is known of the fabric beside its parameters, as JSON.
    fn info(&self) -> PyResult<String> {
        messages::json(&self.sheet().info)
    }

    /// Findings as JSON.
    fn findings(&self) -> PyResult<String> {
        messages::findings(self.sheet().findings.iter().map(|finding| (None, finding)))
    }

    /// The folder or file; empty for a sheet of a document.
    #[getter]
    fn path(&self) -> PathBuf {
        self.evaluated.path.clone()
    }

    /// What the chart of a test shows, as JSON (SI): specimens with their branches, the mean branches, units.
    fn curves(&self, name: &str) -> PyResult<String> {
        let (test, sheet) = (test(name)?, self.sheet());
        let specimens: Vec<_> = sheet.specimens.iter().filter(|s| s.measurement.test == test).collect();
        let specimens = specimens.iter().map(|s| {
            // A record without branches is drawn as it is.
            let raw = Branch { cycle: 0, outgoing: true, curve: s.measurement.curve.clone() };
            let branches = if s.branches.is_empty() { std::slice::from_ref(&raw) } else { &s.branches[..] };
            json!({
                "direction": s.measurement.direction,
                "specimen": s.measurement.specimen,
                "branches": branches,
                "windows": s.windows,
                "values": s.values,
            })
        });
        messages::json(&json!({
            "units": curve_units(test, UnitSystem::Kes).map(|(name, _)| name),
            "factors": curve_units(test, UnitSystem::Kes).map(|(_, factor)| factor),
            "specimens": specimens.collect::<Vec<_>>(),
            "mean": mean_branches(sheet, test),
        }))
    }

    /// The PNG chart of a test, as `kesf run` writes it.
    fn chart(&self, py: Python<'_>, name: &str) -> PyResult<Vec<u8>> {
        let (test, sheet) = (test(name)?, self.sheet());
        py.detach(|| chart::of_test(sheet, test, &[]).and_then(|chart| chart.png())).or_raise(py)
    }

    fn __eq__(&self, other: &Self) -> bool {
        let (a, b) = (&self.evaluated, &other.evaluated);
        Arc::ptr_eq(a, b) || (a.path == b.path && a.sheet == b.sheet)
    }

    /// What the sheet was made of, as bytes for a pickle.
    pub fn packed(&self) -> PyResult<Vec<u8>> {
        match &self.made {
            Made::Measured { input, how, name, renamed } => messages::packed(&(
                Some((fabric::pack(input)?, &how.settings, &how.moduli, name, renamed)),
                "",
            )),
            Made::Written { text } => messages::packed(&(None::<()>, (text, &self.sheet().name))),
        }
    }

    /// The sheet of [`packed`](Self::packed) bytes: it is made again, of the same measurements.
    #[staticmethod]
    pub fn unpacked(py: Python<'_>, version: &str, bytes: &[u8]) -> PyResult<Self> {
        type Measured = (Vec<u8>, Option<(PathBuf, String)>, Vec<String>, String, Vec<Finding>);
        messages::same_version(version)?;
        let (measured, written): (Option<Measured>, ciborium::Value) = messages::unpacked(bytes)?;
        let Some((input, settings, moduli, name, renamed)) = measured else {
            let (text, name): (String, String) =
                written.deserialized().map_err(|e| PyValueError::new_err(e.to_string()))?;
            let mut sheets = Self::written(text).or_raise(py)?.into_iter();
            return sheets
                .find(|sheet| sheet.sheet().name == name)
                .ok_or_else(|| PyValueError::new_err(format!("the pickle has no fabric {name}")));
        };
        let input = Arc::new(fabric::unpack(&input)?);
        let how = How { settings, moduli };
        let sheet = free(py, 1, || Ok(Self::measured(input, &how, &how.settings()?)))?;
        Ok(sheet.named(name, renamed))
    }

    /// The sheets of a document `kesf.sheet/1`.
    #[staticmethod]
    fn of_document(py: Python<'_>, text: String) -> PyResult<Vec<Self>> {
        Self::written(text).or_raise(py)
    }

    /// The parameters of sheets as a table, a row each.
    #[staticmethod]
    fn parameters(py: Python<'_>, sheets: Vec<Py<Self>>, unit_system: &str) -> PyResult<Table> {
        let rows = py.detach(|| {
            sheets.iter().flat_map(|s| fabric_rows(s.get().sheet(), units(unit_system))).collect::<Vec<_>>()
        });
        Table::of(&rows)
    }

    /// The parameters of sheets as a table, a fabric a row and a parameter in a direction a column.
    #[staticmethod]
    fn wide(py: Python<'_>, sheets: Vec<Py<Self>>, unit_system: &str) -> PyResult<Table> {
        let columns = py.detach(|| {
            let sheets: Vec<&FabricSheet> = sheets.iter().map(|s| s.get().sheet()).collect();
            wide(&sheets, units(unit_system))
        });
        Table::of_columns(columns)
    }
}

impl Sheet {
    fn named(mut self, name: String, new: Vec<Finding>) -> Self {
        let path = self.evaluated.path.clone();
        let mut sheet = self.evaluated.sheet.clone();
        sheet.name.clone_from(&name);
        sheet.findings.extend(new.iter().cloned());
        if let Made::Measured { name: own, renamed, .. } = &mut self.made {
            (*own, *renamed) = (name, new);
        }
        Self { evaluated: Arc::new(Evaluated::of_sheet(path, sheet)), ..self }
    }
}

/// The values of a sheet by parameter and direction.
type Cells = HashMap<(String, Option<String>), Cell>;

/// A value of a sheet.
struct Cell {
    mean: Option<f64>,
    unit: String,
    status: String,
}

/// Columns `B_warp`, `T0`, `E_secant_weft` ...: those that any of the sheets has, each with its status behind it
/// (`B_warp_status`), as in libraries of fabrics; then the origin.
fn wide(sheets: &[&FabricSheet], units: UnitSystem) -> Vec<Column> {
    let name = sheets.iter().map(|s| Some(s.name.clone())).collect();
    let mut columns =
        vec![Column { name: "fabric".into(), values: Values::Text(name), metadata: HashMap::new() }];
    let rows: Vec<Cells> = sheets
        .iter()
        .map(|s| {
            fabric_rows(s, units)
                .into_iter()
                .map(|r| ((r.parameter, r.direction), Cell { mean: r.mean, unit: r.unit, status: r.status }))
                .collect()
        })
        .collect();
    for (parameter, direction) in keys(sheets) {
        let key = (parameter, direction.map(|d| d.name().to_string()));
        let cells: Vec<Option<&Cell>> = rows.iter().map(|row| row.get(&key)).collect();
        let Some(unit) = cells.iter().find_map(|cell| Some(cell.as_ref()?.unit.clone())) else {
            continue;
        };
        let words = [Some(key.0.replace(' ', "_")), key.1];
        let name = words.into_iter().flatten().collect::<Vec<_>>().join("_");
        let status = Column {
            name: format!("{name}_status"),
            values: Values::Text(
                cells.iter().map(|cell| Some(cell.filter(|c| c.mean.is_some())?.status.clone())).collect(),
            ),
            metadata: HashMap::new(),
        };
        let mean = Column {
            name,
            values: Values::Number(cells.iter().map(|cell| cell.as_ref()?.mean).collect()),
            metadata: HashMap::from([("unit".into(), unit)]),
        };
        columns.extend([mean, status]);
    }
    let origins = sheets.iter().map(|s| Some(s.info.origin.name().into())).collect();
    columns.push(Column { name: "origin".into(), values: Values::Text(origins), metadata: HashMap::new() });
    columns
}

/// Every parameter and modulus in every direction, in the order of tables.
fn keys(sheets: &[&FabricSheet]) -> Vec<(String, Option<Direction>)> {
    let directions = || [None].into_iter().chain(Direction::ALL.into_iter().map(Some));
    let parameters = Parameter::ALL.iter().flat_map(|p| directions().map(|d| (p.symbol().to_string(), d)));
    let mut moduli: Vec<&String> =
        sheets.iter().flat_map(|s| s.moduli.keys().map(|(name, _)| name)).collect();
    moduli.sort();
    moduli.dedup();
    let moduli = moduli.into_iter().flat_map(|m| directions().map(move |d| (format!("E {m}"), d)));
    parameters.chain(moduli).collect()
}

/// The sheets of fabrics, each with a name of its own, as `kesf characterise` gives them.
#[pyfunction]
#[pyo3(signature = (fabrics, settings=None, moduli=Vec::new(), threads=None, progress=None))]
pub fn characterise(
    py: Python<'_>,
    fabrics: Vec<Py<Fabric>>,
    settings: Option<(PathBuf, String)>,
    moduli: Vec<String>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Vec<Sheet>> {
    let how = How { settings, moduli };
    let inputs: Vec<Arc<FabricInput>> = fabrics.iter().map(|f| Arc::clone(&f.get().input)).collect();
    let follower = Follower { progress, threads };
    let (sheets, _) = follow(py, &follower, move |observer| {
        let settings = how.settings()?;
        (observer.event)(kesf::results::Event::Started("characterising", inputs.len()));
        let sheet = |input: Arc<FabricInput>| {
            if (observer.cancelled)() {
                return None;
            }
            let sheet = Sheet::measured(input, &how, &settings);
            (observer.event)(kesf::results::Event::Step);
            Some(sheet)
        };
        let sheets = kesf::platform::map_several(inputs, sheet).into_iter().collect::<Option<Vec<_>>>();
        (observer.event)(kesf::results::Event::Finished);
        sheets.map(distinguished).ok_or_else(Failure::interrupted)
    })?;
    Ok(sheets)
}

/// The sheets with names that no two share.
fn distinguished(sheets: Vec<Sheet>) -> Vec<Sheet> {
    let mut named: Vec<Evaluated> = sheets
        .iter()
        .map(|s| {
            let sheet = FabricSheet { name: s.sheet().name.clone(), ..FabricSheet::default() };
            Evaluated::of_sheet(s.evaluated.path.clone(), sheet)
        })
        .collect();
    distinguish_fabrics(&mut named);
    let renamed = |(sheet, named): (Sheet, Evaluated)| {
        if named.sheet.findings.is_empty() {
            sheet
        } else {
            sheet.named(named.sheet.name, named.sheet.findings)
        }
    };
    sheets.into_iter().zip(named).map(renamed).collect()
}
