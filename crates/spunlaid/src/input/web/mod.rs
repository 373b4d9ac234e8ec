//! Files of webs: reads a file to what is to be laid, and writes it back.

mod check;
mod laydown;
mod read;
mod sheet;
mod speeds;
mod write;

pub use write::write_web;

use super::{Overrides, document, file};
use crate::case::Note;
use crate::error::{Error, FileKind};
use crate::layers::WebSpec;
use crate::layers::keys::WEB;
use std::path::{Path, PathBuf};

/// The file of a web, read.
#[derive(Clone, Debug)]
pub struct WebFile {
    /// What is to be laid.
    pub spec: WebSpec,
    /// Notes and warnings about the cases that it names.
    pub notes: Vec<Note>,
    /// The file with every default written out.
    pub text: String,
}

/// Reads and checks the file of a web, and the cases that it names.
///
/// * `overrides` – keys and values that replace values of the file or add to them, `("line.belt_speed", "6 m/s")`; of a
///   file with `[[layer]]`, `layer.2.line.belt_speed` or the layer's name in place of its number
///
/// # Errors
/// If the file cannot be read, or if the web cannot be laid; then with every problem found.
pub fn read_web<'a>(path: &Path, overrides: impl Into<Overrides<'a>>) -> Result<WebFile, Error> {
    let text = file::read(path, FileKind::Web)?;
    parse_web(&text, &path.display().to_string(), overrides)
}

/// Reads and checks the text of the file of a web. Messages call the file `name`; cases are looked for in its folder.
///
/// # Errors
/// As [`read_web`].
pub fn parse_web<'a>(text: &str, name: &str, overrides: impl Into<Overrides<'a>>) -> Result<WebFile, Error> {
    parse_web_of_case(text, name, &[overrides.into()], &[], &[])
}

/// [`parse_web`] with the texts of the cases that it names, each with its path. They need not be files.
///
/// # Errors
/// As [`read_web`].
pub fn parse_web_and_cases(text: &str, name: &str, cases: &[(PathBuf, String)]) -> Result<WebFile, Error> {
    parse_web_of_case(text, name, &[], &[], cases)
}

/// [`parse_web`], with changes to the cases that it flies.
pub(super) fn parse_web_of_case(
    text: &str,
    name: &str,
    overrides: &[Overrides<'_>],
    of_case: &[Overrides<'_>],
    cases: &[(PathBuf, String)],
) -> Result<WebFile, Error> {
    let key_values = document::read(&WEB, text, name, overrides)?;
    let (spec, notes) = read::spec(key_values, name, (of_case, cases))?;
    let text = write_web(&spec);
    Ok(WebFile { spec, notes, text })
}
