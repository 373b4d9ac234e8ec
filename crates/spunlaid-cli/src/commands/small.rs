//! `spunlaid new` and `spunlaid completions`.

use super::stem;
use crate::args::{Arguments, Completions, Man, New, is_standard};
use crate::failure::Failure;
use crate::say;
use clap::builder::PossibleValuesParser;
use clap::{Arg, CommandFactory};
use clap_complete::Shell;
use spunlaid::case::keys;
use spunlaid::error::{Error, Fault};
use spunlaid::input::{WEB_KEYS, starter_case, starter_case_of_fed, starter_study};
use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Writes a commented case to start from, or a study of one. It never overwrites a file.
pub(crate) fn new(new: &New) -> Result<(), Failure> {
    let path = &new.file;
    let case = if new.fed { starter_case_of_fed() } else { starter_case() };
    if new.study {
        return new_study(path, case);
    }
    if is_standard(path) {
        say::text(case);
        return Ok(());
    }
    write_new(path, case)?;
    say::line(&format!("wrote {}; change it, then: spunlaid run {}", path.display(), path.display()));
    Ok(())
}

/// Writes a study beside the file that it varies.
fn new_study(path: &Path, case: &str) -> Result<(), Failure> {
    if is_standard(path) {
        let fault = Fault::new(
            "is standard output, and a study stands beside the file that it varies",
            "name a file",
        );
        return Err(Error::folder(path, fault).into());
    }
    let study = path.with_file_name(format!("{}_study.toml", stem(path, "case").to_string_lossy()));
    let (base, shown) = (path.display(), study.display());
    let is_there = path.exists();
    if is_there {
        write_new(&study, &starter_study(path)?)?;
    } else {
        write_new(path, case)?;
        write_new(&study, &starter_study(path)?)?;
        say::line(&format!("wrote {base}"));
    }
    say::line(&format!("wrote {shown}, which varies {base}; change it, then: spunlaid sweep {shown}"));
    Ok(())
}

/// Writes a file that is not there yet.
fn write_new(path: &Path, text: &str) -> Result<(), Failure> {
    let written = OpenOptions::new().write(true).create_new(true).open(path).and_then(|mut file| {
        file.write_all(text.as_bytes()).inspect_err(|_| {
            let _ = std::fs::remove_file(path);
        })
    });
    match written {
        Ok(()) => Ok(()),
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

/// Prints a completion script. Only in the script, options that take keys take the known ones and nothing else.
pub(crate) fn completions(completions: &Completions) -> Result<(), Failure> {
    let mut script = Vec::new();
    let mut command = Arguments::command();
    let names: Vec<String> = command.get_subcommands().map(|sub| sub.get_name().to_owned()).collect();
    for name in names {
        command = command.mut_subcommand(&name, |sub| sub.mut_args(|arg| with_keys(&name, arg)));
    }
    clap_complete::generate(completions.shell, &mut command, "spunlaid", &mut script);
    say::text(&String::from_utf8_lossy(&script));
    if completions.shell == Shell::Bash {
        say::text(NO_SPACE);
    }
    Ok(())
}

/// In Bash: no space follows the `=` of a key, so that its value can.
const NO_SPACE: &str = "
_spunlaid_and_keys() {
    _spunlaid \"$@\"
    if [[ ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} == *= ]]; then
        compopt -o nospace
    fi
}
complete -F _spunlaid_and_keys -o bashdefault -o default spunlaid
";

/// An argument of a command that takes keys, with all of them as its values.
fn with_keys(command: &str, arg: Arg) -> Arg {
    let of_case = keys::all().iter().map(|key| key.name);
    let of_web = WEB_KEYS.iter().map(|key| key.name);
    let known: Vec<&str> = match command {
        "run" | "check" | "air" => of_case.collect(),
        "spin" => of_case.filter(|key| key.starts_with("spinline.") || key.starts_with("drag.")).collect(),
        _ => of_web.chain(of_case).collect(),
    };
    match (command, arg.get_id().as_str()) {
        (_, "set") => {
            arg.value_parser(PossibleValuesParser::new(known.iter().map(|key| &*format!("{key}=").leak())))
        }
        ("keys", "pattern") => arg.value_parser(PossibleValuesParser::new(known)),
        _ => arg,
    }
}

/// Writes a manual page for each command.
pub(crate) fn man(man: &Man) -> Result<(), Failure> {
    let folder = &man.folder;
    let written =
        fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(Arguments::command(), folder));
    written.map_err(Error::unwritable(folder))?;
    say::line(&format!("wrote the manual pages to {}; man spunlaid shows the first", folder.display()));
    Ok(())
}
