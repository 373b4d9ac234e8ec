//! Converts TOML values to the [`Value`] of a key.

use super::entry::kind;
use crate::case::keys::{FileKind, Kind, Value};
use crate::error::Fault;
use crate::units::{Dimension, UnitAdvice};
use crate::vec3::Vec3;
use std::path::PathBuf;
use toml::de::{DeInteger, DeValue};

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
        (Kind::File(FileKind::Records), DeValue::Array(list)) if !list.is_empty() => {
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
    if dimension == Dimension::Ratio { dimension.parse(text) } else { Err(dimension.no_unit()) }
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
