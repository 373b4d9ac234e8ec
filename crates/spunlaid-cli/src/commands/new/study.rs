//! A study to start from.

use super::super::stem;
use super::{need_file, write};
use crate::failure::Failure;
use crate::say;
use spunlaid::input::starter_study;
use std::path::Path;

/// Writes a study beside the file that it varies.
pub(super) fn study(path: &Path, case: &str) -> Result<(), Failure> {
    need_file(path, "a study stands beside the file that it varies")?;
    let study = path.with_file_name(format!("{}_study.toml", stem(path, "case")));
    let (base, shown) = (path.display(), study.display());
    let is_new = !path.exists();
    if is_new {
        write(path, case)?;
    }
    write(&study, &starter_study(path)?)?;
    if is_new {
        say::line(&format!("wrote {base}"));
    }
    say::line(&format!("wrote {shown}, which varies {base}; change it, then: spunlaid sweep {shown}"));
    Ok(())
}
