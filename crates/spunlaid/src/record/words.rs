//! Numbers of a record in messages, to three digits.

use crate::units::{Dimension, shortest};

pub(super) fn time(seconds: f64) -> String {
    Dimension::Time.pretty_to(seconds, 3)
}

pub(super) fn hertz(frequency: f64) -> String {
    Dimension::Frequency.pretty_to(frequency, 3)
}

pub(super) fn number(value: f64) -> String {
    shortest(format!("{value:.2e}").parse().unwrap_or(value))
}
