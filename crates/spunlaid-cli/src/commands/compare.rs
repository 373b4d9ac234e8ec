//! `spunlaid compare`: the results of several runs, or of several webs, side by side.

use super::delivery::{Asides, Delivery};
use crate::args::{Compare, Invocation, Threads};
use crate::failure::Failure;
use spunlaid_results::folders::comparison::{ComparedFolders, Folders};

pub(crate) fn compare(compare: &Compare, invocation: &Invocation) -> Result<(), Failure> {
    let folders = Folders::new(&compare.runs)?;
    let (folder, output) = (compare.output.optional_folder(folders.joined()), &compare.output);
    let (origin, figures) = (invocation.origin_of(&compare.runs), compare.figures.files());
    let delivery = Delivery::open::<ComparedFolders>(folder, origin, output, &figures)?;
    let found = folders.compare()?;
    delivery.deliver(&found, Threads::default(), Asides { found: found.notes(), ..Asides::default() })
}
