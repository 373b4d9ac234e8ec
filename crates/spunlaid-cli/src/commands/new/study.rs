//! A study to start from.

use super::super::stem;
use super::write;
use crate::args::is_standard;
use crate::failure::Failure;
use crate::say;
use spunlaid::error::{Error, Fault};
use spunlaid::input::starter_study;
use std::path::Path;

/// Writes a study beside the file that it varies.
pub(super) fn study(path: &Path, case: &str) -> Result<(), Failure> {
    if is_standard(path) {
        let fault = Fault::new(
            "is standard output, and a study stands beside the file that it varies",
            "name a file",
        );
        return Err(Error::folder(path, fault).into());
    }
    let study = path.with_file_name(format!("{}_study.toml", stem(path, "case").to_string_lossy()));
    let (base, shown) = (path.display(), study.display());
    let is_there = path.exists();
    if is_there {
        write(&study, &starter_study(path)?)?;
    } else {
        write(path, case)?;
        write(&study, &starter_study(path)?)?;
        say::line(&format!("wrote {base}"));
    }
    say::line(&format!("wrote {shown}, which varies {base}; change it, then: spunlaid sweep {shown}"));
    Ok(())
}
