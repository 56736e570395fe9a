//! A library of results.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use arrow_array::{Array, ArrayRef, Float64Array, RecordBatch, StringArray};
use arrow_schema::{DataType, Field, Schema};

use super::error::LibraryError;
use super::file::LAYOUT;
use super::space::{column, status_column};
use crate::kes::{Direction, Parameter, ValueStatus};
use crate::parts::{Table, merge_folder};
use crate::platform::files;
use crate::report::arrow::{Metadata, UNIT, read, write_pieces};
use crate::report::number::counted;
use crate::report::table::{FabricRow, TableError, UnitSystem, in_unit};
use crate::report::write::refuse_unfinished;
use crate::results::Failure;

/// Names that people use, and what they stand for.
const NAMES: [(&str, &str); 2] = [("thickness", "T0"), ("mass", "W")];

/// Columns of a table of parameters.
const OF_RUN: [&str; 5] = ["fabric", "parameter", "direction", "mean", "unit"];

/// Rows of a row group: what an answer reads at once.
const GROUP: usize = 1 << 16;

/// Fabrics without values that are named; of others only the number is told.
const NAMED: usize = 3;

/// Results that are on disk: a folder of `kesf run`, a folder of its shards, a part, or a merged table.
#[derive(Clone, Debug)]
pub struct Stored(pub PathBuf);

/// The fabrics of a library while it is filled, with their values in KES units.
#[derive(Debug, Default)]
pub struct Shelf {
    /// Place of a fabric, and the results that it came from.
    fabrics: HashMap<String, (usize, usize)>,
    names: Vec<String>,
    /// Where the data of each come from; nothing where the results do not say it, as those of earlier versions.
    origins: Vec<Option<String>>,
    /// Values by column: in the order of parameters, directions, and moduli after them.
    columns: BTreeMap<Order, Filled>,
    /// What was added, for messages.
    results: Vec<String>,
    /// Fabrics of which there is a row without a value that a library has.
    without: BTreeSet<String>,
}

/// Place of a column among the others: parameter, name of a modulus, direction.
type Order = (usize, String, usize);

#[derive(Debug)]
struct Filled {
    name: String,
    unit: &'static str,
    /// Not a number where there is none.
    values: Vec<f64>,
    /// How each of them was had.
    statuses: Vec<ValueStatus>,
}

impl Shelf {
    /// Refuses the name of a library that says it is something else than Parquet, before the results are read.
    ///
    /// # Errors
    /// O050.
    pub fn refuse_ending(path: &Path) -> Result<(), LibraryError> {
        const OTHERS: [&str; 5] = ["csv", "tsv", "json", "txt", "xlsx"];
        let ending = path.extension().unwrap_or(OsStr::new(""));
        if OTHERS.iter().any(|other| ending.eq_ignore_ascii_case(other)) {
            return Err(LibraryError::Ending { path: path.to_path_buf() });
        }
        Ok(())
    }

    /// Adds the fabrics of results on disk.
    ///
    /// # Errors
    /// O069 for what is none, O068 if a fabric is there already, and those of [`merge_folder`].
    pub fn add(&mut self, results: &Stored) -> Result<(), Failure> {
        let path = &results.0;
        let rows = results.rows()?;
        Ok(self.add_rows(&path.to_string_lossy(), path, &rows)?)
    }

    /// Adds parameters in SI, as `fabrics.csv` has them; `name` stands for them in messages.
    ///
    /// # Errors
    /// O068 if a fabric is there already, O069 for a parameter in another unit.
    pub fn add_rows(&mut self, name: &str, path: &Path, rows: &[FabricRow]) -> Result<(), LibraryError> {
        self.results.push(name.to_string());
        let number = self.results.len() - 1;
        for row in rows {
            let Some((value, (order, (unit, factor), si))) = row.mean.zip(place_of(row)) else {
                self.without.insert(row.fabric.clone());
                continue;
            };
            let refused = |problem: String| LibraryError::Results { path: path.to_path_buf(), problem };
            if row.unit != si {
                let (fabric, unit) = (&row.fabric, &row.unit);
                return Err(refused(format!(
                    "{fabric} has {} in {unit} where {si} was expected",
                    row.parameter
                )));
            }
            let at = self.fabric(&row.fabric, number, path)?;
            self.origins[at] = row.origin.clone().or_else(|| self.origins[at].take());
            let name = || column(&row.parameter, row.direction.as_deref());
            let filled = self.columns.entry(order).or_insert_with(|| Filled {
                name: name(),
                unit,
                values: Vec::new(),
                statuses: Vec::new(),
            });
            let length = filled.values.len().max(at + 1);
            filled.values.resize(length, f64::NAN);
            filled.values[at] = in_unit(value, factor);
            filled.statuses.resize(length, ValueStatus::Measured);
            // Results of early versions do not say it, and those of today say it of every value.
            filled.statuses[at] = ValueStatus::from_name(&row.status).unwrap_or_default();
        }
        Ok(())
    }

