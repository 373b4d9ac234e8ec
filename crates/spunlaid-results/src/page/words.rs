//! Sentences, and numbers with their units.

use crate::files::origin::Performance;
use crate::numbers::{HARD, THIN, number, plus_minus, significant};
use spunlaid_ground::{Dimension, Estimate};

/// A result with its standard error, `factor` converts the unit.
pub(crate) fn estimate_text(estimate: &Estimate, factor: f64) -> String {
    plus_minus(estimate.mean * factor, estimate.standard_error.map(|error| error * factor))
}

/// A number with its unit.
pub(crate) fn quantity(value: f64, unit: &str) -> String {
    format!("{}{THIN}{unit}", number(value))
}

/// The same text, but no line ends between a number and `%`.
pub(crate) fn unbroken(text: &str) -> String {
    text.replace(" %", &format!("{HARD}%"))
}

/// A quantity in the unit that suits it.
fn pretty(dimension: Dimension, value: f64) -> String {
    dimension.pretty_to(value, 3).replace(' ', &THIN.to_string()).replace('-', "−")
}

pub(crate) fn length(metres: f64) -> String {
    pretty(Dimension::Length, metres)
}

pub(crate) fn time(seconds: f64) -> String {
    pretty(Dimension::Time, seconds)
}

/// What a computation took.
pub(crate) fn cost(of: Performance) -> String {
    let run = of.ns_per_element_step.map_or_else(String::new, |each| {
        format!(" with {} instructions, {} per element and step", of.instruction_set, quantity(each, "ns"))
    });
    format!("computed in {} on {}{run}", time(of.wall_s), count(of.threads as u64, "thread"))
}

/// `1 replicate`, `10 replicates`.
pub(crate) fn count(n: u64, thing: &str) -> String {
    let digits = n.to_string();
    // A thin space between thousands, from five digits on.
    let mut text = String::new();
    for (i, c) in digits.chars().enumerate() {
        if digits.len() > 4 && i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(THIN);
        }
        text.push(c);
    }
    format!("{text} {thing}{}", if n == 1 { "" } else { "s" })
}

/// A length in millimetres.
pub(crate) fn millimetres(length: f64) -> String {
    format!("{}{THIN}mm", significant(length * 1e3, 3))
}

/// A length in millimetres, from one metre on in metres.
pub(crate) fn metres(length: f64) -> String {
    if length < 1.0 { millimetres(length) } else { format!("{}{THIN}m", significant(length, 3)) }
}

/// A basis weight in grams per square metre.
pub(crate) fn grams(weight: f64) -> String {
    format!("{}{THIN}g/m²", significant(weight * 1e3, 3))
}

/// A basis weight with its standard error.
pub(crate) fn grams_with_error((weight, error): (f64, Option<f64>)) -> String {
    error.map_or_else(
        || grams(weight),
        |error| format!("{}{THIN}g/m²", plus_minus(weight * 1e3, Some(error * 1e3))),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_suit_the_size() {
        assert_eq!(time(2e-6), "2\u{202f}µs");
        assert_eq!(length(-0.0123), "−12.3\u{202f}mm");
        assert_eq!(count(1_000_000, "step"), "1\u{202f}000\u{202f}000 steps");
    }
}
