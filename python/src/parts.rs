//! Parts of a batch, their merge, and libraries of fabrics.

use std::path::{Path, PathBuf};

use kesf::finding::Coded;
use kesf::library::{Bounds, LibraryError, LibraryFile, Like, Question, Shelf, Stored};
use kesf::parts::{self, Merged, Part, Request, TABLES, encode, evaluate as evaluation, make};
use kesf::report::arrow::{batch, read};
use kesf::report::table::CurveRow;
use kesf::results::{Failure, Input, Job, Shard, Share, fabrics_of_curves};
use kesf::run::{Drapes, RunSettings};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::error::OrRaise;
use crate::fabric::{Options, inputs};
use crate::messages;
use crate::table::Table;
use crate::work::{Follower, follow, threads as count};

/// What is evaluated: paths, files in memory, and the columns of a table of curves.
type Batch = (Vec<PathBuf>, Vec<(PathBuf, Vec<u8>)>, Option<Curves>);

/// Columns of a table of curves, in the order of `kesf read`.
type Curves = (
    Vec<String>,
    Vec<String>,
    Vec<Option<String>>,
    Vec<u64>,
    Vec<u64>,
    Vec<f64>,
    Vec<String>,
    Vec<f64>,
    Vec<String>,
    Vec<Option<String>>,
);

/// Settings file, whether drape cases are solved, and which shard of how many is wanted, with whether the batch is all
/// of the shards'.
type Making = (Option<PathBuf>, bool, Option<(usize, usize, bool)>);

/// Results, findings and failures, and the tallies of cases as JSON; whether another evaluation could find more.
type Evaluated = (Table, Table, Table, String, bool);

/// Number and count of a shard, and the bytes of its findings, failures and results.
type Files<'py> = (usize, usize, Bound<'py, PyBytes>, Bound<'py, PyBytes>, Bound<'py, PyBytes>);

fn rows(curves: Curves) -> Vec<CurveRow> {
    let (fabric, test, direction, specimen, index, x, x_unit, y, y_unit, origin) = curves;
    let names = fabric.into_iter().zip(test).zip(direction).zip(specimen.into_iter().zip(index));
    let points = x.into_iter().zip(x_unit).zip(y.into_iter().zip(y_unit)).zip(origin);
    let row = |((((fabric, test), direction), (specimen, index)), (((x, x_unit), (y, y_unit)), origin))| {
        CurveRow { fabric, test, direction, specimen, index, x, x_unit, y, y_unit, origin }
    };
    names.zip(points).map(row).collect()
}

fn share(shard: Option<(usize, usize, bool)>) -> Result<Option<Share>, Failure> {
    shard
        .map(|(number, count, of_whole)| Ok(Share { shard: Shard::new(number, count)?, of_whole }))
        .transpose()
}

