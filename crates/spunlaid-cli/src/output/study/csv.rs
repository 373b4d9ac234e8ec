//! Comma-separated values: a line of names, then a line per row; what is missing is empty.

use super::columns::{Column, Value};
use crate::failure::Failure;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

pub(super) struct Csv {
    path: PathBuf,
    writer: BufWriter<File>,
}

impl Csv {
    pub(super) fn create(path: &Path, columns: &[Column]) -> Result<Self, Failure> {
        let file = File::create(path).map_err(Failure::unwritable(path))?;
        let mut csv = Self { path: path.to_owned(), writer: BufWriter::new(file) };
        let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
        csv.line(&names.join(","))?;
        Ok(csv)
    }

    pub(super) fn add(&mut self, row: &[Value]) -> Result<(), Failure> {
        let shown = |value: &Value| match value {
            Value::Whole(value) => value.to_string(),
            Value::Number(value) => value.map_or_else(String::new, shortest),
        };
        let row: Vec<String> = row.iter().map(shown).collect();
        self.line(&row.join(","))
    }

    pub(super) fn finish(mut self) -> Result<(), Failure> {
        let done = self.writer.flush().and_then(|()| self.writer.get_ref().sync_all());
        done.map_err(Failure::unwritable(&self.path))
    }

    fn line(&mut self, line: &str) -> Result<(), Failure> {
        writeln!(self.writer, "{line}").map_err(Failure::unwritable(&self.path))
    }
}

/// The shortest text that reads back to the same bits.
fn shortest(value: f64) -> String {
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    if scientific.len() < plain.len() { scientific } else { plain }
}
