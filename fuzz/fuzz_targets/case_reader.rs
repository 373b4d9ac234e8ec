//! Whatever is in a case file, it is read or refused; what is read passes its check, and writes and reads
//! back to the same bits.
//!
//! `cargo +nightly fuzz run case_reader -- -dict=fuzz/case_file.dict -max_len=4096`
#![no_main]

use libfuzzer_sys::fuzz_target;
use spunlaid::input::{parse_case, starter_case, write_case};

fuzz_target!(|data: &[u8]| {
    let text = String::from_utf8_lossy(data);
    // Either a file, or overrides of the starter, `key=value` on each line.
    let (text, set) = match text.strip_prefix("--set\n") {
        Some(set) => (starter_case(), set),
        None => (&*text, ""),
    };
    let set: Vec<_> = (set.lines().filter_map(|line| line.split_once('=')))
        .map(|(key, value)| (key.to_owned(), value.to_owned()))
        .collect();
    match parse_case(text, "fuzz.toml", &set) {
        Ok((case, notes)) => {
            notes.iter().for_each(|note| assert!(!note.to_string().contains('\n')));
            if let Err(problems) = case.check() {
                panic!("{problems:?}");
            }
            let written = write_case(&case);
            match parse_case(&written, "written.toml", &[]) {
                Ok((again, _)) => {
                    assert_eq!(format!("{again:?}"), format!("{case:?}"), "{written}");
                    assert_eq!(write_case(&again), written);
                }
                Err(error) => panic!("{error}\n{written}"),
            }
        }
        Err(error) => {
            let said = error.to_string();
            assert!(said.lines().count() <= 21);
            assert!(said.chars().all(|c| c == '\n' || !c.is_control()), "{said:?}");
        }
    }
});
