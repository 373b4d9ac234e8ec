//! A case with all defaults, its mesh, limits and expected cost; a spinline alone; a web, and the numbers of its line.

use super::{looked_at, show};
use crate::args::{Check, Threads, overrides};
use crate::failure::Failure;
use crate::say;
use spunlaid::input::{Changes, read_changes, read_spinline, read_web, write_case, write_spinline};
use spunlaid_results::reports::run::about_case;
use spunlaid_results::reports::spinline::{SpinResults, spinline_text};
use spunlaid_results::reports::web::{about_web, expected_of_web};
use std::time::Instant;

/// Checks a case.
pub(super) fn case(check: &Check) -> Result<(), Failure> {
    let started = Instant::now();
    let (case, notes) = looked_at(|resources| check.source.read(&[], resources))?;
    notes.iter().for_each(say::note);
    let comments = about_case(&case, Threads::default().number(), started.elapsed().as_secs_f64())?;
    show("case", &write_case(&case), &[], &comments, "run", &check.source);
    Ok(())
}

/// Checks a file that describes a spinline and no fibre that flies.
pub(super) fn spinline_alone(check: &Check) -> Result<(), Failure> {
    let set = overrides(&check.source.set);
    let file = looked_at(|resources| read_spinline(&check.source.case, set.with(resources)))?;
    file.notes.iter().for_each(say::note);
    let results = SpinResults::new(&file)?;
    let comments: Vec<String> = spinline_text(&results).lines().map(str::to_owned).collect();
    show("spinline", &write_spinline(&file.spec), &[], &comments, "spin", &check.source);
    Ok(())
}

/// Checks the file of a web.
pub(super) fn web(check: &Check) -> Result<(), Failure> {
    let set = overrides(&check.source.set);
    let file = looked_at(|resources| read_web(&check.source.case, set.with(resources)))?;
    file.notes.iter().for_each(say::note);
    let changes = [Changes::OfAssumedValues, Changes::OfLine]
        .map(|which| looked_at(|resources| read_changes(&check.source.case, set.with(resources), which)));
    let [assumed, of_line] = changes;
    let expected = expected_of_web(&file.spec, Threads::default().number(), [&assumed?, &of_line?])?;
    show("web", &file.text, &file.notes, &[about_web(&file.spec), expected].concat(), "web", &check.source);
    Ok(())
}