    /// Adds parameters in SI that are in memory: rows of results or of parameters.
    ///
    /// # Errors
    /// Those of [`add_rows`](Self::add_rows), and O069 for another table.
    pub fn add_table(&mut self, name: &str, table: &RecordBatch) -> Result<(), LibraryError> {
        self.add_rows(name, Path::new(name), &rows_of_parameters(name, table)?)
    }

    fn fabric(&mut self, name: &str, results: usize, path: &Path) -> Result<usize, LibraryError> {
        match self.fabrics.get(name) {
            Some((at, of)) if *of == results => Ok(*at),
            Some((_, of)) => Err(LibraryError::Twice {
                path: path.to_path_buf(),
                fabric: name.into(),
                other: self.results[*of].clone(),
            }),
            None => {
                self.names.push(name.into());
                self.origins.push(None);
                self.fabrics.insert(name.into(), (self.names.len() - 1, results));
                Ok(self.names.len() - 1)
            }
        }
    }

    /// Number of fabrics.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// Names of the fabrics of the results of which no value is in the library, in their order.
    pub fn left_out(&self) -> Vec<&str> {
        let names = self.without.iter().filter(|name| !name.is_empty() && !self.fabrics.contains_key(*name));
        names.map(String::as_str).collect()
    }

    /// How many fabrics there are, and which are left out.
    pub fn sentence(&self) -> String {
        let (fabrics, left_out) = (counted(self.len(), "fabric"), self.left_out());
        let named = left_out[..left_out.len().min(NAMED)].join(", ");
        match left_out.len() {
            0 => fabrics,
            1 => format!("{fabrics}; {named} is left out, as it has no KES value"),
            n @ 2..=NAMED => format!("{fabrics}; {n} without KES values are left out: {named}"),
            n => {
                format!("{fabrics}; {n} without KES values are left out: {named} and {} more", n - NAMED)
            }
        }
    }

    /// The table, in order of names.
    ///
    /// # Errors
    /// O069 if there is no fabric, O030 if memory is too small.
    pub fn table(&self) -> Result<RecordBatch, Failure> {
        if self.is_empty() {
            return Err(LibraryError::Empty.into());
        }
        let mut order: Vec<usize> = (0..self.names.len()).collect();
        order.sort_by_key(|at| &self.names[*at]);
        let names: StringArray = order.iter().map(|at| Some(self.names[*at].as_str())).collect();
        let mut fields = vec![Field::new("fabric", DataType::Utf8, true)];
        let mut arrays: Vec<ArrayRef> = vec![Arc::new(names)];
        for filled in self.columns.values() {
            let value = |at: &usize| filled.values.get(*at).copied().filter(|value| !value.is_nan());
            let array: ArrayRef = Arc::new(order.iter().map(value).collect::<Float64Array>());
            let metadata = Metadata::from([(UNIT.to_string(), filled.unit.to_string())]);
            let statuses: StringArray = order
                .iter()
                .enumerate()
                .map(|(row, at)| array.is_valid(row).then(|| filled.statuses[*at].name()))
                .collect();
            let statuses: ArrayRef = Arc::new(statuses);
            let named = NAMES.iter().filter(|(_, symbol)| *symbol == filled.name).map(|(name, _)| *name);
            for name in named.chain([filled.name.as_str()]) {
                fields.push(Field::new(name, DataType::Float64, true).with_metadata(metadata.clone()));
                fields.push(Field::new(status_column(name), DataType::Utf8, true));
                arrays.extend([Arc::clone(&array), Arc::clone(&statuses)]);
            }
        }
        let origins: StringArray = order.iter().map(|at| self.origins[*at].as_deref()).collect();
        fields.push(Field::new("origin", DataType::Utf8, true));
        arrays.push(Arc::new(origins));
        let table = RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays);
        Ok(table.map_err(|e| TableError::Encode { format: "Parquet", problem: e.to_string() })?)
    }

    /// The file of the library.
    ///
    /// # Errors
    /// Those of [`table`](Self::table).
    pub fn parquet(&self) -> Result<Vec<u8>, Failure> {
        let table = self.table()?;
        let metadata = [("kesf.library", LAYOUT), ("kesf.version", env!("CARGO_PKG_VERSION"))];
        Ok(write_pieces(&table.schema(), [&table], GROUP, &metadata)?)
    }
}

