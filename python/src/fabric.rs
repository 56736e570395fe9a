//! Measurements: what the readers of the library understood of a fabric.

use std::path::PathBuf;
use std::sync::Arc;

use kesf::instrument::{
    Conditions, Direction, FabricInfo, FabricInput, Inference, Library, Measurement, ResultValue, Source,
    Test,
};
use kesf::report::table::{CurveRow, UnitSystem, curve_rows, curve_units};
use kesf::results::{Failure, Input, Reading};
use pyo3::prelude::*;
use serde::Serialize;

use crate::error::OrRaise;
use crate::messages::{self, Messages};
use crate::table::Table;
use crate::work::{Follower, follow};

/// What was read of one fabric.
#[pyclass(frozen, module = "kesf._kesf")]
pub struct Fabric {
    pub input: Arc<FabricInput>,
}

/// All but the points of the curves.
#[derive(Serialize)]
struct Summary<'a> {
    name: &'a str,
    path: String,
    info: &'a FabricInfo,
    measurements: Vec<Record<'a>>,
    results: &'a [ResultValue],
    /// FAB strip tests.
    strips: usize,
    sources: &'a [Source],
    inference: &'a [Inference],
}

#[derive(Serialize)]
struct Record<'a> {
    test: Test,
    direction: Option<Direction>,
    specimen: usize,
    sample: Option<&'a str>,
    conditions: &'a Conditions,
    path: String,
    points: usize,
    units: [&'static str; 2],
    metadata: &'a std::collections::BTreeMap<String, String>,
}

impl<'a> Record<'a> {
    fn of(m: &'a Measurement) -> Self {
        Self {
            test: m.test,
            direction: m.direction,
            specimen: m.specimen,
            sample: m.sample.as_deref(),
            conditions: &m.conditions,
            path: m.source.path.to_string_lossy().into_owned(),
            points: m.curve.len(),
            units: curve_units(m.test, UnitSystem::Si).map(|(name, _)| name),
            metadata: &m.metadata,
        }
    }
}

/// The unit system of a name; the Python half knows no others.
pub fn units(name: &str) -> UnitSystem {
    if name == "kes" { UnitSystem::Kes } else { UnitSystem::Si }
}

/// Numbers as bytes, for an array of that type.
pub fn bytes_of(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_ne_bytes()).collect()
}

#[pymethods]
impl Fabric {
    /// All but the points of the curves and the findings, as JSON.
    fn summary(&self) -> PyResult<String> {
        let input = &*self.input;
        messages::json(&Summary {
            name: &input.name,
            path: input.path.to_string_lossy().into_owned(),
            info: &input.info,
            measurements: input.measurements.iter().map(Record::of).collect(),
            results: &input.results,
            strips: input.fab.iter().map(|file| file.tests.len()).sum(),
            sources: &input.sources,
            inference: &input.inference,
        })
    }

    /// Findings as JSON.
    fn findings(&self) -> PyResult<String> {
        messages::findings(self.input.findings.iter().map(|finding| (Some(&*self.input.name), finding)))
    }

    /// Abscissae and ordinates (SI) of a curve, as bytes of 64-bit numbers.
    fn curve(&self, index: usize) -> PyResult<(Vec<u8>, Vec<u8>)> {
        let measurement = self.input.measurements.get(index);
        let curve = &measurement.ok_or_else(|| pyo3::exceptions::PyIndexError::new_err(index))?.curve;
        Ok((bytes_of(&curve.x), bytes_of(&curve.y)))
    }

    fn __eq__(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.input, &other.input) || self.input == other.input
    }

    /// Everything, as bytes for a pickle.
    fn packed(&self) -> PyResult<Vec<u8>> {
        pack(&self.input)
    }

    /// The fabric of [`packed`](Self::packed) bytes.
    #[staticmethod]
    fn unpacked(version: &str, bytes: &[u8]) -> PyResult<Self> {
        messages::same_version(version)?;
        Ok(Self { input: Arc::new(unpack(bytes)?) })
    }

    /// The points of fabrics as a table; `test` and `direction` pick some.
    #[staticmethod]
    #[pyo3(signature = (fabrics, unit_system, test=None, direction=None))]
    fn curves(
        py: Python<'_>,
        fabrics: Vec<Py<Self>>,
        unit_system: &str,
        test: Option<&str>,
        direction: Option<&str>,
    ) -> PyResult<Table> {
        let chosen = |row: &CurveRow| {
            test.is_none_or(|t| row.test == t)
                && direction.is_none_or(|d| row.direction.as_deref() == Some(d))
        };
        let rows = py.detach(|| {
            let all = fabrics.iter().flat_map(|f| curve_rows(&f.get().input, units(unit_system)));
            all.filter(chosen).collect::<Vec<_>>()
        });
        Table::of(&rows)
    }
}

