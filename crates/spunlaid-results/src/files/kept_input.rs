//! What results are computed from, as it is kept in their folder with the files that it names, so that it can
//! be computed again from there.

use super::folder::{CASE_FILES, Staging};
use crate::Failure;
use spunlaid_fibre::{Case, SpinSpec};
use spunlaid_input::{WebSpec, write_case, write_spinline, write_web};
use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};

/// What results are computed from.
#[derive(Clone, Copy, Debug)]
pub enum Input<'a> {
    /// A case.
    Case(&'a Case),
    /// A web.
    Web(&'a WebSpec),
    /// A spinline.
    Spinline(&'a SpinSpec),
}

impl Input<'_> {
    /// As a file, with every default.
    pub fn text(self) -> String {
        self.text_with(Path::to_owned)
    }

    /// Writes it, and copies the files that it names. Returns its text, which names the copies.
    ///
    /// # Errors
    /// If a file cannot be copied or written.
    pub fn keep(self, staging: &Staging<'_>) -> Result<String, Failure> {
        let (name, files) = match self {
            Self::Case(case) => ("case.toml", case.files()),
            Self::Web(web) => ("web.toml", web.files()),
            Self::Spinline(spinline) => ("spinline.toml", spinline.files()),
        };
        let copied = copy(files, &staging.place(CASE_FILES).0)?;
        let place = |file: &Path| copied.get(file).cloned().unwrap_or_else(|| file.to_owned());
        let text = self.text_with(place);
        staging.write(name, &text)?;
        Ok(text)
    }

    /// * `place` – where the files are that it names
    fn text_with(self, place: impl Fn(&Path) -> PathBuf) -> String {
        match self {
            Self::Case(case) => write_case(&case.with_files_at(place)),
            Self::Web(web) => write_web(&web.with_files_at(place)),
            Self::Spinline(spinline) => write_spinline(&spinline.with_files_at(place)),
        }
    }
}

/// A file with the files that it names, relative to its folder.
type FileWithParts<'a> = (&'a Path, &'a [PathBuf]);

/// Copies files into `folder`. Returns the path of each, relative to the results folder.
pub fn copy<'a>(
    files: impl IntoIterator<Item = FileWithParts<'a>>,
    folder: &Path,
) -> Result<BTreeMap<PathBuf, PathBuf>, Failure> {
    let mut copied = BTreeMap::new();
    for (file, parts) in files {
        let Some(name) = place(file, parts, &mut copied) else { continue };
        copy_file(file, &folder.join(&name))?;
        // The parts of a list lie where it says, seen from its own folder.
        let [from, to] =
            [file, &folder.join(&name)].map(|file| file.parent().unwrap_or(Path::new("")).to_owned());
        parts.iter().try_for_each(|part| copy_file(&from.join(part), &to.join(part)))?;
    }
    Ok(copied)
}

/// The path that the copy of each file has, relative to the results folder.
pub fn places<'a>(files: impl IntoIterator<Item = FileWithParts<'a>>) -> BTreeMap<PathBuf, PathBuf> {
    let mut copied = BTreeMap::new();
    for (file, parts) in files {
        place(file, parts, &mut copied);
    }
    copied
}

/// Adds the copy of a file to those that there are. Returns its path in their folder; None if there is one already.
fn place(file: &Path, parts: &[PathBuf], copied: &mut BTreeMap<PathBuf, PathBuf>) -> Option<PathBuf> {
    if copied.contains_key(file) {
        return None;
    }
    let name = unused(file, !parts.is_empty(), copied);
    copied.insert(file.to_owned(), Path::new(CASE_FILES).join(&name));
    Some(name)
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

/// The path of the copy in its folder: the name of the file, with a number in front if another file has the
/// same name. A list gets a folder of its own, so that its parts meet no other files.
fn unused(file: &Path, is_list: bool, copied: &BTreeMap<PathBuf, PathBuf>) -> PathBuf {
    let whole = file.file_name().unwrap_or_default();
    let name = if is_list { file.file_stem().unwrap_or(whole) } else { whole }.to_string_lossy().into_owned();
    let place = Path::new(CASE_FILES);
    // Many file systems take no notice of the case of letters.
    let same = |path: &Path| {
        path.strip_prefix(place).ok().and_then(|path| path.iter().next()).map(OsStr::to_ascii_lowercase)
    };
    let taken = |name: &str| {
        copied.values().any(|path| same(path) == Some(OsString::from(name).to_ascii_lowercase()))
    };
    let numbered = (2..).map(|number| format!("{number}_{name}"));
    let name = std::iter::once(name.clone()).chain(numbered).find(|name| !taken(name)).unwrap_or(name);
    if is_list { Path::new(&name).join(whole) } else { name.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_differ_by_more_than_the_case_of_letters() {
        let place = tempfile::tempdir().unwrap();
        let files = ["a/Probe.csv", "b/probe.csv", "c/PROBE.csv"].map(|file| place.path().join(file));
        for file in &files {
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, file.to_string_lossy().as_bytes()).unwrap();
        }
        let copied =
            copy(files.iter().map(|file| (&**file, &[][..])), &place.path().join(CASE_FILES)).unwrap();
        let names = copied.values().map(|path| path.to_string_lossy().to_lowercase());
        assert_eq!(names.collect::<std::collections::BTreeSet<_>>().len(), 3, "{copied:?}");
    }
}
