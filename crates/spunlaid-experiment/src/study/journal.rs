//! The journal: it stores a record of every replicate as soon as it is finished, under its point and its number.
//!
//! ```text
//! header   one line of text: magic word, format, version of the program, identity of the study
//! record   1 and what was measured, or 2, node and time of a fibre that was lost
//! ```
//!
//! Records are added to a [`Log`], never changed. One that a crash has cut off or damaged does not count, and its
//! replicate is made again.

use super::measures::{Record, ReplicateOutcome};
use spunlaid_ground::{Error, Fault, Log};
use std::fs::File;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

const MAGIC: &str = "spunlaid-journal";
/// The fifth format is the first one whose records are rows of a log.
const FORMAT: u32 = 5;
/// Longest header [bytes].
const LONGEST_HEADER: usize = 200;
/// Kinds of records.
const MEASURED: f64 = 1.0;
const LOST: f64 = 2.0;

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
    log: Log,
    path: PathBuf,
    /// Length of the header [bytes].
    start: u64,
}

impl Journal {
    /// A journal in memory.
    pub fn in_memory() -> Self {
        Self { log: Log::in_memory(), path: PathBuf::new(), start: 0 }
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
        let mut log = Log::lock(path).map_err(|source| match source.kind() {
            ErrorKind::WouldBlock => in_use(path),
            _ => failed(source),
        })?;
        if fresh {
            log.begin("").map_err(|source| unwritable(path, &source))?;
        }
        let head = log.head(LONGEST_HEADER).map_err(failed)?;
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
        Ok((Self { log, path: path.to_owned(), start }, header))
    }

    /// Empties the journal and writes its header.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn begin(&mut self, Header { version, study }: &Header) -> Result<(), Error> {
        let line = format!("{MAGIC} format={FORMAT} version={version} study={study:08x}\n");
        self.log.begin(&line).map_err(|source| unwritable(&self.path, &source))
    }

    /// Finds the records of a study with this number of points and replicates, and removes an incomplete last record.
    ///
    /// # Errors
    /// When the file cannot be read or shortened.
    pub fn go_on(&mut self, points: usize, most_replicates: u64) -> Result<JournalState, Error> {
        self.log.go_on(self.start).map_err(|source| unusable(&self.path, &source))?;
        let others =
            self.log.retain(|[point, replicate]| point < points as u64 && replicate < most_replicates);
        Ok(JournalState { fibres: self.total(), damaged: self.log.damaged + others, torn: self.log.torn })
    }

    /// Appends records and hands them to the operating system.
    ///
    /// # Errors
    /// When the file cannot be written; the next record takes the place of a part that was written.
    pub fn add(&mut self, records: &[Record]) -> Result<(), Error> {
        records.iter().try_for_each(|Record { point, replicate, outcome }| {
            let (kind, values) = match outcome {
                ReplicateOutcome::Measured(measured) => (MEASURED, measured.to_vec()),
                ReplicateOutcome::Lost { node, time } => (LOST, vec![*node as f64, *time]),
            };
            let numbers = [kind].into_iter().chain(values);
            self.log.append([*point, *replicate], numbers).map_err(|source| unwritable(&self.path, &source))
        })
    }

    /// A second handle of the file, to flush records to the disk while others are appended.
    ///
    /// # Errors
    /// When the operating system cannot provide it.
    pub fn handle(&self) -> Result<Option<File>, Error> {
        self.log.handle().map_err(|source| unusable(&self.path, &source))
    }

    /// Number of recorded replicates of a point.
    pub fn held(&self, point: usize) -> u64 {
        self.log.keys_of(point as u64).len() as u64
    }

    /// One more than the largest replicate that has a record, of any point.
    pub fn most_held(&self) -> u64 {
        self.log.keys().into_iter().map(|[_, replicate]| replicate + 1).max().unwrap_or(0)
    }

    /// Number of recorded replicates of all points.
    pub fn total(&self) -> u64 {
        self.log.keys().len() as u64
    }

    /// Whether a fibre has a record.
    pub fn holds(&self, point: usize, replicate: u64) -> bool {
        self.log.count([point as u64, replicate]) > 0
    }

    /// The existing records among the first `replicates` of a point, in order.
    ///
    /// # Errors
    /// When the file cannot be read, or another program has changed it.
    pub fn records(&mut self, point: usize, replicates: u64) -> Result<Vec<Record>, Error> {
        let point = point as u64;
        let held = self.log.keys_of(point).into_iter().filter(|replicate| *replicate < replicates);
        let record = |replicate: u64| {
            let numbers = self.log.pieces([point, replicate]).next()?;
            Some(numbers.map(|numbers| Record { point, replicate, outcome: outcome(&numbers) }))
        };
        held.filter_map(record).map(|record| record.map_err(|source| unusable(&self.path, &source))).collect()
    }
}

/// What the numbers of a record say.
fn outcome(numbers: &[f64]) -> ReplicateOutcome {
    match numbers {
        [LOST, node, time] => ReplicateOutcome::Lost { node: *node as u64, time: *time },
        numbers => ReplicateOutcome::Measured(numbers.iter().skip(1).copied().collect()),
    }
}

fn first(bytes: &[u8], most: usize) -> &[u8] {
    bytes.get(..most).unwrap_or(bytes)
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
pub(crate) fn other_format(path: &Path, format: &str, known: u32) -> Error {
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
        return Err(other_format(path, &spunlaid_ground::units::excerpt(format, 20), FORMAT));
    }
    match (field("version"), field("study").map(|text| u32::from_str_radix(text, 16))) {
        (Some(version), Some(Ok(study))) => Ok(Header { version: version.to_owned(), study }),
        _ => Err(foreign(path)),
    }
}

#[cfg(test)]
mod tests;
