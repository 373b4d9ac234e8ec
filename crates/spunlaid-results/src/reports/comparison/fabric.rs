//! What two fabrics have in common, laid or scanned.

use super::files::ComparedMeasure;
use super::web::{Web, WebNumber, are_alike, measure};
use crate::numbers::significant;
use serde_json::Value as Json;
use spunlaid_ground::Measure;
use spunlaid_web::{FABRIC_MEASURES, FABRIC_PATCH_MEASURES, STRIP_MEASURES};

/// Side of the patches that are compared in all words [m].
const PATCH: f64 = 5e-3;
/// The number of a fabric that goes with the square of its CV.
const SQUARE_OF_CV: &str = "formation";

/// Every number that is reported of both fabrics with what is known of it: of the whole, of patches and strips.
pub(super) fn in_common(webs: [&Web; 2]) -> Vec<ComparedMeasure> {
    let fabrics = webs.map(|web| (&web.fabric, web.name.as_str()));
    let mut found = both(FABRIC_MEASURES, ["", ""], fabrics, |_, values| values);
    let parts = |list: &str, key: &str, size: f64| {
        fabrics.map(|(fabric, name)| (part(&fabric[list], key, size), name))
    };
    let sides = webs[0].fabric["patches"].as_array().into_iter().flatten();
    for side in sides.filter_map(|patch| patch["patch_m"].as_f64()) {
        let measures =
            if are_alike(side, PATCH) { &FABRIC_PATCH_MEASURES[1..] } else { &FABRIC_PATCH_MEASURES[1..2] };
        let size = significant(side * 1e3, 3);
        let words = [&format!(", patches of {size} mm"), &format!("_{size}_mm")];
        let squared = |column: &str, [a, b]: [WebNumber; 2]| match column {
            SQUARE_OF_CV => [webs[0].squared(side, a), webs[1].squared(side, b)],
            _ => [a, b],
        };
        found.extend(both(measures, words.map(String::as_str), parts("patches", "patch_m", side), squared));
    }
    for (direction, list) in [("MD", "strips_md"), ("CD", "strips_cd")] {
        let words = [&format!(", strips along {direction}"), &format!("_{list}")];
        let strips = fabrics.map(|(fabric, name)| (&fabric[list], name));
        found.extend(both(STRIP_MEASURES, words.map(String::as_str), strips, |_, values| values));
    }
    found
}

/// The part of nearly this size; nothing if there is none.
fn part<'a>(list: &'a Json, key: &str, size: f64) -> &'a Json {
    let is_like = |part: &&Json| part[key].as_f64().is_some_and(|other| are_alike(size, other));
    list.as_array().into_iter().flatten().find(is_like).unwrap_or(&Json::Null)
}

/// * `words` – behind the label and behind the name of a measure
/// * `known` – numbers of a measure, with all that is known of them
fn both<T>(
    measures: &[Measure<T>],
    [of, ending]: [&str; 2],
    parts: [(&Json, &str); 2],
    known: impl Fn(&str, [WebNumber; 2]) -> [WebNumber; 2],
) -> Vec<ComparedMeasure> {
    let in_common = |declared: &Measure<T>| {
        let [a, b] = parts.map(|(json, name)| number(&json[declared.entry()], name));
        let values = known(declared.entry(), [a?, b?]);
        let unit = declared.unit.readable(values[0].value);
        let label = format!("{}{of}", declared.label);
        let column = format!("{}{ending}", declared.entry());
        Some(measure(label, column, unit, values.map(Ok), None))
    };
    measures.iter().filter_map(in_common).collect()
}

/// A number with what is known of it. What is a bound or a range has no difference from another one.
fn number(json: &Json, name: &str) -> Option<WebNumber> {
    let entry = |key: &str| json.get(key).and_then(Json::as_f64);
    let doubtful = |value: f64, kind: &str| WebNumber::doubtful(value, format!("{kind} ({name})"));
    if let Some(value) = entry("value") {
        return Some(match entry("standard_error") {
            Some(error) => WebNumber::known(value, error),
            None => doubtful(value, "no error is known"),
        });
    }
    let bound = [("at_least", "a lower bound"), ("at_most", "an upper bound")];
    let bound = bound.into_iter().find_map(|(key, kind)| Some(doubtful(entry(key)?, kind)));
    bound.or_else(|| Some(doubtful(0.5 * (entry("low")? + entry("high")?), "the middle of a range")))
}
