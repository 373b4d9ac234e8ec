//! Reads text tables of numbers row by row, as loggers, spreadsheets and CFD programs write them.
//!
//! * **Cells** are separated by tabs, semicolons, commas or blanks; a cell may have quotation marks around it.
//! * **Numbers** have a decimal point or, where commas do not separate cells, a decimal comma. NaN, `null`, `n/a` and
//!   an empty cell count as missing and are read as NaN. Infinity is an error. Exponents may be Fortran's, `1.5D+00`.
//! * **Vectors** may have parentheses around their components, as OpenFOAM's probes have.
//! * **The header** is the line of names above the first row of numbers. A line of units may follow it, and so may
//!   the fourth line of TOA5 files. Lines above the header are recognised and skipped. Units may also be
//!   part of the names: `u_m_s`, `u [m/s]`, `u (m/s)`.
//! * **Comments** begin with `#`, `%` or `//`. A comment just above the numbers may be the header.
//! * **Thousands** have no sign: `1.234.567` is refused, and so is a column in which `998` stands beside `1.002`.
//! * **Columns of text** are allowed; only reading a number from one is an error. One may hold time stamps.
//! * **Lines** end with a line feed, with a carriage return, or with both. Tabs at their end part cells like
//!   any others.
//! * **Encoding** is UTF-8; a line that is not valid UTF-8 is read as Latin-1.
//!
//! Memory is bounded: a line has at most `LONGEST_LINE` bytes, and the header is looked for in the first
//! `LINES_AHEAD` lines. Errors name the line and the column.
//!
//! ```
//! use spunlaid_ground::error::{FileError, FileKind};
//! use spunlaid_ground::table::Table;
//! use spunlaid_ground::units::Dimension;
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
mod stamp;
mod start;

use crate::error::{Fault, FileError, FileKind, Position, counted};
use crate::units::excerpt;
use cells::{Digits, Looks, Parting, number};
pub use head::{Head, refuse_twice, scale};
pub use stamp::{FORMS, Stamp};
use start::{Lines, TextLine};
use std::collections::VecDeque;
use std::io::Read;
use std::ops::Range;

/// Longest line read [bytes].
pub(crate) const LONGEST_LINE: usize = 1 << 16;
/// Number of lines in which the header and the first row are looked for.
pub(crate) const LINES_AHEAD: usize = 100;

/// What a column begins with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FirstCell {
    /// A number, or nothing.
    Number,
    /// A time stamp, or another value that says the unit of a time itself.
    Stamp,
    /// Something else.
    Text(String),
}

/// A text table that is read row by row.
#[derive(Debug)]
pub struct Table<R> {
    lines: Lines<R>,
    ahead: VecDeque<TextLine>,
    heads: Vec<Head>,
    named: bool,
    header: u64,
    parting: Parting,
    /// Decimal sign of the numbers read so far.
    decimals: Option<u8>,
    /// What is known of signs between thousands, for each column.
    digits: Vec<Digits>,
    row: TextLine,
    cells: Vec<Range<usize>>,
}

impl<R: Read> Table<R> {
    /// Finds the header of a table and stops before its first row.
    ///
    /// * `kind` – what messages call the table
    /// * `skip` – number of lines to skip at the start
    ///
    /// # Errors
    /// When the source cannot be read, is not text or has no rows of numbers.
    pub fn open(source: R, kind: FileKind, skip: u64) -> Result<Self, FileError> {
        let mut lines = Lines::open(source, kind, skip)?;
        let mut ahead = VecDeque::new();
        while ahead.len() < LINES_AHEAD {
            let mut line = TextLine::default();
            if !lines.next(&mut line)? {
                break;
            }
            ahead.push_back(line);
        }
        let start = start::find(ahead.make_contiguous()).ok_or_else(Fault::no_rows)?;
        let header = ahead.get(start.header).map_or(0, |line| line.number);
        ahead.drain(..start.row);
        if let Some(first) = ahead.front_mut() {
            first.blank = 0;
        }
        let named = start.names.is_some();
        let numbered = || (1..=start.cells).map(|i| format!("column {i}")).collect();
        let heads: Vec<Head> =
            start.names.unwrap_or_else(numbered).iter().map(|name| Head::new(name)).collect();
        let digits = vec![Digits::new(start.parting); heads.len()];
        Ok(Self {
            lines,
            ahead,
            heads,
            named,
            header,
            parting: start.parting,
            decimals: None,
            digits,
            row: TextLine::default(),
            cells: Vec::new(),
        })
    }

    /// The headers of the columns; `column 1`, `column 2` … if the file has no names.
    pub fn heads(&self) -> &[Head] {
        &self.heads
    }

    /// Whether the file names its columns.
    pub const fn named(&self) -> bool {
        self.named
    }

    /// The line of the names.
    pub const fn header(&self) -> Position {
        Position::Line(self.header)
    }

