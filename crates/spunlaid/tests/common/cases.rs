//! Cases that are read and written, and what is remarked on them.
#![allow(dead_code, clippy::unwrap_used, clippy::panic)]

use spunlaid_fibre::Case;
use spunlaid_input::{read_case, starter_case, write_case};
use std::sync::LazyLock;

/// Equal texts mean equal bits: numbers are shown by their shortest text that reads back, `-0.0` apart from `0.0`.
pub fn bits(case: &Case) -> String {
    format!("{case:?}")
}

/// The case that is read from what is written of another one.
pub fn read_again(case: &Case) -> Case {
    let text = write_case(case);
    let (again, _) = read_case((&text, "case.toml"), &[]).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(write_case(&again), text);
    again
}

/// The notes on the text of a case.
pub fn remarks(text: &str) -> Vec<String> {
    let (_, notes) = read_case((text, "case.toml"), &[]).unwrap();
    notes.iter().map(ToString::to_string).collect()
}

/// The starter with the mesh, the scheme and the step of the paper's Table 1.
pub fn papers_starter() -> &'static str {
    static TEXT: LazyLock<String> = LazyLock::new(|| {
        let line = |line: &str| match line.strip_prefix("# ").unwrap_or(line).split(' ').next() {
            Some("element_length") => "# element_length = \"50 mm\"".to_owned(),
            Some("time_step") => "time_step = \"1 µs\"".to_owned(),
            Some("scheme") => "# scheme = \"semi-implicit-euler\"".to_owned(),
            _ => line.to_owned(),
        };
        starter_case().lines().map(|old| line(old) + "\n").collect()
    });
    &TEXT
}

/// The starter of Table 1 with overrides: the case and the texts of its notes.
pub fn changed(set: &[(&str, &str)]) -> (Case, Vec<String>) {
    let set: Vec<_> = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let (case, notes) = read_case((papers_starter(), "starter.toml"), &set).unwrap();
    (case, notes.iter().map(ToString::to_string).collect())
}
