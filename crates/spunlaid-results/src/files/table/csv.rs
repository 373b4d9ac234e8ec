//! Comma-separated values: a header, then a line for each row. Missing values are empty cells.

use super::{Begun, Column, Rows, TableFormat, Value};
use crate::Failure;
use csv::{Writer, WriterBuilder};
use spunlaid_charts::shortest;
use std::fs::File;
use std::path::PathBuf;

pub(super) const FORMAT: TableFormat =
    TableFormat { name: "csv", create: |now, path, columns| separated(b',', now, path, columns) };

/// Values with tabs between them, which a spreadsheet takes in any country.
pub(super) const WITH_TABS: TableFormat =
    TableFormat { name: "tsv", create: |now, path, columns| separated(b'\t', now, path, columns) };

struct Lines {
    path: PathBuf,
    writer: Writer<File>,
}

/// Begins a table with a sign between its cells.
fn separated(sign: u8, now: PathBuf, path: PathBuf, columns: &[Column]) -> Begun {
    let file = File::create(now).map_err(Failure::unwritable(&path))?;
    let writer = WriterBuilder::new().delimiter(sign).from_writer(file);
    let mut lines = Lines { path, writer };
    lines.line(columns.iter().map(|column| column.name.clone()))?;
    Ok(Box::new(lines))
}

impl Lines {
    fn line(&mut self, cells: impl Iterator<Item = String>) -> Result<(), Failure> {
        self.writer.write_record(cells).map_err(|error| {
            let error = match error.into_kind() {
                csv::ErrorKind::Io(error) => error,
                other => std::io::Error::other(format!("{other:?}")),
            };
            Failure::unwritable(&self.path)(error)
        })
    }
}

impl Rows for Lines {
    fn add(&mut self, row: &[Value]) -> Result<(), Failure> {
        self.line(row.iter().map(|value| match value {
            Value::Whole(value) => value.to_string(),
            Value::Number(value) => shortest(*value),
            Value::Word(word) => (*word).to_owned(),
        }))
    }

    fn finish(mut self: Box<Self>) -> Result<(), Failure> {
        let done = self.writer.flush().and_then(|()| self.writer.get_ref().sync_all());
        done.map_err(Failure::unwritable(&self.path))
    }
}
