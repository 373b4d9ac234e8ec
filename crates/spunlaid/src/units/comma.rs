//! Numbers with commas, which are decimal signs or stand between thousands.

use super::excerpt;
use crate::error::Fault;

/// The two readings of a number with commas, as far as it can be meant so: with the commas between thousands, and
/// with the comma as decimal sign. `1,500` has both, `1,234,567` the first, `0,500` and `1,5` the second.
pub(crate) fn readings(number: &str) -> [Option<String>; 2] {
    let mut groups = number.trim_start_matches(['+', '-']).split(',');
    let first = groups.next().unwrap_or_default();
    let groups: Vec<&str> = groups.collect();
    // Decimals follow the last group.
    let whole = |group: &&str| group.split('.').next().is_some_and(|whole| whole.len() == 3);
    let are_thousands = matches!(first.len(), 1..=3)
        && !first.starts_with('0')
        && groups.iter().all(whole)
        && groups.iter().rev().skip(1).all(|group| !group.contains('.'));
    let is_decimal = groups.len() == 1 && !number.contains('.');
    [are_thousands.then(|| number.replace(',', "")), is_decimal.then(|| number.replacen(',', ".", 1))]
}

/// A text whose number has a decimal comma, with a point in its place; None if the comma may stand between thousands
/// too, or if there is none.
///
/// `0,6 g/min` is `0.6 g/min`, and `1,500 MPa` may be either.
pub fn with_decimal_point(text: &str) -> Option<String> {
    let (number, rest) = split(text);
    match readings(number) {
        [None, Some(decimal)] if number.contains(',') => Some(decimal + rest),
        _ => None,
    }
}

fn split(text: &str) -> (&str, &str) {
    let is_of_number = |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | ',' | '.');
    text.split_at(text.find(|c| !is_of_number(c)).unwrap_or(text.len()))
}

/// The fault of a quantity that begins with a number with commas.
pub(super) fn comma(text: &str) -> Fault {
    let (number, rest) = split(text);
    let quoted = |number: String| format!("\"{}\"", excerpt(&(number + rest), 40));
    let remedy = match readings(number).map(|reading| reading.map(quoted)) {
        [Some(thousands), Some(decimal)] => {
            format!(
                "write {thousands} if the comma stands between thousands, or {decimal} if it is a decimal sign"
            )
        }
        [Some(thousands), None] => {
            format!("write the number without signs between its thousands, like {thousands}")
        }
        [None, Some(decimal)] => format!("write the number with a decimal point, like {decimal}"),
        [None, None] => "write the number with a decimal point and without other signs".to_owned(),
    };
    Fault::new("has a comma", remedy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comma_is_read_as_all_that_it_can_mean() {
        for (number, thousands, decimal) in [
            ("1,500", Some("1500"), Some("1.500")),
            ("-12,345", Some("-12345"), Some("-12.345")),
            ("1,234,567", Some("1234567"), None),
            ("1,234.5", Some("1234.5"), None),
            ("0,6", None, Some("0.6")),
            ("0,600", None, Some("0.600")),
            ("12,5", None, Some("12.5")),
            ("1500,25", None, Some("1500.25")),
            ("1.234,5", None, None),
            ("1,23,456", None, None),
        ] {
            let wanted = [thousands, decimal].map(|reading| reading.map(str::to_owned));
            assert_eq!(readings(number), wanted, "{number}");
        }
    }

    #[test]
    fn a_comma_that_can_only_be_a_decimal_sign_becomes_a_point() {
        let read = |text| with_decimal_point(text);
        assert_eq!(read("0,6 g/min").as_deref(), Some("0.6 g/min"));
        assert_eq!(read("2,25").as_deref(), Some("2.25"));
        assert_eq!([read("1,500 MPa"), read("1,234,567"), read("0.6"), read("pp, 35")], [const { None }; 4]);
    }

    #[test]
    fn rejects_a_comma_with_all_that_it_can_mean() {
        let told = |text| comma(text).to_string();
        assert_eq!(
            told("1,500 MPa"),
            "has a comma; write \"1500 MPa\" if the comma stands between thousands, or \"1.500 MPa\" if it is a decimal \
             sign"
        );
        assert_eq!(
            told("0,6 g/min"),
            "has a comma; write the number with a decimal point, like \"0.6 g/min\""
        );
    }
}
