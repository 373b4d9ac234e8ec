//! Puts new results in the place of earlier ones, so that one of both is whole whatever happens.
//!
//! ```text
//! mark OUT   the earlier entries move from the folder to staging/old; who finds this mark moves them back
//! mark IN    the new entries move from staging/new to the folder; who finds this mark moves the rest
//! no mark    all is done, and what is left of the staging folder may be removed
//! ```

use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Folders in the staging folder: the new results, and the earlier ones while they are replaced.
pub(super) const NEW: &str = "new";
const OLD: &str = "old";
/// The marks.
const OUT: &str = "moving-out";
const IN: &str = "moving-in";
/// The hidden list of a results folder: its files, so that those of others in the same folders are known.
pub(crate) const LIST: &str = ".spunlaid-files";

/// Files that mark the results of any command, and the journal that studies of webs had before they were like
/// all others.
pub(crate) const MARKS: &[&str] = &[
    "summary.json",
    "analysis.json",
    "results.csv",
    "comparison.json",
    "fit.json",
    "trials.csv",
    "study.toml",
    "webs.jsonl",
];

/// Puts new results that are complete into their folder. If it exists, the staging folder lies in it: earlier results
/// go, and files of others in their folders stay. If this fails, the earlier results are back, or the mark stays, and
/// with it the staging folder.
///
/// * `entries` – names of results that go
/// * `all` – whether all others go too that the folder's list has
pub(super) fn publish(staging: &Path, folder: &Path, entries: &[&str], all: bool) -> io::Result<()> {
    let [new, old] = [NEW, OLD].map(|name| staging.join(name));
    let listed = listed(folder).unwrap_or_default();
    let mut out = names(&new)?;
    out.extend(entries.iter().map(OsString::from));
    let top = |file: &PathBuf| file.iter().next().map(OsStr::to_owned);
    if all {
        out.extend(listed.iter().filter_map(top));
    }
    let stays = |file: &PathBuf| {
        top(file).is_some_and(|top| !out.contains(&top)) && folder.join(file).symlink_metadata().is_ok()
    };
    list(&new, listed.into_iter().filter(stays))?;
    out.insert(LIST.into());
    sync(&new)?;
    if !folder.exists() {
        rename(&new, folder)?;
        sync_folder(folder.parent());
        return Ok(());
    }
    fs::create_dir(&old)?;
    File::create(staging.join(OUT))?;
    let moved_out = move_all(folder, &old, &last_marks_first(out));
    let moved_in = moved_out
        .and_then(|()| rename(&staging.join(OUT), &staging.join(IN)))
        .and_then(|()| move_all(&new, folder, &marks_last(names(&new)?)));
    match moved_in {
        Ok(()) => finish(staging),
        Err(error) => {
            // What cannot be moved back stays whole where it is, with its mark.
            let _ = back(staging, [&new, &old], folder);
            Err(error)
        }
    }
}

/// After a failure, all that was moved is back where it was, or a part of the way is left with its mark.
fn back(staging: &Path, [new, old]: [&Path; 2], folder: &Path) -> io::Result<()> {
    let is_back = fs::read_dir(new)?.next().is_some();
    if staging.join(IN).exists() && is_back {
        rename(&staging.join(IN), &staging.join(OUT))?;
        move_all(old, folder, &marks_last(names(old)?))?;
    }
    finish(staging)
}

/// Whether a staging folder has a mark, so that it must not be removed.
pub(super) fn is_unfinished(staging: &Path) -> bool {
    [OUT, IN].iter().any(|mark| staging.join(mark).exists())
}

/// Goes on with what a staging folder is marked with, and takes the mark away.
///
/// # Errors
/// If the system refuses; nothing is lost then.
pub(super) fn finish(staging: &Path) -> io::Result<()> {
    let folder = staging.parent().unwrap_or(Path::new("."));
    let [new, old] = [NEW, OLD].map(|name| staging.join(name));
    let mark = [OUT, IN].map(|mark| staging.join(mark)).into_iter().find(|mark| mark.exists());
    let Some(mark) = mark else { return Ok(()) };
    if mark.ends_with(IN) {
        move_all(&new, folder, &marks_last(names(&new)?))?;
        keep_others(&old, folder, names(&old)?)?;
    } else {
        move_all(&old, folder, &marks_last(names(&old)?))?;
    }
    sync_folder(Some(folder));
    fs::remove_file(mark)
}

/// Lists all files of new results.
///
/// * `others` – files of the folder that are listed too
fn list(new: &Path, others: impl Iterator<Item = PathBuf>) -> io::Result<()> {
    let mut all: Vec<PathBuf> = others.collect();
    files(new, Path::new(""), &mut all)?;
    all.sort_unstable();
    let text: String = all.iter().map(|file| format!("{}\n", file.display())).collect();
    fs::write(new.join(LIST), text)
}

/// The files that the list of a results folder names; none without a list.
fn listed(folder: &Path) -> Option<BTreeSet<PathBuf>> {
    let text = fs::read_to_string(folder.join(LIST)).ok()?;
    Some(text.lines().map(PathBuf::from).collect())
}

/// Adds a file that is written later to the list, if there is one.
pub(super) fn add_to_list(folder: &Path, file: &str) -> io::Result<()> {
    use io::Write;
    if listed(folder).is_none_or(|all| all.contains(Path::new(file))) {
        return Ok(());
    }
    File::options().append(true).open(folder.join(LIST))?.write_all(format!("{file}\n").as_bytes())
}

