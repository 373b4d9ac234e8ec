//! Single files that a command writes.

use spunlaid::ground::{Error, Fault};
use std::fs::{OpenOptions, remove_file};
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Whether a single file can be written there, before anything is computed for it. One that is there already is
/// replaced with `--force` only.
///
/// * `option` – that names the file
pub(crate) fn check_file(file: &Path, option: &str, force: bool) -> Result<(), Error> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    let fault = if folder.is_some_and(|folder| !folder.is_dir()) {
        Fault::new("lies in a folder that is not there", "name another file, or make the folder")
            .option(option.to_owned())
    } else if file.is_dir() {
        Fault::new("is a folder", "name a file").option(option.to_owned())
    } else if file.exists() && !force {
        Fault::new("is there already", "name another file, or replace it")
            .option(format!("{option}, --force"))
    } else {
        return Ok(());
    };
    Err(Error::folder(file, fault))
}

/// Writes a file that does not exist yet.
pub(crate) fn write_new(path: &Path, text: &str) -> Result<(), Error> {
    let written = OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(path)
        .and_then(|mut file| file.write_all(text.as_bytes()).inspect_err(|_| drop(remove_file(path))));
    let fault = |message: String| Fault::new(message, "name another file");
    written.map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => {
            Error::folder(path, fault("exists already and is not overwritten".to_owned()))
        }
        _ => Error::system(path, fault(format!("cannot be written: {error}"))),
    })
}
