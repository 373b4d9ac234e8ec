//! The cases that a web flies, beside its file in a folder of results.

use crate::Failure;
use crate::output::copied_files::{self, CASE_FILES};
use crate::output::folder::Staging;
use spunlaid::input::{LaydownSource, WebSpec, write_case, write_web};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Writes the cases as they are flown, and the files that they name. Returns the text of the web's file, which names them.
pub(super) fn write_cases(staging: &Staging<'_>, mut spec: WebSpec) -> Result<String, Failure> {
    for (number, layer) in (1..).zip(&mut spec.layers) {
        if let LaydownSource::Case { path, case } = &mut layer.source {
            let copied = copied_files::copy(case.files(), &staging.place(CASE_FILES).0)?;
            let place = copied_files::place(&copied);
            let text = write_case(&case.with_files_at(|file| Path::new("..").join(place(file))));
            let name = format!("cases/layer_{number}.toml");
            staging.write(&name, text)?;
            (*path, *case) = (PathBuf::from(name), Arc::clone(case));
        }
    }
    Ok(write_web(&spec))
}
