//! The changed webs of a file.

use super::super::unread::{self, Unread};
use super::super::{Overrides, file};
use super::open_web::OpenWeb;
use super::web::WebBase;
use super::{guesses, line};
use crate::advice::Change;
use crate::error::FileKind;
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
/// If the web cannot be read. And what has to be flown first, if a case has a spinline whose tension is that
/// of flights.
pub fn read_changes(
    path: &Path,
    set: Overrides<'_>,
    changes: Changes,
) -> Result<Vec<Change>, Unread<Vec<Change>>> {
    let text = file::read(path, FileKind::Web).map_err(Unread::Faulty)?;
    parse_changes(text, &path.display().to_string(), set, changes)
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
) -> Result<Vec<Change>, Unread<Vec<Change>>> {
    let (name, word, values) = (name.to_owned(), set.word.to_owned(), set.values.to_vec());
    unread::read(move |lookup| {
        let [none, set] = [&[][..], &values].map(|values| Overrides { values, word: &word });
        let base = WebBase::new(text.clone(), name.clone(), [none, set], lookup)?;
        let web = OpenWeb { base: &base, set: &values, lookup };
        Ok(match changes {
            Changes::OfLine => line::changes(web),
            Changes::OfGuesses => guesses::changes(&web),
        })
    })
}
