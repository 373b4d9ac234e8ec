//! `spunlaid check`: shows a case, a spinline, a web or a study with all defaults, and what it means, without computing it.

mod case;
mod study;
mod web;

use crate::args::{CaseSource, Check};
use crate::failure::Failure;
use crate::say;
use spunlaid::error::FileKind;
use spunlaid::input::kind_of;

pub(crate) fn check(check: &Check) -> Result<(), Failure> {
    match kind_of(&check.source.case) {
        FileKind::Web => web::web(check),
        FileKind::Study => study::study(check),
        FileKind::Spinline => case::spinline_alone(check),
        _ => case::case(check),
    }
}

/// Shows a file with every default, and in comments what it means and which command takes it, so that the output is such a file.
fn show(kind: &str, text: &str, comments: &[String], command: &str, source: &CaseSource) {
    say::line(&format!("# the {kind} with every default"));
    say::text(text);
    say::line("");
    comments.iter().for_each(|comment| say::line(&format!("# {comment}")));
    say::line(&format!("# ready: spunlaid {command} {}", source.words()));
}
