//! Fuzzes `checks::spinline`; see `fuzz/README.md`.
#![no_main]

#[path = "../checks.rs"]
#[allow(dead_code)]
mod checks;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    checks::spinline(data);
});
