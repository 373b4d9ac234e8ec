//! The files of a results folder that several reports share.

pub mod folder;
pub mod kept_input;
pub mod leftovers;
pub mod measured;
pub mod origin;
pub mod paraview;
pub mod pictures;
pub(crate) mod swap;
pub mod table;

use serde_json::{Value as Json, json};

/// The text of a JSON file that says which version of the program wrote it.
///
/// * `layout` – version of the layout; it increases when a field is renamed or removed or changes its meaning
pub fn versioned_json(layout: u32, content: Json) -> String {
    let version = json!({"schema_version": layout, "spunlaid_version": env!("CARGO_PKG_VERSION")});
    format!("{:#}\n", measured::joined([version, content]))
}
