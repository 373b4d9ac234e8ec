//! The commands of the program.

mod air;
mod analyse;
mod check;
mod compare;
mod completions;
mod finished;
mod interrupt;
mod keys;
mod live;
mod new;
mod reproduce;
mod run;
mod scan;
mod spin;
mod sweep;
mod web;

pub(crate) use air::air;
pub(crate) use analyse::analyse;
pub(crate) use check::check;
pub(crate) use compare::compare;
pub(crate) use completions::completions;
pub(crate) use keys::keys;
pub(crate) use live::live;
pub(crate) use new::new;
pub(crate) use reproduce::reproduce;
pub(crate) use run::run;
pub(crate) use spin::spin;
pub(crate) use sweep::sweep;
pub(crate) use web::web;

use std::ffi::OsStr;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The requested number of threads, or one for each core.
fn threads(count: Option<u16>) -> usize {
    count.map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), usize::from)
}

/// The name of a file without its extension.
fn stem<'a>(file: &'a Path, otherwise: &'a str) -> &'a OsStr {
    file.file_stem().unwrap_or(otherwise.as_ref())
}

/// The requested folder, or `results/NAME`.
fn folder(out: Option<&PathBuf>, name: impl AsRef<Path>) -> PathBuf {
    out.cloned().unwrap_or_else(|| Path::new("results").join(name))
}

/// `1 fibre`, `2 fibres`.
fn plural(count: u64, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

/// A table whose columns stand below their heads.
fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let width = |i: usize| rows.iter().map(|row| row[i].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let cells: Vec<String> =
            row.iter().zip(&widths).map(|(cell, width)| format!("{cell:>width$}")).collect();
        let _ = writeln!(text, "  {}", cells.join("  "));
    }
    text
}
