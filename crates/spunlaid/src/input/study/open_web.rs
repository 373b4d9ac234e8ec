//! The file of a web with what is set beside it, of which changed webs are made.

use super::super::entry::Entry;
use super::super::lookup::Lookup;
use super::super::unread::{self, Unread};
use super::super::web::replaces;
use super::super::{Overrides, file};
use super::VariedKey;
use super::web::WebBase;
use crate::advice::Change;
use crate::error::FileKind;
use std::path::Path;

/// A web that is changed.
pub(super) struct OpenWeb<'a> {
    pub(super) base: &'a WebBase,
    /// What is set beside the file.
    set: &'a [(String, String)],
    pub(super) lookup: &'a Lookup,
}

/// Reads a file and makes changed webs of it.
///
/// # Errors
/// As [`changed_webs`], and if there is no such file.
pub(super) fn changed_webs_of_file(
    path: &Path,
    set: Overrides<'_>,
    make: fn(OpenWeb<'_>) -> Vec<Change>,
) -> Result<Vec<Change>, Unread<Vec<Change>>> {
    let text = file::read(path, FileKind::Web).map_err(Unread::Faulty)?;
    changed_webs(text, &path.display().to_string(), set, make)
}

/// Reads a text and makes changed webs of it.
///
/// # Errors
/// If the web cannot be read. And what has to be flown first, if a case has a spinline whose tension is that of flights.
pub(super) fn changed_webs(
    text: String,
    name: &str,
    set: Overrides<'_>,
    make: fn(OpenWeb<'_>) -> Vec<Change>,
) -> Result<Vec<Change>, Unread<Vec<Change>>> {
    let (name, word, values) = (name.to_owned(), set.word.to_owned(), set.values.to_vec());
    unread::read(move |lookup| {
        let [none, set] = [&[][..], &values].map(|values| Overrides { values, word: &word });
        let base = WebBase::new(text.clone(), name.clone(), [none, set], lookup)?;
        Ok(make(OpenWeb { base: &base, set: &values, lookup }))
    })
}

impl OpenWeb<'_> {
    /// A value of a key as it is set in the file.
    pub(super) fn setting(&self, (key, value): &(VariedKey, f64)) -> (String, String) {
        let word = key.words().get(*value as usize).map(|word| (*word).to_owned());
        let number = || if key.is_whole() { format!("{value:.0}") } else { key.dimension().written(*value) };
        (self.base.short_name(&key.name).to_owned(), word.unwrap_or_else(number))
    }

    /// What makes a changed web of the file: what was set before, unless it is replaced, and new settings.
    pub(super) fn with_settings(&self, new: Vec<(String, String)>) -> Vec<(String, String)> {
        let is_replaced = |set: &str| new.iter().any(|(key, _)| replaces(key, set.trim()));
        let before = self.set.iter().filter(|(key, _)| !is_replaced(key));
        let before = before.map(|(key, value)| (key.clone(), Entry::plain_override(value)));
        before.chain(new.iter().cloned()).collect()
    }
}