/// Moves files of others out of folders of earlier results, to the same places of another folder.
///
/// * `names` – of the folders
pub(crate) fn keep_others<N: AsRef<Path>>(
    old: &Path,
    folder: &Path,
    names: impl IntoIterator<Item = N>,
) -> io::Result<()> {
    let Some(own) = listed(old) else { return Ok(()) };
    let mut all = Vec::new();
    for name in names.into_iter().filter(|name| old.join(name).is_dir()) {
        files(old, name.as_ref(), &mut all)?;
    }
    for file in all.iter().filter(|file| !own.contains(*file)) {
        let mut to = folder.join(file);
        while to.symlink_metadata().is_ok() {
            let name = to.file_name().unwrap_or_default().to_string_lossy().into_owned();
            to.set_file_name(format!("yours-{name}"));
        }
        to.parent().map_or(Ok(()), fs::create_dir_all)?;
        rename(&old.join(file), &to)?;
    }
    Ok(())
}

/// Copies all files below a folder, but for hidden ones of a process that writes there.
pub(super) fn copy(from: &Path, to: &Path) -> io::Result<()> {
    let mut all = Vec::new();
    files(from, Path::new(""), &mut all)?;
    let is_hidden = |file: &PathBuf| file.iter().any(|part| part.to_string_lossy().starts_with(".spunlaid-"));
    for file in all.iter().filter(|file| !is_hidden(file)) {
        let to = to.join(file);
        to.parent().map_or(Ok(()), fs::create_dir_all)?;
        fs::copy(from.join(file), &to)?;
    }
    Ok(())
}

/// All files below a folder, as paths from it.
fn files(folder: &Path, below: &Path, all: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder.join(below))? {
        let entry = entry?;
        let path = below.join(entry.file_name());
        if entry.file_type()?.is_dir() { files(folder, &path, all)? } else { all.push(path) }
    }
    Ok(())
}

/// Writes all that is in a folder to the disk.
fn sync(folder: &Path) -> io::Result<()> {
    let mut all = Vec::new();
    files(folder, Path::new(""), &mut all)?;
    for file in all.iter().map(|file| folder.join(file)).filter(|file| !file.is_symlink()) {
        // A file that may not be written is not one that was written now.
        File::options().append(true).open(file).map_or(Ok(()), |file| file.sync_all())?;
    }
    sync_folder(Some(folder));
    Ok(())
}

/// Some systems cannot sync a folder, so an error is ignored.
fn sync_folder(folder: Option<&Path>) {
    let _ = folder.map(File::open).and_then(Result::ok).map(|folder| folder.sync_all());
}

fn names(folder: &Path) -> io::Result<BTreeSet<OsString>> {
    fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.file_name())).collect()
}

/// The names, with those last that mark results as complete.
fn marks_last(names: BTreeSet<OsString>) -> Vec<OsString> {
    let is_mark = |name: &OsString| MARKS.iter().any(|mark| OsStr::new(mark) == name);
    let (marks, mut all): (Vec<OsString>, Vec<OsString>) = names.into_iter().partition(is_mark);
    all.extend(marks);
    all
}

fn last_marks_first(names: BTreeSet<OsString>) -> Vec<OsString> {
    let mut all = marks_last(names);
    all.reverse();
    all
}

/// Moves entries, those that are there. If one cannot be moved, the others are moved back as far as that is possible.
fn move_all(from: &Path, to: &Path, names: &[OsString]) -> io::Result<()> {
    let is_there = |path: &Path| path.symlink_metadata().is_ok();
    let mut moved: Vec<&OsString> = Vec::new();
    for name in names.iter().filter(|name| is_there(&from.join(name))) {
        let step = match is_there(&to.join(name)) {
            true => Err(io::Error::from(io::ErrorKind::AlreadyExists)),
            false => rename(&from.join(name), &to.join(name)),
        };
        if let Err(error) = step {
            for name in moved.iter().rev() {
                rename(&to.join(name), &from.join(name))?;
            }
            return Err(error);
        }
        moved.push(name);
    }
    Ok(())
}

/// Renames a file or a folder. Tests may have it refused.
fn rename(from: &Path, to: &Path) -> io::Result<()> {
    #[cfg(test)]
    refused::refuse_or_count()?;
    fs::rename(from, to)
}

/// Which of the next renames of a thread are refused.
#[cfg(test)]
pub(super) mod refused {
    use std::cell::Cell;
    use std::io;
    use std::ops::Range;

    thread_local! {
        /// Renames so far, and those that are refused.
        static RENAMES: Cell<usize> = const { Cell::new(0) };
        static REFUSED: Cell<(usize, usize)> = const { Cell::new((0, 0)) };
    }

    pub(crate) fn refuse(renames: Range<usize>) {
        RENAMES.set(0);
        REFUSED.set((renames.start, renames.end));
    }

    pub(super) fn refuse_or_count() -> io::Result<()> {
        let number = RENAMES.replace(RENAMES.get() + 1);
        let (first, last) = REFUSED.get();
        if (first..last).contains(&number) { Err(io::ErrorKind::PermissionDenied.into()) } else { Ok(()) }
    }
}
