//! Why results could not be written.

use parquet::errors::ParquetError;
use spunlaid::error::Error;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// Why results could not be written.
#[derive(Debug)]
pub enum Failure {
    /// An error of the simulation itself.
    Simulation(Error),
    /// A file or folder cannot be written.
    Unwritable {
        /// Where it was to be.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// The folder holds results already.
    HoldsResults {
        /// The folder.
        folder: PathBuf,
        /// The part of the results that was found.
        found: String,
    },
    /// The folder is a file.
    NotAFolder {
        /// The file.
        path: PathBuf,
    },
    /// A figure cannot be drawn.
    Figure {
        /// Its name.
        name: String,
        /// Why.
        reason: String,
    },
    /// A table cannot be encoded.
    Table {
        /// Where it was to be.
        path: PathBuf,
        /// Why.
        source: ParquetError,
    },
    /// The folder holds another study.
    OtherStudy {
        /// The folder.
        folder: PathBuf,
        /// How they differ, a line each.
        differences: Vec<String>,
    },
    /// The folder holds a study of another version.
    OtherVersion {
        /// The folder.
        folder: PathBuf,
        /// That version.
        version: String,
    },
    /// The folder holds a study with more replicates.
    FewerReplicates {
        /// The folder.
        folder: PathBuf,
        /// Replicates that it holds.
        held: u64,
        /// Replicates that were asked for.
        asked: u64,
    },
}

impl Failure {
    /// Whether the user can mend it by asking for something else.
    pub const fn is_wrong_input(&self) -> bool {
        matches!(
            self,
            Self::HoldsResults { .. }
                | Self::NotAFolder { .. }
                | Self::OtherStudy { .. }
                | Self::OtherVersion { .. }
                | Self::FewerReplicates { .. }
        )
    }

    /// A file or folder that the operating system does not let us write.
    pub fn unwritable(path: &Path) -> impl Fn(io::Error) -> Self + '_ {
        |source| Self::Unwritable { path: path.to_owned(), source }
    }

    /// A table that cannot be written. If the operating system refused, its message is used.
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
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Simulation(error)
    }
}

impl std::error::Error for Failure {}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Simulation(error) => error.fmt(f),
            Self::Unwritable { path, source } => {
                let space = match source.kind() {
                    io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "free some space, or ",
                    _ => "",
                };
                write!(f, "{}: cannot be written: {source}; {space}name another folder", path.display())
            }
            Self::HoldsResults { folder, found } => write!(
                f,
                "{}: holds results already ({found}); name another folder, or replace them",
                folder.display()
            ),
            Self::NotAFolder { path } => write!(f, "{}: is a file; name a folder", path.display()),
            Self::Figure { name, reason } => write!(f, "figure {name} cannot be drawn: {reason}"),
            Self::OtherStudy { folder, differences } => other_study(f, folder, differences),
            Self::OtherVersion { folder, version } => write!(
                f,
                "{}: holds a study of spunlaid {version}, and this is {}; their numbers may differ in the last bits and \
                 are not mixed. The results there can still be read. Continue with spunlaid {version}, name another \
                 folder, or start again",
                folder.display(),
                env!("CARGO_PKG_VERSION")
            ),
            Self::FewerReplicates { folder, held, asked } => write!(
                f,
                "{}: holds {held} replicates of a point, more than the {asked} of this study; ask for {held} or more, name \
                 another folder, or start again",
                folder.display()
            ),
            Self::Table { path, source } => write!(f, "{}: cannot be written: {source}", path.display()),
        }
    }
}

/// Largest number of differences that are listed.
const MOST_TOLD: usize = 20;

fn other_study(f: &mut fmt::Formatter<'_>, folder: &Path, differences: &[String]) -> fmt::Result {
    let folder = folder.display();
    if differences.is_empty() {
        return write!(
            f,
            "{folder}: holds results of this study, but its points have changed because the program has changed. Name \
             another folder (--out), or start again (--force)"
        );
    }
    write!(
        f,
        "{folder}: holds results of another study; name another folder (--out), start again (--force), or undo \
         these differences:"
    )?;
    differences.iter().take(MOST_TOLD).try_for_each(|line| write!(f, "\n{line}"))?;
    match differences.len().checked_sub(MOST_TOLD) {
        Some(more @ 1..) => write!(f, "\nand {more} more"),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_that_the_system_refuses_is_a_file_that_cannot_be_written() {
        let full = io::Error::from(io::ErrorKind::StorageFull);
        let refused = Failure::table(Path::new("t"), ParquetError::External(Box::new(full)));
        assert!(
            matches!(refused, Failure::Unwritable { .. }) && refused.to_string().contains("free some space")
        );
        let other = Failure::table(Path::new("t"), ParquetError::General("no".to_owned()));
        assert!(matches!(other, Failure::Table { .. }));
        assert!(!refused.is_wrong_input() && !other.is_wrong_input());
    }
}
