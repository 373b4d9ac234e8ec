//! The program `spunlaid`: arguments, progress, files, figures, report. It is a library so that a wheel for Python,
//! which holds one compiled file only, has the program too; `main.rs` is the program itself.

mod args;
mod commands;
mod control;
mod delivery;
mod failure;
mod file;
mod progress;
mod say;

use args::{Arguments, Command, Invocation};
use clap::{CommandFactory, FromArgMatches};
use failure::Failure;
use spunlaid::ground::{Error, Fault};
use std::ffi::OsString;
use std::io::Write as _;
use std::path::Path;

/// Does what a command line asks for, and says on standard output and standard error what the program says.
///
/// * `words` – the command line; the first word is the name of the program
///
/// Returns the exit code: 0, 1 if the input is wrong, 130 if interrupted, 2 otherwise.
pub fn main(words: impl IntoIterator<Item = OsString>) -> u8 {
    outlive_the_file_size_limit();
    let code = dispatch(words);
    // A program does this as it ends, but whoever calls this function may go on. What could not be written is reported.
    let _ = std::io::stdout().flush();
    code
}

/// A file beyond the limit of its size (`ulimit -f`) shall be an error like any other, and not a signal that ends the
/// program without a word.
fn outlive_the_file_size_limit() {
    // Without the handler, the program ends there and leaves its hidden folder behind.
    #[cfg(unix)]
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, std::sync::Arc::default());
}

fn dispatch(words: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    let (invocation, arguments) = match parse(&words) {
        Ok(parsed) => parsed,
        Err(error) => {
            // Help and version are not errors; everything else is wrong input.
            drop(error.print());
            return u8::from(error.use_stderr());
        }
    };
    let done = Failure::catch_panic(|| perform(&arguments.command, &invocation));
    let done = done.and_then(|()| say::lost().map_or(Ok(()), |why| Err(output_failure(why))));
    match done {
        Ok(()) => 0,
        Err(failure) => {
            say::error(&failure);
            failure.exit_code()
        }
    }
}

/// The same program, whose options take numbers below zero as values, so that the message is that of the value.
fn with_negative_numbers(program: clap::Command) -> clap::Command {
    let takes_values = |argument: &clap::Arg| argument.get_action().takes_values();
    program.mut_subcommands(|command| {
        command.mut_args(|argument| match takes_values(&argument) {
            true => argument.allow_negative_numbers(true),
            false => argument,
        })
    })
}

/// The command of a command line.
fn parse(words: &[OsString]) -> Result<(Invocation, Arguments), clap::Error> {
    let matches = with_negative_numbers(Arguments::command()).try_get_matches_from(words)?;
    Ok((Invocation::new(&matches, words), Arguments::from_arg_matches(&matches)?))
}

fn perform(command: &Command, invocation: &Invocation) -> Result<(), Failure> {
    match command {
        Command::Run(run) => commands::run::run(run, invocation),
        Command::Sweep(sweep) => commands::sweep::sweep(sweep, invocation),
        Command::Spin(spin) => commands::spin::spin(spin, invocation),
        Command::Web(web) => commands::web::web(web, invocation),
        Command::Fit(fit) => commands::fit::fit(fit, invocation),
        Command::Air(air) => commands::air::air(air, invocation),
        Command::Live(live) => commands::live::live(live),
        Command::Reproduce(arguments) => commands::reproduce::reproduce(arguments, invocation),
        Command::Analyse(analyse) => commands::analyse::analyse(analyse, invocation),
        Command::Compare(compare) => commands::compare::compare(compare, invocation),
        Command::Check(check) => commands::check::check(check),
        Command::Keys(keys) => commands::keys::keys(keys),
        Command::New(new) => commands::new::new(new, invocation),
        Command::Completions(completions) => commands::completions::completions(completions),
        Command::Man(man) => commands::completions::man(man),
    }
}

/// Performs a command as if it had been written.
fn perform_words(words: &[OsString]) -> Result<(), Failure> {
    let parsed = parse(words).map_err(|error| Fault::plain(error.to_string()))?;
    perform(&parsed.1.command, &parsed.0)
}

/// Standard output cannot be written.
fn output_failure(why: &std::io::Error) -> Failure {
    let fault = Fault::new(format!("cannot be written: {why}"), "everything else is done");
    Error::system(Path::new("standard output"), fault).into()
}
