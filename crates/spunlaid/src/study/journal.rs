//! The journal: it stores a record of every replicate as soon as it is finished.
//!
//! ```text
//! header   one line of text: magic word, format, version of the program, identity of the study
//! record   crc32 · kind · point · replicate · numbers, little-endian, all records of equal length
//! ```
//!
//! Records are appended, never changed. A record that a crash has cut off or damaged fails its checksum; it does not
//! count, and its replicate is made again.

use super::measures::{Record, ReplicateOutcome};
use crate::error::{Error, Fault};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

const MAGIC: &str = "spunlaid-journal";
/// The third format had an identity that no other version of the program could compute.
const FORMAT: u32 = 4;
/// Longest header [bytes].
const LONGEST_HEADER: usize = 200;
/// Length of a record without its numbers [bytes].
const HEAD: usize = 4 + 4 + 8 + 8;
/// Fewest numbers of a record: a lost fibre has two.
const FEWEST: usize = 2;
/// Kinds of records.
const MEASURED: u32 = 1;
const LOST: u32 = 2;

/// The study that a journal belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Header {
    /// Version of the program.
    pub version: String,
    /// Identity of the study: a checksum over everything that its records depend on.
    pub study: u32,
}

/// The content of an opened journal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JournalState {
    /// Replicates.
    pub fibres: u64,
    /// Records with a wrong checksum.
    pub damaged: u64,
    /// Whether the last record was incomplete; it has been removed.
    pub torn: bool,
}

/// The records of a study, in a file or in memory.
#[derive(Debug)]
pub struct Journal {
    backing: Backing,
    /// By point and replicate: index of the record plus one; zero means no record.
    slots: Vec<Vec<u32>>,
    /// Number of records, including damaged ones.
    records: u32,
    /// Numbers of each record.
    numbers: usize,
}

#[derive(Debug)]
enum Backing {
    Memory(Vec<Record>),
    File { file: File, path: PathBuf, start: u64 },
}

impl Journal {
    /// A journal in memory.
    pub fn in_memory(points: usize) -> Self {
        Self {
            backing: Backing::Memory(Vec::new()),
            slots: vec![Vec::new(); points],
            records: 0,
            numbers: FEWEST,
        }
    }

