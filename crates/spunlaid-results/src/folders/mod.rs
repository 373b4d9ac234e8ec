//! Folders of results, each written completely or not at all.
//!
//! ```text
//! contents   what every folder holds, and the one way in which it is written
//! journalled a folder with a journal, which fit and study share: begun, continued, replaced
//! ```

mod contents;
mod journalled;

pub use contents::{Contents, Maker, Making, Page};
pub use journalled::JournalFolder;
pub(crate) use journalled::{Work, remove};
