//! Takes a text apart into lines.

use super::LONGEST_LINE;
use crate::error::{Fault, FileError, FileKind, Position};
use std::io::{BufRead, BufReader, Chain, Cursor, Read};

/// A line that is not empty.
#[derive(Clone, Debug, Default)]
pub(super) struct Line {
    /// Line number, from 1.
    pub(super) number: u64,
    /// The text without the end of the line. Tabs at its end remain, because they part cells that are empty.
    pub(super) text: String,
    /// Empty lines above it.
    pub(super) blank: u64,
}

impl Line {
    /// Whether nothing but blanks and tabs is in it.
    pub(super) fn is_blank(&self) -> bool {
        self.text.trim().is_empty()
    }
}

#[derive(Debug)]
pub(super) struct Lines<R> {
    source: BufReader<Chain<Cursor<Vec<u8>>, R>>,
    /// Last byte of a line.
    end: u8,
    buffer: Vec<u8>,
    number: u64,
    kind: FileKind,
    skip: u64,
}

impl<R: Read> Lines<R> {
    /// Begins to read; `skip` lines are left out.
    pub(super) fn open(mut source: R, kind: FileKind, skip: u64) -> Result<Self, FileError> {
        let mut head = Vec::new();
        let read = source.by_ref().take(LONGEST_LINE as u64 + 1).read_to_end(&mut head);
        read.map_err(|e| FileError::from(Fault::unreadable(&e)).at(Position::Line(1)))?;
        // The lines of old instruments end with a carriage return alone.
        let end = if head.contains(&b'\r') && !head.contains(&b'\n') { b'\r' } else { b'\n' };
        let source = BufReader::with_capacity(1 << 16, Cursor::new(head).chain(source));
        Ok(Self { source, end, buffer: Vec::new(), number: 0, kind, skip })
    }

    /// Reads the next line that is not empty; `false` at the end.
    pub(super) fn next(&mut self, line: &mut Line) -> Result<bool, FileError> {
        line.blank = 0;
        loop {
            self.number += 1;
            let number = self.number;
            let refused = |fault: Fault| FileError::from(fault).at(Position::Line(number));
            self.buffer.clear();
            let most = LONGEST_LINE as u64 + 1;
            let read = self.source.by_ref().take(most).read_until(self.end, &mut self.buffer);
            let read = read.map_err(|e| refused(Fault::unreadable(&e)))?;
            if read == 0 {
                return Ok(false);
            }
            // UTF-16 begins with one of two marks, and text never holds a zero byte.
            let marked = self.buffer.starts_with(&[0xff, 0xfe]) || self.buffer.starts_with(&[0xfe, 0xff]);
            if (number == 1 && marked) || self.buffer.contains(&0) {
                return Err(refused(self.kind.not_text()));
            }
            if read > LONGEST_LINE {
                return Err(refused(too_long(self.kind)));
            }
            if number <= self.skip {
                continue;
            }
            line.text.clear();
            match std::str::from_utf8(&self.buffer) {
                Ok(text) => line.text.push_str(text.trim_start_matches('\u{feff}')),
                // Older instruments write Latin-1.
                Err(_) => line.text.extend(self.buffer.iter().map(|byte| char::from(*byte))),
            }
            let length = line.text.trim_end_matches(|c: char| c.is_whitespace() && c != '\t').len();
            line.text.truncate(length);
            // Tabs alone may be a row whose cells are all empty.
            if line.text.is_empty() {
                line.blank += 1;
                continue;
            }
            line.number = number;
            return Ok(true);
        }
    }
}

fn too_long(kind: FileKind) -> Fault {
    match kind {
        FileKind::Scan => Fault::new(
            format!("this row is longer than {LONGEST_LINE} bytes, the limit for a table"),
            "save so wide a map as NumPy array (.npy)",
        ),
        _ => Fault::new(
            format!("this line is longer than {LONGEST_LINE} bytes, the limit for a row of a table"),
            "end each row with a line break",
        ),
    }
}
