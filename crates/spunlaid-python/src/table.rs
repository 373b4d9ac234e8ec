//! Parquet tables of results folders, read back.

use crate::failure::raised_as;
use numpy::PyArray1;
use parquet::column::reader::ColumnReader;
use parquet::errors::{ParquetError, Result as Decoded};
use parquet::file::reader::{FileReader, SerializedFileReader};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::fs::File;
use std::path::PathBuf;

/// The array, of which nothing can be changed any more: it is seen by all who hold the results.
pub(crate) fn locked<'py>(array: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    array.call_method1("setflags", (false,))?;
    Ok(array.clone())
}

/// Numbers as such an array.
pub(crate) fn column(py: Python<'_>, values: impl Iterator<Item = f64>) -> PyResult<Bound<'_, PyAny>> {
    locked(PyArray1::from_vec(py, values.collect()).as_any())
}

/// The columns of a table that spunlaid wrote, by name.
#[pyfunction]
pub(crate) fn read_table(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let columns = py.detach(|| File::open(&path).map_err(ParquetError::from).and_then(decode));
    let columns = columns.map_err(|error| {
        raised_as(py, "FolderError", format!("{}: cannot be read: {error}", path.display()))
    })?;
    let table = PyDict::new(py);
    for (name, values) in columns {
        table.set_item(name, locked(PyArray1::from_vec(py, values).as_any())?)?;
    }
    Ok(table)
}

/// Whole numbers are numbers too.
fn decode(file: File) -> Decoded<Vec<(String, Vec<f64>)>> {
    let reader = SerializedFileReader::new(file)?;
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    let mut columns: Vec<(String, Vec<f64>)> =
        schema.columns().iter().map(|column| (column.name().to_owned(), Vec::new())).collect();
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group)?;
        let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
        for (at, column) in schema.columns().iter().enumerate() {
            let name = column.name();
            let foreign = || ParquetError::General(format!("column {name} is not one of spunlaid's"));
            // A table of optional values would have fewer of them than rows.
            if column.max_def_level() > 0 {
                return Err(foreign());
            }
            let values = &mut columns[at].1;
            match group.get_column_reader(at)? {
                ColumnReader::Int64ColumnReader(mut reader) => {
                    let mut whole = Vec::new();
                    reader.read_records(rows, None, None, &mut whole)?;
                    values.extend(whole.into_iter().map(|number| number as f64));
                }
                ColumnReader::DoubleColumnReader(mut reader) => {
                    reader.read_records(rows, None, None, values)?;
                }
                _ => return Err(foreign()),
            }
        }
    }
    Ok(columns)
}
