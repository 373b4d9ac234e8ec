//! Copies the files that a case names into its results folder, so that the case can be run again from there.

use crate::failure::Failure;
use spunlaid::case::Case;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder for these files in a results folder.
pub(crate) const CASE_FILES: &str = "case_files";

/// Copies the files of cases into `folder`. Returns the path of each, relative to the results folder.
pub(crate) fn copy<'a>(
    cases: impl IntoIterator<Item = &'a Case>,
    folder: &Path,
) -> Result<BTreeMap<PathBuf, PathBuf>, Failure> {
    let mut copied = BTreeMap::new();
    for file in cases.into_iter().flat_map(|case| case.air.files()) {
        if copied.contains_key(file) {
            continue;
        }
        fs::create_dir_all(folder).map_err(Failure::unwritable(folder))?;
        let name = unused(file, &copied);
        let to = folder.join(&name);
        // Copying a file onto itself would empty it.
        let same = || Some(fs::canonicalize(file).ok()? == fs::canonicalize(&to).ok()?);
        if same() != Some(true) {
            fs::copy(file, &to).map_err(Failure::unwritable(&to))?;
        }
        copied.insert(file.to_owned(), Path::new(CASE_FILES).join(name));
    }
    Ok(copied)
}

/// The case with the paths of the copied files.
pub(crate) fn relocated(case: &Case, copied: &BTreeMap<PathBuf, PathBuf>) -> Case {
    let place = |file: &Path| copied.get(file).cloned().unwrap_or_else(|| file.to_owned());
    Case { air: case.air.with_files_at(place), ..case.clone() }
}

/// The name of the file, with a number in front if another file has the same name.
fn unused(file: &Path, copied: &BTreeMap<PathBuf, PathBuf>) -> PathBuf {
    let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let taken = |name: &str| copied.values().any(|path| path.file_name().is_some_and(|taken| taken == name));
    let numbered = (2..).map(|number| format!("{number}_{name}"));
    std::iter::once(name.clone()).chain(numbered).find(|name| !taken(name)).unwrap_or(name).into()
}
