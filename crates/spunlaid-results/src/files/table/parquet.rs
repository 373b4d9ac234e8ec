//! Writes Parquet tables in groups of rows.

use super::{Column, ColumnValues, Rows, TableFormat, Value};
use crate::{Failure, failure};
use bytes::Bytes;
use parquet::basic::{Compression, Encoding, LogicalType, Repetition, Type as PhysicalType};
use parquet::column::writer::{ColumnCloseResult, get_column_writer, get_typed_column_writer_mut as typed};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::{WriterProperties, WriterPropertiesPtr};
use parquet::file::writer::{SerializedFileWriter, SerializedPageWriter, TrackedWrite};
use parquet::schema::types::{ColumnDescPtr, Type};
use spunlaid_ground::threads::par_map;
use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;
use std::sync::Arc;
use std::thread::available_parallelism;

/// Rows of a group that are packed faster than threads begin.
const FEW: usize = 1 << 12;

/// Number of values that are collected before they are written.
const VALUES: usize = 1 << 18;

pub(super) const FORMAT: TableFormat = TableFormat {
    name: "parquet",
    create: |now, later, columns| {
        let rows = VALUES.div_ceil(columns.len().max(1));
        Parquet::create(now, later, columns, rows).map(|table| Box::new(table) as Box<dyn Rows>)
    },
};

impl Rows for Parquet {
    fn add(&mut self, row: &[Value]) -> Result<(), Failure> {
        for (column, value) in row.iter().enumerate() {
            match value {
                Value::Whole(value) => self.extend_whole(column, [*value]),
                Value::Number(value) => self.extend(column, [*value]),
                Value::Word(word) => self.push_text(column, word),
            }
        }
        self.flush_when_full()
    }

    fn finish(self: Box<Self>) -> Result<(), Failure> {
        let path = self.path.clone();
        Self::finish(*self)?.sync_all().map_err(Failure::unwritable(&path))
    }
}

/// A table that is being written. All columns must have the same number of rows when
/// [`Parquet::flush_when_full`] or [`Parquet::finish`] is called.
pub(crate) struct Parquet {
    /// Its final path.
    path: PathBuf,
    writer: SerializedFileWriter<BufWriter<File>>,
    columns: Vec<PendingValues>,
    group: usize,
    /// Number of rows since the last group.
    rows: usize,
}

/// The values of a column since the last group of rows.
enum PendingValues {
    Whole(Vec<i64>),
    Text(Vec<ByteArray>),
    Number(Vec<f64>),
    /// The known values, and for each row 1 if its value is known.
    Optional(Vec<f64>, Vec<i16>),
}

impl Parquet {
    /// * `now`, `path` – present and final path of the table
    /// * `group` – number of rows in a group
    pub(crate) fn create(
        now: PathBuf,
        path: PathBuf,
        columns: &[Column],
        group: usize,
    ) -> Result<Self, Failure> {
        let file = File::create(now).map_err(Failure::unwritable(&path))?;
        let field = |column: &Column| {
            let (physical, repetition) = match column.holds {
                ColumnValues::Whole => (PhysicalType::INT64, Repetition::REQUIRED),
                ColumnValues::Text => (PhysicalType::BYTE_ARRAY, Repetition::REQUIRED),
                ColumnValues::Number => (PhysicalType::DOUBLE, Repetition::REQUIRED),
                ColumnValues::Optional => (PhysicalType::DOUBLE, Repetition::OPTIONAL),
            };
            let field = Type::primitive_type_builder(&column.name, physical);
            let logical = (column.holds == ColumnValues::Text).then_some(LogicalType::String);
            field.with_repetition(repetition).with_logical_type(logical).build().map(Arc::new)
        };
        let fields = columns.iter().map(field).collect::<Result<Vec<_>, _>>();
        let writer = fields
            .and_then(|fields| Type::group_type_builder("spunlaid").with_fields(fields).build())
            .and_then(|schema| {
                let properties = WriterProperties::builder()
                    .set_compression(Compression::SNAPPY)
                    .set_dictionary_enabled(false)
                    .set_encoding(Encoding::PLAIN)
                    .set_created_by(concat!("spunlaid ", env!("CARGO_PKG_VERSION")).to_owned())
                    .build();
                SerializedFileWriter::new(
                    BufWriter::with_capacity(1 << 17, file),
                    Arc::new(schema),
                    Arc::new(properties),
                )
            })
            .map_err(|error| failure::table(&path, error))?;
        let empty = |column: &Column| match column.holds {
            ColumnValues::Whole => PendingValues::Whole(Vec::new()),
            ColumnValues::Text => PendingValues::Text(Vec::new()),
            ColumnValues::Number => PendingValues::Number(Vec::new()),
            ColumnValues::Optional => PendingValues::Optional(Vec::new(), Vec::new()),
        };
        let columns = columns.iter().map(empty).collect();
        Ok(Self { path, writer, columns, group, rows: 0 })
    }

