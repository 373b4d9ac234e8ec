//! Folders that cannot take results, and results that cannot be written.

use parquet::errors::ParquetError;
use spunlaid_ground::{Diagnostic, Error, Fault};
use std::io;
use std::path::Path;

/// Why results could not be written: an error of the simulation, or of a folder.
pub type Failure = Error;

/// The folder is a file.
pub(crate) fn not_a_folder(path: &Path) -> Failure {
    Error::folder(path, Fault::new("is a file", "name a folder").option("--out"))
}

/// The folder holds results already.
///
/// * `found` – the part of the results that was found
pub(crate) fn holds_results(folder: &Path, found: &str) -> Failure {
    let fault =
        Fault::new(format!("holds results already ({found})"), "name another folder, or replace them");
    Error::folder(folder, fault.option("--out, --force"))
}

/// Results would be copied onto themselves.
pub(crate) fn copied_onto_itself(folder: &Path) -> Failure {
    Error::folder(
        folder,
        Fault::new("is where these results are", "name another folder, or leave them there"),
    )
}

/// The system refuses to move results that were being replaced.
///
/// * `staging` – where they lie
pub(crate) fn half_replaced(staging: &Path, error: io::Error) -> Failure {
    let fault = Fault::new(
        format!(
            "holds results that were being replaced, whole, and they cannot be moved to their places: {error}"
        ),
        "make the folder above it writable and run the command again; it moves them first",
    );
    Error::folder(staging, fault)
}

/// The folder holds files that are no results of this command.
///
/// * `first` – one of them
/// * `more` – how many more there are
pub(crate) fn holds_files_of_others(folder: &Path, first: &str, more: usize) -> Failure {
    let others = if more == 0 { String::new() } else { format!(" and {more} more") };
    let fault = Fault::new(
        format!("holds other files already ({first}{others}), and results are not mixed with them"),
        "name another folder, or write next to them",
    );
    Error::folder(folder, fault.option("--out, --force"))
}

/// The folder holds another study.
///
/// * `differences` – how they differ, a line each
pub(crate) fn other_study(folder: &Path, differences: Vec<String>) -> Failure {
    let fault = if differences.is_empty() {
        Fault::new(
            "holds results of this study, but its points have changed because the program has changed",
            "name another folder, or start again",
        )
    } else {
        Fault::new(
            "holds results of another study",
            "name another folder, start again, or undo the differences that follow",
        )
    };
    let refusal = Diagnostic::with_path(folder, fault.option("--out, --force"));
    let differences = differences.into_iter().map(|line| Fault::plain(line).into());
    Error::Folder(std::iter::once(refusal).chain(differences).collect())
}

/// The folder holds a study of another version.
pub(crate) fn other_version(folder: &Path, version: &str) -> Failure {
    let this = env!("CARGO_PKG_VERSION");
    let fault = Fault::new(
        format!(
            "holds a study of spunlaid {version}, and this is {this}; their numbers may differ by rounding and are \
            not mixed. The results there can still be read"
        ),
        format!("continue with spunlaid {version}, name another folder, or start again"),
    );
    Error::folder(folder, fault.option("--out, --force"))
}

/// A figure cannot be drawn.
pub(crate) fn undrawable(name: &str, reason: &str) -> Failure {
    Error::System(Box::new(Fault::plain(format!("figure {name} cannot be drawn: {reason}")).into()))
}

/// A table that cannot be written. If the operating system refused, its message is used.
pub(crate) fn table(path: &Path, error: ParquetError) -> Failure {
    let other = |error: &ParquetError| {
        Error::System(Box::new(Diagnostic::with_path(
            path,
            Fault::plain(format!("cannot be written: {error}")),
        )))
    };
    match error {
        ParquetError::External(cause) => match cause.downcast::<io::Error>() {
            Ok(source) => Error::unwritable(path)(*source),
            Err(cause) => other(&ParquetError::External(cause)),
        },
        error => other(&error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_that_the_system_refuses_is_a_file_that_cannot_be_written() {
        let full = io::Error::from(io::ErrorKind::StorageFull);
        let refused = table(Path::new("t"), ParquetError::External(Box::new(full)));
        assert!(refused.to_string().contains("free some space"), "{refused}");
        let other = table(Path::new("t"), ParquetError::General("no".to_owned()));
        assert_eq!((refused.exit_code(), other.exit_code()), (2, 2));
    }

    #[test]
    fn a_folder_of_another_study_lists_some_of_the_differences() {
        let differences = (0..30).map(|i| format!("study.toml: difference {i}")).collect();
        let message = other_study(Path::new("r"), differences).to_string();
        assert!(message.starts_with("r: holds results of another study; name another folder"), "{message}");
        assert_eq!(message.lines().nth(1), Some("study.toml: difference 0"));
        assert_eq!(message.lines().count(), 21);
    }
}
