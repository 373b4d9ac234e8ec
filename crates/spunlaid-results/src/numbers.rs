//! Numbers as a person reads them, by the same rules on the terminal, in reports and in captions.
//!
//! An error has two significant digits, and its value has as many decimals: `9.54 ± 0.44`, `31200 ± 1500`. A number
//! without an error has three digits, a mean whose error is not known four, far from one with a power of ten.

pub use spunlaid_charts::{signed, significant};

/// A space that neither breaks nor stretches, between a number and its unit.
pub const THIN: char = '\u{202f}';
/// A space that does not break, around a sign.
pub const HARD: char = '\u{a0}';

/// Most decimals that are written out; smaller errors have a power of ten.
const DECIMALS: i32 = 6;
/// Most digits of a value.
const DIGITS: i32 = 9;

/// Number of decimals that shows an error with two digits. Negative if zeros stand before the decimal point. `None`
/// if there is no error.
pub fn decimals(error: f64) -> Option<i32> {
    // The exponent is read after rounding: 0.0996 is 0.10.
    let known = error.is_finite() && error > 0.0;
    let exponent: i32 = format!("{error:.1e}").rsplit('e').next()?.parse().ok().filter(|_| known)?;
    Some(1 - exponent)
}

/// A value with this number of decimals (see [`decimals`]). If that would be too long, with as many digits as they
/// leave, at most six; if nothing would be left of it, with two.
pub fn to_decimals(value: f64, decimals: i32) -> String {
    let size = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    if !value.is_finite() || !(-DECIMALS..=DECIMALS).contains(&decimals) || size + decimals >= DIGITS {
        return number_to(value, size.saturating_add(decimals).saturating_add(1).clamp(2, 6));
    }
    let power = 10f64.powi(-decimals.min(0));
    let rounded = if decimals < 0 { (value / power).round() * power } else { value };
    let text = signed(rounded, decimals.max(0) as usize);
    let is_nothing = value != 0.0 && !text.bytes().any(|digit| (b'1'..=b'9').contains(&digit));
    match is_nothing {
        true if size < -DECIMALS => number_to(value, 2),
        true => significant(value, 2),
        false => text,
    }
}

/// A mean and its error, apart: the error to two digits, the mean to as many decimals.
pub fn rounded(mean: f64, error: Option<f64>) -> (String, Option<String>) {
    let Some((error, decimals)) = error.and_then(|error| Some((error, decimals(error)?))) else {
        return (number_to(mean, 4), None);
    };
    let error_text = if (-DECIMALS..=DECIMALS).contains(&decimals) {
        to_decimals(error, decimals)
    } else {
        number_to(error, 2)
    };
    (to_decimals(mean, decimals), Some(error_text))
}

/// `9.54 ± 0.44`; a mean without an error to four digits.
pub fn plus_minus(mean: f64, error: Option<f64>) -> String {
    match rounded(mean, error) {
        (mean, Some(error)) => format!("{mean}{HARD}±{HARD}{error}"),
        (mean, None) => mean,
    }
}

/// A number to three digits, with a power of ten where it is far from one; a dash if it is not finite.
pub fn number(value: f64) -> String {
    number_to(value, 3)
}

/// A number to so many digits, with a power of ten where it is far from one; a dash if it is not finite.
pub fn number_to(value: f64, digits: i32) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    // The exponent is read after rounding: 9.999e17 is 1 × 10¹⁸.
    let text = format!("{value:.*e}", (digits - 1).max(0) as usize);
    let (mantissa, magnitude) = text.split_once('e').unwrap_or((&text, "0"));
    let mantissa = mantissa.parse().unwrap_or(value);
    let magnitude = magnitude.parse().unwrap_or(0);
    if (-3..6).contains(&magnitude) {
        return significant(value, digits);
    }
    format!("{}{THIN}×{THIN}10{}", significant(mantissa, digits), superscript(magnitude))
}

/// `50 to 52.3`: to three digits, more where the ends would look alike; one number where they are.
pub fn range(low: f64, high: f64) -> String {
    let ends = |digits| (significant(low, digits), significant(high, digits));
    match (3..=9).map(ends).find(|(low, high)| low != high) {
        Some((low, high)) => format!("{low} to {high}"),
        None => significant(high, 3),
    }
}

fn superscript(exponent: i32) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| c.to_digit(10).map_or('⁻', |digit| RAISED[digit as usize]);
    exponent.to_string().chars().map(raised).collect()
}

/// A label as it stands within a sentence: with a small first letter.
pub(crate) fn in_sentence(label: &str) -> String {
    let mut letters = label.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}

/// A text as it stands at the beginning of a sentence: with a large first letter.
pub(crate) fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// `1 of 10 fibres was lost`.
pub fn lost_fibres_text(lost: u64, all: u64) -> String {
    format!("{lost} of {all} fibres {} lost", if lost == 1 { "was" } else { "were" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_have_two_digits_and_means_as_many_decimals() {
        for (mean, error, expected) in [
            (9.541, 0.438, "9.54 ± 0.44"),
            (17.612, 0.123, "17.61 ± 0.12"),
            (9.541, 0.0996, "9.54 ± 0.10"),
            (812.3, 31.4, "812 ± 31"),
            (31_234.0, 1_520.0, "31200 ± 1500"),
            (-0.0004, 0.02, "−0.0004 ± 0.020"),
            (2510.0, 3.7e7, "2510 ± 37000000"),
            (7.270_91e-15, 7.3e-15, "7.3 × 10⁻¹⁵ ± 7.3 × 10⁻¹⁵"),
            (0.0, 0.02, "0.000 ± 0.020"),
            (-12.34, 0.5, "−12.34 ± 0.50"),
            (997.54, 1.23e-9, "997.54 ± 1.2 × 10⁻⁹"),
            (3e12, 2.5e11, "3 × 10¹² ± 2.5 × 10¹¹"),
        ] {
            assert_eq!(plus_minus(mean, Some(error)).replace([HARD, THIN], " "), expected);
        }
    }

    #[test]
    fn means_without_an_error_have_four_digits() {
        for error in [None, Some(0.0), Some(f64::NAN), Some(f64::INFINITY), Some(-1.0)] {
            assert_eq!(plus_minus(9.812_345_678_901_23, error), "9.812");
        }
        assert_eq!(plus_minus(f64::NAN, Some(0.1)).replace(HARD, " "), "– ± 0.10");
        assert_eq!(plus_minus(f64::NAN, None), "–");
    }

    #[test]
    fn numbers_far_from_one_have_a_power_of_ten() {
        assert_eq!(number(1.5e-9), "1.5\u{202f}×\u{202f}10⁻⁹");
        assert_eq!(number(0.0), "0");
        assert_eq!(number(9.999e17), "1\u{202f}×\u{202f}10¹⁸");
        assert_eq!(number(-9.999e-10), "−1\u{202f}×\u{202f}10⁻⁹");
        assert_eq!(number(999_999.0), "1\u{202f}×\u{202f}10⁶");
        assert_eq!(number(9.9999e-4), "0.001");
        assert_eq!(number(-0.25), "−0.25");
    }

    #[test]
    fn the_ends_of_a_range_differ() {
        assert_eq!(range(50.0, 52.34), "50 to 52.3");
        assert_eq!(range(52.311, 52.312), "52.311 to 52.312");
        assert_eq!(range(52.3, 52.3), "52.3");
    }
}
