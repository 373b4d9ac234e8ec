//! `spunlaid compare`: the results of several runs, or of several webs, side by side.

use super::{say_report, staged};
use crate::args::{Compare, Invocation};
use crate::failure::Failure;
use crate::say;
use spunlaid_results::folders::comparison::{FILES, Folders};
use spunlaid_results::report::comparison_text;
use std::path::{Path, PathBuf};

pub(crate) fn compare(compare: &Compare, invocation: &Invocation) -> Result<(), Failure> {
    let folders = Folders::new(&compare.runs)?;
    let folder = compare.output.folder(folders.joined());
    let files: Vec<&Path> = compare.runs.iter().map(PathBuf::as_path).collect();
    let staging = (!compare.json || compare.output.out.is_some())
        .then(|| {
            let origin = invocation.origin(&files, &folder);
            staged((&folder, FILES), &compare.output, origin, &compare.figures.files())
        })
        .transpose()?;
    let found = folders.compare()?;
    if let Some(staging) = staging {
        found.write(&staging)?;
        staging.publish()?;
    }
    if compare.json {
        say::text(&found.json());
    } else if !compare.output.quiet {
        say::table(&comparison_text(found.comparisons(), say::room()));
        found.notes().iter().for_each(|note| say::remark(false, note));
        say_report(&folder);
    }
    Ok(())
}