    /// Number of rows that the group takes which is gathered now.
    pub(crate) const fn room(&self) -> usize {
        self.group.saturating_sub(self.rows)
    }

    /// Adds values to a column of whole numbers.
    pub(crate) fn extend_whole(&mut self, column: usize, values: impl IntoIterator<Item = i64>) {
        if let Some(PendingValues::Whole(gathered)) = self.columns.get_mut(column) {
            gathered.extend(values);
            self.rows = gathered.len();
        }
    }

    /// Adds a word to a column of words.
    pub(crate) fn push_text(&mut self, column: usize, word: &str) {
        if let Some(PendingValues::Text(gathered)) = self.columns.get_mut(column) {
            gathered.push(word.into());
        }
    }

    /// Adds values to a column of numbers.
    pub(crate) fn extend(&mut self, column: usize, values: impl IntoIterator<Item = f64>) {
        match self.columns.get_mut(column) {
            Some(PendingValues::Number(gathered)) => {
                gathered.extend(values);
                self.rows = gathered.len();
            }
            Some(PendingValues::Optional(gathered, known)) => {
                for value in values {
                    gathered.extend(value.is_finite().then_some(value));
                    known.push(i16::from(value.is_finite()));
                }
            }
            Some(PendingValues::Whole(_) | PendingValues::Text(_)) | None => {}
        }
    }

    /// Writes the rows if they fill a group.
    pub(crate) fn flush_when_full(&mut self) -> Result<(), Failure> {
        if self.rows >= self.group { self.flush() } else { Ok(()) }
    }

    /// Writes the remaining rows and returns the file.
    pub(crate) fn finish(mut self) -> Result<File, Failure> {
        self.flush()?;
        let Self { path, writer, .. } = self;
        let file = writer.into_inner().map_err(|error| failure::table(&path, error))?;
        file.into_inner().map_err(|error| Failure::unwritable(&path)(error.into_error()))
    }

    fn flush(&mut self) -> Result<(), Failure> {
        if self.rows == 0 {
            return Ok(());
        }
        self.write_group().map_err(|error| failure::table(&self.path, error))?;
        for gathered in &mut self.columns {
            match gathered {
                PendingValues::Whole(values) => values.clear(),
                PendingValues::Text(values) => values.clear(),
                PendingValues::Number(values) => values.clear(),
                PendingValues::Optional(values, known) => {
                    values.clear();
                    known.clear();
                }
            }
        }
        self.rows = 0;
        Ok(())
    }

    /// Writes a group of rows, each column of which is packed on a thread.
    fn write_group(&mut self) -> Result<(), ParquetError> {
        let threads = if self.rows < FEW { 1 } else { available_parallelism().map_or(1, usize::from) };
        let schema = self.writer.schema_descr();
        let properties = self.writer.properties();
        let columns = &self.columns;
        let packed =
            par_map(threads, columns.len(), |i| columns[i].pack(schema.column(i), properties.clone()));
        let mut group = self.writer.next_row_group()?;
        for column in packed {
            let (bytes, closed) = column?;
            group.append_column(&bytes, closed)?;
        }
        group.close().map(drop)
    }
}

impl PendingValues {
    /// The values as a table holds them, and what the table must know of them.
    fn pack(
        &self,
        column: ColumnDescPtr,
        properties: WriterPropertiesPtr,
    ) -> Result<(Bytes, ColumnCloseResult), ParquetError> {
        let mut packed = TrackedWrite::new(Vec::new());
        let pages = Box::new(SerializedPageWriter::new(&mut packed));
        let mut writer = get_column_writer(column, properties, pages);
        match self {
            Self::Whole(values) => typed::<Int64Type>(&mut writer).write_batch(values, None, None)?,
            Self::Text(values) => typed::<ByteArrayType>(&mut writer).write_batch(values, None, None)?,
            Self::Number(values) => typed::<DoubleType>(&mut writer).write_batch(values, None, None)?,
            Self::Optional(values, known) => {
                typed::<DoubleType>(&mut writer).write_batch(values, Some(known), None)?
            }
        };
        let closed = writer.close()?;
        Ok((packed.into_inner()?.into(), closed))
    }
}