/// Characterises fabrics and solves cases for each of them.
#[pyfunction]
#[pyo3(signature = (batch, options, making, threads=None, progress=None))]
pub fn evaluate(
    py: Python<'_>,
    batch: Batch,
    options: Options,
    making: Making,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Evaluated> {
    let (paths, memory, curves) = batch;
    let (settings, drape, shard) = making;
    let follower = Follower { progress, threads };
    let (done, _) = follow(py, &follower, move |observer| {
        let mut inputs = inputs(paths, memory);
        if let Some(curves) = curves {
            let fabrics = fabrics_of_curves(&rows(curves))?;
            inputs.extend(fabrics.into_iter().map(|fabric| Input::Fabric(Box::new(fabric))));
        }
        let reading = options.reading(settings);
        let job = Job { inputs, reading, threads: count(threads), share: share(shard)?, ..Job::default() };
        evaluation(&job, &RunSettings { drapes: Drapes::asked(drape), ..RunSettings::default() }, observer)
    })?;
    let table = |made: Result<_, kesf::report::table::TableError>| {
        made.map(Table::new).map_err(Failure::from).or_raise(py)
    };
    let tables = [batch_of(&done.results), batch_of(&done.findings), batch_of(&done.failures)];
    let [results, findings, failures] = tables.map(table);
    Ok((results?, findings?, failures?, messages::json(&done.tallies)?, done.unfinished))
}

fn batch_of<R: kesf::report::table::Row>(
    rows: &[R],
) -> Result<arrow_array::RecordBatch, kesf::report::table::TableError> {
    batch(rows)
}

/// Whether the part was there already; fabrics, rows of results, of findings and of failures.
type Counts = (bool, usize, usize, usize, usize);

/// What gave something, numerical failures, and whether a check does not hold.
type Ending = (usize, usize, bool);

/// Makes the part of a shard of the inputs in a folder, unless it is there: whether it was, and how many fabrics, rows,
/// findings and failures it has.
#[pyfunction]
#[pyo3(signature = (paths, options, making, folder, force=false, fresh=false, threads=None))]
#[expect(clippy::too_many_arguments, reason = "of Python")]
pub fn make_part(
    py: Python<'_>,
    paths: Vec<PathBuf>,
    options: Options,
    making: Making,
    folder: PathBuf,
    force: bool,
    fresh: bool,
    threads: Option<usize>,
) -> PyResult<(Counts, Ending)> {
    let (settings, drape, shard) = making;
    let follower = Follower { progress: None, threads };
    let (done, _) = follow(py, &follower, move |observer| {
        let whole = share(shard)?.ok_or_else(|| Failure::new("O050", "no shard is named"))?;
        let (inputs, reading) = (inputs(paths, Vec::new()), options.reading(settings));
        let job = Job { inputs, reading, threads: count(threads), share: Some(whole), ..Job::default() };
        let settings = RunSettings { drapes: Drapes::asked(drape), fresh, ..RunSettings::default() };
        make(&Request { job: &job, settings: &settings, folder: &folder, force }, whole, observer)
    })?;
    Ok((
        (done.kept, done.fabrics, done.rows, done.findings, done.failures),
        (done.useful, done.numerical, done.fails_a_check),
    ))
}

/// The files of a part by their names, in the order of writing.
#[pyfunction]
pub fn part_files<'py>(
    py: Python<'py>,
    tables: (PyRef<'py, Table>, PyRef<'py, Table>, PyRef<'py, Table>),
    cases: &str,
    shard: (usize, usize),
    set_up: &str,
    key: &str,
) -> PyResult<Vec<(String, Bound<'py, PyBytes>)>> {
    let (findings, failures, results) = tables;
    let tables = [findings.batch().clone(), failures.batch().clone(), results.batch().clone()];
    let shard = Shard::new(shard.0, shard.1).or_raise(py)?;
    let files = encode(&tables, cases, shard, set_up, key).or_raise(py)?;
    Ok(files.into_iter().map(|(name, bytes)| (name, PyBytes::new(py, &bytes))).collect())
}

/// The key of a part by the bytes of its results; None if they are none.
#[pyfunction]
pub fn key_in(bytes: Vec<u8>) -> Option<String> {
    read(bytes.into()).ok()?.0.remove("kesf.key")
}

/// The hash of texts, and of the version of kesf.
#[pyfunction]
pub fn key_of(texts: Vec<Vec<u8>>) -> String {
    parts::key_of(texts.iter().map(Vec::as_slice))
}

/// The number of the shard, from 1, that the fabric of a folder or file belongs to.
#[pyfunction]
pub fn shard_of(path: PathBuf, count: usize) -> usize {
    kesf::results::shard_of(&path, count)
}

/// Whether all shards of one run are there; raises what is wrong.
#[pyfunction]
pub fn complete(py: Python<'_>, folder: PathBuf, shards: Vec<(usize, usize)>) -> PyResult<()> {
    let shards: Result<Vec<Shard>, Failure> = shards.into_iter().map(|(k, n)| Shard::new(k, n)).collect();
    parts::complete(&folder, &shards.or_raise(py)?).map(drop).map_err(raised).or_raise(py)
}

fn raised(error: impl Coded) -> Failure {
    Failure::from(error)
}

fn merged(folder: &Path, files: Vec<Files<'_>>) -> Result<Merged, Failure> {
    let part = |(number, count, findings, failures, results): Files<'_>| -> Result<Part, Failure> {
        let bytes = [findings, failures, results].map(|bytes| bytes.as_bytes().to_vec().into());
        Ok(Part::read(folder, Shard::new(number, count)?, bytes)?)
    };
    let parts: Vec<Part> = files.into_iter().map(part).collect::<Result<_, _>>()?;
    Ok(parts::merge(&parts)?)
}

