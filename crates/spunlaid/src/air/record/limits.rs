//! What a record must have, whichever way it comes.

use crate::ground::error::counted;
use crate::ground::units::shortest;
use crate::ground::{Dimension, Fault};

/// Least number of samples.
pub(super) const LEAST_SAMPLES: usize = 64;

/// The fault of a record that has too few samples.
pub(super) fn too_few_samples(found: usize, least: usize) -> Fault {
    Fault::new(
        format!("has {}", counted(found as u64, "sample")),
        format!("at least {least} are needed for statistics of turbulence"),
    )
}

/// The fault of a sampling rate [Hz] that is not above zero.
pub(super) fn rate_fault(rate: f64) -> Fault {
    Fault::new(format!("the sampling rate cannot be {} Hz", shortest(rate)), "give a rate above zero")
}

pub(super) fn time(seconds: f64) -> String {
    Dimension::Time.pretty_to(seconds, 3)
}

pub(super) fn hertz(frequency: f64) -> String {
    Dimension::Frequency.pretty_to(frequency, 3)
}

pub(super) fn number(value: f64) -> String {
    shortest(format!("{value:.2e}").parse().unwrap_or(value))
}
