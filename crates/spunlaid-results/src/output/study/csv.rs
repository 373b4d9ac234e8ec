//! Comma-separated values: a header, then a line per row. Missing values are empty cells.

use super::super::parquet::Column;
use super::columns::Value;
use crate::Failure;
use csv::Writer;
use spunlaid_charts::shortest;
use std::fs::File;
use std::path::PathBuf;

pub(super) struct Csv {
    path: PathBuf,
    writer: Writer<File>,
}

impl Csv {
    /// * `now`, `later` – the temporary path of the table, and its final path
    pub(super) fn create((now, later): (PathBuf, PathBuf), columns: &[Column]) -> Result<Self, Failure> {
        let file = File::create(now).map_err(Failure::unwritable(&later))?;
        let mut csv = Self { path: later, writer: Writer::from_writer(file) };
        csv.line(columns.iter().map(|column| column.name.clone()))?;
        Ok(csv)
    }

    pub(super) fn add(&mut self, row: &[Value]) -> Result<(), Failure> {
        self.line(row.iter().map(|value| match value {
            Value::Whole(value) => value.to_string(),
            Value::Number(value) => shortest(*value),
            Value::Word(word) => (*word).to_owned(),
        }))
    }

    pub(super) fn finish(mut self) -> Result<(), Failure> {
        let done = self.writer.flush().and_then(|()| self.writer.get_ref().sync_all());
        done.map_err(Failure::unwritable(&self.path))
    }

    fn line(&mut self, cells: impl Iterator<Item = String>) -> Result<(), Failure> {
        self.writer.write_record(cells).map_err(|error| Failure::unwritable(&self.path)(error.into()))
    }
}
