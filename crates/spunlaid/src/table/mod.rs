//! Tables of numbers as text, as loggers, spreadsheets and CFD programs write them, read row by row.
//!
//! * **Cells** are parted by tabs, semicolons, commas or blanks; a cell may stand in quotation marks.
//! * **Numbers** have a decimal point or, where commas do not part cells, a decimal comma. NaN, `null`, `n/a` and an
//!   empty cell count as missing, and read as NaN. Infinity is a fault.
//! * **The header** is the line of names above the first row of numbers. A line of units may follow it, and so may
//!   the fourth line of TOA5 files. Lines above the header are left out without being told. Units may also stand in
//!   the names: `u_m_s`, `u [m/s]`, `u (m/s)`.
//! * **Comments** begin with `#`, `%` or `//`. The header may be one, if it stands just above the numbers.
//! * **Columns of text** do no harm until a number is asked of them.
//! * **Encoding**: UTF-8, or else Latin-1.
//!
//! Memory is bounded: a line may have [`LONGEST_LINE`] bytes, and [`LINES_AHEAD`] lines are looked at to find the
//! header. Faults name line and column.
//!
//! ```
//! use spunlaid::error::{FileError, FileKind};
//! use spunlaid::table::Table;
//! use spunlaid::units::Dimension;
//!
//! # fn main() -> Result<(), FileError> {
//! let text = "Logger;7\nRate;10 Hz\nstamp;x_mm;velocity [m/s]\n12:00:00;0;10,5\n12:00:01;100;9,8\n";
//! let mut table = Table::open(text.as_bytes(), FileKind::Table, 0)?;
//! let names: Vec<&str> = table.heads().iter().map(|head| head.name.as_str()).collect();
//! assert_eq!(names, ["stamp", "x", "velocity"]);
//! let to_metres = table.heads()[1].factor(Dimension::Length, "x_mm")?;
//! let mut rows = Vec::new();
//! while table.next_row()? {
//!     rows.push((table.number(1)? * to_metres, table.number(2)?));
//! }
//! assert_eq!(rows, [(0.0, 10.5), (0.1, 9.8)]);
//! # Ok(())
//! # }
//! ```

mod cells;
mod head;
mod start;

pub use head::{Head, scale};

use crate::error::{FileError, FileFault, FileKind, FilePlace};
use cells::{Parting, number};
use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read};
use std::ops::Range;

/// Longest line read [bytes].
pub const LONGEST_LINE: usize = 1 << 16;
/// Most lines among which the header and the first row are found.
pub const LINES_AHEAD: usize = 100;

/// A table that is read row by row.
#[derive(Debug)]
pub struct Table<R> {
    lines: Lines<R>,
    ahead: VecDeque<Line>,
    heads: Vec<Head>,
    named: bool,
    header: u64,
    parting: Parting,
    /// Decimal sign of the numbers so far.
    decimals: Option<u8>,
    row: Line,
    cells: Vec<Range<usize>>,
}

impl<R: Read> Table<R> {
    /// Finds the header of a table and stops before its first row.
    ///
    /// * `kind` – what the table is read for, as messages call it
    /// * `skip` – lines at the start that are left out
    ///
    /// # Errors
    /// When it cannot be read, is no text or has no rows of numbers.
    pub fn open(source: R, kind: FileKind, skip: u64) -> Result<Self, FileError> {
        let source = BufReader::with_capacity(1 << 16, source);
        let mut lines = Lines { source, buffer: Vec::new(), number: 0, kind, skip };
        let mut ahead = VecDeque::new();
        while ahead.len() < LINES_AHEAD {
            let mut line = Line::default();
            if !lines.next(&mut line)? {
                break;
            }
            ahead.push_back(line);
        }
        let start = start::find(ahead.make_contiguous()).ok_or(FileFault::NoRows)?;
        let header = ahead.get(start.header).map_or(0, |line| line.number);
        ahead.drain(..start.row);
        if let Some(first) = ahead.front_mut() {
            first.blank = 0;
        }
        let named = start.names.is_some();
        let numbered = || (1..=start.cells).map(|i| format!("column {i}")).collect();
        let heads = start.names.unwrap_or_else(numbered).iter().map(|name| Head::new(name)).collect();
        Ok(Self {
            lines,
            ahead,
            heads,
            named,
            header,
            parting: start.parting,
            decimals: None,
            row: Line::default(),
            cells: Vec::new(),
        })
    }

    /// The columns; `column 1`, `column 2` … where the file names none.
    pub fn heads(&self) -> &[Head] {
        &self.heads
    }

    /// Whether the columns have names of the file's own.
    pub const fn named(&self) -> bool {
        self.named
    }

