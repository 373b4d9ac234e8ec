//! Numbers and sentences.

use crate::figures::{signed, significant};
use spunlaid::air::EddyModel;
use spunlaid::case::Case;
use spunlaid::chain::schemes::Scheme;
use spunlaid::ensemble::Results;
use spunlaid::fibre::Root;
use spunlaid::statistics::Estimate;

/// A space that neither breaks nor stretches, between a number and its unit.
const THIN: char = '\u{202f}';
/// A space that does not break, around a sign.
const HARD: char = '\u{a0}';

/// `9.8 ± 0.2`: rounded to the error's first digit, or to two where that is a one; without an error to
/// three digits. `factor` converts the unit.
pub(super) fn plus_minus(estimate: &Estimate, factor: f64) -> String {
    let mean = estimate.mean * factor;
    let error = estimate.standard_error.map(|e| e * factor).filter(|e| e.is_finite() && *e > 0.0);
    let Some(error) = error else {
        return number(mean);
    };
    let magnitude = error.log10().floor() as i32;
    let leading = error / 10f64.powi(magnitude);
    let decimals = if leading < 1.95 { 1 - magnitude } else { -magnitude };
    if !mean.is_finite() || decimals > 6 {
        return format!("{}{HARD}±{HARD}{}", number(mean), number(error));
    }
    let decimals = decimals.max(0) as usize;
    format!("{}{HARD}±{HARD}{}", signed(mean, decimals), signed(error, decimals))
}

/// A number to three digits, with a power of ten where it is far from one; a dash for none.
pub(super) fn number(value: f64) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let magnitude = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    if (-3..6).contains(&magnitude) {
        return significant(value, 3);
    }
    let mantissa = significant(value / 10f64.powi(magnitude), 3);
    format!("{mantissa}{THIN}×{THIN}10{}", superscript(magnitude))
}

fn superscript(exponent: i32) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        _ => '⁰',
    };
    exponent.to_string().chars().map(raised).collect()
}

/// A number with its unit.
pub(super) fn quantity(value: f64, unit: &str) -> String {
    format!("{}{THIN}{unit}", number(value))
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
    let end = &results.end_node;
    if !end.amplitude_y.mean.is_finite() || !end.amplitude_z.mean.is_finite() {
        return "The motion of the free end could not be measured.".to_owned();
    }
    // Below this it is rounding.
    let least = 1e-12 * case.fibre.length;
    let moving: Vec<_> =
        [("y", &end.amplitude_y, &end.frequency_y), ("z", &end.amplitude_z, &end.frequency_z)]
            .into_iter()
            .filter(|(_, amplitude, _)| amplitude.mean > least)
            .collect();
    let joined = |parts: Vec<String>| parts.join(" and ");
    let amplitudes = joined(
        moving.iter().map(|(axis, a, _)| format!("{}{THIN}mm in {axis}", plus_minus(a, 1e3))).collect(),
    );
    let frequencies =
        joined(moving.iter().filter(|m| m.2.mean > 0.0).map(|(.., f)| plus_minus(f, 1.0)).collect());
    match (moving.is_empty(), frequencies.is_empty()) {
        (true, _) => "The free end does not move sideways.".to_owned(),
        (false, true) => {
            format!("The free end moves by {amplitudes} (standard deviation) without swinging through zero.")
        }
        (false, false) => format!("The free end swings {amplitudes}, at {frequencies}{THIN}Hz."),
    }
}

/// What was simulated, in two sentences.
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
        "A fibre of {} length and {} diameter, {held}, {medium}: {}, {}simulated for {} in {} of {} \
         ({scheme}), the fibre cut into {}.",
        length(fibre.length),
        length(fibre.diameter),
        count(run.replicates, "replicate"),
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

    fn estimate(mean: f64, standard_error: Option<f64>) -> Estimate {
        Estimate { mean, standard_error, values: Vec::new() }
    }

    #[test]
    fn errors_set_the_digits() {
        assert_eq!(plus_minus(&estimate(9.812e-3, Some(0.21e-3)), 1e3), "9.8\u{a0}±\u{a0}0.2");
        assert_eq!(plus_minus(&estimate(17.612, Some(0.123)), 1.0), "17.61\u{a0}±\u{a0}0.12");
        assert_eq!(plus_minus(&estimate(812.3, Some(31.0)), 1.0), "812\u{a0}±\u{a0}31");
        assert_eq!(plus_minus(&estimate(9.8123, None), 1.0), "9.81");
        assert_eq!(plus_minus(&estimate(f64::NAN, Some(f64::NAN)), 1.0), "–");
    }

    #[test]
    fn numbers_far_from_one_have_a_power_of_ten() {
        assert_eq!(number(1.5e-9), "1.5\u{202f}×\u{202f}10⁻⁹");
        assert_eq!(number(0.0), "0");
        assert_eq!(number(-0.25), "−0.25");
        assert_eq!(time(2e-6), "2\u{202f}µs");
        assert_eq!(count(1_000_000, "step"), "1\u{202f}000\u{202f}000 steps");
    }
}
