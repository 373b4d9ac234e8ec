//! The text of a TOML file, with line and column of each position.

use super::slip::{Unclosed, slip};
use spunlaid_ground::error::Place;
use spunlaid_ground::units::excerpt;
use spunlaid_ground::{Diagnostic, Fault, Position};
use std::ops::Range;

/// The name and text of a file.
pub(super) struct TextWithLines<'a> {
    name: String,
    text: &'a str,
    /// Index of the byte at which each line starts.
    lines: Vec<usize>,
}

impl<'a> TextWithLines<'a> {
    pub(super) fn new(text: &'a str, name: &str) -> Self {
        let starts = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(i, _)| i + 1);
        Self { name: name.to_owned(), text, lines: std::iter::once(0).chain(starts).collect() }
    }

    /// The whole file as a place, for values that it does not contain.
    pub(super) fn whole(&self) -> Place {
        Place::in_file(&self.name, Position::Whole)
    }

    /// The line that contains a byte.
    pub(super) fn place(&self, byte: usize) -> Place {
        Place::in_file(&self.name, Position::Line(self.position(byte).0))
    }

    /// The text of a value, as it is.
    pub(super) fn exact(&self, span: Range<usize>) -> &'a str {
        self.text.get(span).unwrap_or_default()
    }

    /// The text of a value, on one line and shortened.
    pub(super) fn shown(&self, span: Range<usize>) -> String {
        fit(self.text.get(span).unwrap_or_default())
    }

    /// What is wrong with the text, by the faults that the parser found: one problem for a line, and none
    /// behind a list or a text that has no end.
    pub(super) fn syntax(&self, faults: &[toml::de::Error]) -> Vec<Diagnostic> {
        let alone = self.text.contains('\r') && !self.text.contains('\n');
        if alone {
            let fault = Fault::new(
                "the lines end with a carriage return alone, as old editors of the Macintosh save them",
                "save the file with the ends of lines of Unix or Windows",
            );
            return vec![self.problem(Position::Line(1), fault)];
        }
        let unclosed = Unclosed::find(self.text);
        let mut problems: Vec<(u64, Diagnostic)> = Vec::new();
        for fault in faults {
            let at = fault.span().map_or(0, |span| span.start);
            let (line, column) = self.position(at);
            let follows = unclosed.is_some_and(|unclosed| line >= self.position(unclosed.at).0);
            if follows || problems.iter().any(|(reported, _)| *reported == line) {
                continue;
            }
            let message = fault.message().replace('\n', "; ");
            let what = match fault.span().and_then(|span| self.text.get(span)) {
                Some(key) if message == "duplicate key" => Fault::duplicate(&fit(key)),
                _ => slip(self.text.lines().nth((line as usize).saturating_sub(1)).unwrap_or_default())
                    .unwrap_or_else(|| Fault::plain(format!("not valid TOML: {message}"))),
            };
            problems.push((line, self.problem(Position::Character { line, column }, what)));
        }
        if let Some(unclosed) = unclosed {
            let (line, column) = self.position(unclosed.at);
            let place = Position::Character { line, column };
            problems.push((line, self.problem(place, unclosed.fault(self.text))));
        }
        problems.into_iter().map(|(_, problem)| problem).collect()
    }

    fn problem(&self, position: Position, what: Fault) -> Diagnostic {
        Diagnostic { place: Place::in_file(&self.name, position), ..what.into() }
    }

    /// Line and column of a byte, both counted from 1; the column counts characters.
    fn position(&self, byte: usize) -> (u64, u64) {
        let line = self.lines.partition_point(|start| *start <= byte);
        let start = line.checked_sub(1).and_then(|i| self.lines.get(i)).copied().unwrap_or(0);
        let before = self.text.get(start..byte).unwrap_or_default();
        (line as u64, before.chars().count() as u64 + 1)
    }
}

/// TextWithLines text on one line, shortened.
pub(super) fn fit(text: &str) -> String {
    excerpt(text, 60)
}
