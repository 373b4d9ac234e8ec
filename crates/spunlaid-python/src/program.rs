//! The program `spunlaid`, which comes with the package.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Does what a command line asks for, as the program `spunlaid` does, and returns its exit code.
#[pyfunction]
#[pyo3(signature = (words))]
pub(crate) fn program(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| spunlaid_cli::main(words))
}
