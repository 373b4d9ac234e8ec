//! Reads the data files that a case names, each of them once for all points of a study.

mod polymer;
mod profile;

use crate::air::{FileContent, Measured, Profile, RecordLayout, RecordNumbers, SpectrumTable};
use crate::case::Remark;
use crate::error::{FileError, FileKind};
use crate::field::{Field, FieldLayout, ReadField};
use crate::file;
use crate::input::file::text as text_of;
use crate::record::{Interval, LONGEST_GAP, Layout, Record, Settings, analyse_fluctuation, read_record};
use crate::spinline::{AirTable, PolymerFile};
use std::cell::RefCell;
use std::fmt::Debug;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Largest profile or spectrum read [bytes].
const LARGEST_TABLE: u64 = 1 << 24;

/// The files read so far, by path.
#[derive(Default)]
pub(super) struct DataFiles {
    profiles: Shelf<FileContent<Profile>>,
    spectra: Shelf<FileContent<SpectrumTable>>,
    records: Shelf<(FileContent<Measured>, Vec<Remark>)>,
    fields: Shelf<(FileContent<Field>, Vec<Remark>)>,
    spinline_airs: Shelf<FileContent<AirTable>>,
    polymers: Shelf<FileContent<PolymerFile>>,
}

/// Files, of which a study names few; the text tells different ways to read a file apart.
type FileKey = (PathBuf, String);

/// What was read of each file, or the error.
type Shelf<T> = RefCell<Vec<(FileKey, Result<T, FileError>)>>;

impl DataFiles {
    /// A profile of the air.
    pub(super) fn profile(&self, path: &Path) -> Result<FileContent<Profile>, FileError> {
        once(&self.profiles, path, "", || {
            let bytes = file::read(path, FileKind::Table, LARGEST_TABLE)?;
            Ok(from_file(path, crc32fast::hash(&bytes), profile::profile(&bytes)?))
        })
    }

    /// A spectrum.
    pub(super) fn spectrum(&self, path: &Path) -> Result<FileContent<SpectrumTable>, FileError> {
        once(&self.spectra, path, "", || {
            let bytes = file::read(path, FileKind::Table, LARGEST_TABLE)?;
            Ok(from_file(path, crc32fast::hash(&bytes), profile::spectrum(&bytes)?))
        })
    }

    /// The air along a spinline.
    pub(super) fn spinline_air(&self, path: &Path) -> Result<FileContent<AirTable>, FileError> {
        once(&self.spinline_airs, path, "", || {
            let bytes = file::read(path, FileKind::Table, LARGEST_TABLE)?;
            Ok(from_file(path, crc32fast::hash(&bytes), profile::spinline_air(&bytes)?))
        })
    }

    /// The constants of a polymer.
    pub(super) fn polymer(&self, path: &Path) -> Result<FileContent<PolymerFile>, FileError> {
        once(&self.polymers, path, "", || {
            let bytes = file::read(path, FileKind::Case, LARGEST_TABLE)?;
            let checksum = crc32fast::hash(&bytes);
            let polymer = polymer::read(&text_of(bytes)?, &path.display().to_string())?;
            Ok(from_file(path, checksum, polymer))
        })
    }

    /// A CFD field, and what is said of it.
    ///
    /// * `layout` – the arrays that the case names
    pub(super) fn field(
        &self,
        path: &Path,
        layout: &FieldLayout,
    ) -> Result<(FileContent<Field>, Vec<Remark>), FileError> {
        let way = way_of(layout);
        once(&self.fields, path, &way, || {
            let ReadField { field, warnings, checksum, parts } = ReadField::read(path, layout)?;
            let remarks = warnings.into_iter().map(Remark::File).collect();
            Ok((from_file(path, checksum, field).with_parts(parts).read_as(&way), remarks))
        })
    }

    /// A velocity record, and what is said of it: all that `spunlaid analyse` says.
    ///
    /// * `layout` – what the case says of the file
    pub(super) fn record(
        &self,
        path: &Path,
        layout: &RecordLayout,
    ) -> Result<(FileContent<Measured>, Vec<Remark>), FileError> {
        let way = way_of(layout);
        once(&self.records, path, &way, || {
            let columns = layout.columns.iter().flat_map(|columns| columns.split(','));
            let settings = Layout {
                rate: layout.rate,
                skip_lines: layout.skip.unwrap_or(0),
                columns: columns.map(|column| column.trim().to_owned()).collect(),
                time_column: layout.time.clone(),
                velocity_unit: layout.velocity_unit.clone(),
                longest_gap: layout.max_gap.map_or(LONGEST_GAP, |samples| samples as usize),
                ..Layout::default()
            };
            let record = read_record(path, &settings)?;
            let checksum = record.reading.checksum;
            let (measured, remarks) = measured(record)?;
            let measured = Measured { layout: layout.clone(), ..measured };
            Ok((from_file(path, checksum, measured).read_as(&way), remarks))
        })
    }
}

/// The fluctuation of a record with the numbers of the air that it gives, and what is said of it.
fn measured(record: Record) -> Result<(Measured, Vec<Remark>), FileError> {
    let repairs = record.repairs().into_iter().map(Remark::Repaired);
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
    Ok((measured, repairs.chain(analysis.warnings.into_iter().map(Remark::File)).collect()))
}

fn from_file<T>(path: &Path, checksum: u32, content: T) -> FileContent<T> {
    FileContent::new(path.to_owned(), checksum, Arc::new(content))
}

/// A text that tells different ways to read a file apart; empty if the case says nothing of it.
fn way_of<T: Debug + Default + PartialEq>(layout: &T) -> String {
    if *layout == T::default() { String::new() } else { format!("{layout:?}") }
}

/// What was kept from an earlier reading, or what is read now.
fn once<T: Clone>(
    shelf: &Shelf<T>,
    path: &Path,
    way: &str,
    read: impl FnOnce() -> Result<T, FileError>,
) -> Result<T, FileError> {
    let is_it = |(file, by): &FileKey| file == path && by == way;
    if let Some((_, known)) = shelf.borrow().iter().find(|(key, _)| is_it(key)) {
        return known.clone();
    }
    // The error may be about a file that this one names.
    let content = read().map_err(|error| error.path(path));
    shelf.borrow_mut().push(((path.to_owned(), way.to_owned()), content.clone()));
    content
}
