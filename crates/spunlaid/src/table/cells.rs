//! Splits a line into cells and reads the number in a cell.

use super::thousands::{has_thousands, refusal};
use crate::error::Fault;
use crate::units::excerpt;
use std::borrow::Cow;
use std::ops::Range;

/// What separates the cells of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Parting {
    Sign(u8),
    Blanks,
    /// Blanks, and parentheses around the components of a vector: `0.1 (10.2 0.3 -0.1)`.
    Vectors,
}

impl Parting {
    /// All separators, in the order in which they are tried.
    const ALL: [Self; 4] = [Self::Sign(b'\t'), Self::Sign(b';'), Self::Sign(b','), Self::Blanks];

    /// Whether the separator is in a line. Tabs at its end are none where others part its cells.
    fn occurs(self, text: &str) -> bool {
        let inner = text.trim_end();
        let is_in = |text: &str, sign: u8| text.as_bytes().contains(&sign);
        match self {
            Self::Sign(b'\t') => {
                is_in(inner, b'\t') || is_in(text, b'\t') && !inner.contains([';', ',', ' '])
            }
            Self::Sign(sign) => is_in(text, sign),
            Self::Blanks => true,
            Self::Vectors => text.contains('('),
        }
    }

    pub(super) fn is_tab(self) -> bool {
        self == Self::Sign(b'\t')
    }

    /// The first separator that occurs in a line.
    pub(super) fn first_in(text: &str) -> Self {
        Self::ALL.into_iter().find(|parting| parting.occurs(text)).unwrap_or(Self::Blanks)
    }

    /// The separator that makes a line a row of numbers; `None` where no separator does.
    pub(super) fn from_numbers(text: &str) -> Option<Self> {
        let mut cells = Vec::new();
        let all = Self::ALL.into_iter().chain([Self::Vectors]);
        all.filter(|parting| parting.occurs(text)).find(|parting| {
            parting.split(text, &mut cells);
            let looks = || cells.iter().map(|cell| Looks::new(&text[cell.clone()], *parting));
            looks().all(|looks| looks != Looks::Text) && looks().any(|looks| looks == Looks::Number)
        })
    }

    /// Finds the cells of a line. Blanks and quotation marks around a cell are left out.
    pub(super) fn split(self, text: &str, cells: &mut Vec<Range<usize>>) {
        cells.clear();
        // An odd number of quotation marks encloses nothing.
        let pairs = text.as_bytes().contains(&b'"') && text.matches('"').count().is_multiple_of(2);
        let (mut quoted, mut from) = (false, 0);
        let mut put = |from: usize, to: usize| {
            let cell = text.get(from..to).unwrap_or_default();
            let around = |c: char| c.is_whitespace() || c == '"';
            let start = to - cell.trim_start_matches(around).len();
            let cell = cell.trim_matches(around);
            if matches!(self, Self::Sign(_)) || from < to {
                cells.push(start..start + cell.len());
            }
        };
        for (at, byte) in text.bytes().enumerate() {
            quoted ^= pairs && byte == b'"';
            let parts = match self {
                Self::Sign(sign) => byte == sign,
                Self::Blanks => matches!(byte, b' ' | b'\t'),
                Self::Vectors => matches!(byte, b' ' | b'\t' | b'(' | b')'),
            };
            if parts && !quoted {
                put(from, at);
                from = at + 1;
            }
        }
        put(from, text.len());
    }

    /// The cells of a line.
    pub(super) fn cells(self, text: &str) -> Vec<&str> {
        let mut cells = Vec::new();
        self.split(text, &mut cells);
        cells.into_iter().map(|cell| &text[cell]).collect()
    }
}

/// What a cell looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Looks {
    Number,
    Missing,
    Text,
}

impl Looks {
    pub(super) fn new(cell: &str, parting: Parting) -> Self {
        match parsed(cell, parting) {
            // It is refused where it is read.
            None if has_thousands(cell) => Self::Number,
            None => Self::Text,
            Some(number) if number.is_nan() => Self::Missing,
            Some(_) => Self::Number,
        }
    }
}

pub(super) fn is_comment(text: &str) -> bool {
    text.starts_with(['#', '%']) || text.starts_with("//")
}

