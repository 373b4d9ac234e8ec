//! Finds the first row of a table and the line that names its columns.

use super::LONGEST_LINE;
use super::cells::{Looks, Parting, is_comment};
use super::head::{Head, is_unit, names_of_probes};
use crate::error::{Fault, FileError, FileKind, Position, is_invisible};
use std::io::{BufRead, BufReader, Chain, Cursor, Read};

/// What is known before the first row is read.
pub(super) struct Start {
    /// Index of the first row.
    pub(super) row: usize,
    pub(super) parting: Parting,
    /// Cells of the first row.
    pub(super) cells: usize,
    pub(super) names: Option<Vec<String>>,
    /// Index of the line of names.
    pub(super) header: usize,
}

/// Finds the first row and the names above it.
pub(super) fn find(lines: &[TextLine]) -> Option<Start> {
    // The faces that CFX-Post writes below the points are no rows.
    let faces = lines.iter().position(|line| begins_faces(&line.text));
    let lines = &lines[..faces.unwrap_or(lines.len())];
    // Lines that are not comments.
    let is_content = |line: &TextLine| !is_comment(&line.text) && !line.is_blank();
    let content: Vec<usize> = (0..lines.len()).filter(|i| is_content(&lines[*i])).collect();
    let text = |i: usize| lines[content[i]].text.as_str();
    let (first, parting) = numbers(content.len(), text).or_else(|| mixed(content.len(), text))?;
    let cells = parting.cells(text(first));
    // A remark behind the numbers may be left out with its separator.
    let fits = |names: &[String]| match cells.get(names.len()..) {
        Some(rest) => rest.iter().all(|cell| cell.is_empty()),
        None => {
            names.len() == cells.len() + 1 && names.last().is_some_and(|name| Head::new(name).is_remark())
        }
    };
    // Empty names at the end are dropped unless there is something below them.
    let names = |line: &str, parting| {
        let mut names = names(line, parting);
        let empty = |i: usize| cells.get(i).is_none_or(|cell| cell.is_empty());
        while names.last().is_some_and(String::is_empty) && empty(names.len() - 1) {
            names.pop();
        }
        names
    };
    let names_in = |line: &str| {
        let by_rows = names(line, parting);
        let by_itself = names(line, Parting::first_in(line));
        [by_rows, by_itself].into_iter().find(|names| !names.is_empty() && fits(names))
    };
    // Separators at the end of all rows are no column.
    let filled = |i: &usize| {
        let cells = parting.cells(&lines[*i].text);
        cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1)
    };
    let width = content[first..].iter().map(filled).max().unwrap_or(0).min(cells.len());
    let start =
        |row: usize, parting, names, header| Some(Start { row, parting, cells: width, names, header });
    // The header is the nearest line above with one word for each column. Lines between it and the first row count as
    // rows.
    let header = (0..first).rev().find_map(|i| Some((i, names_in(text(i)).filter(|n| words(n))?)));
    if let Some((i, mut names)) = header {
        let mut above = (0..i).rev().map_while(|i| names_in(text(i)).filter(|n| words(n)));
        let (mut units, mut at) = (None, i);
        while notes(&names) || names.iter().any(|name| is_unit(name)) {
            let Some(line) = above.next() else { break };
            let below = std::mem::replace(&mut names, line);
            at -= 1;
            if !notes(&below) {
                units = Some(below);
            }
        }
        for (name, unit) in names.iter_mut().zip(units.iter().flatten()).filter(|(_, unit)| !unit.is_empty())
        {
            *name = format!("{name} [{}]", unit.trim_matches(['[', ']', '(', ')']));
        }
        return start(content[i + 1], parting, Some(names), content[at]);
    }
    let row = content[first];
    if parting == Parting::Vectors {
        let above = lines[..row].iter().map(|line| line.text.as_str());
        return start(row, parting, names_of_probes(above, width), row.saturating_sub(1));
    }
    let above = row.checked_sub(1).map(|i| lines[i].text.as_str());
    if let Some(comment) = above.filter(|text| is_comment(text)) {
        let names = names_in(comment.trim_start_matches(['#', '%', '/', ' '])).filter(|n| words(n));
        return start(row, parting, names, row - 1);
    }
    // The line above is the header all the same. Below a single name a comma is a decimal comma.
    let names = above.map(|text| names(text, Parting::first_in(text)));
    let parting = match &names {
        Some(names) if names.len() == 1 && cells.len() == 2 && parting == Parting::Sign(b',') => {
            Parting::Sign(b';')
        }
        _ => parting,
    };
    start(row, parting, names, row.saturating_sub(1))
}

