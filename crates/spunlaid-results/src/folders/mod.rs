//! Whole folders of results, each written completely or not at all.
//!
//! ```text
//! air        slices of the turbulent air as VTK and moving pictures, report, summary
//! spinline   a solved spinline: the thread, figures, report, summary
//! run        flies a case: tables while it flies, then figures, shapes, report, summary
//! study      the folder of a study: its journal, and what is made from it
//! web        map, single fibres, figures, report, summary
//! ```

pub mod air;
pub mod run;
pub mod spinline;
pub mod study;
#[cfg(test)]
mod tests;
pub mod web;
