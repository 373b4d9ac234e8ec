//! Measures with their values, as texts and in JSON. Objects keep the order of their entries.

use crate::numbers::{number_to, plus_minus};
use serde::Serialize;
use serde_json::{Value as Json, json};
use spunlaid_ground::{ErrorRole, Estimate, Measure, Measured, measure};

/// The values of some measures by their names, in their order, those of a group together; null where there is none.
pub fn values<T>(measures: &'static [Measure<T>], found: &T) -> Json {
    let mut all = json!({});
    for row in measure::measured(measures, found) {
        match row.measure.entry().split_once('.') {
            Some((group, name)) => all[group][name] = json(row.value),
            None => all[row.measure.entry()] = json(row.value),
        }
    }
    all
}

/// A value in JSON.
pub fn json(value: impl Serialize) -> Json {
    serde_json::to_value(value).unwrap_or_default()
}

/// A mean and its standard error, which is null where it is not known.
pub fn mean(estimate: &Estimate) -> Json {
    json!({"mean": estimate.mean, "standard_error": estimate.standard_error})
}

/// An object without the entries that have no value.
pub fn known(mut object: Json) -> Json {
    if let Json::Object(entries) = &mut object {
        entries.retain(|_, value| !value.is_null());
    }
    object
}

/// The entries of some objects in one.
pub fn joined<const N: usize>(objects: [Json; N]) -> Json {
    let entries = |object| if let Json::Object(entries) = object { Some(entries) } else { None };
    Json::Object(objects.into_iter().filter_map(entries).flatten().collect())
}

/// The value of a measure and its errors, by their names, as far as they are known; a standard error that is
/// not known is null.
pub fn with_errors<T>(measure: &'static Measure<T>, found: &T) -> Vec<(String, Json)> {
    let Some(value) = measure.of(found).value else { return Vec::new() };
    let error = |error: &'static Measure<T>| {
        let value = error.of(found).value;
        let is_reported = value.is_some() || error.role == ErrorRole::OfOne;
        is_reported.then(|| (error.entry().to_owned(), json(value)))
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
