//! The moving fibre as data of the page.

mod belt;
mod data;
mod fixed;

pub(super) use data::Frames;

use spunlaid::case::Case;
use spunlaid::ensemble::Results;
use spunlaid::error::Error;

/// Chooses and packs the shapes of a run; `None` where none were kept.
///
/// # Errors
/// The file that they are in cannot be read.
pub(super) fn pack(case: &Case, results: &Results) -> Result<Option<Frames>, Error> {
    match case.line {
        Some(line) => belt::pack(case, line, results),
        None => fixed::pack(case, results),
    }
}
