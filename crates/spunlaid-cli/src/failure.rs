//! Why the program ends without doing what it was asked.

use parquet::errors::ParquetError;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// Why the program ends early.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The library says no.
    Library(spunlaid::error::Error),
    /// A file or folder cannot be written.
    Unwritable { path: PathBuf, source: io::Error },
    /// The file of `new` cannot be written.
    NotWritten { path: PathBuf, source: io::Error },
    /// The output folder holds results already.
    HoldsResults { folder: PathBuf, found: String },
    /// The output folder is a file.
    NotAFolder { path: PathBuf },
    /// `new` would overwrite a file.
    Exists { path: PathBuf },
    /// A figure cannot be drawn.
    Figure { name: String, reason: String },
    /// What was to be read on standard output could not be written there.
    Unheard { why: &'static io::Error },
    /// A study was interrupted.
    Paused { done: u64, of: u64 },
    /// The output folder holds another study.
    OtherStudy { folder: PathBuf, differences: Vec<String> },
    /// The output folder holds a study of another version.
    OtherVersion { folder: PathBuf, version: String },
    /// The paper has no such figure.
    NoSuchFigure { name: String, known: String },
    /// No key is like this.
    NoSuchKey { pattern: String, nearest: Vec<&'static str> },
    /// A study has fewer points than that.
    NoSuchPoint { point: u64, points: u64 },
    /// Fibres stopped being finite.
    FibresLost { lost: u64, of: u64, first: Vec<String> },
    /// A table cannot be encoded.
    Table { path: PathBuf, source: ParquetError },
}

impl Failure {
    pub(crate) fn unwritable(path: &Path) -> impl Fn(io::Error) -> Self + '_ {
        |source| Self::Unwritable { path: path.to_owned(), source }
    }

    /// A table that could not be written: what the system says, where it is the one that refused.
    pub(crate) fn table(path: &Path, error: ParquetError) -> Self {
        let path = path.to_owned();
        match error {
            ParquetError::External(cause) => match cause.downcast::<io::Error>() {
                Ok(source) => Self::Unwritable { path, source: *source },
                Err(cause) => Self::Table { path, source: ParquetError::External(cause) },
            },
            source => Self::Table { path, source },
        }
    }

    /// 1 the input is wrong, 2 the run failed, 130 interrupted.
    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Self::Library(spunlaid::error::Error::Interrupted) | Self::Paused { .. } => 130,
            Self::Library(error) => error.exit_code(),
            Self::Figure { .. } | Self::FibresLost { .. } | Self::Unheard { .. } | Self::NoSuchKey { .. } => {
                2
            }
            _ => 1,
        }
    }
}

impl From<spunlaid::error::Error> for Failure {
    fn from(error: spunlaid::error::Error) -> Self {
        Self::Library(error)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Library(spunlaid::error::Error::Interrupted) => {
                write!(f, "interrupted; nothing was written. The same command starts again")
            }
            Self::Library(error) => error.fmt(f),
            Self::Unwritable { path, source } => {
                write!(f, "{}: cannot be written: {source}; ", path.display())?;
                match source.kind() {
                    io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
                        write!(f, "free some space, or name another folder with --out")
                    }
                    _ => write!(f, "name another folder with --out"),
                }
            }
            Self::NotWritten { path, source } => {
                write!(f, "{}: cannot be written: {source}; name another file", path.display())
            }
            Self::HoldsResults { folder, found } => write!(
                f,
                "{}: holds results already ({found}); name another folder with --out, or replace them with --force",
                folder.display()
            ),
            Self::NoSuchFigure { name, known } => {
                write!(f, "--figures {name}: there is no such result figure; write some of {known}")
            }
            Self::NoSuchKey { pattern, nearest } => {
                write!(f, "no key has \"{}\" in its name or meaning; ", pattern.escape_debug())?;
                match &nearest[..] {
                    [] => f.write_str("`spunlaid keys` lists them all"),
                    keys => write!(f, "did you mean {}?", keys.join(" or ")),
                }
            }
            Self::NotAFolder { path } => {
                write!(f, "{}: is a file; name a folder with --out", path.display())
            }
            Self::Exists { path } => {
                write!(f, "{}: exists already and is left alone; name another file", path.display())
            }
            Self::Figure { name, reason } => write!(f, "figure {name} cannot be drawn: {reason}"),
            Self::Unheard { why } => {
                write!(f, "standard output: cannot be written: {why}; all else is done")
            }
            Self::Paused { done, of } => {
                write!(f, "interrupted; {done} of {of} fibres are done and kept. The same command goes on")
            }
            Self::OtherStudy { folder, differences } => other_study(f, folder, differences),
            Self::OtherVersion { folder, version } => write!(
                f,
                "{}: holds a study of spunlaid {version}, and this is {}; their numbers may differ in the last bits and \
                 are not mixed. What is there can be read as it is; go on with spunlaid {version}, name another folder \
                 with --out, or start anew with --force",
                folder.display(),
                env!("CARGO_PKG_VERSION")
            ),
            Self::NoSuchPoint { point, points } => {
                write!(f, "--print-point {point}: the study has {points} points, counted from 1")
            }
            Self::FibresLost { lost, of, first } => {
                write!(
                    f,
                    "{lost} of {of} fibres were lost, their positions no longer numbers; all others are in the results"
                )?;
                first.iter().try_for_each(|line| write!(f, "\n{line}"))
            }
            Self::Table { path, source } => write!(f, "{}: cannot be written: {source}", path.display()),
        }
    }
}

/// Most differences that are told.
const MOST_TOLD: usize = 20;

fn other_study(f: &mut fmt::Formatter<'_>, folder: &Path, differences: &[String]) -> fmt::Result {
    let folder = folder.display();
    if differences.is_empty() {
        return write!(
            f,
            "{folder}: holds results of this study, but its points are not the same now: the program itself has \
             changed. Name another folder with --out, or start anew with --force"
        );
    }
    write!(
        f,
        "{folder}: holds results of another study; name another folder with --out, start anew with --force, or change \
         back what differs:"
    )?;
    differences.iter().take(MOST_TOLD).try_for_each(|line| write!(f, "\n{line}"))?;
    match differences.len().checked_sub(MOST_TOLD) {
        Some(more @ 1..) => write!(f, "\nand {more} more"),
        _ => Ok(()),
    }
}
