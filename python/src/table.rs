//! Tables: columns with units, handed over by the C stream of Arrow (PyCapsule interface) without a copy.

use std::collections::HashMap;
use std::ffi::CStr;
use std::sync::Arc;

use arrow_array::ffi::FFI_ArrowSchema;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::{Float64Type, UInt64Type};
use arrow_array::{
    Array, ArrayRef, ArrowPrimitiveType, Float64Array, PrimitiveArray, RecordBatch, RecordBatchIterator,
    StringArray, UInt64Array,
};
use arrow_schema::{ArrowError, DataType, Field, Schema};
use arrow_select::concat::concat_batches;
use kesf::report::arrow::{UNIT, UNIT_COLUMN, array, unit_of};
use kesf::report::table::{Row, Values};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyList};

/// Names that the PyCapsule interface of Arrow fixes.
const SCHEMA: &CStr = c"arrow_schema";
const STREAM: &CStr = c"arrow_array_stream";

/// A table of the library. Its columns are text, 64-bit numbers or counts; what is absent is null.
#[pyclass(frozen, module = "kesf._kesf")]
pub struct Table {
    batch: RecordBatch,
}

/// A column before it is one of Arrow.
pub struct Column {
    pub name: String,
    pub values: Values,
    pub metadata: HashMap<String, String>,
}

impl Table {
    /// The table of rows, with units in the metadata of its fields.
    pub fn of<R: Row>(rows: &[R]) -> PyResult<Self> {
        let columns: Vec<(&str, Values)> = R::HEADER.iter().copied().zip(R::values(rows)).collect();
        let with_unit = |(name, values): &(&str, Values)| Column {
            name: (*name).to_string(),
            values: values.clone(),
            metadata: unit(name, &columns),
        };
        Self::of_columns(columns.iter().map(with_unit))
    }

    /// The table of Arrow.
    pub fn new(batch: RecordBatch) -> Self {
        Self { batch }
    }

    /// The table of pieces of one schema, of which there is one at least.
    pub fn of_pieces(pieces: &[RecordBatch]) -> PyResult<Self> {
        let schema = pieces.first().map_or_else(|| Arc::new(Schema::empty()), RecordBatch::schema);
        Ok(Self { batch: concat_batches(&schema, pieces).map_err(refused)? })
    }

    /// The table of Arrow.
    pub fn batch(&self) -> &RecordBatch {
        &self.batch
    }

    /// The table of columns of equal length.
    pub fn of_columns(columns: impl IntoIterator<Item = Column>) -> PyResult<Self> {
        let (mut fields, mut arrays) = (Vec::new(), Vec::new());
        for Column { name, values, metadata } in columns {
            let array = array(values);
            fields.push(Field::new(name, array.data_type().clone(), true).with_metadata(metadata));
            arrays.push(array);
        }
        let schema = Arc::new(Schema::new(fields));
        let options = arrow_array::RecordBatchOptions::new()
            .with_row_count(Some(arrays.first().map_or(0, |array| array.len())));
        let batch = RecordBatch::try_new_with_options(schema, arrays, &options).map_err(refused)?;
        Ok(Self { batch })
    }

    fn schema(&self) -> Arc<Schema> {
        self.batch.schema()
    }

    fn column_named(&self, name: &str) -> PyResult<&ArrayRef> {
        self.batch.column_by_name(name).ok_or_else(|| {
            let names: Vec<_> = self.schema().fields().iter().map(|f| f.name().clone()).collect();
            PyKeyError::new_err(format!("no column `{name}`; there are {}", names.join(", ")))
        })
    }
}

fn refused(error: ArrowError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Where the unit of a column is told, and the unit itself if all of the column has one.
fn unit(name: &str, columns: &[(&str, Values)]) -> HashMap<String, String> {
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    let mut metadata = unit_of(name, &names);
    let source = metadata.get(UNIT_COLUMN).and_then(|source| columns.iter().find(|(name, _)| name == source));
    if let Some((_, Values::Text(units))) = source
        && let Some(Some(first)) = units.first()
        && units.iter().all(|unit| unit.as_ref() == Some(first))
    {
        metadata.insert(UNIT.into(), first.clone());
    }
    metadata
}

/// Name, kind, metadata and cells of a column from Python.
type PythonColumn<'py> = (String, String, HashMap<String, String>, Bound<'py, PyAny>);

