//! Signs between thousands, which look like decimal signs: is `1.002` one or a thousand?

use crate::error::{Fault, Position};

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
}

impl Digits {
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
    pub(super) fn doubt(&self) -> Option<(Fault, Position)> {
        let (value, parted, place) = self.parted.as_ref()?;
        let (largest, small) = self.small.as_ref()?;
        if self.decimals || largest * largest < 1000.0 * value * value {
            return None;
        }
        let whole = parted.replace(['.', ','], "");
        let fault = Fault::new(
            format!(
                "\"{parted}\" stands in a column with \"{small}\", and every sign in this column is followed \
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
    fn thousands_are_told_from_decimals() {
        for cell in ["1.234.567", "1.234,5", "-1,234.56", "1'234", "1 234,5", "12,345,678", "1.234.567,8"] {
            assert!(has_thousands(cell), "{cell}");
        }
        for cell in
            ["", "1.234", "1,5", "1234.5", "1.23.4", "1.2345,6", "12:00", "1 2", "a", ".5", "1.234,", "--"]
        {
            assert!(!has_thousands(cell), "{cell}");
        }
    }

    fn doubted(cells: &[&str]) -> bool {
        let mut digits = Digits::default();
        cells.iter().for_each(|cell| digits.look(cell, || Position::Line(1)));
        digits.doubt().is_some()
    }

    #[test]
    fn a_column_is_doubted_only_if_no_number_tells() {
        assert!(doubted(&["1.035", "964", "1.022"]));
        assert!(doubted(&["998", "1,002"]));
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
