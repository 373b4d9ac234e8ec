//! Whole folders of results, each written completely or not at all.
//!
//! ```text
//! run     flies a case: tables while it flies, then figures, shapes, report, summary
//! study   the folder of a study: its journal, and what is made from it
//! fibres  the fibres of a web: flown, or what earlier runs have laid
//! web     map, single fibres, figures, report, summary
//! webs    the folder of a study of webs
//! ```

pub mod fibres;
mod laid;
pub mod run;
pub mod study;
pub mod web;
pub mod webs;
