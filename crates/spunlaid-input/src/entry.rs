//! A value of a TOML file or of an override, before its key says how it is read.

use super::FORMAT_VERSION;
use super::text_with_lines::{TextWithLines, fit};
use spunlaid_fibre::case::keys::{DataFile, Kind, Value};
use spunlaid_ground::error::Place;
use spunlaid_ground::{Diagnostic, Dimension, Fault, UnitAdvice, Vec3};
use std::path::PathBuf;
use toml::Spanned;
use toml::de::{DeInteger, DeTable, DeValue};

/// The only key above the tables of a case.
pub(super) const VERSION: &str = "version";

/// A value with its place and its text.
pub(super) struct Entry<'a> {
    /// Its first byte in the file; of an override, zero.
    pub(super) at: usize,
    pub(super) place: Place,
    /// Its text, shortened for messages. None for tables, because their text is spread over the file.
    pub(super) shown: Option<String>,
    /// Its whole text.
    pub(super) text: &'a str,
    pub(super) value: DeValue<'a>,
}

impl<'a> Entry<'a> {
    /// The value of a key that stands at byte `at` of a file.
    pub(super) fn from_file(source: &TextWithLines<'a>, at: usize, value: Spanned<DeValue<'a>>) -> Self {
        let shown = source.shown(value.span());
        let is_headed = value.get_ref().is_table() && !shown.starts_with('{') || shown.starts_with("[[");
        let shown = Some(shown).filter(|_| !is_headed);
        let text = source.exact(value.span());
        Self { at, place: source.place(at), shown, text, value: value.into_inner() }
    }

    /// The value of an override. What is not TOML is a text.
    pub(super) fn from_override(word: &str, text: &'a str) -> Self {
        let value = DeValue::parse(text).map_or(DeValue::String(text.into()), Spanned::into_inner);
        let shown = if value.is_str() && !text.trim_start().starts_with(['"', '\'']) {
            format!("\"{}\"", fit(text))
        } else {
            fit(text)
        };
        Self { at: 0, place: Place::Override(word.to_owned()), shown: Some(shown), text, value }
    }

    /// The text of an override without the quotes that it does not need.
    pub(super) fn plain_override(text: &str) -> String {
        match DeValue::parse(text).map(Spanned::into_inner) {
            Ok(DeValue::String(inner)) if DeValue::parse(&inner).is_err() => inner.into_owned(),
            _ => text.to_owned(),
        }
    }

    /// A problem with it.
    pub(super) fn problem(&self, key: &str, what: Fault) -> Diagnostic {
        Diagnostic { place: self.place.clone(), key: fit(key), value: self.shown.clone(), ..what.into() }
    }
}

/// The root table of a file.
///
/// # Errors
/// What the parser finds.
pub(super) fn root<'a>(source: &TextWithLines<'_>, text: &'a str) -> Result<DeTable<'a>, Vec<Diagnostic>> {
    let (root, faults) = DeTable::parse_recoverable(text);
    if faults.is_empty() { Ok(root.into_inner()) } else { Err(source.syntax(&faults)) }
}

/// Keys with their positions, and values of a table in the order of the file.
pub(super) fn in_order<'a>(table: DeTable<'a>) -> Vec<((usize, String), Spanned<DeValue<'a>>)> {
    let mut entries: Vec<_> = table
        .into_iter()
        .map(|(key, value)| ((key.span().start, key.into_inner().into_owned()), value))
        .collect();
    entries.sort_by_key(|((at, _), _)| *at);
    entries
}

/// Rejects a file of a newer format.
pub(super) fn check_version(entry: &Entry<'_>) -> Result<(), Box<Diagnostic>> {
    let known = FORMAT_VERSION;
    let what = match &entry.value {
        DeValue::Integer(number) => match number.as_str().parse() {
            Ok(version) if (1..=i128::from(known)).contains(&version) => return Ok(()),
            Ok(version) if version < 1 => Fault::out_of_range(1, u64::from(known)),
            _ => Fault::newer_version(known),
        },
        other => Fault::wrong_type(kind(other), format!("a whole number, {known}")),
    };
    Err(Box::new(entry.problem(VERSION, what)))
}

