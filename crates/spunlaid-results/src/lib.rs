//! What an engineer gets to see of results: tables, figures and reports, in folders that are written completely or not
//! at all.
//!
//! ```text
//! results of the library → figures (drawn with spunlaid-charts) → output (files of a folder)
//! → report (one page that shows all) → folders (everything of a run, of a study, of a web)
//! ```

// Units are written in brackets, [m/s], which rustdoc would take for broken links.
#![allow(rustdoc::broken_intra_doc_links)]

// Each module imports only from the modules above it. The program's tests/rooms.rs checks this.
pub mod command;
mod failure;
pub mod numbers;

mod effects;

pub mod figures;

pub mod output;

pub mod report;

pub mod folders;

pub use failure::Failure;