    /// Opens the file, creates it if it does not exist, and locks it for this process until the journal is dropped.
    ///
    /// Returns the journal, which is empty until [`begin`](Self::begin) or [`go_on`](Self::go_on), and the header;
    /// `None` if the file is new or its header is incomplete.
    ///
    /// * `fresh` – what the file holds is removed
    ///
    /// # Errors
    /// When another process has locked it, when it is not a journal or has another format, and when it cannot be read.
    pub fn open(path: &Path, fresh: bool) -> Result<(Self, Option<Header>), Error> {
        let failed = |source| unusable(path, &source);
        let mut options = OpenOptions::new();
        let mut file = options.read(true).append(true).create(true).open(path).map_err(failed)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(in_use(path)),
            // Some file systems have no locks; the user must then start one process only.
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(failed(error)),
        }
        if fresh {
            file.set_len(0).map_err(|source| unwritable(path, &source))?;
        }
        let mut head = Vec::new();
        (&mut file).take(LONGEST_HEADER as u64).read_to_end(&mut head).map_err(failed)?;
        let (header, start) = match head.iter().position(|byte| *byte == b'\n') {
            Some(end) => {
                let line = head.get(..end).unwrap_or_default();
                let header = parse_header(path, &String::from_utf8_lossy(line))?;
                (Some(header), end as u64 + 1)
            }
            // An incomplete header, as left by a crash.
            None if head.len() < LONGEST_HEADER
                && MAGIC.as_bytes().starts_with(first(&head, MAGIC.len())) =>
            {
                (None, 0)
            }
            None => return Err(foreign(path)),
        };
        let backing = Backing::File { file, path: path.to_owned(), start };
        Ok((Self { backing, slots: Vec::new(), records: 0, numbers: FEWEST }, header))
    }

    /// Empties the journal and writes its header.
    ///
    /// * `numbers` – those of each record
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn begin(&mut self, header: &Header, points: usize, numbers: usize) -> Result<(), Error> {
        self.numbers = numbers.max(FEWEST);
        self.slots = vec![Vec::new(); points];
        self.records = 0;
        match &mut self.backing {
            Backing::Memory(records) => records.clear(),
            Backing::File { file, path, start } => {
                let Header { version, study } = header;
                let line = format!("{MAGIC} format={FORMAT} version={version} study={study:08x}\n");
                let written = file.set_len(0).and_then(|()| file.write_all(line.as_bytes()));
                let written = written.and_then(|()| file.sync_all());
                written.map_err(|source| unwritable(path, &source))?;
                *start = line.len() as u64;
            }
        }
        Ok(())
    }

    /// Reads the records of a study with this number of points, replicates and numbers of each record, and removes an
    /// incomplete last record.
    ///
    /// # Errors
    /// When the file cannot be read or shortened.
    pub fn go_on(
        &mut self,
        points: usize,
        most_replicates: u64,
        numbers: usize,
    ) -> Result<JournalState, Error> {
        self.numbers = numbers.max(FEWEST);
        let length_of_record = self.record();
        let Backing::File { file, path, start } = &mut self.backing else {
            return Ok(JournalState::default());
        };
        let start = *start;
        let failed = |source| unusable(path, &source);
        file.seek(SeekFrom::Start(start)).map_err(failed)?;
        self.slots = vec![Vec::new(); points];
        self.records = 0;
        let mut found = JournalState::default();
        // Number of records up to the last valid one.
        let mut sound = 0;
        let mut reader = BufReader::with_capacity(1 << 16, file);
        let mut bytes = vec![0; length_of_record];
        loop {
            let length = read_up_to(&mut reader, &mut bytes).map_err(failed)?;
            if length < length_of_record {
                found.torn = length > 0;
                break;
            }
            self.records += 1;
            let record = decode(&bytes)
                .filter(|record| record.point < points as u64 && record.replicate < most_replicates);
            match record {
                Some(record) => {
                    sound = self.records;
                    let slot = slot(&mut self.slots, &record);
                    if *slot == 0 {
                        *slot = self.records;
                        found.fibres += 1;
                    }
                }
                None => found.damaged += 1,
            }
        }
        if found.torn || sound < self.records {
            // New records must start at a multiple of the record length.
            let file = reader.into_inner();
            file.set_len(start + u64::from(sound) * length_of_record as u64).map_err(failed)?;
            self.records = sound;
        }
        Ok(found)
    }

    /// Appends records and hands them to the operating system.
    ///
    /// # Errors
    /// When the file cannot be written; a part that was written is removed again.
    pub fn add(&mut self, records: &[Record]) -> Result<(), Error> {
        let (length, numbers) = (self.record(), self.numbers);
        match &mut self.backing {
            Backing::Memory(kept) => kept.extend_from_slice(records),
            Backing::File { file, path, start } => {
                let bytes: Vec<u8> = records.iter().flat_map(|record| encode(record, numbers)).collect();
                if let Err(source) = file.write_all(&bytes) {
                    let _ = file.set_len(*start + u64::from(self.records) * length as u64);
                    return Err(unwritable(path, &source));
                }
            }
        }
        for record in records {
            self.records += 1;
            *slot(&mut self.slots, record) = self.records;
        }
        Ok(())
    }

    /// Length of a record [bytes].
    const fn record(&self) -> usize {
        HEAD + 8 * self.numbers
    }

    /// A second handle of the file, to flush records to the disk while others are appended.
    ///
    /// # Errors
    /// When the operating system cannot provide it.
    pub fn handle(&self) -> Result<Option<File>, Error> {
        match &self.backing {
            Backing::Memory(_) => Ok(None),
            Backing::File { file, path, .. } => {
                let failed = |source| unusable(path, &source);
                file.try_clone().map(Some).map_err(failed)
            }
        }
    }

    /// Number of recorded replicates of a point.
    pub fn held(&self, point: usize) -> u64 {
        self.slots
            .get(point)
            .map_or(0, |replicates| replicates.iter().filter(|slot| **slot != 0).count() as u64)
    }

    /// One more than the largest replicate that has a record, of any point.
    pub fn most_held(&self) -> u64 {
        self.slots.iter().map(|replicates| replicates.len() as u64).max().unwrap_or(0)
    }

    /// Number of recorded replicates of all points.
    pub fn total(&self) -> u64 {
        (0..self.slots.len()).map(|point| self.held(point)).sum()
    }

    /// Whether a fibre has a record.
    pub fn holds(&self, point: usize, replicate: u64) -> bool {
        self.slots
            .get(point)
            .and_then(|replicates| replicates.get(replicate as usize))
            .is_some_and(|slot| *slot != 0)
    }

    /// The existing records among the first `replicates` of a point, in order.
    ///
    /// # Errors
    /// When the file cannot be read, or another program has changed it.
    pub fn records(&mut self, point: usize, replicates: u64) -> Result<Vec<Record>, Error> {
        let length = self.record();
        let slots = self.slots.get(point).map_or(&[][..], Vec::as_slice);
        let slots = slots.iter().take(replicates as usize).filter(|slot| **slot != 0).map(|slot| slot - 1);
        match &mut self.backing {
            Backing::Memory(kept) => Ok(slots.filter_map(|i| kept.get(i as usize).cloned()).collect()),
            Backing::File { file, path, start } => {
                let mut read = |i: u32| {
                    let mut bytes = vec![0; length];
                    file.seek(SeekFrom::Start(*start + u64::from(i) * length as u64))?;
                    file.read_exact(&mut bytes)?;
                    decode(&bytes).ok_or_else(|| std::io::Error::from(ErrorKind::InvalidData))
                };
                let failed = |source| unusable(path, &source);
                slots.map(|i| read(i).map_err(failed)).collect()
            }
        }
    }
}

fn first(bytes: &[u8], most: usize) -> &[u8] {
    bytes.get(..most).unwrap_or(bytes)
}

