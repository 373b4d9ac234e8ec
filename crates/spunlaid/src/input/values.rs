//! Values of the kinds a case file has: quantities, whole numbers, names, directions.

use super::document::{Document, Entry, kind};
use super::layout;
use crate::case::keys::Quantity;
use crate::error::Fault;
use crate::units::{Dimension, QuantityFault, Wanted};
use crate::vec3::Vec3;
use toml::de::{DeInteger, DeValue};

/// Reads values out of a document. What cannot be read is told and stands as a NaN, or the default, of
/// which nothing is made.
impl Document<'_> {
    /// A quantity that the case must state; `line` is one that would do.
    pub(super) fn required(&mut self, quantity: &Quantity, line: &'static str) -> f64 {
        if let Some(value) = self.optional(quantity) {
            return value;
        }
        self.missing(quantity.key, line);
        f64::NAN
    }

    /// A quantity that the case may leave open.
    pub(super) fn optional(&mut self, quantity: &Quantity) -> Option<f64> {
        let entry = self.take(quantity.key)?;
        Some(self.quantity(quantity, entry))
    }

    /// The quantity that an entry holds.
    pub(super) fn quantity(&mut self, quantity: &Quantity, entry: Entry<'_>) -> f64 {
        let Entry { place, shown, value } = entry;
        let read = number(quantity.dimension, &value);
        match read.and_then(|value| quantity.fault(value).map_or(Ok(value), Err)) {
            Ok(value) => value,
            Err(fault) => {
                self.reject(place, quantity.key, shown, fault);
                f64::NAN
            }
        }
    }

    /// A whole number, and where it was written.
    pub(super) fn whole_number(&mut self, key: &str, least: u64, most: u64) -> Option<u64> {
        let Entry { place, shown, value } = self.take(key)?;
        let fault = match &value {
            DeValue::Integer(number) => match integer(number) {
                Some(number) if (least..=most).contains(&number) => return Some(number),
                _ => Fault::OutOfRange { least, most },
            },
            other => Fault::WrongType {
                found: kind(other),
                wanted: "a whole number without quotes, like 10".to_owned(),
            },
        };
        self.reject(place, key, shown, fault);
        Some(least)
    }

    /// One of several names.
    pub(super) fn choice<T: Copy>(&mut self, key: &str, names: &[(&'static str, T)]) -> Option<T> {
        let Entry { place, shown, value } = self.take(key)?;
        let allowed: Vec<&'static str> = names.iter().map(|(name, _)| *name).collect();
        let fault = match &value {
            DeValue::String(text) => {
                if let Some((_, choice)) = names.iter().find(|(name, _)| name == text) {
                    return Some(*choice);
                }
                let nearest = layout::nearest(text, names.iter().map(|(name, _)| (*name, 0.0)));
                Fault::NotOneOf { nearest: nearest.map(|name| format!("\"{name}\"")), allowed }
            }
            other => {
                let quoted: Vec<String> = allowed.iter().map(|name| format!("\"{name}\"")).collect();
                Fault::WrongType { found: kind(other), wanted: quoted.join(" or ") }
            }
        };
        self.reject(place, key, shown, fault);
        None
    }

    /// A point in space [m].
    pub(super) fn point(&mut self, key: &str) -> Option<Vec3<f64>> {
        let Entry { place, shown, value } = self.take(key)?;
        let length = |value: &DeValue<'_>| number(Dimension::Length, value);
        let coordinates: Option<Result<Vec<f64>, Fault>> =
            value.as_array().map(|list| list.iter().map(|one| length(one.get_ref())).collect());
        let fault = match coordinates {
            Some(Ok(list)) if list.len() == 3 => return Some(Vec3::new(list[0], list[1], list[2])),
            Some(Err(fault)) => fault,
            other => {
                let found = if other.is_some() { "a list of another length" } else { kind(&value) };
                let wanted = "three lengths, like [\"0 m\", \"50 mm\", \"0 m\"]".to_owned();
                Fault::WrongType { found, wanted }
            }
        };
        self.reject(place, key, shown, fault);
        None
    }

    /// A direction, made a unit vector.
    pub(super) fn direction(&mut self, key: &str) -> Option<Vec3<f64>> {
        let Entry { place, shown, value } = self.take(key)?;
        match vector(&value).and_then(unit) {
            Ok(direction) => Some(direction),
            Err(fault) => {
                self.reject(place, key, shown, fault);
                None
            }
        }
    }

    /// Tells of a key that must be there, unless it is there under another name.
    pub(super) fn missing(&mut self, key: &str, line: &'static str) {
        let Some(table) = key.split_once('.').and_then(|(table, _)| layout::table(table)) else {
            return;
        };
        if !self.is_excused(key) {
            self.reject(self.whole(), key, None, Fault::Missing { table, line });
        }
    }
}

pub(super) fn integer(number: &DeInteger<'_>) -> Option<u64> {
    u64::from_str_radix(number.as_str(), number.radix()).ok()
}

/// A number in SI units.
pub(super) fn number(dimension: Dimension, value: &DeValue<'_>) -> Result<f64, Fault> {
    let text = match value {
        DeValue::String(text) => return Ok(dimension.parse(text)?),
        DeValue::Integer(number) if number.radix() == 10 => number.as_str(),
        DeValue::Float(number) => number.as_str(),
        other => {
            return Err(Fault::WrongType { found: kind(other), wanted: Wanted(dimension).to_string() });
        }
    };
    if dimension == Dimension::Ratio {
        Ok(dimension.parse(text)?)
    } else {
        Err(QuantityFault::NoUnit { wanted: Wanted(dimension) }.into())
    }
}

fn vector(value: &DeValue<'_>) -> Result<Vec3<f64>, Fault> {
    let wanted = || "three plain numbers, like [1.0, 0.0, 0.0]".to_owned();
    let wrong = |found| Fault::WrongType { found, wanted: wanted() };
    let DeValue::Array(list) = value else {
        return Err(wrong(kind(value)));
    };
    let mut components = list.iter().map(|component| match component.get_ref() {
        text @ DeValue::String(_) => Err(wrong(kind(text))),
        other => number(Dimension::Ratio, other).map_err(|fault| match fault {
            Fault::Quantity(QuantityFault::NotFinite { .. } | QuantityFault::TooLarge { .. }) => {
                Fault::NotFinite
            }
            _ => wrong(kind(other)),
        }),
    });
    match (components.next(), components.next(), components.next(), components.next()) {
        (Some(x), Some(y), Some(z), None) => Ok(Vec3::new(x?, y?, z?)),
        _ => Err(wrong("a list of another length")),
    }
}

/// The unit vector along `v`; `v` itself if it is one but for rounding.
fn unit(v: Vec3<f64>) -> Result<Vec3<f64>, Fault> {
    if (v.norm() - 1.0).abs() <= 4.0 * f64::EPSILON {
        return Ok(v);
    }
    let largest = v.x.abs().max(v.y.abs()).max(v.z.abs());
    if largest == 0.0 {
        return Err(Fault::ZeroDirection);
    }
    // Division by the largest first, lest the squares overflow or vanish.
    let v = Vec3::new(v.x / largest, v.y / largest, v.z / largest);
    let norm = v.norm();
    Ok(Vec3::new(v.x / norm, v.y / norm, v.z / norm))
}
