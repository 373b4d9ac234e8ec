//! Splits a line into cells and reads the number in a cell.

use crate::error::{Fault, Position};
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
            let looks = || cells.iter().map(|cell| Looks::new(&text[cell.clone()]));
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
    pub(super) fn new(cell: &str) -> Self {
        match parsed(cell) {
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
pub(super) fn number(cell: &str, decimals: &mut Option<u8>) -> Result<f64, Fault> {
    let text = excerpt(cell, 40);
    let Some(number) = parsed(cell) else {
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
    if let Some(sign) = decimal_sign(cell)
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

/// Between commas, a cell in quotation marks may have one.
fn decimal_sign(cell: &str) -> Option<u8> {
    cell.bytes().find(|byte| matches!(byte, b'.' | b','))
}

/// The number in a cell: NaN if it is missing, infinite if it is too large, none if there is something else.
fn parsed(cell: &str) -> Option<f64> {
    #[rustfmt::skip]
    const MISSING: [&str; 13] = [
        "", "-", "--", "na", "n/a", "#n/a", "null", "none", "nan", "-nan", "-nan(ind)", "1.#qnan", "-1.#ind",
    ];
    let with_point = match decimal_sign(cell) {
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
pub(super) fn is_number(cell: &str) -> bool {
    parsed(cell).is_some_and(|number| !number.is_infinite())
}

/// The unit of the last digit of a number as it is written.
pub(super) fn last_place(cell: &str) -> f64 {
    let (mantissa, exponent) = cell.split_once(['e', 'E', 'd', 'D']).unwrap_or((cell, "0"));
    let decimals = mantissa.split_once(['.', ',']).map_or(0, |(_, decimals)| decimals.len() as i32);
    let exponent = exponent.parse::<i32>().unwrap_or(0);
    libm::exp10(f64::from(exponent.saturating_sub(decimals).clamp(-400, 400)))
}

/// Whether a cell is a number whose thousands are parted by signs, in a way that no decimal number is written:
/// `1.234.567`, `1.234,5`, `1,234.5`, `1'234` or `1 234,5`.
pub(super) fn has_thousands(cell: &str) -> bool {
    let digits = cell.trim_start_matches(['+', '-', '−']);
    let is_sign = |c: char| matches!(c, '.' | ',' | '\'' | '’' | ' ' | '\u{a0}' | '\u{202f}');
    let Some(sign) = digits.chars().find(|c| is_sign(*c)) else { return false };
    let mut groups = digits.split(sign).peekable();
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    if !groups.next().is_some_and(|first| is_number(first) && first.len() <= 3) {
        return false;
    }
    let mut count = 0;
    while let Some(group) = groups.next() {
        count += 1;
        // Decimals follow the last group.
        let (whole, decimals) = match group.split_once(['.', ',']) {
            Some((whole, decimals)) if groups.peek().is_none() => (whole, Some(decimals)),
            _ => (group, None),
        };
        if whole.len() != 3 || !is_number(whole) || decimals.is_some_and(|decimals| !is_number(decimals)) {
            return false;
        }
        if decimals.is_some() {
            return true;
        }
    }
    count > 1 || !matches!(sign, '.' | ',')
}

/// The fault of a cell with signs between thousands.
pub(super) fn refusal(cell: &str) -> Fault {
    Fault::new(
        format!("\"{cell}\" has signs between its thousands"),
        "write numbers without them, so that the only sign is that of the decimals",
    )
}

/// What the numbers of a column have been so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Digits {
    /// The smallest that may be written with a sign between thousands, as decimals are read: `1.002`.
    parted: Option<(f64, String, Position)>,
    /// The largest below a thousand that has no sign: `998`.
    small: Option<(f64, String)>,
    /// One cannot be written so: `0.998`, `1.02`, `1002`.
    decimals: bool,
    /// Whether commas part the cells of the table.
    between_commas: bool,
}

impl Digits {
    pub(super) fn new(parting: Parting) -> Self {
        Self { between_commas: parting == Parting::Sign(b','), ..Self::default() }
    }

    /// Looks at a cell that is a number.
    pub(super) fn look(&mut self, cell: &str, place: impl FnOnce() -> Position) {
        if self.decimals {
            return;
        }
        let digits = cell.trim_start_matches(['+', '-']);
        match digits.split_once(['.', ',']) {
            None if matches!(digits.len(), 1..=3) && digits.bytes().all(|byte| byte.is_ascii_digit()) => {
                let value: f64 = digits.parse().unwrap_or(0.0);
                if self.small.as_ref().is_none_or(|(largest, _)| value > *largest) {
                    self.small = Some((value, cell.to_owned()));
                }
            }
            Some((whole, decimals)) if is_parted(whole, decimals) => {
                let value: f64 = format!("{whole}.{decimals}").parse().unwrap_or(f64::INFINITY);
                if self.parted.as_ref().is_none_or(|(smallest, ..)| value < *smallest) {
                    self.parted = Some((value, cell.to_owned(), place()));
                }
            }
            _ => self.decimals = digits.bytes().any(|byte| byte.is_ascii_digit()),
        }
    }

    /// The fault of a column in which `998` stands beside `1.002` and no number has other decimals, with its
    /// place. Beside `5` the same number has decimals: it is nearer to five as one than as a thousand.
    ///
    /// Between commas only numbers in quotation marks have a comma, and `"1,234"` may be either.
    pub(super) fn doubt(&self) -> Option<(Fault, Position)> {
        let (value, parted, place) = self.parted.as_ref()?;
        if self.between_commas && parted.contains(',') && !self.decimals {
            let [decimal, whole] = [".", ""].map(|sign| parted.replace(',', sign));
            let fault = Fault::new(
                format!(
                    "\"{parted}\" may be {decimal} or {whole}, and no other number in this column shows which"
                ),
                format!("write {decimal} or {whole}"),
            );
            return Some((fault, *place));
        }
        let (largest, small) = self.small.as_ref()?;
        if self.decimals || largest * largest < 1000.0 * value * value {
            return None;
        }
        let whole = parted.replace(['.', ','], "");
        let fault = Fault::new(
            format!(
                "\"{parted}\" is in a column with \"{small}\", and every sign in this column is followed \
                by three digits: it looks like a sign between thousands"
            ),
            format!("write {whole} without a sign if that is meant, or all numbers with the same decimals"),
        );
        Some((fault, *place))
    }
}

fn is_parted(whole: &str, decimals: &str) -> bool {
    let are_digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    matches!(whole.len(), 1..=3)
        && decimals.len() == 3
        && are_digits(whole)
        && are_digits(decimals)
        && !whole.starts_with('0')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_of_fortran_are_read() {
        let read = |cell| number(cell, &mut None);
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

#[cfg(test)]
mod thousands_tests {
    use super::*;

    #[test]
    fn thousands_are_distinguished_from_decimals() {
        for cell in ["1.234.567", "1.234,5", "-1,234.56", "1'234", "1 234,5", "12,345,678", "1.234.567,8"] {
            assert!(has_thousands(cell), "{cell}");
        }
        for cell in [
            "",
            "1.234",
            "1,5",
            "1234.5",
            "1.23.4",
            "1.2345,6",
            "12:00",
            "1 2",
            "a",
            ".5",
            "1.234,",
            "--",
            "1234.567.890",
            "1.234,5.678",
        ] {
            assert!(!has_thousands(cell), "{cell}");
        }
    }

    fn doubted(cells: &[&str]) -> bool {
        let mut digits = Digits::default();
        cells.iter().for_each(|cell| digits.look(cell, || Position::Line(1)));
        digits.doubt().is_some()
    }

    #[test]
    fn a_column_is_doubted_only_if_no_number_decides() {
        assert!(doubted(&["1.035", "964", "1.022"]));
        assert!(doubted(&["998", "1,002"]));
        // The largest number without a sign and the smallest with one count, wherever they stand.
        for cells in [["998", "5", "1.002"], ["5", "998", "1.002"], ["900.125", "998", "1.002"]] {
            assert!(doubted(&cells), "{cells:?}");
        }
        // Nearer to a thousand times the number than to the number itself: by √1000.
        for (cells, is_doubted) in [
            (["32", "1.000"], true),
            (["31", "1.000"], false),
            (["64", "2.000"], true),
            (["63", "2.000"], false),
        ] {
            assert_eq!(doubted(&cells), is_doubted, "{cells:?}");
        }
        assert!(!doubted(&["1,002"]));
        // Decimals that are always written, decimals of another length, a zero, thousands without a sign.
        for cells in [
            &["1.035", "0.964"][..],
            &["1.035", "964.000"],
            &["1", "1.125", "1.25"],
            &["0", "1.250", "2.500"],
            &["5", "5.001", "5.002"],
            &["998", "1002", "1.125"],
            &["1", "2", "1e3"],
            &["1.035", "nan", ""],
        ] {
            assert!(!doubted(cells), "{cells:?}");
        }
    }
}
