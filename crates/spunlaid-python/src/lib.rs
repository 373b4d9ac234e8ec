//! The part of the Python package `spunlaid` that is written in Rust: what the library does, on NumPy's arrays. The
//! Python part, `python/spunlaid`, makes it convenient.
//!
//! ```text
//! failure   errors as exceptions        value     values of Python as those of keys
//! watched   work without the lock of the interpreter, with Ctrl-C and progress
//! save      results in a folder         source    the file that a user names
//! case, run, flight, air, spinline, study, web, scan, record, compare, keys     the classes and functions
//! ```

// Names such as CaseError are those of Python; units are written in brackets, [m/s].
#![allow(rustdoc::broken_intra_doc_links)]

mod air;
mod failure;
mod save;
mod source;
mod value;
mod watched;

mod case;
mod keys;
mod record;

mod fit;
mod flight;
mod run;
mod samples;

mod bundle;
mod compare;
mod scan;
mod spinline;
mod study;
mod table;
mod web;

use pyo3::prelude::*;

/// The compiled part of spunlaid. Use the package `spunlaid`.
#[pymodule]
mod _spunlaid {
    use super::{Bound, PyModule, PyModuleMethods, PyResult};
    #[pymodule_export]
    use super::{
        air::AirSampler,
        bundle::fly_bundle,
        case::Case,
        compare::{Compared, compare_folders},
        fit::find_fit,
        flight::Flight,
        keys::{keys, program, removed},
        record::analyse,
        run::{RunResults, column_unit, fly, measures},
        save::check_figures,
        scan::{AnalysedScan, analyse_scan, is_scan},
        spinline::{SolvedSpinline, solve_spinline},
        study::Study,
        table::read_table,
        web::{LaidWeb, lay_web},
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        super::case::Case::register(module.py())?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
