//! The keys of a case: one table that describes each of them.
//!
//! ```text
//! table/, one row for each key → reading, checking and writing case files, studies, labels of figures,
//!   `spunlaid keys`, docs/keys.md, `Key::set` for programs that change a case or a flight
//! ```
//!
//! To add a key, add a row to its file in `table`; then write the code that uses its value.

pub mod key_table;
mod relations;
mod relative;
#[macro_use]
pub mod row;
mod table;
mod value;
mod varied;

pub use key_table::KeyTable;
pub use key_table::TableList;
pub use relations::{Condition, Relations};
pub use relative::Relative;
pub use value::{Content, DataFile, Kind, Sign, Value};
pub use varied::VariedKey;

use super::Case;
use spunlaid_ground::{Diagnostic, Dimension, Fault};

/// The tables of a case file, in order.
pub const TABLES: [&str; table::NAMES.len()] = table::NAMES;

/// The keys of a case.
pub static CASE: KeyTable =
    KeyTable { rows: &table::KEYS, tables: &TABLES, lists: &[], noun: "a case", file: "a case file" };

/// The text that a case file may give as cut-off frequency: Taylor's hypothesis.
pub(crate) const TAYLOR: &str = "taylor";

/// The text that a case file may give as tension at the end of the spinline: that of the simulated fibre.
pub(crate) const FLOWN: &str = "simulated";

/// The text that a web may give as pitch of a row: that of holes over the whole width.
pub const EVEN: &str = "even";

/// What applies if a case leaves a key out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Omission {
    /// The key is required. The text is an example value.
    Required(&'static str),
    /// This default value, written as in a case file.
    Value(&'static str),
    /// The value follows from other keys; the text says how.
    Follows(&'static str),
}

/// A key of a case or of another input, which is a row of its table.
pub struct Key<T: 'static = Case> {
    /// Full name, `air.velocity`.
    pub name: &'static str,
    /// Which values it takes.
    pub kind: Kind,
    /// What applies if it is left out.
    pub omission: Omission,
    /// Its meaning, in one or two sentences.
    pub meaning: &'static str,
    /// Other words for it, by which it is searched.
    pub synonyms: &'static [&'static str],
    /// The label of an axis in figures, with its symbol: `Mean velocity *U*`.
    pub label: &'static str,
    /// Whether a study may vary it.
    pub varies: bool,
    /// Whether it may change during a flight.
    pub in_flight: bool,
    /// The ends of a slider, in SI units.
    pub slider: Option<(f64, f64)>,
    /// Outside of these a value, unless it is zero, is most likely a slip; in SI units, of the magnitude.
    pub usual: Option<(f64, f64)>,
    /// Whether it is set after all others: it is rounded to whole elements, steps or harmonics, or another
    /// number follows from it.
    pub read_last: bool,
    /// Words that may stand in place of a number.
    pub words: &'static [&'static str],
    /// What it has to do with other keys.
    pub relations: Relations,
    /// When it is needed, with an example value.
    pub needed_if: Option<(&'static Condition<T>, &'static str)>,
    /// When it has another default, and which.
    pub default_if: Option<(&'static Condition<T>, &'static str)>,
    /// Takes it from what has been set if it is left out, and says whether that gives it.
    infer: fn(&mut T) -> bool,
    /// Its value in an input that says it in other words.
    in_other_words: fn(&T) -> Option<Value>,
    get: fn(&T) -> Option<Value>,
    set: fn(&mut T, &Value) -> Result<(), Fault>,
    derived: fn(&T) -> bool,
}

// Derived ones would ask the same of `T`.
impl<T> Clone for Key<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Key<T> {}

impl<T> std::fmt::Debug for Key<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Key").field("name", &self.name).field("kind", &self.kind).finish_non_exhaustive()
    }
}

/// Every key, in the order of a case file.
pub fn all() -> &'static [Key] {
    &table::KEYS
}

/// The key with this full name, `air.velocity`.
pub fn find(name: &str) -> Option<&'static Key> {
    CASE.find(name)
}

/// The row of a key, for the tables of other inputs. A program that asks for another name does not compile.
pub const fn row_of(name: &str) -> &'static Key {
    let mut i = 0;
    while !is_same(table::KEYS[i].name, name) {
        i += 1;
    }
    &table::KEYS[i]
}

const fn is_same(one: &str, other: &str) -> bool {
    let one = one.as_bytes();
    let other = other.as_bytes();
    let mut i = 0;
    while i < one.len() && i < other.len() && one[i] == other[i] {
        i += 1;
    }
    i == one.len() && i == other.len()
}

/// The key with this full name.
///
/// # Errors
/// If no key has the name. The problem suggests a similar key.
pub fn named(name: &str) -> Result<&'static Key, Box<Diagnostic>> {
    find(name).ok_or_else(|| {
        let (table, _) = name.split_once('.').unwrap_or(("", name));
        let known: Vec<&str> = keys_of_table(table).map(Key::short).collect();
        let (takes, known) = if known.is_empty() {
            ("a case takes".to_owned(), all().iter().map(|key| key.name).collect())
        } else {
            (format!("[{table}] takes"), known)
        };
        let nearest = nearest(name).map(|key| key.name.to_owned());
        let what = Fault::unknown("is not a key of a case file", nearest, &takes, &known);
        let key = spunlaid_ground::units::excerpt(name, 60);
        Box::new(Diagnostic { key, ..what.into() })
    })
}

