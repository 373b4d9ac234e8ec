//! `spunlaid completions` and `spunlaid man`.

use crate::args::{Arguments, Completions, Man};
use crate::failure::Failure;
use crate::say;
use clap::builder::PossibleValuesParser;
use clap::{Arg, CommandFactory};
use clap_complete::Shell;
use spunlaid::fibre::case::keys;
use spunlaid::ground::Error;
use spunlaid::input::WEB_KEYS;
use std::fs;

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
