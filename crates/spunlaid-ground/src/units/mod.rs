//! Quantities with units. They are converted to SI units when they are read, and from SI units when they are shown.

mod expression;
mod spelling;
mod table;

use crate::error::is_invisible;
pub use crate::error::{excerpt, rounded, shortest};
pub use expression::{Expression, Powers, unknown_name};
pub use spelling::{plain_spelling, readings, si_unit_of, udunits, with_decimal_point};
pub use table::Dimension;

use crate::error::Fault;
use spelling::{factors, is_same};
use std::borrow::Cow;
use std::fmt;
use table::Scale::{Above, Over, Ten, Times};

/// Shows what to write for a dimension: `a length with its unit: m, cm, mm, µm or nm`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnitAdvice(pub Dimension);

impl fmt::Display for UnitAdvice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 == Dimension::Ratio {
            return f.write_str("a plain number like 0.1, or a percentage like \"10 %\"");
        }
        write!(f, "{} with its unit: ", self.0.name())?;
        let units: Vec<&str> =
            self.0.units().iter().map(|unit| unit.shown).filter(|shown| !shown.is_empty()).collect();
        for (i, unit) in units.iter().enumerate() {
            let joint = match i {
                0 => "",
                _ if i + 1 == units.len() => " or ",
                _ => ", ",
            };
            write!(f, "{joint}{unit}")?;
        }
        Ok(())
    }
}

