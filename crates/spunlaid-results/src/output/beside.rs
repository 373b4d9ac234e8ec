//! Copies the files that a case or a spinline names into its results folder, so that it can be run again from there.

use crate::Failure;
use spunlaid::air::FromFile;
use spunlaid::case::Case;
use spunlaid::spinline::{PolymerSource, Spinline, Surroundings};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder for these files in a results folder.
pub const CASE_FILES: &str = "case_files";

/// A file with the files that it names, relative to its folder.
type FileWithParts<'a> = (&'a Path, &'a [PathBuf]);

/// Copies the files of cases into `folder`. Returns the path of each, relative to the results folder.
pub fn copy<'a>(
    cases: impl IntoIterator<Item = &'a Case>,
    folder: &Path,
) -> Result<BTreeMap<PathBuf, PathBuf>, Failure> {
    let files =
        |case: &'a Case| case.air.files().into_iter().chain(case.spinline.iter().flat_map(files_of_spinline));
    copy_all(cases.into_iter().flat_map(files), folder)
}

/// The same of a spinline.
pub fn copy_of_spinline(spinline: &Spinline, folder: &Path) -> Result<BTreeMap<PathBuf, PathBuf>, Failure> {
    copy_all(files_of_spinline(spinline).into_iter(), folder)
}

fn copy_all<'a>(
    files: impl Iterator<Item = FileWithParts<'a>>,
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

/// The case with the paths of the copied files.
pub fn relocated(case: &Case, copied: &BTreeMap<PathBuf, PathBuf>) -> Case {
    let place = |file: &Path| copied.get(file).cloned().unwrap_or_else(|| file.to_owned());
    let spinline = case.spinline.as_ref().map(|spinline| relocated_spinline(spinline, copied));
    Case { air: case.air.with_files_at(place), spinline, ..case.clone() }
}

/// The same of a spinline.
pub fn relocated_spinline(spinline: &Spinline, copied: &BTreeMap<PathBuf, PathBuf>) -> Spinline {
    fn moved<T>(file: &FromFile<T>, copied: &BTreeMap<PathBuf, PathBuf>) -> FromFile<T> {
        file.moved_to(copied.get(file.path()).cloned().unwrap_or_else(|| file.path().to_owned()))
    }
    let mut spinline = spinline.clone();
    if let PolymerSource::File(file) = &mut spinline.polymer {
        *file = moved(file, copied);
    }
    if let Surroundings::Table(table) = &mut spinline.air {
        *table = moved(table, copied);
    }
    spinline
}

/// The files that a spinline names: constants of a polymer, air along the line.
fn files_of_spinline(spinline: &Spinline) -> Vec<FileWithParts<'_>> {
    let polymer = match &spinline.polymer {
        PolymerSource::Known(_) => None,
        PolymerSource::File(file) => Some((file.path(), file.parts())),
    };
    let air = match &spinline.air {
        Surroundings::Table(table) => Some((table.path(), table.parts())),
        Surroundings::Uniform(_) | Surroundings::Field { .. } | Surroundings::Behind(_) => None,
    };
    polymer.into_iter().chain(air).collect()
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
