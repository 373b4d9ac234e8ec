//! The files of a results folder.

pub(crate) mod analysis;
pub(crate) mod beside;
pub(crate) mod comparison;
pub(crate) mod folder;
pub(crate) mod laid;
pub(crate) mod leftovers;
pub(crate) mod paraview;
mod parquet;
pub(crate) mod pictures;
pub(crate) mod step_check;
pub(crate) mod study;
pub(crate) mod summary;
pub(crate) mod table;
pub(crate) mod tables;
pub(crate) mod web;

use serde::Serialize;

/// The text of a JSON file.
pub(crate) fn json_text(of: &impl Serialize) -> String {
    // Serialising plain numbers and strings into memory cannot fail.
    serde_json::to_string_pretty(of).unwrap_or_default() + "\n"
}
