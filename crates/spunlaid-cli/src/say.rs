//! Words to the person: results to standard output, remarks and errors to standard error.

use anstream::{eprintln, print, println};
use anstyle::{AnsiColor, Style};
use spunlaid::case::Note;
use spunlaid::input::StudyNote;
use std::fmt::Display;

const ERROR: Style = AnsiColor::Red.on_default().bold();
const WARNING: Style = AnsiColor::Yellow.on_default().bold();
const NOTE: Style = AnsiColor::Cyan.on_default();

/// What went wrong, a line for each thing that did.
#[allow(clippy::print_stderr)]
pub(crate) fn error(what: &impl Display) {
    for line in what.to_string().lines() {
        eprintln!("{ERROR}error:{ERROR:#} {line}");
    }
}

/// What to know of the case all the same.
#[allow(clippy::print_stderr)]
pub(crate) fn note(note: &Note) {
    let (style, word) = if note.what.is_warning() { (WARNING, "warning") } else { (NOTE, "note") };
    eprintln!("{style}{word}:{style:#} {note}");
}

/// What to know of the points of a study all the same.
#[allow(clippy::print_stderr)]
pub(crate) fn study_note(note: &StudyNote) {
    let is_warning = note.note.what.is_warning();
    let (style, word) = if is_warning { (WARNING, "warning") } else { (NOTE, "note") };
    eprintln!("{style}{word}:{style:#} {note}");
}

/// What is not as it should be, but no reason to stop.
#[allow(clippy::print_stderr)]
pub(crate) fn warning(text: &str) {
    eprintln!("{WARNING}warning:{WARNING:#} {text}");
}

/// What is going on, beside the results.
#[allow(clippy::print_stderr)]
pub(crate) fn aside(text: &str) {
    eprintln!("{text}");
}

/// A line of results.
#[allow(clippy::print_stdout)]
pub(crate) fn line(text: &str) {
    println!("{text}");
}

/// Text as it is.
#[allow(clippy::print_stdout)]
pub(crate) fn text(text: &str) {
    print!("{text}");
}
