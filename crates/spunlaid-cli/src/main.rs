//! The program `spunlaid`: arguments, progress, files, figures, report.

mod args;
mod commands;
mod failure;
mod progress;
mod say;

use args::{Arguments, Command, Invocation};
use clap::{CommandFactory, FromArgMatches};
use failure::Failure;
use spunlaid::error::{Error, Fault};
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let parsed = Arguments::command()
        .try_get_matches()
        .and_then(|matches| Ok((Invocation::new(&matches), Arguments::from_arg_matches(&matches)?)));
    let (invocation, arguments) = match parsed {
        Ok(parsed) => parsed,
        Err(error) => {
            // Help and version are not errors; everything else is wrong input.
            let code = u8::from(error.use_stderr());
            let _ = error.print();
            return ExitCode::from(code);
        }
    };
    let done = Failure::catch_panic(|| match arguments.command {
        Command::Run(run) => commands::run::run(&run, &invocation),
        Command::Sweep(sweep) => commands::sweep::sweep(&sweep, &invocation),
        Command::Spin(spin) => commands::spin::spin(&spin, &invocation),
        Command::Web(web) => commands::web::web(&web, &invocation),
        Command::Fit(fit) => commands::fit::fit(&fit, &invocation),
        Command::Air(air) => commands::air::air(&air, &invocation),
        Command::Live(live) => commands::live::live(&live),
        Command::Reproduce(arguments) => commands::reproduce::reproduce(&arguments, &invocation),
        Command::Analyse(analyse) => commands::analyse::analyse(&analyse, &invocation),
        Command::Compare(compare) => commands::compare::compare(&compare, &invocation),
        Command::Check(check) => commands::check::check(&check),
        Command::Keys(keys) => commands::keys::keys(&keys),
        Command::New(new) => commands::new::new(&new),
        Command::Completions(completions) => commands::completions::completions(&completions),
        Command::Man(man) => commands::man::man(&man),
    });
    let done = done.and_then(|()| say::lost().map_or(Ok(()), |why| Err(output_failure(why))));
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            say::error(&failure);
            ExitCode::from(failure.exit_code())
        }
    }
}

/// Standard output cannot be written.
fn output_failure(why: &std::io::Error) -> Failure {
    let fault = Fault::new(format!("cannot be written: {why}"), "everything else is done");
    Error::system(Path::new("standard output"), fault).into()
}
