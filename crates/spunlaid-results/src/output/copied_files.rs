//! Copies the files that a case or a spinline names into its results folder, so that it can be run again from there.

use crate::Failure;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder for these files in a results folder.
pub const CASE_FILES: &str = "case_files";

/// A file with the files that it names, relative to its folder.
type FileWithParts<'a> = (&'a Path, &'a [PathBuf]);

/// Copies files into `folder`. Returns the path of each, relative to the results folder.
pub fn copy<'a>(
    files: impl IntoIterator<Item = FileWithParts<'a>>,
    folder: &Path,
) -> Result<BTreeMap<PathBuf, PathBuf>, Failure> {
    let mut copied = BTreeMap::new();
    for (file, parts) in files {
        if copied.contains_key(file) {
            continue;
        }
        let name = unused(file, !parts.is_empty(), &copied);
        copy_file(file, &folder.join(&name))?;
        // The parts of a list lie where it says, seen from its own folder.
        let [from, to] =
            [file, &folder.join(&name)].map(|file| file.parent().unwrap_or(Path::new("")).to_owned());
        parts.iter().try_for_each(|part| copy_file(&from.join(part), &to.join(part)))?;
        copied.insert(file.to_owned(), Path::new(CASE_FILES).join(name));
    }
    Ok(copied)
}

fn copy_file(from: &Path, to: &Path) -> Result<(), Failure> {
    let folder = to.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder).map_err(Failure::unwritable(folder))?;
    // Copying a file onto itself would empty it.
    let same = || Some(fs::canonicalize(from).ok()? == fs::canonicalize(to).ok()?);
    if same() != Some(true) {
        fs::copy(from, to).map_err(Failure::unwritable(to))?;
    }
    Ok(())
}

/// Where a copied file lies; another one stays where it is.
pub fn place(copied: &BTreeMap<PathBuf, PathBuf>) -> impl Fn(&Path) -> PathBuf {
    |file| copied.get(file).cloned().unwrap_or_else(|| file.to_owned())
}

/// The path of the copy in its folder: the name of the file, with a number in front if another file has the same name. A
/// list gets a folder of its own, so that its parts meet no other files.
fn unused(file: &Path, is_list: bool, copied: &BTreeMap<PathBuf, PathBuf>) -> PathBuf {
    let whole = file.file_name().unwrap_or_default();
    let name = if is_list { file.file_stem().unwrap_or(whole) } else { whole }.to_string_lossy().into_owned();
    let place = Path::new(CASE_FILES);
    let taken = |name: &str| copied.values().any(|path| path.starts_with(place.join(name)));
    let numbered = (2..).map(|number| format!("{number}_{name}"));
    let name = std::iter::once(name.clone()).chain(numbered).find(|name| !taken(name)).unwrap_or(name);
    if is_list { Path::new(&name).join(whole) } else { name.into() }
}
