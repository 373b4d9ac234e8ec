//! `spunlaid new` and `spunlaid completions`.

use crate::args::{Arguments, Completions, New};
use crate::failure::Failure;
use crate::say;
use clap::CommandFactory;
use spunlaid::error::{Error, Fault};
use spunlaid::input::{starter_case, starter_case_of_fed};
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};

/// Writes a commented case to start from. It never overwrites a file.
pub(crate) fn new(new: &New) -> Result<(), Failure> {
    let path = &new.file;
    let case = if new.fed { starter_case_of_fed() } else { starter_case() };
    let written = OpenOptions::new().write(true).create_new(true).open(path).and_then(|mut file| {
        file.write_all(case.as_bytes()).inspect_err(|_| {
            let _ = std::fs::remove_file(path);
        })
    });
    match written {
        Ok(()) => {
            say::line(&format!("wrote {}; change it, then: spunlaid run {}", path.display(), path.display()));
            Ok(())
        }
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            let fault = Fault::new("exists already and is not overwritten", "name another file");
            Err(Error::folder(path, fault).into())
        }
        Err(source) => {
            let fault = Fault::new(format!("cannot be written: {source}"), "name another file");
            Err(Error::system(path, fault).into())
        }
    }
}

/// Prints a completion script.
pub(crate) fn completions(completions: &Completions) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(completions.shell, &mut Arguments::command(), "spunlaid", &mut script);
    say::text(&String::from_utf8_lossy(&script));
    Ok(())
}