impl Dimension {
    /// Its name with an article: `a length`.
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// The SI unit, `m/s²`. Empty for a ratio.
    pub fn si_unit(self) -> &'static str {
        self.units().first().map_or("", |unit| unit.shown)
    }

    /// Whether this is one of its units, however it is spelt.
    pub fn has_unit(self, unit: &str) -> bool {
        let plain = |unit: &str| plain_spelling(unit.trim()).to_lowercase();
        !unit.trim().is_empty() && self.units().iter().any(|one| plain(one.plain) == plain(unit))
    }

    /// The SI unit as the ending of a column's name, `_m_s2`. Empty for a ratio.
    pub fn suffix(self) -> String {
        match self.si_unit() {
            "" => String::new(),
            unit => format!(
                "_{}",
                plain_spelling(unit).replace(['(', ')'], "").replace(['/', ' '], "_").to_lowercase()
            ),
        }
    }

    /// Whether a number without a unit is a value.
    pub fn takes_plain_numbers(self) -> bool {
        self.units().iter().any(|unit| unit.plain.is_empty())
    }

    /// The fault of a number without a unit.
    pub fn no_unit(self) -> Fault {
        Fault::new("has no unit", format!("write {}", UnitAdvice(self)))
    }

    /// Reads a quantity such as `50 µm` into SI units.
    ///
    /// If the unit is a power of ten of the SI unit, only the decimal exponent of the text changes before it is
    /// rounded: `50 µm` gives exactly the floating-point number nearest to 5e-5.
    ///
    /// # Errors
    /// If the text is not a finite number followed by a unit of this dimension.
    pub fn parse(self, text: &str) -> Result<f64, Fault> {
        let wrong = |message: Cow<'static, str>| Fault::new(message, format!("write {}", UnitAdvice(self)));
        let visible: String = text.trim().chars().filter(|c| !is_invisible(*c)).collect();
        let text = visible.trim();
        let (number, rest) = split_number(text);
        if number.is_empty() {
            let word = text.trim_start_matches(['+', '-']).to_ascii_lowercase();
            return Err(if word.starts_with("nan") || word.starts_with("inf") {
                wrong("is not a finite number".into())
            } else {
                wrong("does not start with a number".into())
            });
        }
        let digit_follows = rest.chars().nth(1).is_some_and(|c| c.is_ascii_digit());
        if digit_follows && rest.starts_with(',') {
            return with_decimal_point(text)
                .map_or_else(|| Err(spelling::comma(text)), |text| self.parse(&text));
        }
        if digit_follows && rest.starts_with('_') {
            let mended = excerpt(&text.replace('_', ""), 40);
            let remedy = format!("write the number without separators, like \"{mended}\"");
            return Err(Fault::new("has an underscore", remedy));
        }
        let written = rest.trim();
        let plain = plain_spelling(written);
        let own = factors(&plain);
        let fits = |unit: &table::Unit| unit.plain == plain || is_same(own.as_deref(), unit.plain);
        let Some(unit) = self.units().iter().find(|unit| fits(unit)) else {
            return Err(if written.is_empty() {
                self.no_unit()
            } else if let Some(other) = Self::all().find(|d| d.units().iter().any(fits)) {
                wrong(format!("is {}", other.name()).into())
            } else {
                wrong(format!("has the unknown unit \"{}\"", excerpt(written, 20)).into())
            });
        };
        let value = match unit.scale {
            Ten(power) => shifted(number, power),
            Times(factor) => shifted(number, 0).map(|value| value * factor),
            Over(divisor) => shifted(number, 0).map(|value| value / divisor),
            Above(zero, size) => shifted(number, 0).map(|value| value * size + zero),
        };
        match value {
            Some(value) if value.is_finite() => Ok(value),
            Some(_) => Err(wrong("is too large".into())),
            None => Err(wrong("does not start with a number".into())),
        }
    }

    /// The value in the SI unit, `5e-5 m`. [`Dimension::parse`] reads it back to the same bits. Where the SI unit takes
    /// more digits than people write, in the unit that takes few, if there is one: `0.6 g/min`.
    pub fn exact(self, value: f64) -> String {
        /// Most digits that people write.
        const FEW: usize = 8;
        let plain = with_unit(&shortest(value), self.si_unit());
        if format!("{value:.*e}", FEW - 1).parse() == Ok(value) {
            return plain;
        }
        let short = |unit: &table::Unit| {
            let zero = if let Above(zero, _) = unit.scale { zero } else { 0.0 };
            let number: f64 = format!("{:.*e}", FEW - 1, (value - zero) / unit.scale.size()).parse().ok()?;
            let text = with_unit(&shortest(number), unit.shown);
            self.parse(&text).is_ok_and(|read| read == value).then_some((unit.pretty, text))
        };
        let mut texts: Vec<(bool, String)> = self.units().iter().filter_map(short).collect();
        texts.sort_by_key(|(is_usual, text)| text.len() + if *is_usual { 0 } else { 100 });
        texts.into_iter().next().map_or(plain, |(_, text)| text)
    }

    /// The value for people, with four digits and a suitable unit: `50 µm`, `34.46 µs`, `2 GPa`.
    pub fn pretty(self, value: f64) -> String {
        self.pretty_to(value, 4)
    }

    /// The value for people who write it in a file: as [`Dimension::pretty`], with as many digits as it takes
    /// to be read back within a rounding, `1.6 dtex`.
    pub fn written(self, value: f64) -> String {
        /// Of the value: what two roundings make.
        const ROUNDING: f64 = 4.0 * f64::EPSILON;
        let texts = (4..=17).map(|digits| self.pretty_to(value, digits));
        let is_same =
            |text: &String| self.parse(text).is_ok_and(|read| (read - value).abs() <= ROUNDING * value.abs());
        texts.into_iter().find(is_same).unwrap_or_else(|| self.exact(value))
    }

    /// [`Dimension::pretty`] with a given number of digits, 1 to 17.
    pub fn pretty_to(self, value: f64, digits: usize) -> String {
        let decimals = digits.saturating_sub(1).min(16);
        let best = self.unit_for(value, decimals);
        let zero = self.units().iter().find_map(|unit| match unit.scale {
            Above(zero, _) if unit.pretty => Some((zero, unit.shown)),
            _ => None,
        });
        let (number, unit) = zero.map_or((value / best.0, best.1), |(zero, unit)| (value - zero, unit));
        with_unit(&shortest(rounded(number, decimals)), unit)
    }

    /// The same digits as [`Dimension::pretty`] shows, with the other units that bring the value between two others:
    /// `18 mm` between 1 µm and 1 mm is `18 µm`. The units are those whose size is a power of ten, so none for a ratio.
    pub fn in_other_units(self, value: f64, least: f64, greatest: f64) -> Vec<String> {
        let (size, own) = self.unit_for(value, 3);
        let digits = rounded(value / size, 3);
        let others = self.units().iter().filter(|unit| unit.shown != own && unit.shown != "%");
        let fits = others.filter(|unit| match unit.scale {
            Ten(power) => (least..=greatest).contains(&(digits.abs() * 10f64.powi(power))),
            Times(_) | Over(_) | Above(..) => false,
        });
        fits.map(|unit| with_unit(&shortest(digits), unit.shown)).collect()
    }

    /// The number of up to three digits that a value has in another unit and that lies between two others as it stands:
    /// 0.5 of `0.5 kg/s` in g/min between 0.05 and 5.
    pub fn meant_in(self, unit: &str, value: f64, [least, greatest]: [f64; 2]) -> Option<f64> {
        let number = |own: &table::Unit| {
            let number = value / own.scale.size();
            let short = rounded(number, 2);
            ((short / number - 1.0).abs() < 1e-6 && (least..=greatest).contains(&short)).then_some(short)
        };
        self.units().iter().filter(|own| own.shown != unit).find_map(number)
    }

    /// Size in SI units and symbol of the unit that suits a value.
    fn unit_for(self, value: f64, decimals: usize) -> (f64, &'static str) {
        let mut best = (1.0, self.si_unit());
        if value != 0.0 && value.is_finite() {
            // The largest unit that gives a number of at least one, or else the smallest unit.
            let mut sizes: Vec<(f64, &str)> = (self.units().iter().filter(|unit| unit.pretty))
                .filter(|unit| !matches!(unit.scale, Above(..)))
                .map(|unit| (unit.scale.size(), unit.shown))
                .collect();
            sizes.sort_by(|(one, _), (other, _)| other.total_cmp(one));
            let rounded: f64 = format!("{:.decimals$e}", value.abs()).parse().unwrap_or(value);
            let smallest = sizes.last().filter(|(size, _)| rounded >= 0.01 * size);
            let fits = sizes.iter().find(|(size, _)| rounded >= *size).or(smallest);
            best = fits.copied().unwrap_or(best);
        }
        best
    }
}

fn with_unit(number: &str, unit: &str) -> String {
    if unit.is_empty() { number.to_owned() } else { format!("{number} {unit}") }
}

/// Splits a decimal number off the front of a text. The number is empty if there is none.
fn split_number(text: &str) -> (&str, &str) {
    let bytes = text.as_bytes();
    let digits_from =
        |start: usize| start + bytes.iter().skip(start).take_while(|b| b.is_ascii_digit()).count();
    let start = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let mut end = digits_from(start);
    let mut digits = end - start;
    if bytes.get(end) == Some(&b'.') {
        let fraction = digits_from(end + 1);
        digits += fraction - (end + 1);
        end = fraction;
    }
    if digits == 0 {
        return ("", text);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits_from(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    text.split_at(end)
}

/// The number times `10^power`, rounded once. Infinite if it is too large.
fn shifted(number: &str, power: i32) -> Option<f64> {
    let (mantissa, exponent) = match number.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()),
        None => (number, Some(0)),
    };
    match exponent.and_then(|exponent| exponent.checked_add(power)) {
        Some(exponent) => format!("{mantissa}e{exponent}").parse().ok(),
        // The number is so large or so small that the unit does not matter.
        None => number.parse().ok(),
    }
}

#[cfg(test)]
mod tests;