#[pymethods]
impl Table {
    /// A table of `(name, kind, metadata, cells)`; kind is `text`, `number` or `count`.
    #[staticmethod]
    fn _from_columns(columns: Vec<PythonColumn<'_>>) -> PyResult<Self> {
        let columns = columns.into_iter().map(|(name, kind, metadata, cells)| {
            let values = match kind.as_str() {
                "text" => Values::Text(cells.extract()?),
                "number" => Values::Number(cells.extract()?),
                "count" => Values::Count(cells.extract()?),
                other => return Err(PyValueError::new_err(format!("`{other}` is no kind of column"))),
            };
            Ok(Column { name, values, metadata })
        });
        Self::of_columns(columns.collect::<PyResult<Vec<_>>>()?)
    }

    /// The schema for other programs (Arrow PyCapsule interface).
    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        let schema = FFI_ArrowSchema::try_from(&*self.schema()).map_err(refused)?;
        PyCapsule::new_with_value(py, schema, SCHEMA)
    }

    /// The table for other programs (Arrow PyCapsule interface). A requested schema is not looked at, as the interface
    /// allows: whoever asks converts.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        drop(requested_schema);
        let reader = RecordBatchIterator::new([Ok(self.batch.clone())], self.schema());
        PyCapsule::new_with_value(py, FFI_ArrowArrayStream::new(Box::new(reader)), STREAM)
    }

    fn __len__(&self) -> usize {
        self.batch.num_rows()
    }

    /// Names of the columns, in order.
    #[getter]
    fn column_names(&self) -> Vec<String> {
        self.schema().fields().iter().map(|field| field.name().clone()).collect()
    }

    /// Unit of each column that has one throughout.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let units = PyDict::new(py);
        for field in self.schema().fields() {
            if let Some(unit) = field.metadata().get(UNIT) {
                units.set_item(field.name(), unit)?;
            }
        }
        Ok(units)
    }

    /// The cells of a column as a list; what is absent is None.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyList>> {
        list(py, self.column_named(name)?)
    }

    /// All columns as lists, by name.
    fn to_pydict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        for (field, array) in self.schema().fields().iter().zip(self.batch.columns()) {
            columns.set_item(field.name(), list(py, array)?)?;
        }
        Ok(columns)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.batch == other.batch
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyAny>,))> {
        let mut columns = Vec::new();
        for (field, array) in self.schema().fields().iter().zip(self.batch.columns()) {
            let metadata: HashMap<String, String> =
                field.metadata().iter().map(|(key, value)| (key.clone(), value.clone())).collect();
            let entry = (field.name().clone(), kind(array), metadata, list(py, array)?);
            columns.push(entry.into_bound_py_any(py)?);
        }
        let make = py.get_type::<Self>().getattr("_from_columns")?;
        Ok((make, (columns.into_bound_py_any(py)?,)))
    }
}

fn kind(array: &ArrayRef) -> &'static str {
    match array.data_type() {
        DataType::Float64 => "number",
        DataType::UInt64 => "count",
        _ => "text",
    }
}

fn list<'py>(py: Python<'py>, array: &ArrayRef) -> PyResult<Bound<'py, PyList>> {
    let any = array.as_any();
    if let Some(text) = any.downcast_ref::<StringArray>() {
        return PyList::new(py, text.iter());
    }
    if let Some(numbers) = any.downcast_ref::<Float64Array>() {
        return PyList::new(py, cells::<Float64Type>(numbers));
    }
    match any.downcast_ref::<UInt64Array>() {
        Some(counts) => PyList::new(py, cells::<UInt64Type>(counts)),
        None => Err(PyValueError::new_err(format!("a column of {} is none of kesf", array.data_type()))),
    }
}

fn cells<T: ArrowPrimitiveType>(array: &PrimitiveArray<T>) -> Vec<Option<T::Native>> {
    array.iter().collect()
}
