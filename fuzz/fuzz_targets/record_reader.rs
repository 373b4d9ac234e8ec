//! Whatever is in a velocity record, CSV or Parquet, it is read or refused; what is read can be analysed or
//! is refused for a reason.
//!
//! `cargo +nightly fuzz run record_reader -- -max_len=4096`
#![no_main]

use libfuzzer_sys::fuzz_target;
use spunlaid::record::{Layout, Settings, analyse, parse_csv, parse_parquet};

fuzz_target!(|data: &[u8]| {
    let rate = Layout { rate: Some(1e4), velocity_unit: Some("m/s".to_owned()), ..Layout::default() };
    for layout in [Layout::default(), rate] {
        let read = if data.starts_with(b"PAR1") {
            parse_parquet(data.to_vec(), "fuzz.parquet", &layout)
        } else {
            parse_csv(data, "fuzz.csv", &layout)
        };
        match read {
            Ok(record) => {
                let samples = record.samples();
                for component in &record.components {
                    assert_eq!(component.values.len(), samples);
                    assert!(component.values.iter().all(|x| x.is_finite()));
                }
                assert!(record.interval > 0.0);
                if let Ok(of) = analyse(&record, &Settings::default()) {
                    of.warnings.iter().for_each(|w| assert!(!w.to_string().contains('\n')));
                }
            }
            Err(error) => {
                let said = error.to_string();
                assert!(said.chars().all(|c| !c.is_control()), "{said:?}");
            }
        }
    }
});
