//! Files that a case names: each read once, however many points of a study fly in it.

mod table;

use crate::air::{FromFile, Measured, Profile, Said, SpectrumTable};
use crate::error::{DataError, Error, RecordFault, RecordPlace, RecordProblem, TableFault};
use crate::field::{Field, FieldWarning};
use crate::record::{Interval, Layout, Record, Settings, analyse, read_record};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The files read so far, by path.
#[derive(Default)]
pub(super) struct DataFiles {
    profiles: Shelf<Profile>,
    spectra: Shelf<SpectrumTable>,
    records: Shelf<Measured>,
    fields: Shelf<Field>,
    field_warnings: RefCell<BTreeMap<PathBuf, Vec<FieldWarning>>>,
}

/// A file's content, or why there is none; the text tells apart ways to read it.
type Shelf<T> = RefCell<BTreeMap<(PathBuf, String), Result<FromFile<T>, DataError>>>;

impl DataFiles {
    /// A profile of the air.
    pub(super) fn profile(&self, path: &Path) -> Result<FromFile<Profile>, DataError> {
        once(&self.profiles, path, "", || {
            let (text, checksum) = small(path)?;
            Ok((table::profile(path, &text)?, checksum))
        })
    }

    /// A spectrum.
    pub(super) fn spectrum(&self, path: &Path) -> Result<FromFile<SpectrumTable>, DataError> {
        once(&self.spectra, path, "", || {
            let (text, checksum) = small(path)?;
            Ok((table::spectrum(path, &text)?, checksum))
        })
    }

    /// A CFD field, and what to know of it.
    pub(super) fn field(&self, path: &Path) -> Result<(FromFile<Field>, Vec<FieldWarning>), DataError> {
        let field = once(&self.fields, path, "", || {
            let (field, warnings) = Field::read(path).map_err(|error| DataError::Field(Box::new(error)))?;
            self.field_warnings.borrow_mut().insert(path.to_owned(), warnings);
            Ok((field, checksum(path)?))
        })?;
        Ok((field, self.field_warnings.borrow().get(path).cloned().unwrap_or_default()))
    }

    /// A velocity record.
    ///
    /// * `rate` – sampling rate [Hz], where the record has no column of time
    pub(super) fn record(&self, path: &Path, rate: Option<f64>) -> Result<FromFile<Measured>, DataError> {
        once(&self.records, path, &format!("{rate:?}"), || {
            let layout = Layout { rate, ..Layout::default() };
            let measured = read_record(path, &layout).and_then(measured).map_err(|error| {
                let of_system = |error: Error| RecordProblem {
                    file: path.display().to_string(),
                    place: RecordPlace::Whole,
                    column: None,
                    fault: RecordFault::Unreadable { message: error.to_string() },
                };
                DataError::Record(match error {
                    Error::Record(problem) => problem,
                    other => Box::new(of_system(other)),
                })
            })?;
            Ok((Measured { rate, ..measured }, checksum(path)?))
        })
    }
}

/// The fluctuation of a record, and what the record says of the air.
fn measured(record: Record) -> Result<Measured, Error> {
    let (analysis, with_mean) = match analyse(&record, &Settings::default()) {
        Err(Error::Record(problem)) if matches!(problem.fault, RecordFault::NoMean { .. }) => {
            // Any mean will do for what does not rest on it.
            (analyse(&record, &Settings { mean_velocity: Some(1.0), ..Settings::default() })?, false)
        }
        analysed => (analysed?, true),
    };
    let said = |interval: &Interval| with_mean.then_some(interval.value);
    let says = Said {
        velocity: said(&analysis.mean_velocity),
        turbulence_intensity: said(&analysis.turbulence_intensity),
        length_scale: said(&analysis.length_scale),
        cutoff_frequency: analysis.cutoff_frequency.value,
    };
    let components: Vec<&[f64]> = record.components.iter().map(|c| c.values.as_slice()).collect();
    Ok(Measured::new(record.interval, &components, analysis.integral_time.value, says))
}

/// What the file was found to hold before, or else what it holds now.
fn once<T>(
    shelf: &Shelf<T>,
    path: &Path,
    way: &str,
    read: impl FnOnce() -> Result<(T, u32), DataError>,
) -> Result<FromFile<T>, DataError> {
    let key = (path.to_owned(), way.to_owned());
    if let Some(known) = shelf.borrow().get(&key) {
        return known.clone();
    }
    let content =
        read().map(|(content, checksum)| FromFile::new(path.to_owned(), checksum, Arc::new(content)));
    shelf.borrow_mut().insert(key, content.clone());
    content
}

/// The bytes of a small table and their checksum.
fn small(path: &Path) -> Result<(Vec<u8>, u32), DataError> {
    let refused = |fault| DataError::Table { path: path.to_owned(), line: None, fault };
    let mut bytes = Vec::new();
    let file = open(path)?;
    file.take(table::LARGEST_TABLE + 1)
        .read_to_end(&mut bytes)
        .map_err(|source| refused(TableFault::Unreadable { message: source.to_string() }))?;
    if bytes.len() as u64 > table::LARGEST_TABLE {
        return Err(refused(TableFault::TooLarge { most: table::LARGEST_TABLE }));
    }
    let checksum = crc32fast::hash(&bytes);
    Ok((bytes, checksum))
}

/// Checksum of a file of any size.
fn checksum(path: &Path) -> Result<u32, DataError> {
    let unreadable = |source: std::io::Error| DataError::Table {
        path: path.to_owned(),
        line: None,
        fault: TableFault::Unreadable { message: source.to_string() },
    };
    let (mut file, mut sum) = (open(path)?, crc32fast::Hasher::new());
    let mut buffer = vec![0; 1 << 16];
    loop {
        match file.read(&mut buffer).map_err(unreadable)? {
            0 => return Ok(sum.finalize()),
            read => sum.update(buffer.get(..read).unwrap_or_default()),
        }
    }
}

fn open(path: &Path) -> Result<File, DataError> {
    let refused = |fault| DataError::Table { path: path.to_owned(), line: None, fault };
    let file = File::open(path).map_err(|source| {
        refused(match source.kind() {
            ErrorKind::NotFound => TableFault::NotThere,
            ErrorKind::IsADirectory => TableFault::IsFolder,
            _ => TableFault::Unreadable { message: source.to_string() },
        })
    })?;
    if file.metadata().is_ok_and(|about| about.is_dir()) {
        return Err(refused(TableFault::IsFolder));
    }
    Ok(file)
}
