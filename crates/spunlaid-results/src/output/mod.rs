//! The files of a results folder.

pub mod air;
pub mod analysis;
mod appended;
mod compared;
pub mod comparison;
pub mod doubt;
pub mod finer;
pub mod fit;
pub mod folder;
pub mod in_order;
pub mod kept_input;
pub mod leftovers;
pub mod load;
pub mod measured;
pub mod origin;
pub mod paraview;
pub mod pictures;
pub mod sources;
mod spill;
pub mod spinline;
pub mod study;
pub mod summary;
pub mod table;
pub mod tables;
pub mod web;

use serde::Serialize;

/// The text of a JSON file that says which version of the program wrote it.
///
/// * `layout` – version of the layout; it increases when a field is renamed or removed or changes its meaning
pub fn versioned_json(layout: u32, content: &impl Serialize) -> String {
    #[derive(Serialize)]
    struct Versioned<'a, T> {
        schema_version: u32,
        spunlaid_version: &'static str,
        #[serde(flatten)]
        content: &'a T,
    }
    let text = Versioned { schema_version: layout, spunlaid_version: env!("CARGO_PKG_VERSION"), content };
    // Serialising plain numbers and strings into memory cannot fail.
    serde_json::to_string_pretty(&text).unwrap_or_default() + "\n"
}
