//! `spunlaid completions`.

use crate::args::{Arguments, Completions};
use crate::failure::Failure;
use crate::say;
use clap::CommandFactory;

/// Prints a completion script.
pub(crate) fn completions(completions: &Completions) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(completions.shell, &mut Arguments::command(), "spunlaid", &mut script);
    say::text(&String::from_utf8_lossy(&script));
    Ok(())
}
