//! Bad input and what is said of it.
#![allow(clippy::unwrap_used)]

use spunlaid::input::read_case;
use std::path::Path;

#[test]
fn every_case_of_the_repository_is_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    for entry in std::fs::read_dir(folder).unwrap() {
        let (_, notes) = read_case(&entry.unwrap().path(), &[]).unwrap();
        assert_eq!(notes, []);
    }
}
