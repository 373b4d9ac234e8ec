//! Whole folders of results, each written completely or not at all.
//!
//! ```text
//! contents   what every folder holds, and the one way in which it is written
//! comparison the results of runs or webs side by side: figures, report, numbers
//! finished   what the folder of a run or a web says
//! products   those that are written at once: air, paper, record, scan, sources, spinline
//! fit        the journal of a fit, and what is made from it
//! journalled a folder with a journal, which fit and study share: begun, continued, replaced
//! run        flies a case: tables while it flies, then figures, shapes, report, summary
//! study      the folder of a study: its journal, and what is made from it
//! web        map, single fibres, figures, report, summary
//! ```

pub mod comparison;
mod contents;
#[cfg(test)]
mod declared;
mod finished;
pub mod fit;
mod journalled;
pub mod products;
pub mod run;
pub mod study;
pub mod web;

pub use contents::{Contents, Maker, Making, Page};
pub use finished::{read_measured_web, read_summary, read_summary_of_run};
pub use journalled::JournalFolder;
