//! What is wrong with a value or a file, and what to do about it.

use super::words::{all_of, did_you_mean, one_of};
use std::borrow::Cow;
use std::fmt;

/// What is wrong, and what to do about it. The text continues after `key = value `, and shows as `message; remedy`.
///
/// Messages are written where the fault is found. Faults that many places find have a function here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// What is wrong.
    pub message: Cow<'static, str>,
    /// What to do about it. Empty if the message says it.
    pub remedy: Cow<'static, str>,
    /// What a user of the program `spunlaid` types for the remedy: `--points`. Empty if there is no option for it.
    pub option: Cow<'static, str>,
    /// The key or table without which this one has no effect.
    pub needs: Option<&'static str>,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        if self.remedy.is_empty() { Ok(()) } else { write!(f, "; {}", self.remedy) }
    }
}

impl Fault {
    /// What is wrong, and what to do about it.
    pub fn new(message: impl Into<Cow<'static, str>>, remedy: impl Into<Cow<'static, str>>) -> Self {
        Self { message: message.into(), remedy: remedy.into(), option: Cow::Borrowed(""), needs: None }
    }

    /// What is wrong, where no remedy is known or the message says it.
    pub fn plain(message: impl Into<Cow<'static, str>>) -> Self {
        Self::new(message, "")
    }

    /// Adds what a user of the program types for the remedy.
    #[must_use]
    pub fn option(self, option: impl Into<Cow<'static, str>>) -> Self {
        Self { option: option.into(), ..self }
    }

    /// A value of the wrong kind.
    ///
    /// * `found` – the kind found, with an article
    /// * `wanted` – what to write
    pub fn wrong_type(found: &str, wanted: impl fmt::Display) -> Self {
        Self::new(format!("is {found}"), format!("write {wanted}"))
    }

    /// A whole number out of range.
    /// The same with words that may stand in place of what is wanted.
    pub fn or_words(mut self, words: &[&str]) -> Self {
        if !words.is_empty() && !self.remedy.is_empty() {
            let words = words.iter().map(|word| format!(", or \"{word}\""));
            self.remedy.to_mut().extend(words);
        }
        self
    }

    /// A whole number that is not within its bounds.
    pub fn out_of_range(least: u64, most: u64) -> Self {
        let allowed =
            if least == most { least.to_string() } else { format!("a whole number from {least} to {most}") };
        Self::new("is out of range", format!("write {allowed}"))
    }

    /// NaN or infinite.
    pub fn not_finite() -> Self {
        Self::new("is not a finite number", "write a finite one")
    }

    /// A word that the key does not take.
    ///
    /// * `nearest` – the most similar word that it takes
    pub fn not_one_of(nearest: Option<&str>, allowed: &[&str]) -> Self {
        let remedy = match nearest {
            Some(word) => format!("did you mean \"{word}\"?"),
            None => format!("write {}", one_of(allowed)),
        };
        Self::new("is unknown", remedy)
    }

    /// A name that is not known.
    ///
    /// * `message` – what it is not
    /// * `nearest` – the most similar name
    /// * `takes` – the table or the top of the file, with a verb: `[air] takes`
    /// * `known` – the names that are known there
    pub fn unknown(
        message: impl Into<Cow<'static, str>>,
        nearest: Option<String>,
        takes: &str,
        known: &[impl ToString],
    ) -> Self {
        Self::new(message, did_you_mean(&nearest, || format!("{takes} {}", all_of(known))))
    }

    /// A required key is missing.
    ///
    /// * `line` – a line that would do
    pub fn missing(table: &str, line: &str) -> Self {
        let to = if table.is_empty() { String::new() } else { format!(" to [{table}]") };
        Self::new("is missing", format!("add {line}{to}"))
    }

    /// A key belongs to another table.
    pub fn misplaced(table: &str, key: &str) -> Self {
        if table.is_empty() {
            return Self::plain("is out of place; it belongs above the tables");
        }
        Self::plain(format!("is out of place; it belongs in [{table}], as {table}.{key}"))
    }

    /// A key is written twice.
    pub fn duplicate(key: &str) -> Self {
        Self::new(format!("\"{key}\" is written twice"), "keep one")
    }

    /// A key has no effect without another one.
    pub fn needs(needed: &'static str, remedy: &'static str) -> Self {
        Self { needs: Some(needed), ..Self::new(format!("has no effect without {needed}"), remedy) }
    }

    /// Two keys exclude each other.
    pub fn excludes(other: &str, remedy: &'static str) -> Self {
        Self::new(format!("cannot be combined with {other}"), remedy)
    }

    /// The file has a newer version of the format.
    pub fn newer_version(known: u32) -> Self {
        Self::new(format!("is newer than the format that this spunlaid reads ({known})"), "update spunlaid")
    }

    /// Values from which a number follows that is too large or too small.
    pub fn degenerate(what: &str, value: f64) -> Self {
        let size = if value.abs() < 1.0 { "small" } else { "large" };
        let message = format!("makes {what} too {size} for a floating-point number");
        Self::new(message, "check the values that it follows from")
    }
}