    /// Where the names are.
    pub(crate) const fn header(&self) -> FilePlace {
        FilePlace::Line(self.header)
    }

    /// Goes on to the next row; `false` at the end.
    ///
    /// # Errors
    /// When the file cannot be read, or the row has cells missing or too many.
    pub fn next_row(&mut self) -> Result<bool, FileError> {
        let mut blank = 0;
        loop {
            match self.ahead.pop_front() {
                Some(line) => self.row = line,
                None if self.lines.next(&mut self.row)? => {}
                None => return Ok(false),
            }
            blank += self.row.blank;
            if !cells::is_comment(&self.row.text) {
                break;
            }
        }
        self.row.blank = blank;
        self.parting.split(&self.row.text, &mut self.cells);
        let (found, wanted) = (self.cells.len(), self.heads.len());
        // Separators may end a row.
        if self.cells.get(wanted..).is_some_and(|rest| rest.iter().all(Range::is_empty)) {
            Ok(true)
        } else {
            Err(FileError::from(FileFault::Cells { found, wanted }).at(self.place()))
        }
    }

    /// Line of the row, from 1.
    pub const fn line(&self) -> u64 {
        self.row.number
    }

    /// Where the row is.
    pub(crate) const fn place(&self) -> FilePlace {
        FilePlace::Line(self.row.number)
    }

    /// Empty lines between this row and the one before.
    pub const fn blank_lines(&self) -> u64 {
        self.row.blank
    }

    /// What stands in a column of the row; empty where there is no such column.
    pub fn text(&self, column: usize) -> &str {
        self.cells.get(column).map_or("", |cell| &self.row.text[cell.clone()])
    }

    /// The number in a column of the row; NaN where it is missing.
    ///
    /// # Errors
    /// When there is something else, or infinity.
    pub fn number(&mut self, column: usize) -> Result<f64, FileError> {
        let mut decimals = self.decimals;
        let number = number(self.text(column), self.parting, &mut decimals);
        self.decimals = decimals;
        number.map_err(|fault| self.blame(column, fault))
    }

    /// The unit in the last place of the number in a column, as it is written: 1e-3 for `0,125`, 1e-5 for `1.25e-3`.
    pub fn last_place(&self, column: usize) -> f64 {
        cells::last_place(self.text(column))
    }

    /// A fault of a column in this row.
    pub(crate) fn blame(&self, column: usize, fault: impl Into<FileFault>) -> FileError {
        let name = self.heads.get(column).map_or("", |head| &head.text);
        FileError::from(fault.into()).at(self.place()).column(name)
    }
}

/// A line that is not empty.
#[derive(Clone, Debug, Default)]
struct Line {
    /// From 1.
    number: u64,
    text: String,
    /// Empty lines above it.
    blank: u64,
}

#[derive(Debug)]
struct Lines<R> {
    source: BufReader<R>,
    buffer: Vec<u8>,
    number: u64,
    kind: FileKind,
    skip: u64,
}

impl<R: Read> Lines<R> {
    /// Reads on to the next line that is not empty; `false` at the end.
    fn next(&mut self, line: &mut Line) -> Result<bool, FileError> {
        line.blank = 0;
        loop {
            self.number += 1;
            let number = self.number;
            let refused = |fault: FileFault| FileError::from(fault).at(FilePlace::Line(number));
            self.buffer.clear();
            let most = LONGEST_LINE as u64 + 1;
            let read = self.source.by_ref().take(most).read_until(b'\n', &mut self.buffer);
            let read = read.map_err(|e| refused(FileFault::Unreadable { message: e.to_string() }))?;
            if read == 0 {
                return Ok(false);
            }
            // UTF-16 begins with one of two marks; a zero is in no text.
            let marked = self.buffer.starts_with(&[0xff, 0xfe]) || self.buffer.starts_with(&[0xfe, 0xff]);
            if (number == 1 && marked) || self.buffer.contains(&0) {
                return Err(refused(FileFault::NotText(self.kind)));
            }
            if read > LONGEST_LINE {
                return Err(refused(FileFault::LineTooLong { most: LONGEST_LINE }));
            }
            if number <= self.skip {
                continue;
            }
            line.text.clear();
            match std::str::from_utf8(&self.buffer) {
                Ok(text) => line.text.push_str(text.trim_start_matches('\u{feff}').trim_end()),
                // Latin-1, as older instruments write it.
                Err(_) => line.text.extend(self.buffer.iter().map(|byte| char::from(*byte))),
            }
            if line.text.trim().is_empty() {
                line.blank += 1;
                continue;
            }
            line.number = number;
            return Ok(true);
        }
    }
}

#[cfg(test)]
mod tests;
