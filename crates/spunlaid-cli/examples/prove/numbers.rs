//! The numbers of a summary that have an error.

use serde_json::{Map, Value as Json};
use spunlaid_ground::NORMAL_95;
use std::collections::BTreeMap;

/// A number with its error.
#[derive(Clone, Debug)]
pub struct Reported {
    pub value: f64,
    /// Standard error by all causes.
    pub error: f64,
    /// The part of it that comes of the sample of filaments, if it is reported separately.
    pub of_sample: Option<f64>,
    pub interval: [f64; 2],
    /// Degrees of freedom of the error, as far as it is known.
    pub degrees: f64,
}

/// What a number is, and of which patch, layer or place.
pub type Name = (String, String);
/// All numbers with an error of a summary.
pub type Numbers = BTreeMap<Name, Reported>;

/// By what a name says that it is the error of another, the whole one first. `error` alone is that of a mean.
const ERRORS: [&str; 3] = ["total_error", "standard_error", "_se"];
const OF_SAMPLE: &str = "flight_error";
/// Numbers without a name of their own.
const VALUES: [&str; 4] = ["value", "mean", "index", "variance"];
/// Parts of a summary that are no results.
const INPUTS: [&str; 2] = ["case", "performance"];
/// Degrees of freedom of an error that says nothing of them.
const FEW: f64 = 6.0;

/// All numbers of a summary that have an error.
///
/// # Panics
/// If it has an error of which it is not known whose it is.
pub fn numbers(summary: &Json) -> Numbers {
    let mut found = Numbers::new();
    walk(summary, (String::new(), String::new()), &mut found);
    found
}

fn walk(json: &Json, (name, of): Name, found: &mut Numbers) {
    match json {
        Json::Array(entries) => {
            for (place, entry) in entries.iter().enumerate() {
                let size = |name| Some(format!("{} mm", (1e6 * entry.get(name)?.as_f64()?).round() / 1e3));
                let which =
                    size("patch_m").or_else(|| size("from_m")).unwrap_or_else(|| (place + 1).to_string());
                walk(entry, (name.clone(), [&*of, &which].join(" ").trim().to_owned()), found);
            }
        }
        Json::Object(entries) => {
            let dotted =
                |entry: &str| if name.is_empty() { entry.to_owned() } else { format!("{name}.{entry}") };
            for (entry, error) in entries.iter().filter(|(_, error)| !error.is_object()) {
                let Some(value) = whose(entries, entry) else { continue };
                let full = if value == "value" || value == "mean" { name.clone() } else { dotted(&value) };
                if let Some(reported) = reported(entries, &value, error.as_f64()) {
                    let other = found.get(&(full.clone(), of.clone()));
                    if other.is_none() || entry.contains(ERRORS[0]) {
                        found.insert((full, of.clone()), reported);
                    }
                }
            }
            for (entry, part) in entries.iter().filter(|(entry, _)| !INPUTS.contains(&entry.as_str())) {
                walk(part, (dotted(entry), of.clone()), found);
            }
        }
        _ => {}
    }
}

/// The name of the number whose error an entry is; none of what is no error, or not the whole one.
fn whose(entries: &Map<String, Json>, error: &str) -> Option<String> {
    let own = || VALUES.iter().find(|name| entries.contains_key(**name)).map(ToString::to_string);
    if error == "error" {
        return own();
    }
    if error == "standard_error" && entries.contains_key("error") {
        return None;
    }
    let is_one =
        |word: &&&str| if word.starts_with('_') { error.ends_with(**word) } else { error.contains(**word) };
    let word = ERRORS.iter().find(is_one)?;
    let name = error.replace(word, "").replace("__", "_").trim_matches('_').to_owned();
    let name = if name.is_empty() { own() } else { Some(name) };
    let name = name.filter(|name| entries.contains_key(name));
    assert!(name.is_some(), "whose error is {error}? There are {:?}", entries.keys());
    name
}

fn reported(entries: &Map<String, Json>, name: &str, error: Option<f64>) -> Option<Reported> {
    let (value, error) = (entries[name].as_f64()?, error?);
    let interval = entries.get(&format!("{name}_interval")).or_else(|| entries.get("interval"));
    let end = |place: usize| interval?.get(place)?.as_f64();
    let half = NORMAL_95 * error;
    let degrees = entries.get(&format!("{name}_degrees")).and_then(Json::as_f64);
    let values = || Some(entries.get("values")?.as_array()?.len() as f64 - 1.0);
    Some(Reported {
        value,
        error,
        of_sample: entries.get(&format!("{name}_{OF_SAMPLE}")).and_then(Json::as_f64),
        interval: [end(0).unwrap_or(value - half), end(1).unwrap_or(value + half)],
        degrees: degrees.or_else(values).unwrap_or(FEW),
    })
}
