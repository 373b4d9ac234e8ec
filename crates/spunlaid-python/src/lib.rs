//! The part of the Python package `spunlaid` that is written in Rust: what the library does, on NumPy's arrays. The
//! Python part, `python/spunlaid`, makes it convenient.
//!
//! ```text
//! failure   errors as exceptions        value     values of Python as those of keys
//! watched   work without the lock of the interpreter, with Ctrl-C and progress
//! save      results in a folder
//! case, run, flight, air, spinline, study, web, record, keys     the classes and functions
//! ```

// Names such as CaseError are those of Python; units are written in brackets, [m/s].
#![allow(rustdoc::broken_intra_doc_links)]

mod air;
mod failure;
mod save;
mod value;
mod watched;

mod case;
mod keys;
mod merged;
mod record;

mod fit;
mod flight;
mod results;
mod run;
mod samples;
mod scale;
mod state;

mod bundle;
mod spinline;
mod study;
mod table;
mod web;

use pyo3::prelude::*;

/// The compiled part of spunlaid. Use the package `spunlaid`.
#[pymodule]
mod _spunlaid {
    #[pymodule_export]
    use super::air::AirSampler;
    #[pymodule_export]
    use super::bundle::fly_bundle;
    #[pymodule_export]
    use super::case::Case;
    #[pymodule_export]
    use super::fit::find_fit;
    #[pymodule_export]
    use super::flight::Flight;
    #[pymodule_export]
    use super::keys::keys;
    #[pymodule_export]
    use super::record::analyse;
    #[pymodule_export]
    use super::results::RunResults;
    #[pymodule_export]
    use super::run::{fly, measures};
    #[pymodule_export]
    use super::save::check_figures;
    #[pymodule_export]
    use super::spinline::{SolvedSpinline, solve_spinline};
    #[pymodule_export]
    use super::state::flown_from;
    #[pymodule_export]
    use super::study::Study;
    #[pymodule_export]
    use super::table::read_table;
    #[pymodule_export]
    use super::web::{LaidWeb, lay_web};
    use super::{Bound, PyModule, PyModuleMethods, PyResult};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        super::case::Case::register(module.py())?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
