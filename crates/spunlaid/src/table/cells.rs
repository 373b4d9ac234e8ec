//! Splits a line into cells and reads the number in a cell.

use crate::error::FileFault;
use crate::units::excerpt;
use std::ops::Range;

/// What separates the cells of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Parting {
    Sign(u8),
    Blanks,
}

impl Parting {
    /// All separators, in the order in which they are tried.
    const ALL: [Self; 4] = [Self::Sign(b'\t'), Self::Sign(b';'), Self::Sign(b','), Self::Blanks];

    fn occurs(self, text: &str) -> bool {
        match self {
            Self::Sign(sign) => text.as_bytes().contains(&sign),
            Self::Blanks => true,
        }
    }

    /// The first separator that occurs in a line.
    pub(super) fn of(text: &str) -> Self {
        Self::ALL.into_iter().find(|parting| parting.occurs(text)).unwrap_or(Self::Blanks)
    }

    /// The separator that makes a line a row of numbers; `None` where no separator does.
    pub(super) fn of_numbers(text: &str) -> Option<Self> {
        let mut cells = Vec::new();
        Self::ALL.into_iter().filter(|parting| parting.occurs(text)).find(|parting| {
            parting.split(text, &mut cells);
            let looks = || cells.iter().map(|cell| Looks::of(&text[cell.clone()], *parting));
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
            if self != Self::Blanks || from < to {
                cells.push(start..start + cell.len());
            }
        };
        for (at, byte) in text.bytes().enumerate() {
            quoted ^= pairs && byte == b'"';
            let parts = match self {
                Self::Sign(sign) => byte == sign,
                Self::Blanks => matches!(byte, b' ' | b'\t'),
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
    pub(super) fn of(cell: &str, parting: Parting) -> Self {
        match number(cell, parting, &mut None) {
            Ok(number) if number.is_nan() => Self::Missing,
            Ok(_) | Err(FileFault::NotFinite { .. }) => Self::Number,
            Err(_) => Self::Text,
        }
    }
}

pub(super) fn is_comment(text: &str) -> bool {
    text.starts_with(['#', '%']) || text.starts_with("//")
}

/// The number in a cell; NaN if it is missing.
///
/// * `decimals` – decimal sign of the cells read so far
pub(super) fn number(cell: &str, parting: Parting, decimals: &mut Option<u8>) -> Result<f64, FileFault> {
    let sign = cell.bytes().find(|byte| matches!(byte, b'.' | b','));
    let Some(sign) = sign.filter(|_| parting != Parting::Sign(b',')) else {
        return with_point(cell, cell);
    };
    let number =
        if sign == b',' { with_point(&cell.replacen(',', ".", 1), cell) } else { with_point(cell, cell) };
    if number.as_ref().is_ok_and(|number| !number.is_nan()) && *decimals.get_or_insert(sign) != sign {
        return Err(FileFault::MixedDecimals { text: excerpt(cell, 40) });
    }
    number
}

fn with_point(cell: &str, written: &str) -> Result<f64, FileFault> {
    #[rustfmt::skip]
    const MISSING: [&str; 13] = [
        "", "-", "--", "na", "n/a", "#n/a", "null", "none", "nan", "-nan", "-nan(ind)", "1.#qnan", "-1.#ind",
    ];
    match cell.parse::<f64>() {
        Ok(number) if number.is_infinite() => Err(FileFault::NotFinite { text: excerpt(written, 40) }),
        Ok(number) => Ok(number),
        Err(_) if cell.len() <= 10 && MISSING.contains(&cell.to_ascii_lowercase().as_str()) => Ok(f64::NAN),
        Err(_) => Err(FileFault::not_a_number(written)),
    }
}

/// The unit of the last digit of a number as it is written.
pub(super) fn last_place(cell: &str) -> f64 {
    let (mantissa, exponent) = cell.split_once(['e', 'E']).unwrap_or((cell, "0"));
    let decimals = mantissa.split_once(['.', ',']).map_or(0, |(_, decimals)| decimals.len() as i32);
    let exponent = exponent.parse::<i32>().unwrap_or(0);
    libm::exp10(f64::from(exponent.saturating_sub(decimals).clamp(-400, 400)))
}
