//! `spunlaid new`: writes a file to start from. It never overwrites one.

mod ask;
mod line;

use crate::args::{New, is_standard};
use crate::failure::Failure;
use crate::say;
use ask::complete;
use line::NewLine;
use spunlaid::ground::{Error, Fault};
use spunlaid::input::{read_web, starter_case, starter_case_of_fed, starter_study};
use std::fs::{OpenOptions, remove_file};
use std::io::{ErrorKind, Write, stdin};
use std::path::{Path, PathBuf};

pub(crate) fn new(new: &New) -> Result<(), Failure> {
    let path = &new.file;
    if new.web {
        return web(new);
    }
    let case = if new.fed { starter_case_of_fed() } else { starter_case() };
    if new.study {
        return study(path, case);
    }
    if is_standard(path) {
        say::text(case);
        return Ok(());
    }
    write(path, case)?;
    say::line(&format!("wrote {}; change it, then: spunlaid run {}", path.display(), path.display()));
    Ok(())
}

/// Writes the file of a line, and the table of its air.
fn web(new: &New) -> Result<(), Failure> {
    let numbers = complete(new.line.clone(), &mut stdin().lock())?;
    numbers.remarks().for_each(|remark| say::remark(false, &remark));
    let line = NewLine::new(&numbers)?;
    let path = &new.file;
    need_file(path, "a web is written with the table of its air beside it")?;
    let name = super::stem(path, "line");
    let air = format!("{name}_air.csv");
    let files = [(path.with_file_name(&air), line.air()), (path.clone(), line.file(&name, &air))];
    let mut written: Vec<&PathBuf> = Vec::new();
    let done = files.iter().try_for_each(|(path, text)| {
        write(path, text)?;
        written.push(path);
        Ok(())
    });
    // What is written can be laid, or nothing is written.
    let read = done.and_then(|()| read_web(path, &[]).map_err(Failure::from));
    if let Err(failure) = read {
        for path in written {
            let _ = remove_file(path);
        }
        return Err(failure);
    }
    line.warnings().iter().for_each(|warning| say::warning(warning));
    let path = path.display();
    say::line(&format!(
        "wrote {path} and {air}; change them, then: spunlaid check {path}, spunlaid web {path}"
    ));
    Ok(())
}

/// Writes a study beside the file that it varies.
fn study(path: &Path, case: &str) -> Result<(), Failure> {
    need_file(path, "a study stands beside the file that it varies")?;
    let study = path.with_file_name(format!("{}_study.toml", super::stem(path, "case")));
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

/// Refuses standard output where a file is needed.
fn need_file(path: &Path, why: &str) -> Result<(), Failure> {
    if is_standard(path) {
        let fault = Fault::new(format!("is standard output, and {why}"), "name a file");
        return Err(Error::folder(path, fault).into());
    }
    Ok(())
}

/// Writes a file that does not exist yet.
fn write(path: &Path, text: &str) -> Result<(), Failure> {
    let written = OpenOptions::new().write(true).create_new(true).open(path).and_then(|mut file| {
        file.write_all(text.as_bytes()).inspect_err(|_| {
            let _ = remove_file(path);
        })
    });
    let fault = |message: String| Fault::new(message, "name another file");
    written.map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => {
            Error::folder(path, fault("exists already and is not overwritten".to_owned())).into()
        }
        _ => Error::system(path, fault(format!("cannot be written: {error}"))).into(),
    })
}
