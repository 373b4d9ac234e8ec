//! Why the program ends without doing what it was asked.

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
    /// The output folder holds results already.
    HoldsResults { folder: PathBuf, found: String },
    /// The output folder is a file.
    NotAFolder { path: PathBuf },
    /// `new` would overwrite a file.
    Exists { path: PathBuf },
    /// A figure cannot be drawn.
    Figure { name: String, reason: String },
    /// A table cannot be encoded.
    Table { path: PathBuf, source: parquet::errors::ParquetError },
}

impl Failure {
    pub(crate) fn unwritable(path: &Path) -> impl Fn(io::Error) -> Self + '_ {
        |source| Self::Unwritable { path: path.to_owned(), source }
    }

    /// 1 the input is wrong, 2 the run failed, 130 interrupted.
    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Self::Library(spunlaid::error::Error::Interrupted) => 130,
            Self::Library(error) => error.exit_code(),
            Self::Figure { .. } => 2,
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
            Self::HoldsResults { folder, found } => write!(
                f,
                "{}: holds results already ({found}); name another folder with --out, or replace them with --force",
                folder.display()
            ),
            Self::NotAFolder { path } => {
                write!(f, "{}: is a file; name a folder with --out", path.display())
            }
            Self::Exists { path } => {
                write!(f, "{}: exists already and is left alone; name another file", path.display())
            }
            Self::Figure { name, reason } => write!(f, "figure {name} cannot be drawn: {reason}"),
            Self::Table { path, source } => write!(f, "{}: cannot be written: {source}", path.display()),
        }
    }
}
