//! `spunlaid check`: shows a case, a spinline, a web or a study with all defaults, and what it means, without computing it.

mod case;
mod study;
mod web;

use crate::args::Check;
use crate::failure::Failure;
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
