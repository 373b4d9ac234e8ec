//! Cases that are read and written, and what is remarked on them.
#![allow(dead_code, clippy::unwrap_used, clippy::panic)]

use spunlaid::case::Case;
use spunlaid::input::{parse_case, starter_case, write_case};

/// Equal texts mean equal bits: numbers are shown by their shortest text that reads back, `-0.0` apart from `0.0`.
pub fn bits(case: &Case) -> String {
    format!("{case:?}")
}

/// The case that is read from what is written of another one.
pub fn read_again(case: &Case) -> Case {
    let text = write_case(case);
    let (again, _) = parse_case(&text, "case.toml", &[]).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(write_case(&again), text);
    again
}

/// The notes on the text of a case.
pub fn remarks(text: &str) -> Vec<String> {
    let (_, notes) = parse_case(text, "case.toml", &[]).unwrap();
    notes.iter().map(ToString::to_string).collect()
}

/// The starter with overrides: the case and the texts of its notes.
pub fn changed(set: &[(&str, &str)]) -> (Case, Vec<String>) {
    let set: Vec<_> = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let (case, notes) = parse_case(starter_case(), "starter.toml", &set).unwrap();
    (case, notes.iter().map(ToString::to_string).collect())
}
