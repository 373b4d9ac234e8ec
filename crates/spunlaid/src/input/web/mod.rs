//! Files of webs: reads a file to what is to be laid, and writes it back.

mod check;
mod guessed;
mod laydown;
mod read;
mod sheet;
mod sides;
mod speeds;
mod write;

pub(super) use guessed::Guess;
pub(super) use sides::{AllSides, Sides, flies_none, is_of_case, replaces};
pub use write::write_web;

use super::lookup::Lookup;
use super::unread::{self, Unread};
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
///   file with `[[layer]]`, `layer.2.line.belt_speed` or the layer's name in place of its number. Keys of a case,
///   `("belt.distance", "0.4 m")`, are those of all cases that the web flies; they also say what both have, as `fibre.density`
///
/// # Errors
/// If the file cannot be read, or if the web cannot be laid; then with every problem found. And what has to be flown first, if a case
/// has a spinline whose tension is that of flights.
pub fn read_web<'a>(path: &Path, overrides: impl Into<Overrides<'a>>) -> Result<WebFile, Unread<WebFile>> {
    let text = file::read(path, FileKind::Web).map_err(Unread::Faulty)?;
    parse_web(&text, &path.display().to_string(), overrides)
}

/// Reads and checks the text of the file of a web. Messages call the file `name`; cases are looked for in its folder.
///
/// # Errors
/// As [`read_web`].
pub fn parse_web<'a>(
    text: &str,
    name: &str,
    overrides: impl Into<Overrides<'a>>,
) -> Result<WebFile, Unread<WebFile>> {
    let all = Sides::split(text, name, &[overrides.into()]).map_err(Unread::Faulty)?;
    let (text, name) = (text.to_owned(), name.to_owned());
    unread::read(move |lookup| parse_sides(&text, &name, &all.sides, &[], lookup))
}

/// [`parse_web`] with the texts of the cases that it names, each with its path. They need not be files.
///
/// # Errors
/// As [`read_web`].
pub fn parse_web_and_cases(
    text: &str,
    name: &str,
    cases: Vec<(PathBuf, String)>,
) -> Result<WebFile, Unread<WebFile>> {
    let (text, name) = (text.to_owned(), name.to_owned());
    unread::read(move |lookup| parse_sides(&text, &name, &[], &cases, lookup))
}

/// [`parse_web`] with what is set from several places, each of which replaces those before it.
pub(super) fn parse_sides(
    text: &str,
    name: &str,
    sides: &[Sides],
    cases: &[(PathBuf, String)],
    lookup: &Lookup,
) -> Result<WebFile, Error> {
    let of_web: Vec<Overrides<'_>> = sides.iter().map(Sides::web).collect();
    let of_case: Vec<Overrides<'_>> = sides.iter().map(Sides::case).collect();
    let key_values = document::read(&WEB, text, name, &of_web)?;
    let (spec, notes) = read::spec(key_values, name, (&of_case, cases), lookup)?;
    let text = write_web(&spec);
    Ok(WebFile { spec, notes, text })
}
