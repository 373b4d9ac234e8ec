//! Differences between two TOML files.

use super::super::source::fit;
use std::collections::BTreeMap;
use toml::de::{DeTable, DeValue};

/// The keys whose values differ between two TOML texts: `air.velocity was "10 m/s", is "12 m/s"`.
///
/// Comments, order and spaces are ignored.
pub fn differences(was: &str, is: &str) -> Vec<String> {
    let (was, is) = (entries(was), entries(is));
    let keys: std::collections::BTreeSet<&String> = was.keys().chain(is.keys()).collect();
    keys.into_iter()
        .filter_map(|key| match (was.get(key), is.get(key)) {
            (Some(was), Some(is)) if was == is => None,
            (Some(was), Some(is)) => Some(format!("{key} was {was}, is {is}")),
            (Some(was), None) => Some(format!("{key} was {was}, is missing")),
            (None, Some(is)) => Some(format!("{key} was missing, is {is}")),
            (None, None) => None,
        })
        .collect()
}

/// Full keys and the text of their values; a single entry if the text is not TOML.
fn entries(text: &str) -> BTreeMap<String, String> {
    let mut entries = BTreeMap::new();
    match DeTable::parse(text) {
        Ok(root) => gather(text, "", root.get_ref(), &mut entries),
        Err(_) => drop(entries.insert("the file".to_owned(), "damaged".to_owned())),
    }
    entries
}

fn gather(text: &str, above: &str, table: &DeTable<'_>, entries: &mut BTreeMap<String, String>) {
    for (key, value) in table {
        let key =
            if above.is_empty() { key.get_ref().to_string() } else { format!("{above}.{}", key.get_ref()) };
        match value.get_ref() {
            DeValue::Table(inner) => gather(text, &key, inner, entries),
            _ => drop(entries.insert(fit(&key), fit(text.get(value.span()).unwrap_or_default()))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::differences;

    #[test]
    fn differences_are_listed_by_key() {
        let was = "a = 1 # one\n[b]\nc = [1, 2]\nd.e = \"x\"\ngone = 1\n";
        assert_eq!(differences(was, "a=1\n[b]\nd = { e = \"x\" }\ngone =  1\nc = [1, 2]\n"), [""; 0]);
        assert_eq!(
            differences(was, "a = 2\n[b]\nc = [1, 2]\nd.e = \"y\"\nnew = 2\n"),
            [
                "a was 1, is 2",
                "b.d.e was \"x\", is \"y\"",
                "b.gone was 1, is missing",
                "b.new was missing, is 2"
            ]
        );
        assert_eq!(differences("a = 1", "a = "), ["a was 1, is missing", "the file was missing, is damaged"]);
    }
}
