//! `spunlaid new`: writes a file to start from. It never overwrites one.

mod ask;
mod beam;
mod line;
mod melt;
mod text;

use crate::args::{Invocation, LineNumbers, New, is_standard};
use crate::failure::Failure;
use crate::file::write_new;
use crate::{perform_words, say};
use ask::ask;
use line::NewLine;
use melt::NewMelt;
use spunlaid::ground::{Error, Fault};
use spunlaid::input::{WebFile, read_web, starter_case, starter_case_of_fed, starter_study};
use std::fs::remove_file;
use std::io::stdin;
use std::path::{Path, PathBuf};

pub(crate) fn new(new: &New, invocation: &Invocation) -> Result<(), Failure> {
    let (path, shown) = (&new.file, new.file.display());
    let case = if new.fed { starter_case_of_fed() } else { starter_case() };
    if is_standard(path) && (new.web || new.study) {
        let of_web = "is standard output, and a web is written with the table of its air next to it";
        let of_study = "is standard output, and a study is written next to the file that it varies";
        let fault = Fault::new(if new.web { of_web } else { of_study }, "name a file");
        return Err(Error::folder(path, fault).into());
    }
    let answers = if new.web { ask(invocation, &mut stdin().lock())? } else { Vec::new() };
    let written = match new {
        _ if !answers.is_empty() => return perform_words(&[invocation.words(), &answers].concat()),
        New { web: true, line, .. } => web(path, line)?,
        New { study: true, .. } => study(path, case)?,
        _ if is_standard(path) => {
            say::text(case);
            return Ok(());
        }
        _ => {
            write_new(path, case)?;
            format!("wrote {shown}; change it, then: spunlaid run {shown}")
        }
    };
    say::line(&written);
    Ok(())
}

/// Writes the file of a line, and the table of its air.
fn web(path: &Path, numbers: &LineNumbers) -> Result<String, Failure> {
    numbers.remarks().for_each(|remark| say::remark(false, &remark));
    let (line, name) = (NewLine::new(numbers)?, super::stem(path, "line"));
    let mut tables: Vec<(PathBuf, String)> = Vec::new();
    let air = format!("{name}_air.csv");
    tables.push((path.with_file_name(&air), text::air(&line)));
    let melt = NewMelt::of(&line);
    let quench = format!("{name}_spinline.csv");
    tables.extend(melt.as_ref().map(|melt| (path.with_file_name(&quench), melt.air(&line))));
    let names = if melt.is_some() { format!("{air}, {quench}") } else { air.clone() };
    let mut written = Vec::new();
    // What is written can be laid and is a line as there may be, or nothing is written.
    let mut write = || -> Result<(), Failure> {
        for (table, content) in &tables {
            write_new(table, content)?;
            written.push(table);
        }
        let text = match &melt {
            Some(melt) => {
                melt.calibrated(&line, path, |spinline| text::file(&line, &name, &air, Some(spinline)))?
            }
            None => text::file(&line, &name, &air, None),
        };
        let source = (text.as_str(), &*path.display().to_string());
        read_web(source, &[]).and_then(WebFile::within_reason)?;
        Ok(write_new(path, &text)?)
    };
    write().inspect_err(|_| written.iter().for_each(|table| drop(remove_file(table))))?;
    line.warning().iter().for_each(|warning| say::warning(warning));
    let shown = path.display();
    let then = format!("spunlaid check {shown}, spunlaid web {shown}");
    Ok(format!("wrote {shown} and {names}; change them, then: {then}"))
}

/// Writes a study beside the file that it varies.
fn study(path: &Path, case: &str) -> Result<String, Failure> {
    let study = path.with_file_name(format!("{}_study.toml", super::stem(path, "case")));
    let base = path.display();
    let shown = study.display();
    let is_new = !path.exists();
    if is_new {
        write_new(path, case)?;
    }
    write_new(&study, &starter_study(path)?)?;
    let first = if is_new { format!("wrote {base}\n") } else { String::new() };
    Ok(format!("{first}wrote {shown}, which varies {base}; change it, then: spunlaid sweep {shown}"))
}
