//! The keys of a case: one table that says everything about each.
//!
//! ```text
//! table.rs, a row for each key → what a case file may hold, how a value is checked and written,
//!   what a study may vary, labels of figures, `spunlaid keys`, docs/keys.md, `Key::set` for whoever steers a flight
//! ```
//!
//! A new key is a row of the table; whatever uses its value comes besides.

mod nearest;
mod table;
mod value;

pub(crate) use nearest::{like_in, nearest_word};
pub use value::{Content, FileKind, Kind, Sign, Value};

use super::Case;
use crate::error::{Fault, Finding, Place, Problem};
use crate::units::Dimension;

/// The tables of a case file, in their order.
pub const TABLES: [&str; 4] = ["fibre", "air", "drag", "run"];

/// What is taken where a case leaves a key out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeftOut {
    /// Nothing: the case must say it. A value that would do.
    Required(&'static str),
    /// This value, as a case file has it.
    Value(&'static str),
    /// What follows from other keys, in words.
    Follows(&'static str),
}

/// A key of a case: a row of the table.
#[derive(Debug)]
pub struct Key {
    /// Full name, `air.velocity`.
    pub name: &'static str,
    /// What it takes.
    pub kind: Kind,
    /// What is taken where it is left out.
    pub left_out: LeftOut,
    /// What it means, in a sentence or two.
    pub meaning: &'static str,
    /// What an axis of a figure is called, with its letter: `Mean velocity *U*`.
    pub label: &'static str,
    /// Whether a study may vary it.
    pub varies: bool,
    /// Whether it may change while a fibre flies.
    pub in_flight: bool,
    /// Usual least and greatest value, in SI units: the ends of a slider.
    pub slider: Option<(f64, f64)>,
    /// Whether it is counted in whole elements, steps or harmonics, and so set after all others.
    pub(crate) counted: bool,
    get: fn(&Case) -> Option<Value>,
    set: fn(&mut Case, &Value) -> Result<(), Fault>,
    told: fn(&Case) -> bool,
}

/// Every key, in the order of a case file.
pub fn all() -> &'static [Key] {
    table::KEYS
}

/// The key of a full name, `air.velocity`.
pub fn find(name: &str) -> Option<&'static Key> {
    all().iter().find(|key| key.name == name)
}

/// The key of a full name.
///
/// # Errors
/// When there is none: the problem says which key may be meant.
pub fn named(name: &str) -> Result<&'static Key, Box<Problem>> {
    find(name).ok_or_else(|| {
        let (table, _) = name.split_once('.').unwrap_or(("", name));
        let known = of_table(table).map(Key::short).collect::<Vec<_>>();
        let (where_, known) = if known.is_empty() {
            ("a case".to_owned(), all().iter().map(|key| key.name).collect())
        } else {
            (format!("[{table}]"), known)
        };
        let nearest = nearest(name).map(|key| key.name.to_owned());
        let what = Fault::UnknownKey { nearest, where_, known };
        let key = crate::units::excerpt(name, 60);
        Box::new(Finding { place: Place::Code, key, value: None, what })
    })
}

/// The key that a misspelt name may mean.
pub fn nearest(name: &str) -> Option<&'static Key> {
    like(name).first().copied()
}

/// The keys that a misspelt name may mean, the most like first.
pub fn like(name: &str) -> Vec<&'static Key> {
    let (table, key) = name.split_once('.').unwrap_or(("", name));
    like_in(table, key)
}

/// What is found of the value of a key, in SI units; where it was written, is not known here.
pub(crate) fn finding<W>(key: &str, value: f64, what: W) -> Finding<W> {
    let value =
        find(key).map_or_else(|| crate::units::shortest(value), |key| key.kind.pretty(&Value::Number(value)));
    Finding { place: Place::Code, key: key.to_owned(), value: Some(value), what }
}