/// Whether a line is the head of the faces or lines that follow the points in a file of CFX-Post.
pub(super) fn begins_faces(line: &str) -> bool {
    matches!(line.trim(), "[Faces]" | "[Lines]")
}

/// The first row of nothing but numbers.
fn numbers<'a>(lines: usize, text: impl Fn(usize) -> &'a str) -> Option<(usize, Parting)> {
    let rows: Vec<Option<(Parting, usize)>> = (0..lines)
        .map(|i| Parting::from_numbers(text(i)).map(|parting| (parting, parting.cells(text(i)).len())))
        .collect();
    let mut first = None;
    for (i, row) in rows.iter().enumerate() {
        match (row, first) {
            (Some((parting, cells)), None) => first = Some((i, *parting, *cells)),
            (None, Some((_, _, cells))) => {
                // Numbers above the header, as a rate on a line of its own, are not as many as those below it.
                let parting = Parting::first_in(text(i));
                let header = parting.cells(text(i)).iter().all(|cell| Looks::new(cell) != Looks::Number);
                let next = rows.get(i + 1).copied().flatten();
                if header && next.is_some_and(|(_, below)| below != cells) {
                    first = None;
                }
            }
            _ => {}
        }
    }
    first.map(|(i, parting, _)| (i, parting))
}

/// The first row of numbers and words: where most lines in a row look alike.
fn mixed<'a>(lines: usize, text: impl Fn(usize) -> &'a str) -> Option<(usize, Parting)> {
    let looks = |i: usize| {
        let parting = Parting::first_in(text(i));
        let looks: Vec<Looks> = parting.cells(text(i)).iter().map(|cell| Looks::new(cell)).collect();
        (parting, looks)
    };
    let alike = |a: &[Looks], b: &[Looks]| {
        let same = |(a, b): (&Looks, &Looks)| a == b || *a == Looks::Missing || *b == Looks::Missing;
        a.len() == b.len() && a.iter().zip(b).all(same)
    };
    let mut longest: Option<(usize, usize, Parting)> = None;
    let mut i = 0;
    while i < lines {
        let from = i;
        i += 1;
        let (parting, first) = looks(from);
        if !first.contains(&Looks::Number) {
            continue;
        }
        let continues = |(other, next): (Parting, Vec<Looks>)| other == parting && alike(&first, &next);
        while i < lines && continues(looks(i)) {
            i += 1;
        }
        if longest.is_none_or(|(length, ..)| i - from >= length) {
            longest = Some((i - from, from, parting));
        }
    }
    longest.map(|(_, from, parting)| (from, parting))
}

/// The names in a line. Where blanks separate cells, a unit is joined to its name, and a time too.
fn names(line: &str, parting: Parting) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for cell in parting.cells(line) {
        match names.last_mut() {
            Some(name)
                if parting == Parting::Blanks
                    && (cell.starts_with(['[', '('])
                        || cell.contains('/') && is_unit(cell)
                        // COMSOL’s `u (m/s) @ t=0`.
                        || cell == "@"
                        || name.ends_with('@')) =>
            {
                name.push(' ');
                name.push_str(cell);
            }
            _ => names.push(cell.to_owned()),
        }
    }
    names
}

/// Whether a line has names and no numbers.
fn words(names: &[String]) -> bool {
    !names.is_empty()
        && names.iter().all(|name| Looks::new(name) != Looks::Number)
        && names.iter().any(|name| Looks::new(name) == Looks::Text)
}

/// Whether a line says how values were sampled, like the fourth line of a TOA5 file.
fn notes(names: &[String]) -> bool {
    const NOTES: [&str; 9] = ["", "avg", "smp", "max", "min", "std", "tot", "wvc", "med"];
    names.iter().all(|name| NOTES.contains(&name.to_lowercase().as_str()))
}

/// A line that is not empty.
#[derive(Clone, Debug, Default)]
pub(super) struct TextLine {
    /// Line number, from 1.
    pub(super) number: u64,
    /// The text without the end of the line. Tabs at its end remain, because they part cells that are empty.
    pub(super) text: String,
    /// Empty lines above it.
    pub(super) blank: u64,
}

impl TextLine {
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
    pub(super) fn next(&mut self, line: &mut TextLine) -> Result<bool, FileError> {
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
                Ok(text) => line.text.extend(text.chars().filter(|c| !is_invisible(*c))),
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
