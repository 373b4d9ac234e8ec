//! The rooms of the program, of results and of charts import one another one way only.

#[path = "../../spunlaid/tests/rooms_of/mod.rs"]
mod rooms_of;

use rooms_of::faults;
use std::path::Path;

/// The rooms of the program from left to right; those of one group may not import one another.
const PROGRAM: &[&[&str]] = &[&["args", "failure", "progress", "say"], &["live"], &["commands"]];

const RESULTS: &[&[&str]] =
    &[&["failure", "numbers"], &["webs"], &["figures"], &["output"], &["report"], &["folders"]];

const CHARTS: &[&[&str]] = &[
    &["decimate", "glyphs", "numbers", "palette"],
    &["png", "svg"],
    &["table", "map"],
    &["scale"],
    &["chart"],
    &["legend"],
    &["draw"],
    &["figure"],
    &["rose"],
];

#[test]
fn rooms_import_only_from_their_left() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut wrong = faults(&crates.join("spunlaid-cli/src"), PROGRAM, &["main"]);
    wrong.extend(faults(&crates.join("spunlaid-results/src"), RESULTS, &["lib"]));
    wrong.extend(faults(&crates.join("spunlaid-charts/src"), CHARTS, &["lib"]));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
