//! Reads the data files that a case names, each of them once for all points of a study.

mod polymer;
mod profile;

use crate::file::text as text_of;
use spunlaid_air::record::{analyse_fluctuation, read_record};
use spunlaid_air::{
    FieldLayout, FileContent, LONGEST_GAP, Layout, Measured, ReadField, Record, RecordLayout, RecordNumbers,
    Settings,
};
use spunlaid_fibre::case::keys::{Content, DataFile};
use spunlaid_ground::threads::lock;
use spunlaid_ground::{Diagnostic, FileError, FileKind, Interval, Vec3, file};
use std::fmt::Debug;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// Largest profile or spectrum read [bytes].
const LARGEST_TABLE: u64 = 1 << 24;

/// What is read of a file, and what is said of it.
type Found = Result<(Content, Vec<Diagnostic>), FileError>;

/// What the case says of the files of its records and of its field.
pub(super) struct Layouts {
    pub(super) record: RecordLayout,
    pub(super) field: FieldLayout,
}

/// A file by its path, what it is read as, and a text that distinguishes different ways to read it.
type FileKey = (PathBuf, DataFile, String);

/// The files read so far, of which a study names few.
#[derive(Debug, Default)]
pub(super) struct DataFiles(Mutex<Vec<(FileKey, Found)>>);

impl DataFiles {
    /// The content of a file that is kept from an earlier reading, or is read now.
    pub(super) fn read(&self, kind: DataFile, path: &Path, layouts: &Layouts) -> Found {
        let way = match kind {
            DataFile::Records => way_of(&layouts.record),
            DataFile::Field => way_of(&layouts.field),
            _ => String::new(),
        };
        let key = (path.to_owned(), kind, way);
        if let Some((_, known)) = lock(&self.0).iter().find(|(other, _)| *other == key) {
            return known.clone();
        }
        // The error may be about a file that this one names.
        let found = read(kind, path, layouts, &key.2).map_err(|error| error.path(path));
        lock(&self.0).push((key, found.clone()));
        found
    }
}

fn read(kind: DataFile, path: &Path, layouts: &Layouts, way: &str) -> Found {
    let content = match kind {
        DataFile::Profile => Content::Profile(table(path, FileKind::Table, profile::profile)?),
        DataFile::Spectrum => Content::Spectrum(table(path, FileKind::Table, profile::spectrum)?),
        DataFile::SpinlineAir => Content::SpinlineAir(table(path, FileKind::Table, profile::spinline_air)?),
        DataFile::Polymer => Content::Polymer(table(path, FileKind::Case, |bytes| {
            polymer::read(&text_of(bytes.to_vec())?, &path.display().to_string())
        })?),
        DataFile::FrictionLaw | DataFile::NormalLaw => {
            let law = table(path, FileKind::Table, profile::drag_law)?;
            let remark = profile::interpolation(&law);
            return Ok((Content::DragLaw(law), vec![remark]));
        }
        DataFile::Field => {
            let ReadField { field, warnings, checksum, parts } = ReadField::read(path, &layouts.field)?;
            let content = Content::Field(from_file(path, checksum, field).with_parts(parts).read_as(way));
            return Ok((
                content,
                warnings.iter().map(|fault| Diagnostic::warning(fault.to_string())).collect(),
            ));
        }
        // All that `spunlaid analyse` says is said of a record.
        DataFile::Records => {
            let record = &layouts.record;
            let columns = record.columns.iter().flat_map(|columns| columns.split(','));
            let settings = Layout {
                rate: record.rate,
                skip_lines: record.skip.unwrap_or(0),
                columns: columns.map(|column| column.trim().to_owned()).collect(),
                time_column: record.time.clone(),
                velocity_unit: record.velocity_unit.clone(),
                longest_gap: record.max_gap.map_or(LONGEST_GAP, |samples| samples as usize),
                ..Layout::default()
            };
            let read = read_record(path, &settings)?;
            let checksum = read.reading.checksum;
            let (measured, remarks) = measured(read)?;
            let measured = Measured { layout: record.clone(), ..measured };
            return Ok((Content::Records(vec![from_file(path, checksum, measured).read_as(way)]), remarks));
        }
    };
    Ok((content, Vec::new()))
}

/// The content of a small file.
fn table<T>(
    path: &Path,
    kind: FileKind,
    read: impl FnOnce(&[u8]) -> Result<T, FileError>,
) -> Result<FileContent<T>, FileError> {
    let bytes = file::read(path, kind, LARGEST_TABLE)?;
    Ok(from_file(path, crc32fast::hash(&bytes), read(&bytes)?))
}

/// The fluctuation of a record with the numbers of the air that it gives, and what is said of it.
fn measured(record: Record) -> Result<(Measured, Vec<Diagnostic>), FileError> {
    let repairs = record.repairs().into_iter().map(|fault| Diagnostic::note(fault.to_string()));
    let analysis = analyse_fluctuation(&record, &Settings::default())?;
    let with_mean = analysis.has_mean();
    let known_value = |interval: &Interval| with_mean.then_some(interval.value);
    let says = RecordNumbers {
        velocity: known_value(&analysis.mean_velocity),
        turbulence_intensity: known_value(&analysis.turbulence_intensity),
        length_scale: known_value(&analysis.length_scale),
        cutoff_frequency: analysis.cutoff_frequency.value,
    };
    let components: Vec<&[f64]> = record.components.iter().map(|c| c.values.as_slice()).collect();
    let measured = Measured::new(record.interval, &components, analysis.integral_time.value, says);
    let warnings = analysis.warnings.iter().map(|fault| Diagnostic::warning(fault.to_string()));
    Ok((measured, repairs.chain(warnings).collect()))
}

/// Reads places from a table with the columns x, y and z, each with its unit [m].
///
/// # Errors
/// If the file cannot be read, or lacks a column, a unit or a number; the message says where.
pub fn read_points(path: &Path) -> Result<Vec<Vec3<f64>>, FileError> {
    table(path, FileKind::Table, profile::points)
        .map(|points| points.to_vec())
        .map_err(|error| error.path(path))
}

fn from_file<T>(path: &Path, checksum: u32, content: T) -> FileContent<T> {
    FileContent::new(path.to_owned(), checksum, Arc::new(content))
}

/// A text that distinguishes different ways to read a file; empty if the case says nothing of it.
fn way_of<T: Debug + Default + PartialEq>(layout: &T) -> String {
    if *layout == T::default() { String::new() } else { format!("{layout:?}") }
}