/// The keys of a table.
pub fn of_table(table: &str) -> impl Iterator<Item = &'static Key> {
    all().iter().filter(move |key| key.table() == table)
}

impl Key {
    /// The table it belongs in: `air`.
    pub fn table(&self) -> &'static str {
        self.name.split_once('.').map_or("", |(table, _)| table)
    }

    /// Its name within the table: `velocity`.
    pub fn short(&self) -> &'static str {
        self.name.split_once('.').map_or(self.name, |(_, key)| key)
    }

    /// What it measures, of a quantity.
    pub const fn dimension(&self) -> Option<Dimension> {
        match self.kind {
            Kind::Quantity(dimension, _) => Some(dimension),
            Kind::Point => Some(Dimension::Length),
            _ => None,
        }
    }

    /// Whether only whole numbers will do.
    pub const fn is_whole(&self) -> bool {
        matches!(self.kind, Kind::Whole(..))
    }

    /// The value that a case has, in SI units; none where the key means nothing to it.
    pub fn get(&self, case: &Case) -> Option<Value> {
        (self.get)(case)
    }

    /// Sets the value of a case, which keeps its mesh and its times: what follows from the key where a case file is
    /// read, stays as it is.
    ///
    /// * `value` – in SI units, or as text with its unit, `"20 m/s"`, or a name, `"clamped"`
    ///
    /// The value is checked on its own; [`Case::check`] says whether the case can still be run.
    ///
    /// # Errors
    /// When the key takes no such value, or means nothing to this case.
    pub fn set(&self, case: &mut Case, value: impl Into<Value>) -> Result<(), Box<Problem>> {
        let value = value.into();
        let shown = self.kind.pretty(&value);
        self.kind.accept(value).and_then(|value| (self.set)(case, &value)).map_err(|what| {
            let (place, key) = (Place::Code, self.name.to_owned());
            Box::new(Finding { place, key, value: Some(shown), what })
        })
    }

    /// Sets a value that has been accepted.
    pub(crate) fn apply(&self, case: &mut Case, value: &Value) -> Result<(), Fault> {
        (self.set)(case, value)
    }

    /// Whether something else tells the value, so that a case file leaves it out.
    pub(crate) fn is_told(&self, case: &Case) -> bool {
        (self.told)(case)
    }

    /// A line of a case file that states it, with a value that would do.
    pub(crate) fn example(&self) -> String {
        let (LeftOut::Required(value) | LeftOut::Value(value) | LeftOut::Follows(value)) = self.left_out;
        match self.kind {
            Kind::Quantity(dimension, _) if dimension != Dimension::Ratio => {
                format!("{} = \"{value}\"", self.short())
            }
            _ => format!("{} = {value}", self.short()),
        }
    }

    /// What may be written, in words: `a length above zero`.
    pub fn allowed(&self) -> String {
        match self.kind {
            Kind::Quantity(dimension, Sign::Positive) => format!("{} above zero", dimension.name()),
            Kind::Quantity(dimension, Sign::NotNegative) => format!("{}, zero or above", dimension.name()),
            Kind::Quantity(dimension, Sign::Any) => format!("{}, of either sign", dimension.name()),
            Kind::Whole(0, _) => "a whole number".to_owned(),
            Kind::Whole(least, most) if most > 1 << 50 => format!("a whole number from {least} up"),
            Kind::Whole(least, most) => format!("a whole number from {least} to {most}"),
            Kind::Choice(_) | Kind::File(FileKind::Spectrum) => {
                let names = self.kind.names();
                names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(" or ")
            }
            Kind::Direction => "three numbers, like [1.0, 0.0, 0.0]".to_owned(),
            Kind::Point => "three lengths, like [\"0 m\", \"50 mm\", \"0 m\"]".to_owned(),
            Kind::File(FileKind::Records) => {
                "the path of a file, or a list with one for each eddy".to_owned()
            }
            Kind::File(_) => "the path of a file".to_owned(),
        }
    }
}
