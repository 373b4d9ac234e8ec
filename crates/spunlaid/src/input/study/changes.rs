//! The changed webs of a file.

use super::super::{Overrides, Resources, file};
use super::open_web::OpenWeb;
use super::web::WebBase;
use super::{guesses, line};
use crate::advice::Change;
use crate::error::{Error, FileKind};
use std::path::Path;

/// Which changes of a web are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Changes {
    /// One setting of the line, on the belt that lays the same weight.
    OfLine,
    /// Half and twice of each number that the file calls a guess (`web.guessed`).
    OfGuesses,
}

/// Reads the file of a web and makes changed webs of it.
///
/// # Errors
/// If the web cannot be read.
pub fn read_changes(path: &Path, set: Overrides<'_>, changes: Changes) -> Result<Vec<Change>, Error> {
    parse_changes(file::read(path, FileKind::Web)?, &path.display().to_string(), set, changes)
}

/// [`read_changes`] of a text.
///
/// # Errors
/// As [`read_changes`].
pub fn parse_changes(
    text: String,
    name: &str,
    set: Overrides<'_>,
    changes: Changes,
) -> Result<Vec<Change>, Error> {
    let own = Resources::default();
    let resources = set.resources.unwrap_or(&own);
    let base = WebBase::new(text, name.to_owned(), [Overrides::new(&[], set.word), set], resources)?;
    let web = OpenWeb { base: &base, set: set.values, resources };
    Ok(match changes {
        Changes::OfLine => line::changes(web),
        Changes::OfGuesses => guesses::changes(&web),
    })
}
