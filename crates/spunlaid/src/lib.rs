//! Simulator of fibres in turbulent air, for the spunbonding of nonwovens.
//!
//! The data goes through these stages:
//!
//! case file → [`case::Case`] (validated, SI) → fibres packed in [`lanes`] → step by step → observers →
//! statistics → files
//!
//! This crate does everything from the case file to the statistics; the program `spunlaid` writes the files. In
//! short, the program does this:
//!
//! ```
//! use spunlaid::ensemble::{RunControl, Keep, Results, fly};
//! use spunlaid::error::Error;
//! use spunlaid::input::{parse_case, starter_case};
//! use spunlaid::lanes::Isa;
//! use std::sync::atomic::{AtomicBool, AtomicU64};
//!
//! # fn main() -> Result<(), Error> {
//! let changes = [("run.duration", "0.1 s"), ("run.time_step", "20 µs"), ("run.replicates", "4")];
//! let changes = changes.map(|(key, value)| (key.to_owned(), value.to_owned()));
//! let (stop, progress) = (AtomicBool::new(false), AtomicU64::new(0));
//! let computing = RunControl { threads: 2, isa: Isa::detect(), stop: &stop, fibre_steps: &progress, recorder: None };
//! // No reader flies fibres. `Resources::settle` flies for a spinline that ends at the tension of its fibre.
//! let (case, _notes) = parse_case(starter_case(), "starter.toml", &changes)?;
//!
//! let mut results = Results::collector(0);
//! fly::<Error>(&case, Keep::NUMBERS, computing, |flight| {
//!     results.take(flight);
//!     Ok(())
//! })?;
//!
//! let results = results.finish();
//! let amplitude = results.estimate("amplitude_y");
//! println!("{:.2} ± {:.2} mm", amplitude.mean * 1e3, amplitude.standard_error.unwrap_or(0.0) * 1e3);
//! # assert!(amplitude.mean > 1e-3 && amplitude.mean < 2e-2);
//! # Ok(())
//! # }
//! ```
//!
//! [`input::read_case`] reads a file. A [`case::Case`] can also be built in code; [`case::Case::check`] then says
//! whether it can be run. Every quantity is in SI units, and its documentation gives the unit.
//!
//! Equations are cited as `theory.md (n)`. They are in `docs/theory.md` of the repository; `docs/validation.md`
//! describes the checks.
//!
//! `docs/glossary.md` explains the words, and `CONTRIBUTING.md` shows how to add a drag law, a measure, a key, a
//! reader or a case.

// Units are written in brackets, [m/s], which rustdoc would take for broken links.
#![allow(rustdoc::broken_intra_doc_links)]

// Each module imports only from the modules above it. tests/rooms.rs checks this.
// Vector instructions are unsafe to call; nothing else in the workspace is.
#[allow(unsafe_code)]
pub mod lanes;
pub mod line;
pub mod nodes;
pub mod vec3;

mod fft;
mod random;
mod sort;
pub mod units;

pub mod error;
pub mod removed;

pub mod threads;

mod company;
pub mod log;

mod file;
pub mod table;

pub mod fibre;

pub mod field;

pub mod air;
pub mod drag;

pub mod spinline;

pub mod charge;

pub mod chain;

pub mod energy;

pub mod statistics;

pub mod claim;
pub mod effects;

pub mod laydown;
pub mod surrogate;
pub mod web;

pub mod curtain;

pub mod fabric;

pub mod record;
pub mod scan;

pub mod case;

pub mod load;

pub mod flight;

pub mod observe;

pub mod ensemble;

pub mod beam;

pub mod layers;

pub mod plausible;

pub mod study;

pub mod advice;
pub mod fit;

pub mod input;
pub mod paper;