/// The number in a cell; NaN if it is missing.
///
/// * `decimals` – decimal sign of the cells read so far
pub(super) fn number(cell: &str, parting: Parting, decimals: &mut Option<u8>) -> Result<f64, Fault> {
    let text = excerpt(cell, 40);
    let Some(number) = parsed(cell, parting) else {
        if has_thousands(cell) {
            return Err(refusal(&text));
        }
        return Err(Fault::new(
            format!("\"{text}\" is not a number"),
            "write one, or leave the cell empty where a value is missing",
        ));
    };
    if number.is_infinite() {
        return Err(Fault::infinite(&text));
    }
    if let Some(sign) = decimal_sign(cell, parting)
        && !number.is_nan()
        && *decimals.get_or_insert(sign) != sign
    {
        return Err(Fault::new(
            format!("\"{text}\" has another decimal sign than the rows above"),
            "write all numbers with a point, or all with a comma",
        ));
    }
    Ok(number)
}

fn decimal_sign(cell: &str, parting: Parting) -> Option<u8> {
    let sign = cell.bytes().find(|byte| matches!(byte, b'.' | b','));
    sign.filter(|_| parting != Parting::Sign(b','))
}

/// The number in a cell: NaN if it is missing, infinite if it is too large, none if there is something else.
fn parsed(cell: &str, parting: Parting) -> Option<f64> {
    #[rustfmt::skip]
    const MISSING: [&str; 13] = [
        "", "-", "--", "na", "n/a", "#n/a", "null", "none", "nan", "-nan", "-nan(ind)", "1.#qnan", "-1.#ind",
    ];
    let with_point = match decimal_sign(cell, parting) {
        Some(b',') => Cow::Owned(cell.replacen(',', ".", 1)),
        _ => Cow::Borrowed(cell),
    };
    let is_missing = || with_point.len() <= 10 && MISSING.contains(&with_point.to_ascii_lowercase().as_str());
    let number = with_point.parse().ok().or_else(|| double_precision(&with_point)?.parse().ok());
    number.or_else(|| is_missing().then_some(f64::NAN))
}

/// A number with an exponent of Fortran's double precision, `1.5D+00`, as others write it.
fn double_precision(cell: &str) -> Option<String> {
    let (mantissa, exponent) = cell.split_once(['D', 'd'])?;
    // A name like 2D5 has neither a point nor a sign.
    (mantissa.contains('.') || exponent.starts_with(['+', '-'])).then(|| format!("{mantissa}e{exponent}"))
}

/// Whether a cell holds a finite number, or says that it is missing.
pub(super) fn is_number(cell: &str, parting: Parting) -> bool {
    parsed(cell, parting).is_some_and(|number| !number.is_infinite())
}

/// The unit of the last digit of a number as it is written.
pub(super) fn last_place(cell: &str) -> f64 {
    let (mantissa, exponent) = cell.split_once(['e', 'E', 'd', 'D']).unwrap_or((cell, "0"));
    let decimals = mantissa.split_once(['.', ',']).map_or(0, |(_, decimals)| decimals.len() as i32);
    let exponent = exponent.parse::<i32>().unwrap_or(0);
    libm::exp10(f64::from(exponent.saturating_sub(decimals).clamp(-400, 400)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_of_fortran_are_read() {
        let read = |cell| number(cell, Parting::Blanks, &mut None);
        for (cell, value, last) in [
            ("1.0043D+01", 10.043, 1e-3),
            ("-0.5d-3", -5e-4, 1e-4),
            ("2.D0", 2.0, 1.0),
            ("3D+02", 300.0, 100.0),
            ("1,5D+00", 1.5, 0.1),
        ] {
            assert_eq!(read(cell), Ok(value), "{cell}");
            assert!((last_place(cell) / last - 1.0).abs() < 1e-12, "{cell}");
        }
        for cell in ["2D5", "D+01", "1.5D", "1.5D+", "1.5DD+01", "3D"] {
            assert!(read(cell).is_err(), "{cell}");
        }
    }

    #[test]
    fn parentheses_part_the_components_of_vectors() {
        let line = "0.1 (10.04 0.1 -0.2) (1 2 3)";
        assert_eq!(Parting::from_numbers(line), Some(Parting::Vectors));
        assert_eq!(Parting::Vectors.cells(line), ["0.1", "10.04", "0.1", "-0.2", "1", "2", "3"]);
        assert_eq!(Parting::from_numbers("0.1 (a b c)"), None);
    }
}