fn slot<'a>(slots: &'a mut [Vec<u32>], record: &Record) -> &'a mut u32 {
    let replicates = &mut slots[record.point as usize];
    let replicate = record.replicate as usize;
    if replicates.len() <= replicate {
        replicates.resize(replicate + 1, 0);
    }
    &mut replicates[replicate]
}

/// Another process has the journal open.
pub fn in_use(path: &Path) -> Error {
    let remedy = "wait until it ends, or use another folder";
    Error::folder(path, Fault::new("another spunlaid process is using this folder", remedy).option("--out"))
}

/// The file is not a journal.
pub fn foreign(path: &Path) -> Error {
    let fault = Fault::new(
        "is not the journal of a study, or its first line is damaged, so its records cannot be used",
        "use another folder, or start again",
    );
    Error::folder(path, fault.option("--out, --force"))
}

/// The journal has another format.
pub fn other_format(path: &Path, format: &str, known: u32) -> Error {
    let fault = Fault::new(
        format!("is a journal of format {format}, but this spunlaid reads format {known}"),
        "continue with the version of spunlaid that wrote it, use another folder, or start again",
    );
    Error::folder(path, fault.option("--out, --force"))
}

/// The file cannot be opened or read.
fn unusable(path: &Path, source: &std::io::Error) -> Error {
    Error::system(path, Fault::plain(format!("cannot be read: {source}")))
}

/// Records cannot be appended.
fn unwritable(path: &Path, source: &std::io::Error) -> Error {
    let message = format!("cannot be written: {source}. All finished fibres are kept");
    let fault = Fault::new(message, "solve this problem, then continue the study");
    Error::system(path, fault.option("repeat the command"))
}

/// The records cannot be flushed to the disk.
pub fn unsynced(source: &std::io::Error) -> Error {
    let message = format!("the journal cannot be saved to the disk: {source}");
    let fault = Fault::new(message, "solve this problem, then continue the study");
    Error::System(Box::new(fault.option("repeat the command").into()))
}

fn parse_header(path: &Path, line: &str) -> Result<Header, Error> {
    let rest = line.strip_prefix(MAGIC).ok_or_else(|| foreign(path))?;
    let field = |name: &str| {
        let fields = rest.split_whitespace().filter_map(|field| field.split_once('='));
        fields.filter(|(key, _)| *key == name).map(|(_, value)| value).next()
    };
    let format = field("format").ok_or_else(|| foreign(path))?;
    if format != FORMAT.to_string() {
        return Err(other_format(path, &crate::units::excerpt(format, 20), FORMAT));
    }
    match (field("version"), field("study").map(|text| u32::from_str_radix(text, 16))) {
        (Some(version), Some(Ok(study))) => Ok(Header { version: version.to_owned(), study }),
        _ => Err(foreign(path)),
    }
}

/// Fills `bytes` as far as the reader has data.
fn read_up_to(reader: &mut impl Read, bytes: &mut [u8]) -> std::io::Result<usize> {
    let mut length = 0;
    while length < bytes.len() {
        match reader.read(&mut bytes[length..]) {
            Ok(0) => break,
            Ok(more) => length += more,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(length)
}

/// The bytes of a record of so many numbers.
fn encode(record: &Record, numbers: usize) -> Vec<u8> {
    let mut bytes = vec![0; 4];
    let (kind, values) = match &record.outcome {
        ReplicateOutcome::Measured(measured) => (MEASURED, measured.to_vec()),
        ReplicateOutcome::Lost { node, time } => (LOST, vec![*node as f64, *time]),
    };
    let missing = vec![0.0; numbers.saturating_sub(values.len())];
    bytes.extend(kind.to_le_bytes());
    bytes.extend(record.point.to_le_bytes());
    bytes.extend(record.replicate.to_le_bytes());
    bytes.extend(values.iter().chain(&missing).take(numbers).flat_map(|value| value.to_le_bytes()));
    let sum = crc32fast::hash(&bytes[4..]);
    bytes[..4].copy_from_slice(&sum.to_le_bytes());
    bytes
}

/// The record; `None` if its checksum is wrong.
fn decode(bytes: &[u8]) -> Option<Record> {
    let (sum, rest) = bytes.split_first_chunk::<4>()?;
    if crc32fast::hash(rest) != u32::from_le_bytes(*sum) {
        return None;
    }
    let (kind, rest) = rest.split_first_chunk::<4>()?;
    let (point, rest) = rest.split_first_chunk::<8>()?;
    let (replicate, rest) = rest.split_first_chunk::<8>()?;
    let values: Option<Box<[f64]>> =
        rest.chunks_exact(8).map(|bytes| Some(f64::from_le_bytes(bytes.try_into().ok()?))).collect();
    let values = values.filter(|values| values.len() >= FEWEST)?;
    let outcome = match u32::from_le_bytes(*kind) {
        MEASURED => ReplicateOutcome::Measured(values),
        LOST => ReplicateOutcome::Lost { node: values[0] as u64, time: values[1] },
        _ => return None,
    };
    let (point, replicate) = (u64::from_le_bytes(*point), u64::from_le_bytes(*replicate));
    Some(Record { point, replicate, outcome })
}

#[cfg(test)]
mod tests;
