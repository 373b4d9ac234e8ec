//! Output to the user: results on standard output; notes, warnings and errors on standard error.
//!
//! A reader may close its end early, as `head` does; this is not an error. If standard output cannot be written
//! for another reason, [`lost`] reports it at the end.

mod wrap;

use anstyle::{AnsiColor, Style};
use spunlaid::ground::Diagnostic;
use spunlaid::input::StudyNote;
use std::fmt::Display;
use std::io::{Error, ErrorKind, Write};
use std::sync::OnceLock;
use terminal_size::terminal_size_of;
use wrap::wrapped;

const ERROR: Style = AnsiColor::Red.on_default().bold();
const WARNING: Style = AnsiColor::Yellow.on_default().bold();
const NOTE: Style = AnsiColor::Cyan.on_default();

static LOST: OnceLock<Error> = OnceLock::new();

/// The reason why output was lost, if it was.
pub(crate) fn lost() -> Option<&'static Error> {
    LOST.get()
}

/// An error, one line for each problem.
pub(crate) fn error(what: &impl Display) {
    for line in what.to_string().lines() {
        aside(&format!("{ERROR}error:{ERROR:#} {line}"));
    }
}

/// A note or a warning about a case.
pub(crate) fn note(note: &Diagnostic) {
    remark(note.is_warning(), note);
}

/// A note or a warning about points of a study.
pub(crate) fn study_note(note: &StudyNote) {
    remark(note.note.is_warning(), note);
}

/// A warning.
pub(crate) fn warning(text: &str) {
    remark(true, &text);
}

pub(crate) fn remark(is_warning: bool, what: &impl Display) {
    let (style, word) = if is_warning { (WARNING, "warning") } else { (NOTE, "note") };
    aside(&format!("{style}{word}:{style:#} {what}"));
}

/// A question on standard error, without an end of line.
pub(crate) fn prompt(question: &str) {
    let mut out = anstream::stderr();
    // If standard error cannot be written, there is no other place for a message.
    let _ = write!(out, "{question}").and_then(|()| out.flush());
}

/// A line on standard error.
pub(crate) fn aside(text: &str) {
    let width = terminal_size_of(std::io::stderr()).map(|(width, _)| usize::from(width.0));
    // If standard error cannot be written, there is no other place for a message.
    let _ = writeln!(anstream::stderr(), "{}", width.map_or_else(|| text.to_owned(), |w| wrapped(text, w)));
}

/// Columns of the terminal that shows the results; none if they go elsewhere.
pub(crate) fn columns() -> Option<usize> {
    terminal_size_of(std::io::stdout()).map(|(width, _)| usize::from(width.0))
}

/// Columns for tables of results; any number if they do not go to a terminal.
pub(crate) fn room() -> usize {
    columns().unwrap_or(usize::MAX)
}

/// A line of results, which the terminal shows in several if it is not wide enough.
pub(crate) fn line(line: &str) {
    table(&format!("{line}\n"));
}

/// Tables and sentences of results. On a terminal, lines that are too long go on below.
pub(crate) fn table(words: &str) {
    match columns() {
        Some(width) => text(&wrapped(words, width)),
        None => text(words),
    }
}

/// Text of results, unchanged.
pub(crate) fn text(text: &str) {
    let mut out = anstream::stdout().lock();
    if let Err(error) = out.write_all(text.as_bytes()).and_then(|()| out.flush())
        && error.kind() != ErrorKind::BrokenPipe
    {
        let _ = LOST.set(error);
    }
}