fn table_named(name: &str) -> Result<parts::Table, Failure> {
    TABLES.into_iter().find(|table| table.name() == name).ok_or_else(|| {
        Failure::new("O050", format!("`{name}` is no table of a part"))
            .hint("take results, findings or failures")
    })
}

/// The parts of a batch as one table.
#[pyfunction]
pub fn merge(py: Python<'_>, folder: PathBuf, files: Vec<Files<'_>>, table: &str) -> PyResult<Table> {
    let pieces =
        table_named(table).and_then(|table| Ok(merged(&folder, files)?.table(table)?)).or_raise(py)?;
    Table::of_pieces(&pieces)
}

/// The same as the bytes of a Parquet file.
#[pyfunction]
pub fn merge_file<'py>(
    py: Python<'py>,
    folder: PathBuf,
    files: Vec<Files<'_>>,
    table: &str,
) -> PyResult<Bound<'py, PyBytes>> {
    let bytes =
        table_named(table).and_then(|table| Ok(merged(&folder, files)?.parquet(table)?)).or_raise(py)?;
    Ok(PyBytes::new(py, &bytes))
}

/// Results of which a library is made: a path, or a name and a table in SI.
#[derive(FromPyObject)]
pub enum Results<'py> {
    Table(String, PyRef<'py, Table>),
    Path(PathBuf),
}

/// The file of a library, how many fabrics it has, and the names of those that have no value.
#[pyfunction]
pub fn library_build<'py>(
    py: Python<'py>,
    results: Vec<Results<'py>>,
) -> PyResult<(Bound<'py, PyBytes>, usize, Vec<String>)> {
    let mut shelf = Shelf::default();
    for one in results {
        let added = match one {
            Results::Path(path) => shelf.add(&Stored(path)),
            Results::Table(name, table) => shelf.add_table(&name, table.batch()).map_err(raised),
        };
        added.or_raise(py)?;
    }
    let bytes = shelf.parquet().or_raise(py)?;
    let left_out = shelf.left_out().into_iter().map(String::from).collect();
    Ok((PyBytes::new(py, &bytes), shelf.len(), left_out))
}

/// The fabrics of a library within bounds, and what speaks against the answer; those most like a fabric of it, or one of
/// a table in SI, first. None if the fabric that is named is not in it.
#[pyfunction]
#[pyo3(signature = (library, name=None, like=None, bounds=None, count=None))]
pub fn library_find(
    py: Python<'_>,
    library: PathBuf,
    name: Option<String>,
    like: Option<PyRef<'_, Table>>,
    bounds: Option<&str>,
    count: Option<usize>,
) -> PyResult<Option<(Table, Vec<String>)>> {
    let count = Question::most(count, like.is_some() || name.is_some());
    let like = like.map(|table| Like::of_table(table.batch())).transpose().map_err(raised).or_raise(py)?;
    let answer = || -> Result<_, LibraryError> {
        let file = LibraryFile::open(&library)?;
        let bounds = bounds.map(|text| Bounds::parse(text, file.schema())).transpose()?;
        file.find(&Question { like: like.or(name.map(Like::Named)), bounds, count })
    };
    match answer() {
        Ok(answer) => {
            let warnings = answer.warnings();
            Ok(Some((Table::new(answer.table), warnings)))
        }
        Err(LibraryError::Unknown { .. }) => Ok(None),
        Err(error) => Err(raised(error)).or_raise(py),
    }
}
