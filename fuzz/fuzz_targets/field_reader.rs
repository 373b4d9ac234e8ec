//! Whatever is in a file of air, VTK or a table, it is read or refused; what is read can be asked anywhere.
//!
//! `cargo +nightly fuzz run field_reader -- -max_len=8192`
#![no_main]

use libfuzzer_sys::fuzz_target;
use spunlaid::field::{Field, Hint};

fuzz_target!(|data: &[u8]| match Field::parse(data, "fuzz.vtu") {
    Ok((field, warnings)) => {
        warnings.iter().for_each(|warning| assert!(!warning.to_string().contains('\n')));
        let (low, high) = field.bounds();
        let mut hint = Hint::default();
        for share in [0.0, 0.1, 0.33, 0.5, 0.9, 1.0, 1.7] {
            for at in [low + (high - low) * share, low - high * share] {
                let local = field.sample(at, &mut hint);
                let numbers = [local.velocity.x, local.velocity.y, local.velocity.z, local.k, local.epsilon];
                assert!(numbers.into_iter().all(f64::is_finite), "{local:?}");
            }
        }
    }
    Err(error) => {
        let said = error.to_string();
        assert!(said.chars().all(|c| !c.is_control()), "{said:?}");
    }
});
