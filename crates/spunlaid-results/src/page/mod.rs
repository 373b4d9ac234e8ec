//! `report.html`: one file that shows results to whoever opens it, offline.
//!
//! ```text
//! results → a function for each product (run, web, study, …) → Report: headline, notes, sections of parts
//!   → one template (templates/page.html)
//! ```
//!
//! `document` has the parts and what is looked at, `table` tables. `words`, `claims` and `methods` say what
//! several reports say.

pub(crate) mod claims;
pub(crate) mod document;
pub mod keys;
pub(crate) mod methods;
pub(crate) mod table;
mod text;
pub(crate) mod words;

pub use document::Report;
pub use text::aligned;
