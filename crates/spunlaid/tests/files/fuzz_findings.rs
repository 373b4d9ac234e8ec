//! What the fuzzers found, and what they start from, put to the same checks as their inputs. A finding is kept
//! as a file in `fuzz_findings/case`, `record`, `field`, `scan`, `web` or `spinline`.

use crate::checks;
use std::fs;
use std::path::Path;

/// Checks every file in some folders; gives how many were read and how many refused.
fn replay(check: fn(&[u8]) -> bool, folders: &[&str]) -> (usize, usize) {
    let (mut read, mut refused) = (0, 0);
    for folder in folders {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        // Git keeps no folder in which there is nothing yet.
        for entry in fs::read_dir(&folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                continue;
            }
            // Shown where the check panics.
            println!("{}", path.display());
            *(if check(&fs::read(path).unwrap()) { &mut read } else { &mut refused }) += 1;
        }
    }
    (read, refused)
}

#[test]
fn case_files_found_by_the_fuzzer() {
    let (read, refused) =
        replay(checks::case, &["tests/fuzz_findings/case", "../../cases", "tests/bad_cases"]);
    assert!(read >= 25 && refused >= 25, "{read} read, {refused} refused");
}

#[test]
fn velocity_records_found_by_the_fuzzer() {
    let (read, refused) = replay(
        checks::record,
        &["tests/fuzz_findings/record", "../../cases/records", "../../cases/tables", "tests/bad_tables"],
    );
    assert!(read >= 1 && refused >= 5, "{read} read, {refused} refused");
}

#[test]
fn fields_found_by_the_fuzzer() {
    let (read, refused) = replay(
        checks::field,
        &["tests/fuzz_findings/field", "../spunlaid-field/tests/fixtures", "../../cases/fields"],
    );
    assert!(read >= 20 && refused >= 1, "{read} read, {refused} refused");
}

#[test]
fn scans_found_by_the_fuzzer() {
    let (read, refused) = replay(checks::scan, &["tests/fuzz_findings/scan", "tests/scan_fixtures"]);
    assert!(read >= 6 && refused >= 2, "{read} read, {refused} refused");
}

#[test]
fn webs_found_by_the_fuzzer() {
    let (read, refused) = replay(checks::web, &["tests/fuzz_findings/web", "../../cases", "tests/bad_webs"]);
    assert!(read >= 1 && refused >= 100, "{read} read, {refused} refused");
}

/// The fuzzer starts from these files alone, without the tables of air that most of them name; those are refused.
#[test]
fn spinlines_found_by_the_fuzzer() {
    let (read, refused) = replay(
        checks::spinline,
        &["tests/fuzz_findings/spinline", "../../cases", "tests/spinline_cases", "tests/bad_cases"],
    );
    assert!(read >= 10 && refused >= 50, "{read} read, {refused} refused");
}
