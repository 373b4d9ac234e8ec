//! What an engineer gets to see of results: tables, figures and reports, in folders that are written completely or not
//! at all.
//!
//! ```text
//! figures, files, page, folders – what all reports share: charts with spunlaid-charts, files of a folder,
//!   a page, and the one way in which a folder is written
//! reports – each has its figures, files, report and folder
//! ```

// Units are written in brackets, [m/s], which rustdoc would take for broken links.
#![allow(rustdoc::broken_intra_doc_links)]

// Each module imports only from the modules above it.
pub mod command;
mod failure;
pub mod numbers;

mod effects;

mod figures;

pub mod files;

pub mod page;

pub mod folders;

pub mod reports;

pub use failure::Failure;
