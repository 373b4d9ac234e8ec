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
pub(crate) use access::in_rows;
pub(crate) use table::{METHODS, NUMBERS, ONE_SOURCE};
pub use table::{WEB_KEYS, WEB_TABLES};

use super::WebSpec;
use crate::case::keys::{self, Key, KeyTable, TableList};

/// The keys of a web.
pub static WEB: KeyTable<WebSpec> = KeyTable {
    rows: WEB_KEYS,
    tables: &WEB_TABLES,
    lists: &[
        TableList {
            name: "layer",
            tables: &["fibre", "laydown", "line"],
            entry: "a layer",
            wanted: "a list of tables: [[layer]], and below it [layer.fibre], [layer.laydown] and [layer.line]",
        },
        TableList {
            name: "line.rows",
            tables: &[],
            entry: "a row of nozzles",
            wanted: "a list of rows, like [{ offset = \"0 mm\", pitch = \"0.2 mm\", filaments = 5000 }]",
        },
    ],
    noun: "a web",
    file: "a web file",
};

impl WebKey {
    /// The key of a case that means the same, if there is one.
    pub fn key_of_case(&self) -> Option<&'static Key> {
        keys::find(self.relations.same_in_case.unwrap_or(self.name))
    }

    /// Other words for it: with those of the same key of a case, where there is one.
    pub fn all_synonyms(&self) -> Vec<&'static str> {
        let of_case = self.key_of_case().map_or(&[][..], |key| key.synonyms);
        self.synonyms.iter().chain(of_case).copied().collect()
    }

    /// Outside of these a value, unless it is zero, is most likely a slip, in SI units: as for the same key of a
    /// case, where there is one.
    pub fn usual_range(&self) -> Option<(f64, f64)> {
        self.key_of_case().map_or(self.usual, |key| key.usual)
    }
}

#[cfg(test)]
mod tests {
    use super::WEB;

    #[test]
    fn relations_name_keys_that_are_there_and_values_that_they_take() {
        WEB.check_relations();
        assert_eq!(WEB.replaced_by(&["line.rows"]), ["line.filaments_per_metre"]);
        assert_eq!(WEB.replaced_by(&["laydown.results"]), ["laydown.case"]);
    }
}
