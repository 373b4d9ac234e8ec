//! What a case file says: values by key, each with the place it was written.

use crate::case::keys::{Key, Value};
use crate::error::{Fault, Finding, Place, Problem};
use std::collections::BTreeMap;

/// A value as written.
#[derive(Clone, Debug)]
pub(super) struct Said {
    pub(super) place: Place,
    /// As the file has it.
    pub(super) shown: Option<String>,
    /// None where it cannot be read, which has been told.
    pub(super) value: Option<Value>,
}

/// The values of a case file, and what is wrong with it so far.
#[derive(Clone, Debug)]
pub(super) struct Written {
    /// The file as a place, for what it does not say.
    file: Place,
    values: BTreeMap<&'static str, Said>,
    pub(super) problems: Vec<Problem>,
    /// Keys that are missed only because of another problem; tables end in a dot.
    excused: Vec<String>,
}

impl Written {
    pub(super) const fn new(file: Place) -> Self {
        Self { file, values: BTreeMap::new(), problems: Vec::new(), excused: Vec::new() }
    }

    /// The file as a place.
    pub(super) fn whole(&self) -> Place {
        self.file.clone()
    }

    pub(super) fn get(&self, key: &str) -> Option<&Said> {
        self.values.get(key)
    }

    pub(super) fn set(&mut self, key: &'static Key, said: Said) {
        self.values.insert(key.name, said);
    }

    /// The number of a key, where it is written.
    pub(super) fn number(&self, key: &str) -> Option<f64> {
        self.get(key)?.value.as_ref()?.number()
    }

    /// Has nothing told of keys that are missed; a table ends in a dot.
    pub(super) fn excuse(&mut self, keys: impl Into<String>) {
        self.excused.push(keys.into());
    }

    /// Whether what is wrong with a key comes from a problem that has been told.
    pub(super) fn is_excused(&self, key: &str) -> bool {
        self.excused.iter().any(|excuse| excuse == key || excuse.ends_with('.') && key.starts_with(excuse))
    }

    /// Tells of a problem with the value of a key, or with its absence.
    pub(super) fn reject(&mut self, key: &str, what: Fault) {
        let (place, value) = match self.get(key) {
            Some(said) => (said.place.clone(), said.shown.clone()),
            None => (self.file.clone(), None),
        };
        self.problems.push(Finding { place, key: key.to_owned(), value, what });
    }

    /// The finding with the place and the text of the value it is about.
    pub(super) fn placed<W>(&self, mut finding: Finding<W>) -> Finding<W> {
        match self.get(&finding.key) {
            Some(said) => (finding.place, finding.value) = (said.place.clone(), said.shown.clone()),
            None => {
                finding.place = self.file.clone();
                finding.value = finding.value.map(|value| format!("{value} (the default)"));
            }
        }
        finding
    }
}

/// Findings in the order of the file, then of the overrides.
pub(super) fn sorted<W>(mut findings: Vec<Finding<W>>) -> Vec<Finding<W>> {
    findings.sort_by(|a, b| a.place.cmp(&b.place));
    findings
}
