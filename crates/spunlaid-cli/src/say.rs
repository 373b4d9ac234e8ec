//! Words to the person: results to standard output, remarks and errors to standard error.
//!
//! Who reads may have gone, as `head` does when it has enough: that is no error. A standard output that cannot
//! be written for another reason is one, and [`lost`] tells it at the end.

use anstyle::{AnsiColor, Style};
use spunlaid::case::Note;
use spunlaid::input::StudyNote;
use std::fmt::Display;
use std::io::{Error, ErrorKind, Write};
use std::sync::OnceLock;

const ERROR: Style = AnsiColor::Red.on_default().bold();
const WARNING: Style = AnsiColor::Yellow.on_default().bold();
const NOTE: Style = AnsiColor::Cyan.on_default();

static LOST: OnceLock<Error> = OnceLock::new();

/// Why words to standard output were lost, if they were.
pub(crate) fn lost() -> Option<&'static Error> {
    LOST.get()
}

/// What went wrong, a line for each thing that did.
pub(crate) fn error(what: &impl Display) {
    for line in what.to_string().lines() {
        aside(&format!("{ERROR}error:{ERROR:#} {line}"));
    }
}

/// What to know of the case all the same.
pub(crate) fn note(note: &Note) {
    remark(note.what.is_warning(), note);
}

/// What to know of the points of a study all the same.
pub(crate) fn study_note(note: &StudyNote) {
    remark(note.note.what.is_warning(), note);
}

/// What is not as it should be, but no reason to stop.
pub(crate) fn warning(text: &str) {
    remark(true, &text);
}

fn remark(is_warning: bool, what: &impl Display) {
    let (style, word) = if is_warning { (WARNING, "warning") } else { (NOTE, "note") };
    aside(&format!("{style}{word}:{style:#} {what}"));
}

/// What is going on, beside the results.
pub(crate) fn aside(text: &str) {
    // There is nowhere left to say that this does not work.
    let _ = writeln!(anstream::stderr(), "{text}");
}

/// A line of results.
pub(crate) fn line(line: &str) {
    text(&format!("{line}\n"));
}

/// Text as it is.
pub(crate) fn text(text: &str) {
    let mut out = anstream::stdout().lock();
    if let Err(error) = out.write_all(text.as_bytes()).and_then(|()| out.flush())
        && error.kind() != ErrorKind::BrokenPipe
    {
        let _ = LOST.set(error);
    }
}