/// Where the value of a row goes, its unit in the library with its SI value, and the unit that it must be in.
fn place_of(row: &FabricRow) -> Option<(Order, (&'static str, f64), &'static str)> {
    let direction = match row.direction.as_deref() {
        None => 0,
        Some(name) => Direction::ALL.iter().position(|d| d.name() == name)? + 1,
    };
    if row.parameter.starts_with("E ") {
        let order = (Parameter::ALL.len(), row.parameter.clone(), direction);
        return Some((order, UnitSystem::Kes.of_modulus(), UnitSystem::Si.of_modulus().0));
    }
    let at = Parameter::ALL.iter().position(|p| p.symbol() == row.parameter)?;
    let parameter = Parameter::ALL[at];
    Some(((at, String::new(), direction), UnitSystem::Kes.of(parameter), parameter.si_unit()))
}

impl Stored {
    /// The parameters.
    fn rows(&self) -> Result<Vec<FabricRow>, Failure> {
        let path = &self.0;
        let refused = |problem: String| LibraryError::Results { path: path.clone(), problem };
        let of_run = ["fabrics.parquet", "fabrics.csv"].map(|name| path.join(name));
        if !files::exists(path) {
            return Err(refused("there is no such file or folder".into()).into());
        }
        refuse_unfinished(path)?;
        if files::is_file(&of_run[0]) {
            return Ok(rows_of_run(&of_run[0])?);
        }
        if files::is_file(&of_run[1]) {
            return Ok(rows_of_csv(&of_run[1])?);
        }
        let mut rows = Vec::new();
        let pieces = if files::is_folder(path) {
            let merged = merge_folder(path)?;
            rows.extend(merged.table(Table::Failures)?.iter().flat_map(rows_without_value));
            merged.table(Table::Results)?
        } else {
            let bytes = files::read(path).map_err(|e| refused(e.to_string()))?;
            vec![read(bytes.into()).map_err(|e| refused(e.to_string()))?.1]
        };
        for piece in &pieces {
            rows.extend(
                rows_of_results(piece).map_err(|name| refused(format!("there is no column `{name}`")))?,
            );
        }
        Ok(rows)
    }
}

fn rows_of_run(path: &Path) -> Result<Vec<FabricRow>, LibraryError> {
    let refused = |problem: String| LibraryError::Results { path: path.to_path_buf(), problem };
    let bytes = files::read(path).map_err(|e| refused(e.to_string()))?;
    let (_, table) = read(bytes.into()).map_err(|e| refused(e.to_string()))?;
    rows(&table, OF_RUN).map_err(|name| refused(format!("there is no column `{name}`")))
}

fn rows_of_csv(path: &Path) -> Result<Vec<FabricRow>, LibraryError> {
    let refused = |problem: String| LibraryError::Results { path: path.to_path_buf(), problem };
    let bytes = files::read(path).map_err(|e| refused(e.to_string()))?;
    let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(&bytes);
    let mut reader = csv::Reader::from_reader(bytes);
    reader.deserialize().collect::<Result<_, _>>().map_err(|e| refused(e.to_string()))
}

/// The parameters of a table of results or of parameters; `name` stands for it in messages.
pub(super) fn rows_of_parameters(name: &str, table: &RecordBatch) -> Result<Vec<FabricRow>, LibraryError> {
    let of_results = table.column_by_name("case").is_some();
    let rows = if of_results { rows_of_results(table) } else { rows(table, OF_RUN) };
    let missing = |column| LibraryError::Results {
        path: name.into(),
        problem: format!("there is no column `{column}`"),
    };
    rows.map_err(missing)
}

/// Of the results of a part or of all parts, those of no case.
fn rows_of_results(table: &RecordBatch) -> Result<Vec<FabricRow>, &'static str> {
    let cases = table.column_by_name("case").ok_or("case")?;
    let rows = rows(table, ["fabric", "quantity", "direction", "value", "unit"])?;
    Ok(rows.into_iter().enumerate().filter(|(at, _)| cases.is_null(*at)).map(|(_, row)| row).collect())
}

/// Fabrics of a table of failures. They may have values all the same, if it was a case that failed.
fn rows_without_value(failures: &RecordBatch) -> Vec<FabricRow> {
    let fabrics = failures.column_by_name("fabric").and_then(|column| column.as_string_opt::<i32>());
    let names = fabrics.into_iter().flat_map(|names| names.iter().flatten());
    names.map(|name| FabricRow { fabric: name.into(), ..FabricRow::default() }).collect()
}

/// Rows of columns: fabric, parameter, direction, mean and unit, and status and origin where there are such columns; the
/// name of one that is missing.
fn rows(table: &RecordBatch, names: [&'static str; 5]) -> Result<Vec<FabricRow>, &'static str> {
    let text =
        |name: &'static str| table.column_by_name(name).and_then(|c| c.as_string_opt::<i32>()).ok_or(name);
    let [fabric, parameter, direction, unit] = [names[0], names[1], names[2], names[4]].map(text);
    let (fabric, parameter, direction, unit) = (fabric?, parameter?, direction?, unit?);
    let mean =
        table.column_by_name(names[3]).and_then(|c| c.as_primitive_opt::<Float64Type>()).ok_or(names[3])?;
    let [statuses, origins] = ["status", "origin"].map(|name| text(name).ok());
    let row = |at: usize| FabricRow {
        fabric: fabric.value(at).into(),
        parameter: parameter.value(at).into(),
        direction: direction.is_valid(at).then(|| direction.value(at).into()),
        mean: mean.is_valid(at).then(|| mean.value(at)),
        unit: unit.value(at).into(),
        status: statuses
            .filter(|column| column.is_valid(at))
            .map_or_else(String::new, |column| column.value(at).into()),
        origin: origins.filter(|column| column.is_valid(at)).map(|column| column.value(at).into()),
        ..FabricRow::default()
    };
    Ok((0..table.num_rows()).map(row).collect())
}
