//! The values of a file by key, each with the place where it was written.

use spunlaid_fibre::case::keys::{self, Key, Omission, Value};
use spunlaid_ground::error::Place;
use spunlaid_ground::{Diagnostic, Fault, Position};
use spunlaid_simulation::layers::full_names::replaced_by;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// A value as it was written.
#[derive(Clone, Debug)]
pub(super) struct WrittenValue {
    pub(super) place: Place,
    /// The text in the file.
    pub(super) shown: Option<String>,
    /// None if it cannot be read; the problem has been recorded.
    pub(super) value: Option<Value>,
}

impl WrittenValue {
    /// A value that is set at a place outside of the file.
    pub(super) fn new(place: &Place, shown: impl Into<Option<String>>, value: Value) -> Self {
        Self { place: place.clone(), shown: shown.into(), value: Some(value) }
    }

    /// Whether it is set beside the file.
    pub(super) const fn is_set(&self) -> bool {
        matches!(self.place, Place::Override(_))
    }
}

/// The values of a file, and the problems found so far.
#[derive(Clone, Debug)]
pub(super) struct WrittenValues {
    /// The whole file as a place, for values that it does not contain.
    file: Place,
    values: BTreeMap<Cow<'static, str>, WrittenValue>,
    pub(super) problems: Vec<Diagnostic>,
    /// Keys that are missing only because of another problem. Names of tables end in a dot.
    excused: Vec<String>,
    /// What is taken out beside the file.
    pub(super) taken_out: Vec<String>,
}

impl WrittenValues {
    pub(super) const fn new(file: Place) -> Self {
        Self {
            file,
            values: BTreeMap::new(),
            problems: Vec::new(),
            excused: Vec::new(),
            taken_out: Vec::new(),
        }
    }

    /// The file as a place.
    pub(super) fn whole(&self) -> Place {
        self.file.clone()
    }

    pub(super) fn get(&self, key: &str) -> Option<&WrittenValue> {
        self.values.get(key)
    }

    /// Every value with its key.
    pub(super) fn all(&self) -> impl Iterator<Item = (&str, &WrittenValue)> {
        self.values.iter().map(|(key, written_value)| (key.as_ref(), written_value))
    }

    /// Whether any key of a table is written.
    pub(super) fn has_table(&self, table: &str) -> bool {
        self.values.keys().any(|key| key.split_once('.').is_some_and(|(first, _)| first == table))
    }

    pub(super) fn set(&mut self, key: impl Into<Cow<'static, str>>, written_value: WrittenValue) {
        self.values.insert(key.into(), written_value);
    }

    /// The values whose full names begin like this, by the rest of their names, with what is excused of them.
    /// Problems stay here.
    pub(super) fn part(&self, before: &str, is_wanted: impl Fn(&str) -> bool) -> Self {
        let rest = |name: &str| name.strip_prefix(before).map(ToOwned::to_owned);
        let mut part = Self::new(self.file.clone());
        for (name, written_value) in self.all() {
            if let Some(rest) = rest(name).filter(|rest| is_wanted(rest)) {
                part.set(rest, written_value.clone());
            }
        }
        part.excused = self.excused.iter().filter_map(|name| rest(name)).collect();
        part
    }

    /// Takes a value out, as if it had not been written; with a list, all its entries.
    pub(super) fn remove(&mut self, key: &str) -> Option<WrittenValue> {
        let is_in_list = |name: &str| name.strip_prefix(key).is_some_and(|rest| rest.starts_with('.'));
        self.values.retain(|name, _| !is_in_list(name));
        self.values.remove(key)
    }

    /// Leaves out what these keys take the place of.
    pub(super) fn give_way(&mut self, set: &[&str]) {
        let is_displaced = replaced_by(set, self.get("layer").is_some());
        let displaced: Vec<_> = self.values.keys().filter(|name| is_displaced(name)).cloned().collect();
        displaced.iter().for_each(|name| drop(self.remove(name)));
    }

    /// The same with other values of keys, which take the place of all that is written in other words.
    pub(super) fn with(&self, changes: impl IntoIterator<Item = (String, WrittenValue)>) -> Self {
        let (mut new, changes) = (self.clone(), changes.into_iter().collect::<Vec<_>>());
        new.give_way(&changes.iter().map(|(name, _)| &**name).collect::<Vec<_>>());
        new.values.extend(changes.into_iter().map(|(name, value)| (Cow::Owned(name), value)));
        new
    }

    /// The number of a key, if it is written.
    pub(super) fn number(&self, key: &str) -> Option<f64> {
        self.get(key)?.value.as_ref()?.number()
    }

    /// The whole number of a key, if it is written.
    pub(super) fn integer(&self, key: &str) -> Option<u64> {
        match self.get(key)?.value.as_ref()? {
            Value::Whole(number) => Some(*number),
            _ => None,
        }
    }

    /// The text of a key, if it is written.
    pub(super) fn text(&self, key: &str) -> Option<String> {
        match self.get(key)?.value.as_ref()? {
            Value::Text(text) => Some(text.clone()),
            _ => None,
        }
    }

    /// Suppresses messages about these missing keys. The name of a table ends in a dot.
    pub(super) fn suppress_missing(&mut self, keys: impl Into<String>) {
        self.excused.push(keys.into());
    }

    /// Suppresses what is suppressed of other values.
    pub(super) fn excuse_as(&mut self, other: &Self) {
        self.excused.extend(other.excused.iter().cloned());
    }

    /// Whether messages about a key are suppressed.
    pub(super) fn is_excused(&self, key: &str) -> bool {
        self.excused.iter().any(|excuse| excuse == key || excuse.ends_with('.') && key.starts_with(excuse))
    }

    /// Records a problem with a key: with its value, or that it is missing.
    pub(super) fn reject(&mut self, key: &str, what: Fault) {
        self.problems.push(self.problem(key, what));
    }

    /// A problem with a key.
    pub(super) fn problem(&self, key: &str, what: Fault) -> Diagnostic {
        let (place, value) = match self.get(key) {
            Some(written_value) => (written_value.place.clone(), written_value.shown.clone()),
            None => (self.file.clone(), None),
        };
        Diagnostic { place, key: key.to_owned(), value, ..what.into() }
    }

    /// Adds the place and the written text of the value to a diagnostic.
    pub(super) fn placed(&self, mut diagnostic: Diagnostic) -> Diagnostic {
        match self.get(&diagnostic.key) {
            Some(written_value) => {
                (diagnostic.place, diagnostic.value) =
                    (written_value.place.clone(), written_value.shown.clone())
            }
            None => {
                diagnostic.place = self.file.clone();
                let is_required = |key: &Key| matches!(key.omission, Omission::Required(_));
                // A case that leaves out what it needs has it from its air or from its spinline.
                let source = if keys::find(&diagnostic.key).is_some_and(is_required) {
                    "it follows from the air or the spinline"
                } else {
                    "the default"
                };
                diagnostic.value = diagnostic.value.map(|value| format!("{value} ({source})"));
            }
        }
        diagnostic
    }
}

/// Sorts diagnostics by their place: first what is written in the file, then the overrides, then what is missing, which
/// may follow from the others.
pub(super) fn sorted(mut diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let is_missing =
        |diagnostic: &Diagnostic| matches!(diagnostic.place, Place::File { position: Position::Whole, .. });
    diagnostics.sort_by(|a, b| is_missing(a).cmp(&is_missing(b)).then_with(|| a.place.cmp(&b.place)));
    diagnostics
}