/// The kind of the value in words, with an article.
pub(super) fn kind(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a text",
        DeValue::Integer(_) => "a whole number",
        DeValue::Float(_) => "a decimal number",
        DeValue::Boolean(_) => "a truth value",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}

/// Reads the value of a key of this kind.
///
/// * `beside` – gives the path for the name of a file
pub(super) fn read(
    expected: &Kind,
    value: &DeValue<'_>,
    beside: impl Fn(&str) -> PathBuf,
) -> Result<Value, Fault> {
    let wrong = |found| Fault::wrong_type(found, expected.wanted());
    let read = match (expected, value) {
        (Kind::Quantity(dimension, _), value) => Value::Number(number(*dimension, value)?),
        (&Kind::Whole(least, most), DeValue::Integer(number)) => {
            Value::Whole(integer(number).ok_or_else(|| Fault::out_of_range(least, most))?)
        }
        (Kind::Choice(_) | Kind::Text(_), DeValue::String(text)) => Value::Text(text.to_string()),
        (Kind::Direction, value) => Value::Vector(vector(value)?),
        (Kind::Point, DeValue::Array(list)) => {
            let lengths: Result<Vec<f64>, Fault> =
                list.iter().map(|one| number(Dimension::Length, one.get_ref())).collect();
            match lengths?[..] {
                [x, y, z] => Value::Vector(Vec3::new(x, y, z)),
                _ => return Err(wrong("a list of another length")),
            }
        }
        (Kind::Lengths, DeValue::Array(list)) => {
            let lengths: Result<_, Fault> =
                list.iter().map(|one| number(Dimension::Length, one.get_ref())).collect();
            Value::Numbers(lengths?)
        }
        (Kind::Switch, DeValue::Boolean(switch)) => Value::Text(switch.to_string()),
        (Kind::File(file), DeValue::String(text)) if file.is_word(text) => Value::Text(text.to_string()),
        (Kind::File(DataFile::Records), DeValue::Array(list)) if !list.is_empty() => {
            let paths = list.iter().map(|one| one.get_ref().as_str().map(&beside));
            Value::Paths(paths.collect::<Option<_>>().ok_or_else(|| wrong(kind(value)))?)
        }
        (Kind::File(_), DeValue::String(text)) if text.is_empty() => return Err(wrong("an empty text")),
        (Kind::File(_), DeValue::String(text)) => Value::Paths(vec![beside(text)]),
        (_, other) => return Err(wrong(kind(other))),
    };
    expected.accept(read)
}

pub(super) fn integer(number: &DeInteger<'_>) -> Option<u64> {
    u64::from_str_radix(number.as_str(), number.radix()).ok()
}

/// A number in SI units.
pub(super) fn number(dimension: Dimension, value: &DeValue<'_>) -> Result<f64, Fault> {
    let text = match value {
        DeValue::String(text) => return dimension.parse(text),
        DeValue::Integer(number) if number.radix() == 10 => number.as_str(),
        DeValue::Float(number) => number.as_str(),
        other => {
            return Err(Fault::wrong_type(kind(other), UnitAdvice(dimension)));
        }
    };
    if dimension.takes_plain_numbers() { dimension.parse(text) } else { Err(dimension.no_unit()) }
}

fn vector(value: &DeValue<'_>) -> Result<Vec3<f64>, Fault> {
    let wrong = |found| Fault::wrong_type(found, "three plain numbers, like [1.0, 0.0, 0.0]");
    let DeValue::Array(list) = value else {
        return Err(wrong(kind(value)));
    };
    let mut components = list.iter().map(|component| match component.get_ref() {
        one @ DeValue::Float(_) => number(Dimension::Ratio, one).map_err(|_| Fault::not_finite()),
        DeValue::Integer(one) if one.radix() == 10 => {
            number(Dimension::Ratio, component.get_ref()).map_err(|_| Fault::not_finite())
        }
        other => Err(wrong(kind(other))),
    });
    match (components.next(), components.next(), components.next(), components.next()) {
        (Some(x), Some(y), Some(z), None) => Ok(Vec3::new(x?, y?, z?)),
        _ => Err(wrong("a list of another length")),
    }
}
