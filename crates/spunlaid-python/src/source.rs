//! The file of a case, of a web or of a spinline that a user names.

use crate::watched::guarded;
use pyo3::prelude::*;
use spunlaid::ground::FileKind;
use spunlaid::input::read_text;
use std::path::{Path, PathBuf};

/// What is read.
pub(crate) struct Source {
    /// What results of it are called.
    pub(crate) name: String,
    pub(crate) text: String,
    /// What messages call it.
    pub(crate) file: String,
}

impl Source {
    /// Reads a file; without one the text is empty, because all keys are given as changes, and it is called
    /// `otherwise`.
    pub(crate) fn read(
        py: Python<'_>,
        path: Option<PathBuf>,
        kind: FileKind,
        otherwise: &str,
    ) -> PyResult<Self> {
        let Some(path) = path else {
            return Ok(Self { name: otherwise.to_owned(), text: String::new(), file: otherwise.to_owned() });
        };
        let text = guarded(py, || read_text(&path, kind))?;
        Ok(Self { name: stem(&path), text, file: path.display().to_string() })
    }
}

/// The full path of a file, so that it is found from any folder.
pub(crate) fn full_path(file: &Path) -> PathBuf {
    std::path::absolute(file).unwrap_or_else(|_| file.to_owned())
}

/// The name of a file without its extension.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
