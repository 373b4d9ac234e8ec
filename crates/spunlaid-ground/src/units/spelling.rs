//! The ways in which a unit is written, `m²/s²`, `m^2 s^-2`, `m²·s⁻²`, `m**2/s**2`; and numbers with commas, which are
//! decimal signs or stand between thousands. The units of values as they are kept, in words that other programs read.

use super::{Dimension, excerpt};
use crate::error::Fault;

/// A symbol, as `m`, and its power.
type Factor = (String, f64);

/// Brings the signs of a unit to one spelling in plain characters: `kg/m³`, `kg/m^3` and `kg/m3` become
/// `kg/m3`; `µ` (micro) and `μ` (mu) become `u`; the signs for minus, times and divided by become `-`, `·`
/// and `/`.
pub fn plain_spelling(unit: &str) -> String {
    let plain = unit.replace("**", "");
    let plain = plain.chars().filter(|c| *c != '^').map(|c| match c {
        'µ' | 'μ' => 'u',
        '⁰' => '0',
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        '⁴' => '4',
        '⁵' => '5',
        '⁶' => '6',
        '⁷' => '7',
        '⁸' => '8',
        '⁹' => '9',
        '⁻' | '−' | '‐' | '‑' | '–' => '-',
        '⋅' | '∙' | '•' | '×' | '*' => '·',
        '∕' | '⁄' | '÷' => '/',
        '\u{a0}' | '\u{2009}' | '\u{202f}' => ' ',
        other => other,
    });
    plain.collect()
}

/// Whether a unit in plain spelling has these factors.
pub(super) fn is_same(factors_of_other: Option<&[Factor]>, plain: &str) -> bool {
    factors_of_other.is_some_and(|other| factors(plain).is_some_and(|own| own == other))
}

/// The factors of a unit in plain spelling, sorted by their symbols, each of them once. None if it is not
/// written as symbols with powers.
///
/// A slash divides by the next factor only, or by a parenthesis: `J/(kg K)`, `J/kg/K`.
pub(super) fn factors(plain: &str) -> Option<Vec<Factor>> {
    let mut found = Vec::new();
    let rest = product(plain.trim(), &mut found, 0)?;
    found.retain(|(_, power)| *power != 0.0);
    found.sort_by(|a, b| a.0.cmp(&b.0));
    (rest.is_empty() && !found.is_empty()).then_some(found)
}

/// Reads a product up to its end or a closing parenthesis, and returns what follows.
fn product<'a>(mut rest: &'a str, found: &mut Vec<Factor>, depth: usize) -> Option<&'a str> {
    const DEEPEST: usize = 4;
    let mut divided = 1.0;
    loop {
        rest = rest.trim_start();
        if let Some(inner) = rest.strip_prefix('(').filter(|_| depth < DEEPEST) {
            let mut group = Vec::new();
            let after = product(inner, &mut group, depth + 1)?.strip_prefix(')')?;
            let (outer, after) = power(after)?;
            group.into_iter().for_each(|(symbol, inner)| add(found, &symbol, divided * outer * inner));
            rest = after;
        } else if let Some(after) = rest.strip_prefix('1').filter(|after| !after.starts_with(is_digit)) {
            rest = after;
        } else {
            let end = rest.find(|c| !is_in_symbol(c)).unwrap_or(rest.len());
            let (symbol, after) = rest.split_at(end);
            let (own, after) = power(after)?;
            if symbol.is_empty() {
                return None;
            }
            add(found, symbol, divided * own);
            rest = after;
        }
        let after = rest.trim_start();
        divided = if after.starts_with('/') { -1.0 } else { 1.0 };
        rest = match after.strip_prefix(['/', '·', '.']) {
            Some(after) => after,
            None if after.is_empty() || after.starts_with(')') => return Some(after),
            // A blank between two factors, or nothing at a parenthesis.
            None => after,
        };
    }
}

/// The power at the start of a text, 1 if there is none, and what follows.
fn power(text: &str) -> Option<(f64, &str)> {
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
    let whole = digits.find(|c| !is_digit(c)).unwrap_or(digits.len());
    let fraction = digits[whole..].strip_prefix('.').filter(|after| after.starts_with(is_digit));
    let length = whole + fraction.map_or(0, |after| 1 + after.find(|c| !is_digit(c)).unwrap_or(after.len()));
    let end = text.len() - digits.len() + length;
    match &text[..end] {
        "" => Some((1.0, text)),
        written => Some((written.parse().ok()?, &text[end..])),
    }
}