/// The key most similar to a misspelt name.
pub fn nearest(name: &str) -> Option<&'static Key> {
    like(name).first().copied()
}

/// The keys similar to a misspelt name, the most similar first.
pub fn like(name: &str) -> Vec<&'static Key> {
    let (table, key) = name.split_once('.').unwrap_or(("", name));
    CASE.like(table, key)
}

/// A diagnostic about the value of a key, in SI units. The place where the value was written is not known here.
pub fn diagnostic(key: &str, value: f64, cause: impl Into<Diagnostic>) -> Diagnostic {
    let value = find(key).map_or_else(
        || spunlaid_ground::units::shortest(value),
        |key| key.kind.pretty(&Value::Number(value)),
    );
    cause.into().with_key(key, Some(value))
}

/// The keys of a table.
pub fn keys_of_table(table: &str) -> impl Iterator<Item = &'static Key> {
    CASE.keys_of_table(table)
}

impl<T> Key<T> {
    /// The table that it belongs to: `air`; `line.rows` of a row of holes.
    pub fn table(&self) -> &'static str {
        self.name.rsplit_once('.').map_or("", |(table, _)| table)
    }

    /// Its name within the table: `velocity`.
    pub fn short(&self) -> &'static str {
        self.name.rsplit_once('.').map_or(self.name, |(_, key)| key)
    }

    /// The key of a case that means the same, if there is one.
    pub fn key_of_case(&self) -> Option<&'static Key> {
        find(self.relations.same_in_case.unwrap_or(self.name))
    }

    /// The dimension of a quantity; none for other kinds.
    pub const fn dimension(&self) -> Option<Dimension> {
        self.kind.dimension()
    }

    /// The value in a case or another input, in SI units. None if the key has no meaning for it.
    pub fn get(&self, input: &T) -> Option<Value> {
        (self.get)(input)
    }

    /// Sets the value in a case. Mesh and times stay the same: only reading a case file derives other keys from
    /// this one.
    ///
    /// * `value` – in SI units, or as text with its unit, `"20 m/s"`, or a name, `"clamped"`, or a change, `"+20 %"`
    ///
    /// Only the value itself is checked. [`Case::check`] says whether the case can still be run.
    ///
    /// # Errors
    /// If the key does not take this value, or has no meaning for this case.
    pub fn set(&self, input: &mut T, value: impl Into<Value>) -> Result<(), Box<Diagnostic>> {
        let value = value.into();
        let shown = self.kind.pretty(&value);
        let is_word = matches!(&value, Value::Text(word) if self.words.contains(&word.as_str()));
        let change = match &value {
            Value::Text(text) if !is_word => Relative::read(&self.kind, text),
            _ => Ok(None),
        };
        let accepted = change.and_then(|change| match change {
            Some(change) => {
                let before = self.get(input).and_then(|before| before.number());
                change.of(before, &self.kind, "write the value itself".to_owned())
            }
            None if is_word => Ok(value),
            None => self.kind.accept(value).map_err(|fault| fault.or_words(self.words)),
        });
        accepted
            .and_then(|value| (self.set)(input, &value))
            .map_err(|what| Box::new(Diagnostic::from(what).with_key(self.name, Some(shown))))
    }

    /// Sets a value that has been checked already.
    pub fn apply(&self, input: &mut T, value: &Value) -> Result<(), Fault> {
        (self.set)(input, value)
    }

    /// Whether a flow or a file gives the value, so that a case file leaves it out.
    pub fn is_derived(&self, input: &T) -> bool {
        (self.derived)(input)
    }

    /// Whether it is found by this word: in its name, its meaning or its synonyms, or as one of its units.
    pub fn has_word(&self, word: &str) -> bool {
        let has = |text: &str| text.to_lowercase().contains(&word.to_lowercase());
        let when = [self.needed_if, self.default_if].into_iter().flatten().map(|(when, _)| when.words);
        [self.name, self.meaning].into_iter().chain(self.synonyms.iter().copied()).chain(when).any(has)
            || self.dimension().is_some_and(|dimension| dimension.has_unit(word))
    }

    /// An example line of its file: `velocity = "10 m/s"`.
    pub fn example(&self) -> String {
        let (Omission::Required(value) | Omission::Value(value) | Omission::Follows(value)) = self.omission;
        let value = self.needed_if.map_or(value, |(_, example)| example);
        match self.dimension() {
            // Of any name.
            None if self.short() == "*" => value.to_owned(),
            Some(Dimension::Ratio) | None => format!("{} = {value}", self.short()),
            Some(_) => format!("{} = \"{value}\"", self.short()),
        }
    }

    /// The allowed values in words: `a length above zero`.
    pub fn allowed(&self) -> String {
        self.kind.allowed()
    }
}
