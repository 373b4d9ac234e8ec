//! Measures with their values, as texts and in JSON.

use super::in_order::OrderedObject;
use crate::numbers::{number_to, plus_minus};
use serde::Serialize;
use serde_json::Value as Json;
use spunlaid::observe::{ErrorRole, Measure, Measured, Value, measured};

/// The values of some measures by their names, in their order; null where there is none.
pub fn values<T>(measures: &'static [Measure<T>], found: &T) -> OrderedObject<Option<Value>> {
    OrderedObject(measured(measures, found).map(|row| (row.measure.entry().to_owned(), row.value)).collect())
}

/// A value in JSON.
pub fn json(value: impl Serialize) -> Json {
    serde_json::to_value(value).unwrap_or_default()
}

/// The value of a measure and its errors, by their names, as far as they are known; a standard error that is
/// not known is null.
pub fn with_errors<T>(measure: &'static Measure<T>, found: &T) -> Vec<(String, Json)> {
    let Some(value) = measure.of(found).value else { return Vec::new() };
    let error = |error: &'static Measure<T>| {
        let value = error.of(found).value;
        let is_told = value.is_some() || error.role == ErrorRole::OfOne;
        is_told.then(|| (error.entry().to_owned(), json(value)))
    };
    let entry = (measure.entry().to_owned(), json(value));
    std::iter::once(entry).chain(measure.errors.iter().filter_map(error)).collect()
}

/// The value of a row in the unit in which it is shown: to its digits, or with its error. None if there is none.
pub fn text<T>(row: &Measured<T>) -> Option<String> {
    let per_si = row.measure.unit.per_si;
    let value = row.value.as_ref()?.number() * per_si;
    Some(match row.measure.digits {
        Some(digits) => number_to(value, digits),
        None => plus_minus(value, row.error.map(|error| error * per_si)),
    })
}
