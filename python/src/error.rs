//! Failures of the library become the one exception type of the package.

use kesf::results::Failure;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

/// Code of work that was ended by its caller.
const INTERRUPTED: &str = "O054";

/// The exception of a failure: `kesf.KesfError`, or `KeyboardInterrupt` of work that was ended.
pub fn raised(py: Python<'_>, failure: &Failure) -> PyErr {
    if &*failure.code == INTERRUPTED {
        return PyKeyboardInterrupt::new_err(failure.message.clone());
    }
    instance(py, failure).map_or_else(|error| error, PyErr::from_value)
}

fn instance<'py>(py: Python<'py>, failure: &Failure) -> PyResult<Bound<'py, PyAny>> {
    let entry = failure.entry();
    let fields = crate::messages::json(&entry.fields)?;
    let class = py.import("kesf._errors")?.getattr("KesfError")?;
    class.call_method1(
        "_of",
        (entry.code, entry.message, entry.file, entry.line, entry.column, entry.hint, fields),
    )
}

/// A result of the library as one of Python.
pub trait OrRaise<T> {
    /// The value, or the exception of the failure.
    fn or_raise(self, py: Python<'_>) -> PyResult<T>;
}

impl<T, E: Into<Failure>> OrRaise<T> for Result<T, E> {
    fn or_raise(self, py: Python<'_>) -> PyResult<T> {
        self.map_err(|error| raised(py, &error.into()))
    }
}
