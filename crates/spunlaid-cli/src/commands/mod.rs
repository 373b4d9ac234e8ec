//! The commands of the program.

pub(crate) mod air;
pub(crate) mod analyse;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod completions;
mod delivery;
pub(crate) mod fit;
mod flown;
pub(crate) mod keys;
pub(crate) mod live;
pub(crate) mod new;
pub(crate) mod reproduce;
pub(crate) mod run;
pub(crate) mod spin;
pub(crate) mod sweep;
pub(crate) mod web;

use crate::args::{Threads, is_standard};
use crate::say;
use spunlaid::ground::{FileKind, Isa};
use spunlaid::input::kind_of;
use spunlaid::simulation::RunControl;
use spunlaid::web::LayControl;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Largest number of points of a study that are listed.
const LISTED: usize = 24;

/// The name of a file without its extension.
fn stem(file: &Path, otherwise: &str) -> String {
    let stem = file.file_stem().filter(|_| !is_standard(file)).unwrap_or(otherwise.as_ref());
    stem.to_string_lossy().into_owned()
}

/// What results are called if nobody says it: after their file, and where that is a file of something else, after what
/// they are of, `line_fibre`. So results of several commands on one file lie beside each other.
fn name_of(file: &Path, own: FileKind, [otherwise, what]: [&str; 2]) -> String {
    let name = stem(file, otherwise);
    if is_standard(file) || kind_of(file) == own { name } else { format!("{name}_{what}") }
}

/// Installs a handler for Ctrl-C and returns the flag that it sets.
fn stop_on_ctrl_c() -> &'static AtomicBool {
    static STOP: AtomicBool = AtomicBool::new(false);
    // Without the handler, Ctrl-C still ends the program but leaves its hidden folder behind.
    let _ = ctrlc::set_handler(|| STOP.store(true, Ordering::Relaxed));
    &STOP
}

/// How fibres are flown; Ctrl-C ends it.
fn run_control(threads: Threads, fibre_steps: &AtomicU64) -> RunControl<'_> {
    let (threads, isa, stop) = (threads.number(), Isa::detect(), stop_on_ctrl_c());
    RunControl { threads, isa, stop, fibre_steps, recorder: None }
}

/// How a web is laid; Ctrl-C ends it.
fn lay_control(threads: Threads, laid: &AtomicU64) -> LayControl<'_> {
    LayControl { threads: threads.number(), isa: Isa::detect(), stop: stop_on_ctrl_c(), laid }
}

/// `1 fibre`, `2 fibres`.
fn plural(count: u64, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

/// A table whose columns stand below their heads. Columns for which the terminal is too narrow follow below,
/// beside the first column once more.
fn aligned(rows: &[Vec<String>]) -> String {
    spunlaid_results::page::aligned(rows, &[], say::room())
}
