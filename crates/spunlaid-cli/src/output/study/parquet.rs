//! Parquet, written in groups of rows.

use super::columns::{Column, Value};
use crate::failure::Failure;
use parquet::basic::{Compression, Encoding, Repetition, Type as PhysicalType};
use parquet::data_type::{DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Values gathered before a row group is written.
const VALUES: usize = 1 << 18;

pub(super) struct Parquet {
    path: PathBuf,
    writer: SerializedFileWriter<BufWriter<File>>,
    columns: Vec<Gathered>,
}

/// The values of a column since the last row group.
enum Gathered {
    Whole(Vec<i64>),
    /// Values there are, and for each row 1 where there is one.
    Numbers(Vec<f64>, Vec<i16>),
}

impl Parquet {
    pub(super) fn create(path: &Path, columns: &[Column]) -> Result<Self, Failure> {
        let file = File::create(path).map_err(Failure::unwritable(path))?;
        let field = |column: &Column| {
            let (physical, repetition) = if column.whole {
                (PhysicalType::INT64, Repetition::REQUIRED)
            } else {
                (PhysicalType::DOUBLE, Repetition::OPTIONAL)
            };
            Type::primitive_type_builder(&column.name, physical)
                .with_repetition(repetition)
                .build()
                .map(Arc::new)
        };
        let writer = columns
            .iter()
            .map(field)
            .collect::<Result<Vec<_>, _>>()
            .and_then(|fields| Type::group_type_builder("spunlaid").with_fields(fields).build())
            .and_then(|schema| {
                let properties = WriterProperties::builder()
                    .set_compression(Compression::SNAPPY)
                    .set_dictionary_enabled(false)
                    .set_encoding(Encoding::PLAIN)
                    .set_created_by(concat!("spunlaid ", env!("CARGO_PKG_VERSION")).to_owned())
                    .build();
                SerializedFileWriter::new(BufWriter::new(file), Arc::new(schema), Arc::new(properties))
            })
            .map_err(|error| Failure::table(path, error))?;
        let empty = |column: &Column| {
            if column.whole { Gathered::Whole(Vec::new()) } else { Gathered::Numbers(Vec::new(), Vec::new()) }
        };
        Ok(Self { path: path.to_owned(), writer, columns: columns.iter().map(empty).collect() })
    }

    pub(super) fn add(&mut self, row: &[Value]) -> Result<(), Failure> {
        let mut rows = 0;
        for (gathered, value) in self.columns.iter_mut().zip(row) {
            match (gathered, value) {
                (Gathered::Whole(values), Value::Whole(value)) => {
                    values.push(*value);
                    rows = values.len();
                }
                (Gathered::Numbers(values, there), Value::Number(value)) => {
                    values.extend(value);
                    there.push(i16::from(value.is_some()));
                }
                // The columns are made for the rows.
                (Gathered::Whole(values), Value::Number(_)) => values.push(0),
                (Gathered::Numbers(_, there), Value::Whole(_)) => there.push(0),
            }
        }
        if rows * self.columns.len() >= VALUES { self.flush() } else { Ok(()) }
    }

    pub(super) fn finish(mut self) -> Result<(), Failure> {
        self.flush()?;
        let Self { path, writer, .. } = self;
        let file = writer.into_inner().map_err(|error| Failure::table(&path, error))?;
        let file = file.into_inner().map_err(|error| Failure::unwritable(&path)(error.into_error()))?;
        file.sync_all().map_err(Failure::unwritable(&path))
    }

    fn flush(&mut self) -> Result<(), Failure> {
        let is_empty = |gathered: &Gathered| match gathered {
            Gathered::Whole(values) => values.is_empty(),
            Gathered::Numbers(_, there) => there.is_empty(),
        };
        if self.columns.iter().all(is_empty) {
            return Ok(());
        }
        self.write_group().map_err(|error| Failure::table(&self.path, error))?;
        for gathered in &mut self.columns {
            match gathered {
                Gathered::Whole(values) => values.clear(),
                Gathered::Numbers(values, there) => {
                    values.clear();
                    there.clear();
                }
            }
        }
        Ok(())
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let mut group = self.writer.next_row_group()?;
        for gathered in &self.columns {
            let Some(mut column) = group.next_column()? else {
                break;
            };
            match gathered {
                Gathered::Whole(values) => column.typed::<Int64Type>().write_batch(values, None, None)?,
                Gathered::Numbers(values, there) => {
                    column.typed::<DoubleType>().write_batch(values, Some(there), None)?
                }
            };
            column.close()?;
        }
        group.close().map(drop)
    }
}
