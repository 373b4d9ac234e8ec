//! Sentences, and numbers with their units.

use crate::numbers::{HARD, THIN, number, plus_minus};
use spunlaid::air::EddyModel;
use spunlaid::case::Case;
use spunlaid::chain::schemes::Scheme;
use spunlaid::ensemble::Results;
use spunlaid::fibre::Root;
use spunlaid::statistics::Estimate;

/// A result with its standard error, `factor` converts the unit.
pub(super) fn estimate_text(of: &Estimate, factor: f64) -> String {
    plus_minus(of.mean * factor, of.standard_error.map(|error| error * factor))
}

/// A number with its unit.
pub(super) fn quantity(value: f64, unit: &str) -> String {
    format!("{}{THIN}{unit}", number(value))
}

/// The same text, but no line ends between a number and `%`.
pub(super) fn unbroken(text: &str) -> String {
    text.replace(" %", &format!("{HARD}%"))
}

/// A length in the unit that suits it.
pub(super) fn length(metres: f64) -> String {
    match metres.abs() {
        m if m >= 1.0 || m == 0.0 => quantity(metres, "m"),
        m if m >= 1e-3 => quantity(metres * 1e3, "mm"),
        _ => quantity(metres * 1e6, "µm"),
    }
}

/// A time in the unit that suits it.
pub(super) fn time(seconds: f64) -> String {
    match seconds.abs() {
        s if s >= 1.0 || s == 0.0 => quantity(seconds, "s"),
        s if s >= 1e-3 => quantity(seconds * 1e3, "ms"),
        s if s >= 1e-6 => quantity(seconds * 1e6, "µs"),
        _ => quantity(seconds * 1e9, "ns"),
    }
}

/// `1 replicate`, `10 replicates`.
pub(super) fn count(n: u64, thing: &str) -> String {
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

/// The result in a sentence.
pub(super) fn headline(case: &Case, results: &Results) -> String {
    let of = |axis| {
        let of = |measure: &str| results.estimate(&format!("{measure}_{axis}"));
        (axis, of("amplitude"), of("frequency"))
    };
    let both = ["y", "z"].map(of);
    if both.iter().any(|(_, amplitude, _)| !amplitude.mean.is_finite()) {
        return "The motion of the free end could not be measured.".to_owned();
    }
    // Below this it is rounding.
    let least = 1e-12 * case.fibre.length;
    let moving: Vec<_> = both.iter().filter(|(_, amplitude, _)| amplitude.mean > least).collect();
    let joined = |parts: Vec<String>| parts.join(" and ");
    let amplitudes = joined(
        moving.iter().map(|(axis, a, _)| format!("{}{THIN}mm in {axis}", estimate_text(a, 1e3))).collect(),
    );
    let frequencies =
        joined(moving.iter().filter(|m| m.2.mean > 0.0).map(|(.., f)| estimate_text(f, 1.0)).collect());
    match (moving.is_empty(), frequencies.is_empty()) {
        (true, _) => "The free end does not move sideways.".to_owned(),
        (false, true) => {
            format!("The free end moves by {amplitudes} (standard deviation) without swinging through zero.")
        }
        (false, false) => format!("The free end swings {amplitudes}, at {frequencies}{THIN}Hz."),
    }
}

/// What was simulated, in three sentences.
pub(super) fn case(case: &Case) -> String {
    let (fibre, air, run) = (&case.fibre, &case.air, &case.run);
    let held = match fibre.root {
        Root::Pinned => "held at one end, free to turn there",
        Root::Clamped => "clamped at one end",
        Root::Free => "free at both ends",
    };
    let medium = if air.density == 0.0 {
        "in a vacuum".to_owned()
    } else if air.velocity == 0.0 {
        "in still air".to_owned()
    } else if air.rms() == 0.0 {
        format!("in air of {} without turbulence", quantity(air.velocity, "m/s"))
    } else {
        let along = if air.is_uniform() { "" } else { ", on average along the fibre" };
        let eddies = match air.eddies {
            EddyModel::Independent => format!("in eddies of {}", length(air.length_scale)),
            EddyModel::Convected { .. } => "that is carried along the fibre".to_owned(),
        };
        let measured = if air.records.is_empty() { "" } else { "measured " };
        format!(
            "in air of {} with {} {measured}turbulence {eddies}{along}",
            quantity(air.velocity, "m/s"),
            quantity(air.turbulence_intensity * 100.0, "%"),
        )
    };
    let scheme = match run.scheme {
        Scheme::SemiImplicitEuler => "semi-implicit Euler",
        Scheme::Leapfrog => "leapfrog",
        Scheme::ImplicitTension => "leapfrog with implicit tension",
    };
    format!(
        "A fibre of {} length and {} diameter, {held}, moves {medium}. {} computed, {}for {} in {} of {} ({scheme}). The \
         fibre is divided into {}.",
        length(fibre.length),
        length(fibre.diameter),
        count(run.replicates, "replicate") + if run.replicates == 1 { " was" } else { " were" },
        if run.replicates > 1 { "each " } else { "" },
        time(run.duration()),
        count(run.steps, "step"),
        time(run.time_step),
        count(fibre.elements as u64, "element"),
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
