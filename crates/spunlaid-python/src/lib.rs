//! The part of the Python package `spunlaid` that is written in Rust: what the library does, on NumPy's arrays. The
//! Python part, `python/spunlaid`, makes it convenient.
//!
//! ```text
//! failure   errors as exceptions        value     values of Python as those of keys
//! watched   work without the lock of the interpreter, with Ctrl-C and progress
//! warning   what the program prints as a warning, as one of Python
//! save      figures as asked for        source    the file that a user names
//! computed  results of a run, a web, a scan, a spinline, a comparison, which are what goes into their folder
//! case, run, flight, air, study, web, scan, record, fit, keys     the other classes and functions
//! ```

// Names such as CaseError are those of Python; units are written in brackets, [m/s].
#![allow(rustdoc::broken_intra_doc_links)]

mod air;
mod failure;
mod save;
mod source;
mod value;
mod warning;
mod watched;

mod case;
mod keys;
mod record;

mod fit;
mod flight;
mod run;

mod bundle;
mod computed;
mod scan;
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
        computed::{Computed, compare_folders, copy_results, find_drag_factor, solve_spinline},
        fit::find_fit,
        flight::Flight,
        keys::{column_unit, keys, measures, program},
        record::analyse,
        run::fly,
        save::check_figures,
        scan::{analyse_scan, is_scan},
        study::Study,
        table::read_table,
        web::{lay_web, patch_numbers},
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        super::case::Case::register(module.py())?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
