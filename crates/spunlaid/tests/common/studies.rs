//! A short case, and studies of it.
#![allow(clippy::unwrap_used)]

use spunlaid_experiment::Point;
use spunlaid_fibre::Case;
use spunlaid_input::{StudyFile, parse_study};

/// Table 1 of the paper, 10 ms of it in steps of 20 µs.
pub const SHORT: &str = "version = 1
[fibre]
length = '1 m'
diameter = '50 µm'
density = '950 kg/m³'
youngs_modulus = '2 GPa'
element_length = '50 mm'
[air]
velocity = '10 m/s'
turbulence_intensity = 0.1
length_scale = '50 mm'
cutoff_frequency = '100 Hz'
[run]
duration = '10 ms'
time_step = '20 µs'
";

/// Reads a study of a case.
pub fn study(case: &str, text: &str) -> StudyFile {
    parse_study(text, "study.toml", None, |_, _| Ok((case.to_owned(), "case.toml".to_owned()))).unwrap()
}

/// The case of a point.
pub fn case_of(point: &Point) -> &Case {
    point.experiment.case().unwrap()
}
