//! The moving fibre as data of the page.

mod belt;
mod data;
mod fixed;

pub(super) use data::Frames;

use spunlaid::case::Case;
use spunlaid::ensemble::Results;

/// Chooses and packs the shapes of a run; `None` where none were kept.
pub(super) fn pack(case: &Case, results: &Results) -> Option<Frames> {
    match case.line {
        Some(line) => belt::pack(case, line, results),
        None => fixed::pack(case, results),
    }
}
