//! Records as text: comma, semicolon, tab or blanks between cells, decimal points or commas.
//!
//! Lines are read one at a time and never more than [`LONGEST_LINE`] bytes of one, so that no file takes more
//! memory than its samples. A field of numbers needs no quoting rules: a quotation mark around a cell is
//! taken off, one with a separator or a line break in it is not understood.

use super::columns::roles;
use super::rows::Rows;
use super::{Layout, Record, problem};
use crate::error::{Error, RecordFault, RecordPlace};
use crate::units::excerpt;
use std::borrow::Cow;
use std::io::{BufRead, BufReader, Read};

/// Longest line read [bytes].
const LONGEST_LINE: usize = 1 << 16;

/// Reads a record from text; `name` is what messages call it.
///
/// # Errors
/// When it is no evenly sampled velocity record; the message says where and why.
pub fn parse_csv(source: impl Read, name: &str, layout: &Layout) -> Result<Record, Error> {
    let mut lines =
        Lines { source: BufReader::with_capacity(1 << 16, source), buffer: Vec::new(), number: 0 };
    let whole = |fault| problem(name, RecordPlace::Whole, None, fault);
    let mut header: Option<Header> = None;
    // The first row of numbers says how cells are parted.
    let mut first = None;
    while let Some(line) = lines.next(name)? {
        let place = RecordPlace::Line(line.number);
        if line.number <= layout.skip_lines || line.text.trim().is_empty() || line.text.starts_with('#') {
            continue;
        }
        let separator = Separator::of(&line.text);
        let cells: Vec<&str> = separator.cells(&line.text).collect();
        if cells.iter().all(|cell| Decimals::default().number(cell, separator).is_ok()) {
            first = Some((place, line.text.into_owned()));
            break;
        }
        match &mut header {
            // A second line of words may hold the units.
            Some(header) if !header.with_units && cells.len() == header.names.len() => {
                header.with_units = true;
                for (name, unit) in header.names.iter_mut().zip(&cells) {
                    if !unit.is_empty() {
                        *name = format!("{name} [{}]", unit.trim_matches(['[', ']', '(', ')']));
                    }
                }
            }
            Some(_) => {
                let cell = cells.iter().find(|c| Decimals::default().number(c, separator).is_err());
                let text = excerpt(cell.copied().unwrap_or_default(), 40);
                return Err(problem(name, place, None, RecordFault::NotANumber { text }));
            }
            None => {
                let names = cells.iter().map(|cell| (*cell).to_owned()).collect();
                header = Some(Header { names, separator, with_units: false });
            }
        }
    }
    let Some((first_place, first_line)) = first else {
        return Err(whole(RecordFault::Empty));
    };
    // The header knows best: below a single name a comma is a decimal one.
    let separator = match &header {
        Some(header) if header.names.len() > 1 => header.separator,
        Some(_) => Separator::Sign(';'),
        None => Separator::of(&first_line),
    };
    let named = header.is_some();
    let columns = separator.cells(&first_line).count();
    let headers =
        header.map_or_else(|| (1..=columns).map(|i| format!("column {i}")).collect(), |header| header.names);
    let roles = roles(&headers, named, layout)
        .map_err(|(column, fault)| problem(name, RecordPlace::Whole, column.as_deref(), fault))?;
    let mut reader = Reader {
        name,
        wanted: headers.len(),
        separator,
        decimals: Decimals::default(),
        rows: Rows::new(name, roles, layout),
        blank: 0,
    };
    reader.row(first_place, &first_line)?;
    while let Some(line) = lines.next(name)? {
        reader.row(RecordPlace::Line(line.number), &line.text)?;
    }
    reader.rows.finish()
}

struct Header {
    names: Vec<String>,
    separator: Separator,
    with_units: bool,
}

/// A line of text and its number, from 1.
struct Line<'a> {
    number: u64,
    text: Cow<'a, str>,
}

struct Lines<R> {
    source: BufReader<R>,
    buffer: Vec<u8>,
    number: u64,
}

impl<R: Read> Lines<R> {
    fn next(&mut self, name: &str) -> Result<Option<Line<'_>>, Error> {
        self.number += 1;
        let number = self.number;
        let refused = |fault| problem(name, RecordPlace::Line(number), None, fault);
        self.buffer.clear();
        let most = LONGEST_LINE as u64 + 1;
        let read = self.source.by_ref().take(most).read_until(b'\n', &mut self.buffer);
        let read = read.map_err(|source| refused(RecordFault::Unreadable { message: source.to_string() }))?;
        if read == 0 {
            return Ok(None);
        }
        // UTF-16 begins with one of two marks; a zero is in no text.
        let marked = self.buffer.starts_with(&[0xff, 0xfe]) || self.buffer.starts_with(&[0xfe, 0xff]);
        if (number == 1 && marked) || self.buffer.contains(&0) {
            return Err(refused(RecordFault::NotText));
        }
        if read > LONGEST_LINE {
            return Err(refused(RecordFault::LineTooLong { most: LONGEST_LINE }));
        }
        let text = match std::str::from_utf8(&self.buffer) {
            Ok(text) => Cow::Borrowed(text),
            // Latin-1, as older instruments write it.
            Err(_) => Cow::Owned(self.buffer.iter().map(|byte| char::from(*byte)).collect()),
        };
        let text = match text {
            Cow::Borrowed(text) => {
                Cow::Borrowed(text.trim_start_matches('\u{feff}').trim_end_matches(['\r', '\n']))
            }
            Cow::Owned(text) => Cow::Owned(text.trim_end_matches(['\r', '\n']).to_owned()),
        };
        Ok(Some(Line { number, text }))
    }
}

