//! The keys of a web.
//!
//! A key of a layer is one of the first layer: [`super::WebSpec::alone`] makes a web of any layer.
//!
//! ```text
//! access   where a web has what a key names
//! table    one row for each key, a file for each table: its values, its meaning and its access
//! ```

mod access;
mod table;

pub use access::WebKey;
pub use access::in_rows;
pub use table::{EITHER, NUMBERS, ONE_SOURCE};
pub use table::{WEB_KEYS, WEB_TABLES};

use super::WebSpec;
use spunlaid_fibre::case::keys::row::AccessTo;
use spunlaid_fibre::case::keys::{CASE, Key, KeyTable, TableList};
use std::sync::LazyLock;

/// The keys of a web.
pub static WEB: KeyTable<WebSpec> =
    KeyTable { rows: WEB_KEYS, tables: &WEB_TABLES, lists: LISTS, noun: "a web", file: "a web file" };

/// The keys of the file of a web: those of the web, and those of the case of its filament. They say how a
/// file is read, and have no access to either. A key or a table that both have stands here once, as that of
/// the filament.
pub static WEB_FILE: LazyLock<KeyTable<()>> = LazyLock::new(|| {
    let of_case = CASE.rows.iter().map(|key| key.of_input(AccessTo::NONE));
    let own_keys = WEB.rows.iter().filter(|key| CASE.find(key.name).is_none());
    let rows: Vec<Key<()>> = of_case.chain(own_keys.map(|key| key.of_input(AccessTo::NONE))).collect();
    let own_tables = WEB.tables.iter().filter(|table| !CASE.tables.contains(table));
    let tables: Vec<&str> = CASE.tables.iter().chain(own_tables).copied().collect();
    KeyTable { rows: rows.leak(), tables: tables.leak(), lists: LISTS, noun: WEB.noun, file: WEB.file }
});

/// The tables of a filament, which all layers may have in common.
pub const OF_FILAMENT: &[&str] = &["spinline", "fibre", "feed", "belt", "air", "drag", "run"];

const LISTS: &[TableList] = &[
    TableList {
        name: "layer",
        tables: &["spinline", "fibre", "feed", "belt", "air", "drag", "run", "laydown", "line"],
        common: OF_FILAMENT,
        entry: "a layer",
        wanted: "a list of tables: [[layer]], and below it [layer.fibre], [layer.laydown] and [layer.line]",
    },
    TableList {
        name: "line.rows",
        tables: &[],
        common: &[],
        entry: "a row of holes",
        wanted: "a list of rows, like [{ offset = \"0 mm\", pitch = \"0.2 mm\", filaments = 5000 }]",
    },
    TableList {
        name: "line.defects",
        tables: &[],
        common: &[],
        entry: "a defect",
        wanted: "a list of defects, like [{ from = \"0.5 m\", to = \"0.51 m\", titre = 0 }]",
    },
];
