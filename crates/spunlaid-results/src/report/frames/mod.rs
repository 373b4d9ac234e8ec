//! The moving fibre as data of the page.

mod belt;
mod data;
mod fixed;

pub(super) use data::Frames;

use spunlaid::fibre::Case;
use spunlaid::ground::Error;
use spunlaid::simulation::Results;

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
