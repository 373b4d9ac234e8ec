//! The moving fibre as data of the page.

mod belt;
mod data;
mod fixed;

pub(super) use data::Frames;
pub(crate) use data::POSITIONS;

use crate::page::document::script;
use spunlaid_fibre::Case;
use spunlaid_ground::Error;
use spunlaid_simulation::Results;

/// Script with the class `Camera`: how the space of the moving fibre is seen and turned, for other pages that show one.
pub const CAMERA: &str = script!("camera.js");
/// Script with the class `Scene`, which draws the fibre on a canvas as a `Camera` sees it.
pub const SCENE: &str = script!("scene.js");

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
