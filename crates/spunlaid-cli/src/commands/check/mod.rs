//! `spunlaid check`: shows a case, a spinline, a web or a study with all defaults, and what it means, without
//! computing it.

mod case;
mod study;

use crate::args::{CaseSource, Check, Threads};
use crate::commands::stem;
use crate::control::settled_with;
use crate::failure::Failure;
use crate::say;
use spunlaid::ground::{Diagnostic, Error, FileKind, Severity};
use spunlaid::input::{Resources, kind_of};

pub(crate) fn check(check: &Check) -> Result<(), Failure> {
    match kind_of(&check.source.case) {
        FileKind::Web => case::web(check),
        FileKind::Study => study::study(check),
        FileKind::Spinline => case::spinline_alone(check),
        _ => case::case(check),
    }
}

/// What is read of a file, without flights: a check is quick, and a tension at the end of a spinline changes
/// little of what it says. A note names each tension that a flight will find. Fibres fly only where there are
/// problems that may go away with it.
fn looked_at<T>(read: impl Fn(&Resources) -> Result<T, Error>) -> Result<T, Error> {
    let mut resources = Resources::default();
    match read(&resources) {
        Err(_) if resources.is_in_doubt() => settled_with(&mut resources, Threads::default(), false, read),
        outcome => outcome,
    }
}

/// Shows a file with every default, and in comments what it means and which command takes it, so that the
/// output is such a file.
///
/// * `notes` – of the file; one may doubt that it is meant
fn show(
    kind: &str,
    text: &str,
    notes: &[Diagnostic],
    comments: &[String],
    command: &str,
    source: &CaseSource,
) {
    let is_doubtful = notes.iter().any(|note| note.severity == Severity::Implausible);
    say::line(&format!("# the {kind} with every default"));
    say::text(text);
    say::line("");
    comments.iter().for_each(|comment| say::line(&format!("# {comment}")));
    let ready = if is_doubtful { "see the warnings above; as it is" } else { "ready" };
    say::line(&format!("# {ready}: spunlaid {command} {}", source.words(&stem(&source.case, kind))));
}
