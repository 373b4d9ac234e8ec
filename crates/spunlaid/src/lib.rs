//! Simulator of fibres in turbulent air, for the spunbonding of nonwovens.
//!
//! The library is made of crates, which are its modules. Each depends only on those above it:
//!
//! | module | contents |
//! |---|---|
//! | [`ground`] | numbers in lanes, units, errors, tables, statistics, measures |
//! | [`air`] | CFD fields (the crate [`spunlaid-field`](spunlaid_field)), hot-wire records, turbulence |
//! | [`fibre`] | one fibre: spinline, chain, forces, the checked [`Case`](fibre::case::Case), its flight |
//! | [`web`] | curves on the belt, the map of a web, the fabric, scans |
//! | [`simulation`] | ensembles, filaments in shared turbulence, and what is measured |
//! | [`experiment`] | studies, advice, the fit of settings to a scan |
//! | [`input`] | files of cases, webs and studies |
//!
//! The crate of a module is called `spunlaid-` and its name. Depend on `spunlaid`: the interfaces of those crates may
//! change with any version.
//!
//! The library does everything from the case file to the statistics; the program `spunlaid` writes the files. In
//! short, the program does this:
//!
//! ```
//! use spunlaid::simulation::ensemble::{Recorded, Results, fly};
//! use spunlaid::ground::error::Error;
//! use spunlaid::input::{read_case, starter_case};
//! use spunlaid::ground::{RunContext, Isa};
//! use std::sync::atomic::{AtomicBool, AtomicU64};
//!
//! # fn main() -> Result<(), Error> {
//! let changes = [("run.duration", "0.1 s"), ("run.time_step", "20 µs"), ("run.replicates", "4")];
//! let changes = changes.map(|(key, value)| (key.to_owned(), value.to_owned()));
//! let (stop, progress) = (AtomicBool::new(false), AtomicU64::new(0));
//! let computing = RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &progress };
//! // No reader flies fibres. `Resources::resolve_tension` flies for a spinline that ends at the tension of its fibre.
//! let (case, _notes) = read_case((starter_case(), "starter.toml"), &changes)?;
//!
//! let mut results = Results::collector(0);
//! fly::<Error>(&case, Recorded::NUMBERS, computing, |flight| {
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
//! A program of its own may advance a flight of up to eight fibres and look at it whenever it likes:
//!
//! ```
//! use spunlaid::fibre::flight::{Flight, Job};
//! use spunlaid::input::{read_case, starter_case};
//! use spunlaid::ground::lanes::Isa;
//!
//! # fn main() -> Result<(), spunlaid::ground::error::Error> {
//! let (case, _notes) = read_case((starter_case(), "starter.toml"), &[])?;
//! let jobs = [0, 1, 2].map(|replicate| Job::new(&case, replicate));
//! let mut flight = Flight::new(&jobs, Isa::detect())?;
//! flight.step_to(0.01)?;
//! let end = flight.snapshot().position.last().map(|end| end.lane(2));
//! # assert!(end.is_some_and(|end| end.norm().is_finite()));
//! # Ok(())
//! # }
//! ```
//!
//! [`input::read_case`] reads a file. A [`Case`](fibre::case::Case) can also be built in code;
//! [`Case::check`](fibre::case::Case::check) then says whether it can be run. Every quantity is in SI units, and its
//! documentation gives the unit.
//!
//! Equations are cited as `theory.md (n)`. They are in `docs/theory.md` of the repository; `docs/validation.md`
//! describes the checks.
//!
//! `docs/glossary.md` explains the words, and `CONTRIBUTING.md` shows how to add a drag law, a measure, a key, a
//! reader or a case.

// Units are written in brackets, [m/s], which rustdoc would take for broken links.
#![allow(rustdoc::broken_intra_doc_links)]

pub extern crate spunlaid_ground as ground;

pub use spunlaid_air as air;
pub use spunlaid_experiment as experiment;
pub use spunlaid_fibre as fibre;
pub use spunlaid_input as input;
pub use spunlaid_simulation as simulation;
pub use spunlaid_web as web;