    /// Reads the next row; `false` at the end.
    ///
    /// # Errors
    /// When the file cannot be read, the row has too few or too many cells, or nothing shows whether the signs in a
    /// column that was read are those of decimals or of thousands.
    pub fn next_row(&mut self) -> Result<bool, FileError> {
        let mut blank = 0;
        loop {
            if !self.next_line()? {
                return self.finish();
            }
            blank += self.row.blank;
            if cells::is_comment(&self.row.text) {
                continue;
            }
            self.parting.split(&self.row.text, &mut self.cells);
            // Tabs alone are a row whose cells are all empty, where tabs part the cells of a row.
            let is_row =
                !self.row.is_blank() || self.parting.is_tab() && self.cells.len() == self.heads.len();
            if is_row {
                break;
            }
            blank += 1;
        }
        if start::begins_faces(&self.row.text) {
            return self.skip_faces();
        }
        self.row.blank = blank;
        let (found, wanted) = (self.cells.len(), self.heads.len());
        // Separators may end a row, and a remark behind its numbers may be left out with its separator.
        let extra = self.cells.get(wanted..);
        let fits = match extra {
            _ if self.begins_block() => false,
            Some(extra) => extra.iter().all(Range::is_empty),
            None => found + 1 == wanted && self.heads.last().is_some_and(Head::is_remark),
        };
        if fits { Ok(true) } else { Err(self.wrong_count(found, wanted)) }
    }

    fn next_line(&mut self) -> Result<bool, FileError> {
        match self.ahead.pop_front() {
            Some(line) => {
                self.row = line;
                Ok(true)
            }
            None => self.lines.next(&mut self.row),
        }
    }

    /// Goes to the end of the file.
    ///
    /// # Errors
    /// If another block begins before it.
    fn skip_faces(&mut self) -> Result<bool, FileError> {
        while self.next_line()? {
            self.parting.split(&self.row.text, &mut self.cells);
            if self.begins_block() {
                return Err(self.wrong_count(self.cells.len(), self.heads.len()));
            }
        }
        self.finish()
    }

    /// Whether this is the head of a further block in a file of LabVIEW or of CFX-Post.
    fn begins_block(&self) -> bool {
        matches!(self.text(0), "Channels" | "***End_of_Header***" | "[Name]" | "[Data]")
    }

    /// The error of a row with too few or too many cells, or of none.
    fn wrong_count(&self, found: usize, wanted: usize) -> FileError {
        if self.begins_block() {
            let fault = Fault::new("another block of data begins here", "cut the file into its blocks");
            return FileError::from(fault).at(self.place());
        }
        let remedy = if found < wanted {
            "is the file cut off here?"
        } else {
            "are both decimals and cells separated by commas?"
        };
        let fault =
            Fault::new(format!("this row has {} and needs {wanted}", counted(found as u64, "cell")), remedy);
        FileError::from(fault).at(self.place())
    }

    /// Whether the columns that were read leave a doubt, at the end of the file.
    fn finish(&self) -> Result<bool, FileError> {
        let doubt =
            self.digits.iter().zip(&self.heads).find_map(|(digits, head)| Some((digits.doubt()?, head)));
        match doubt {
            None => Ok(false),
            Some(((fault, place), head)) => Err(FileError::from(fault).at(place).column(&head.text)),
        }
    }

    /// Line number of the row, from 1.
    pub const fn line(&self) -> u64 {
        self.row.number
    }

    /// The place of the row, for messages.
    pub const fn place(&self) -> Position {
        Position::Line(self.row.number)
    }

    /// Empty lines between this row and the one before.
    pub const fn blank_lines(&self) -> u64 {
        self.row.blank
    }

    /// The text in a column of the row; empty if there is no such column.
    pub fn text(&self, column: usize) -> &str {
        self.cells.get(column).map_or("", |cell| &self.row.text[cell.clone()])
    }

    /// The number in a column of the row; NaN if it is missing.
    ///
    /// # Errors
    /// When the cell holds text or infinity.
    pub fn number(&mut self, column: usize) -> Result<f64, FileError> {
        let mut decimals = self.decimals;
        let text = self.cells.get(column).map_or("", |cell| &self.row.text[cell.clone()]);
        let number = number(text, &mut decimals);
        self.decimals = decimals;
        if let Some(digits) = self.digits.get_mut(column) {
            digits.look(text, || Position::Line(self.row.number));
        }
        number.map_err(|fault| self.blame(column, fault))
    }

    /// The time stamp in a column of the row, if there is one.
    pub fn stamp(&self, column: usize) -> Option<Stamp> {
        Stamp::parse(self.text(column))
    }

    /// What the first row has in each column. Only before it is read.
    pub fn first_row(&self) -> Vec<FirstCell> {
        let first = self.ahead.iter().find(|line| !cells::is_comment(&line.text) && !line.is_blank());
        let cells = first.map_or_else(Vec::new, |line| self.parting.cells(&line.text));
        let of = |cell: &str| match Stamp::parse(cell) {
            Some(_) => FirstCell::Stamp,
            None if Looks::new(cell) == Looks::Text => FirstCell::Text(excerpt(cell, 40)),
            None => FirstCell::Number,
        };
        cells.into_iter().map(of).collect()
    }

    /// Whether a column of the row holds a finite number, with whatever decimal sign, or says that it is missing.
    pub fn is_number(&self, column: usize) -> bool {
        cells::is_number(self.text(column))
    }

    /// The unit of the last digit of the number in a column as it is written: 1e-3 for `0,125`, 1e-5 for `1.25e-3`.
    pub fn last_place(&self, column: usize) -> f64 {
        cells::last_place(self.text(column))
    }

    /// An error at a column of this row.
    pub fn blame(&self, column: usize, fault: impl Into<Fault>) -> FileError {
        let name = self.heads.get(column).map_or("", |head| &head.text);
        FileError::from(fault.into()).at(self.place()).column(name)
    }
}

#[cfg(test)]
mod tests;