fn add(found: &mut Vec<Factor>, symbol: &str, power: f64) {
    match found.iter_mut().find(|(known, _)| known == symbol) {
        Some((_, sum)) => *sum += power,
        None => found.push((symbol.to_owned(), power)),
    }
}

fn is_digit(c: char) -> bool {
    c.is_ascii_digit()
}

fn is_in_symbol(c: char) -> bool {
    c.is_alphabetic() || matches!(c, '°' | '%' | '√')
}

/// The two readings of a number with commas, as far as it can be meant so: with the commas between thousands, and
/// with the comma as decimal sign. `1,500` has both, `1,234,567` the first, `0,500` and `1,5` the second.
pub fn readings(number: &str) -> [Option<String>; 2] {
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
        [None, Some(decimal)] => Some(decimal + rest),
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
                "write {thousands} if the comma separates thousands, or {decimal} if it is a decimal sign"
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

/// The SI unit of a multiple of it, or of a quotient of such multiples: `m²/Hz` of `mm²/Hz`, `kg/m` of `dtex`.
pub fn si_unit_of(multiple: &str) -> String {
    const POWERS: &[char] = &['²', '³'];
    let known = |symbol: &str| Dimension::all().find(|d| d.units().iter().any(|unit| unit.shown == symbol));
    // Kilometres are shown, though no key takes them.
    let of_thousands = |symbol: &str| symbol.strip_prefix('k').and_then(known);
    let si = |symbol: &str| {
        // No key takes watts.
        if symbol == "kW" {
            return "W".to_owned();
        }
        let dimension = known(symbol).or_else(|| of_thousands(symbol));
        dimension.map_or_else(|| symbol.to_owned(), |d| d.si_unit().to_owned())
    };
    if known(multiple).is_some() {
        return si(multiple);
    }
    let part = |part: &str| {
        let symbol = part.trim_end_matches(POWERS);
        si(symbol) + &part[symbol.len()..]
    };
    multiple.split('/').map(part).collect::<Vec<_>>().join("/")
}

/// A unit in the spelling of UDUNITS, which the CF conventions ask for and programs read: `m2/Hz`, `degC`;
/// `1` of a plain number.
pub fn udunits(unit: &str) -> String {
    match unit {
        "" => "1".to_owned(),
        "%" => "percent".to_owned(),
        "°" => "degree".to_owned(),
        _ => plain_spelling(unit).replace('°', "deg").replace('½', "0.5"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_taken_apart_into_symbols_and_powers() {
        for (unit, wanted) in [
            ("kg/(m s)^2", &[("kg", 1.0), ("m", -2.0), ("s", -2.0)][..]),
            ("((m2/s)^3)^-2", &[("m", -12.0), ("s", 6.0)]),
            ("m^0.25 s", &[("m", 0.25), ("s", 1.0)]),
            ("1/s", &[("s", -1.0)]),
            ("m·s/m", &[("s", 1.0)]),
            ("((((m))))", &[("m", 1.0)]),
            // No unit, or none that is written whole; so many parentheses nobody writes.
            ("m/m", &[]),
            ("m)", &[]),
            ("10 s", &[]),
            ("(((((m)))))", &[]),
        ] {
            let plain = plain_spelling(unit);
            let found = factors(&plain).unwrap_or_default();
            let found: Vec<(&str, f64)> =
                found.iter().map(|(symbol, power)| (symbol.as_str(), *power)).collect();
            assert_eq!(found, wanted, "{unit}");
        }
    }

    #[test]
    fn units_of_columns_are_those_of_si_and_of_udunits() {
        for (multiple, si) in
            [("mm²/Hz", "m²/Hz"), ("dtex", "kg/m"), ("kW", "W"), ("km", "m"), ("g/m²", "kg/m²")]
        {
            assert_eq!(si_unit_of(multiple), si);
        }
        for (unit, written) in [
            ("", "1"),
            ("%", "percent"),
            ("°", "degree"),
            ("°C", "degC"),
            ("m²/Hz", "m2/Hz"),
            ("m^½", "m0.5"),
        ] {
            assert_eq!(udunits(unit), written);
        }
    }

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
        let reported = |text| comma(text).to_string();
        assert_eq!(
            reported("1,500 MPa"),
            "has a comma; write \"1500 MPa\" if the comma separates thousands, or \"1.500 MPa\" if it is \
             a decimal sign"
        );
        assert_eq!(
            reported("0,6 g/min"),
            "has a comma; write the number with a decimal point, like \"0.6 g/min\""
        );
    }
}