/// What was inferred is no part of the documents of a fabric, but it is of its pickle.
pub fn pack(input: &FabricInput) -> PyResult<Vec<u8>> {
    messages::packed(&(input, &input.inference))
}

/// The inverse of [`pack`].
pub fn unpack(bytes: &[u8]) -> PyResult<FabricInput> {
    let (input, inference): (FabricInput, Vec<Inference>) = messages::unpacked(bytes)?;
    Ok(FabricInput { inference, ..input })
}

/// How files are read where they do not say it themselves.
#[derive(FromPyObject)]
pub struct Options {
    dialect: Option<PathBuf>,
    delimiter: Option<char>,
    decimal: Option<char>,
    assume_kes_units: bool,
}

impl Options {
    /// The library's word for it; `settings` is a file.
    pub fn reading(self, settings: Option<PathBuf>) -> Reading {
        let Self { dialect, delimiter, decimal, assume_kes_units } = self;
        Reading { dialect, delimiter, decimal, assume_kes_units, settings }
    }
}

/// Inputs: files and folders by their paths, and files in memory with what stands for their names.
pub fn inputs(paths: Vec<PathBuf>, memory: Vec<(PathBuf, Vec<u8>)>) -> Vec<Input> {
    let in_memory = memory.into_iter().map(|(name, bytes)| Input::Memory { name, bytes });
    paths.into_iter().map(Input::Path).chain(in_memory).collect()
}

/// The folder or file of each fabric below the paths, with its measurement files. A folder that cannot be opened, or whose
/// `fabric.toml` or `dialect.toml` cannot be read, has what is wrong in their place: whoever evaluates it is told why.
#[pyfunction]
pub fn find(py: Python<'_>, paths: Vec<PathBuf>, options: Options) -> PyResult<Vec<(PathBuf, Vec<PathBuf>)>> {
    let settings = options.reading(None).read_settings().or_raise(py)?;
    Ok(py.detach(|| {
        let library = Library::find(&paths, &settings);
        let fabrics = library.fabrics().map(|(path, files)| (path.to_path_buf(), files.to_vec()));
        let failures = library.failures().iter().map(|error| {
            let path = &error.place.path;
            let folder = path.parent().filter(|_| path.is_file()).unwrap_or(path);
            (folder.to_path_buf(), vec![path.clone()])
        });
        fabrics.chain(failures).collect()
    }))
}

/// Reads every fabric below the paths and in memory. Fabrics, and findings and failures as JSON.
#[pyfunction]
#[pyo3(signature = (paths, memory, options, threads=None, progress=None))]
pub fn read(
    py: Python<'_>,
    paths: Vec<PathBuf>,
    memory: Vec<(PathBuf, Vec<u8>)>,
    options: Options,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Vec<Fabric>, String, String)> {
    let (inputs, reading) = (inputs(paths, memory), options.reading(None));
    let follower = Follower { progress, threads };
    let (read, messages): (_, Messages) = follow(py, &follower, move |observer| {
        let read = reading.each(&inputs, "reading", |fabric| fabric, observer)?;
        if read.done.is_empty() && read.failures.is_empty() {
            return Err(Failure::new("O055", "there is no measurement in the inputs")
                .hint("name a fabric folder or a measurement file, as in kesf.read(\"kesf_data/poplin\")"));
        }
        Ok(read)
    })?;
    let mut said = messages.findings;
    let of_fabrics =
        read.done.iter().flat_map(|f| f.findings.iter().map(|x| (Some(f.name.clone()), x.clone())));
    said.extend(of_fabrics);
    let findings = messages::findings(said.iter().map(|(fabric, finding)| (fabric.as_deref(), finding)))?;
    let failures = messages::failures(&read.failures)?;
    let fabrics = read.done.into_iter().map(|input| Fabric { input: Arc::new(input) }).collect();
    Ok((fabrics, findings, failures))
}
