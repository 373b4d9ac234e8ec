//! Parquet tables of results folders, read back.

use crate::failure::raised_as;
use crate::samples::locked;
use numpy::PyArray1;
use parquet::column::reader::ColumnReader;
use parquet::errors::{ParquetError, Result as Decoded};
use parquet::file::reader::{FileReader, SerializedFileReader};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::fs::File;
use std::path::PathBuf;

/// A column of whole numbers or of numbers.
enum Values {
    Whole(Vec<i64>),
    Number(Vec<f64>),
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
        let array = match values {
            Values::Whole(values) => PyArray1::from_vec(py, values).into_any(),
            Values::Number(values) => PyArray1::from_vec(py, values).into_any(),
        };
        table.set_item(name, locked(&array)?)?;
    }
    Ok(table)
}

fn decode(file: File) -> Decoded<Vec<(String, Values)>> {
    let reader = SerializedFileReader::new(file)?;
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    let mut columns: Vec<(String, Values)> = Vec::new();
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
            let reader = group.get_column_reader(at)?;
            if columns.len() == at {
                let values = match reader {
                    ColumnReader::Int64ColumnReader(_) => Values::Whole(Vec::new()),
                    _ => Values::Number(Vec::new()),
                };
                columns.push((name.to_owned(), values));
            }
            match (reader, &mut columns[at].1) {
                (ColumnReader::Int64ColumnReader(mut reader), Values::Whole(values)) => {
                    reader.read_records(rows, None, None, values)?
                }
                (ColumnReader::DoubleColumnReader(mut reader), Values::Number(values)) => {
                    reader.read_records(rows, None, None, values)?
                }
                _ => return Err(foreign()),
            };
        }
    }
    Ok(columns)
}
