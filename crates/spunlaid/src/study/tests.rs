//! What the tests of this room share.

use crate::case::Case;
use crate::input::{parse_case, starter_case};

/// Table 1 of the paper, short and coarse in time.
pub(super) fn table1() -> Case {
    let changes = [("run.duration", "20 ms"), ("run.time_step", "20 µs"), ("fibre.element_length", "50 mm")];
    let changes = changes.map(|(key, value)| (key.to_owned(), value.to_owned()));
    parse_case(starter_case(), "starter.toml", &changes).expect("the starter case").0
}
