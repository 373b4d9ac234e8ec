//! The document of a study, and what is said of keys that a study cannot take.

use super::super::document::{self, Document};
use super::super::written_values::sorted;
use crate::case::keys;
use crate::error::{Error, Fault};
use crate::removed::Removed;
use crate::study::{STUDY, Study};
use std::borrow::Cow;

/// A study file, and the problems found in it so far.
pub(super) type Reader<'a> = Document<'a, Study>;

/// Reads what the file says without that which varies.
///
/// # Errors
/// If the text is not TOML, is a file of another kind, or has a format that is newer than this library.
pub(super) fn open<'a>(text: &'a str, name: &str) -> Result<Reader<'a>, Error> {
    let mut reader = document::open(&STUDY, text, name, &[])?;
    reader.check_relations();
    Ok(reader)
}

impl Reader<'_> {
    /// Number of problems so far.
    pub(super) const fn problems(&self) -> usize {
        self.key_values.problems.len()
    }

    /// All problems, in the order of the file.
    pub(super) fn rejected(self) -> Error {
        sorted(self.key_values.problems).into()
    }
}

/// Advice for a key whose values a study cannot vary.
pub(super) const TAKE_A_NUMBER: &str = "take a key whose value is a number or one of a few words";

/// Advice for a name that a study cannot vary.
pub(super) fn advice(name: &str) -> String {
    if let Some(key) = keys::find(name) {
        let in_study = |line| format!("write {line} in the study file, above its tables");
        return key.relations.in_study.map_or_else(|| TAKE_A_NUMBER.to_owned(), in_study);
    }
    if let Some(removed) = Removed::Key.fault(name) {
        return format!("it {removed}");
    }
    match keys::nearest(name) {
        Some(key) if key.varies => format!("did you mean {}?", key.name),
        _ => "write the full name of a key of the case, like air.velocity".to_owned(),
    }
}

/// A study cannot vary, link or set this key.
pub(super) fn not_varied(remedy: impl Into<Cow<'static, str>>) -> Fault {
    Fault::new("cannot be set by a study", remedy)
}

/// A key that is both set and varied or linked.
///
/// * `by` – the key that sets it, which may be another one that gives it in other words
pub(super) fn set_twice(key: &str, by: &str) -> Fault {
    let by = if by == key { String::new() } else { format!(" by {by}") };
    Fault::new(format!("is set to one value for all points{by}, and varied or linked as well"), "keep one")
}

/// The case does not give the key a value of its own.
pub(super) fn not_written(purpose: &str) -> Fault {
    let message = "has no value in the case, where it follows from other keys";
    Fault::new(message, format!("write it there to {purpose}"))
}