/// What stands between cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    Sign(char),
    Blanks,
}

impl Separator {
    /// The separator of a line, if it has more than one cell.
    fn of(line: &str) -> Self {
        let sign = ['\t', ';', ','].into_iter().find(|sign| line.contains(*sign));
        match sign {
            Some(sign) => Self::Sign(sign),
            None if line.split_whitespace().nth(1).is_some() && !line.contains(['[', '(', '/']) => {
                Self::Blanks
            }
            None => Self::Sign(','),
        }
    }

    fn cells(self, line: &str) -> impl Iterator<Item = &str> {
        let mut by_sign = None;
        let mut by_blanks = None;
        match self {
            Self::Sign(sign) => by_sign = Some(line.split(sign)),
            Self::Blanks => by_blanks = Some(line.split_whitespace()),
        }
        let cells = by_sign.into_iter().flatten().chain(by_blanks.into_iter().flatten());
        cells.map(|cell| cell.trim().trim_matches('"').trim())
    }
}

/// Decimal points, or decimal commas.
#[derive(Clone, Copy, Debug, Default)]
struct Decimals {
    sign: Option<char>,
}

impl Decimals {
    /// The number in a cell, NaN where a sample is missing.
    fn number(&mut self, cell: &str, separator: Separator) -> Result<f64, RecordFault> {
        if separator != Separator::Sign(',') {
            let sign = cell.bytes().find(|byte| matches!(byte, b'.' | b',')).map(char::from);
            if let Some(sign) = sign
                && *self.sign.get_or_insert(sign) != sign
                && is_number(cell)
            {
                return Err(RecordFault::MixedDecimals { text: excerpt(cell, 40) });
            }
            if sign == Some(',') {
                return plain_number(&cell.replacen(',', ".", 1)).map_err(|_| not_a_number(cell));
            }
        }
        plain_number(cell)
    }
}

fn is_number(cell: &str) -> bool {
    plain_number(&cell.replacen(',', ".", 1)).is_ok_and(|x| !x.is_nan())
}

fn not_a_number(cell: &str) -> RecordFault {
    RecordFault::NotANumber { text: excerpt(cell, 40) }
}

fn plain_number(cell: &str) -> Result<f64, RecordFault> {
    match cell.parse::<f64>() {
        Ok(number) if number.is_infinite() => Err(RecordFault::NotFinite { text: excerpt(cell, 40) }),
        Ok(number) => Ok(number),
        Err(_) => {
            const MISSING: [&str; 12] = [
                "",
                "-",
                "--",
                "na",
                "n/a",
                "#n/a",
                "null",
                "none",
                "nan",
                "-nan(ind)",
                "1.#qnan",
                "-1.#ind",
            ];
            let word = cell.len() <= 10 && MISSING.contains(&cell.to_ascii_lowercase().as_str());
            if word { Ok(f64::NAN) } else { Err(not_a_number(cell)) }
        }
    }
}

/// The unit in the last place of a number as it is written: 1e-3 for `0,125`, 1e-5 for `1.25e-3`.
fn last_place(cell: &str) -> f64 {
    let (mantissa, exponent) = cell.split_once(['e', 'E']).unwrap_or((cell, "0"));
    let decimals = mantissa.split_once(['.', ',']).map_or(0, |(_, decimals)| decimals.len() as i32);
    let exponent = exponent.parse::<i32>().unwrap_or(0);
    libm::exp10(f64::from(exponent.saturating_sub(decimals).clamp(-400, 400)))
}

/// Rows of cells into rows of numbers.
struct Reader<'a> {
    name: &'a str,
    /// Cells in a row.
    wanted: usize,
    separator: Separator,
    decimals: Decimals,
    rows: Rows<'a>,
    /// Empty lines since the last row.
    blank: usize,
}

impl Reader<'_> {
    fn row(&mut self, place: RecordPlace, line: &str) -> Result<(), Error> {
        if line.starts_with('#') {
            return Ok(());
        }
        if line.trim().is_empty() {
            self.blank += 1;
            return Ok(());
        }
        // Where no clock tells, an empty line is a sample that is missing.
        if self.rows.roles().time.is_none() {
            for _ in 0..self.blank {
                self.rows.push(place, (f64::NAN, f64::NAN), &[])?;
            }
        }
        self.blank = 0;
        let mut values = [f64::NAN; 3];
        let mut time = (f64::NAN, f64::INFINITY);
        let mut found = 0;
        for (i, cell) in self.separator.cells(line).enumerate() {
            found = i + 1;
            let role = self.rows.roles();
            let is_time = role.time.as_ref().is_some_and(|column| column.index == i);
            let component = role.components.iter().position(|column| column.index == i);
            if !is_time && component.is_none() {
                continue;
            }
            let number = self.decimals.number(cell, self.separator).map_err(|fault| {
                let role = self.rows.roles();
                let mut used = role.time.iter().chain(&role.components);
                let header = used.find(|column| column.index == i).map(|column| column.header.as_str());
                problem(self.name, place, header, fault)
            })?;
            match component {
                Some(component) => values[component] = number,
                None => time = (number, last_place(cell)),
            }
        }
        // A separator may end the row.
        let ended = found == self.wanted + 1 && self.separator.cells(line).last() == Some("");
        if found != self.wanted && !ended {
            let fault = RecordFault::Cells { found, wanted: self.wanted };
            return Err(problem(self.name, place, None, fault));
        }
        self.rows.push(place, time, &values)
    }
}
