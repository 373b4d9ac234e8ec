//! The files of a results folder.

pub mod air;
pub mod analysis;
pub mod comparison;
pub mod doubt;
pub mod finer;
pub mod fit;
pub mod flown;
pub mod folder;
pub mod kept_input;
pub mod leftovers;
pub mod load;
pub mod measured;
pub mod origin;
pub mod paraview;
pub mod pictures;
pub mod sources;
pub mod spinline;
pub mod study;
pub mod summary;
pub mod table;
pub mod tables;
pub mod web;

use serde_json::{Value as Json, json};

/// The text of a JSON file that says which version of the program wrote it.
///
/// * `layout` – version of the layout; it increases when a field is renamed or removed or changes its meaning
pub fn versioned_json(layout: u32, content: Json) -> String {
    let version = json!({"schema_version": layout, "spunlaid_version": env!("CARGO_PKG_VERSION")});
    format!("{:#}\n", measured::joined([version, content]))
}
