//! Parquet tables of a run, written flight by flight.

use crate::failure::Failure;
use parquet::basic::{Compression, Encoding, Repetition, Type as PhysicalType};
use parquet::data_type::{DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use spunlaid::ensemble::{Sample, Trajectory};
use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;
use std::sync::Arc;

/// A column of doubles: its name, unit included, and its value at an instant.
type Column = (&'static str, fn(&Sample) -> f64);

/// `end_node.parquet`: the free end over time.
pub(crate) const END_NODE: &[Column] =
    &[("time_s", |s| s.time), ("x_m", |s| s.end.x), ("y_m", |s| s.end.y), ("z_m", |s| s.end.z)];

/// `energy.parquet`: both ledgers over time.
pub(crate) const ENERGY: &[Column] = &[
    ("time_s", |s| s.time),
    ("kinetic_j", |s| s.kinetic),
    ("axial_j", |s| s.axial),
    ("bending_j", |s| s.bending),
    ("work_j", |s| s.work),
    ("gravity_work_j", |s| s.gravity_work),
    ("air_work_j", |s| s.air_work),
    ("damping_work_j", |s| s.damping_work),
    ("tension_dissipation_j", |s| s.tension_dissipation),
    ("imbalance_j", |s| s.imbalance),
    ("work_error_percent", Sample::work_error_percent),
    ("balance_error_percent", Sample::balance_error_percent),
];

/// Rows gathered before a row group is written.
const ROWS: usize = 1 << 18;

/// A table with a row per replicate and recorded instant: `replicate` (from 1), then the columns.
pub(crate) struct Table {
    /// Where it will be.
    path: PathBuf,
    writer: SerializedFileWriter<BufWriter<File>>,
    columns: &'static [Column],
    replicates: Vec<i64>,
    values: Vec<Vec<f64>>,
}

impl Table {
    /// * `now`, `later` – where the table is written, and where it will be
    pub(crate) fn create(
        (now, later): (PathBuf, PathBuf),
        columns: &'static [Column],
    ) -> Result<Self, Failure> {
        let path = later;
        let file = File::create(now).map_err(Failure::unwritable(&path))?;
        let field = |name: &str, physical| {
            Type::primitive_type_builder(name, physical).with_repetition(Repetition::REQUIRED).build()
        };
        let writer = std::iter::once(field("replicate", PhysicalType::INT64))
            .chain(columns.iter().map(|(name, _)| field(name, PhysicalType::DOUBLE)))
            .map(|column| column.map(Arc::new))
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
            .map_err(|error| Failure::table(&path, error))?;
        Ok(Self { path, writer, columns, replicates: Vec::new(), values: vec![Vec::new(); columns.len()] })
    }

    /// Adds a flight.
    pub(crate) fn add(&mut self, flight: &Trajectory) -> Result<(), Failure> {
        self.replicates.resize(self.replicates.len() + flight.samples.len(), flight.replicate as i64 + 1);
        for (values, (_, of)) in self.values.iter_mut().zip(self.columns) {
            values.extend(flight.samples.iter().map(of));
        }
        if self.replicates.len() >= ROWS { self.flush() } else { Ok(()) }
    }

    /// Writes what is left and closes the file.
    pub(crate) fn finish(mut self) -> Result<(), Failure> {
        self.flush()?;
        let Self { path, writer, .. } = self;
        let file = writer.into_inner().map_err(|error| Failure::table(&path, error))?;
        file.into_inner().map(drop).map_err(|error| Failure::unwritable(&path)(error.into_error()))
    }

    fn flush(&mut self) -> Result<(), Failure> {
        if self.replicates.is_empty() {
            return Ok(());
        }
        self.write_group().map_err(|error| Failure::table(&self.path, error))?;
        self.replicates.clear();
        self.values.iter_mut().for_each(Vec::clear);
        Ok(())
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let mut group = self.writer.next_row_group()?;
        if let Some(mut column) = group.next_column()? {
            column.typed::<Int64Type>().write_batch(&self.replicates, None, None)?;
            column.close()?;
        }
        for values in &self.values {
            if let Some(mut column) = group.next_column()? {
                column.typed::<DoubleType>().write_batch(values, None, None)?;
                column.close()?;
            }
        }
        group.close().map(drop)
    }
}
