//! A web with all defaults, and the numbers of its line.

use super::{looked_at, show};
use crate::args::{Check, overrides};
use crate::failure::Failure;
use crate::say;
use spunlaid::input::read_web;
use spunlaid_results::products::web::about_web;

/// Checks the file of a web.
pub(super) fn web(check: &Check) -> Result<(), Failure> {
    let set = overrides(&check.source.set);
    let file = looked_at(|resources| read_web(&check.source.case, set.with(resources)))?;
    file.notes.iter().for_each(say::note);
    show("web", (&file.text, &file.notes), &about_web(&file.spec), "web", &check.source);
    Ok(())
}
