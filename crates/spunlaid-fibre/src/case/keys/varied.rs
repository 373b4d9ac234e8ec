//! A key that has several values: in a study, in a fit, among trials.

use super::{Kind, Value};
use spunlaid_ground::{Dimension, Fault};
use std::path::Path;

/// A key that has several values, of a case or of a web. They are numbers in SI units, or the places of words
/// among those of the key, or of files behind them.
#[derive(Clone, Debug)]
pub struct VariedKey {
    /// Full name, `air.velocity`; of a layer of a web with its number, `layer.2.line.filaments_per_metre`.
    pub name: String,
    /// Which values it takes.
    pub kind: Kind,
    /// Paths of the files that it takes besides the words; kept as long as the program runs, like the words.
    files: Vec<&'static str>,
}

impl PartialEq for VariedKey {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl VariedKey {
    /// A key by its full name.
    pub fn new(name: impl Into<String>, kind: Kind) -> Self {
        Self { name: name.into(), kind, files: Vec::new() }
    }

    /// The same key, which also takes this file; a word is none.
    pub fn or_file(mut self, path: &Path) -> Self {
        let text = path.display().to_string();
        if !self.files.contains(&&*text) {
            self.files.push(Box::leak(text.into_boxed_str()));
        }
        self
    }

    /// Whether its values are whole numbers.
    pub const fn is_whole(&self) -> bool {
        matches!(self.kind, Kind::Whole(..))
    }

    /// The words and the files that it takes; none if its values are numbers.
    pub fn words(&self) -> Vec<&'static str> {
        [self.kind.words(), self.files.clone()].concat()
    }

    /// Physical dimension of its values.
    pub fn dimension(&self) -> Dimension {
        self.kind.dimension().unwrap_or(Dimension::Ratio)
    }

    /// The word that a value stands for; none for numbers.
    pub fn word(&self, value: f64) -> Option<&'static str> {
        self.words().get(value as usize).copied()
    }

    /// A value for people: a word, or a number with its unit.
    pub fn pretty(&self, value: f64) -> String {
        self.number_or_word(value, |dimension| dimension.pretty(value))
    }

    /// A value for people who write it in a file.
    pub fn written(&self, value: f64) -> String {
        self.number_or_word(value, |dimension| dimension.written(value))
    }

    fn number_or_word(&self, value: f64, number: impl FnOnce(Dimension) -> String) -> String {
        match self.word(value) {
            Some(word) => word.to_owned(),
            None if self.is_whole() => format!("{value:.0}"),
            None => number(self.dimension()),
        }
    }

    /// A value as a case would show it.
    pub fn shown(&self, value: f64) -> String {
        match self.word(value) {
            Some(word) => self.kind.pretty(&word.into()),
            None => self.pretty(value),
        }
    }

    /// A value in the form of a file, without rounding.
    pub fn exact(&self, value: f64) -> String {
        match self.words()[..] {
            [] if !self.is_whole() => format!("\"{}\"", self.dimension().exact(value)),
            _ => self.shown(value),
        }
    }

    /// Name of its column in a table: the key and the SI unit of a quantity.
    pub fn column(&self) -> String {
        let unit = if self.words().is_empty() { self.dimension().suffix() } else { String::new() };
        format!("{}{unit}", self.name)
    }

    /// A value as a number: of a word, its place among the words of the key.
    pub fn number(&self, value: &Value) -> Option<f64> {
        match value {
            Value::Text(word) => self.words().iter().position(|one| one == word).map(|i| i as f64),
            Value::Content(content) => {
                let is_it = |word: &&str| content.paths() == [Path::new(word)];
                self.words().iter().position(is_it).map(|i| i as f64)
            }
            value => value.number(),
        }
    }

    /// A number as a value of the key.
    ///
    /// # Errors
    /// If the key does not take it.
    pub fn value(&self, number: f64) -> Result<Value, Fault> {
        match self.word(number) {
            Some(path) if self.files.contains(&path) => Ok(Value::Paths(vec![path.into()])),
            Some(word) => Ok(word.into()),
            None => self.kind.accept(Value::Number(number)),
        }
    }
}
