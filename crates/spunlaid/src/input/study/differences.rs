//! Differences between two TOML files.

use super::super::source::fit;
use std::collections::BTreeSet;
use toml::de::{DeTable, DeValue};

/// The keys whose values differ between two TOML texts: `air.velocity was "10 m/s", is "12 m/s"`.
///
/// Comments, order and spaces are ignored.
pub fn differences(was: &str, is: &str) -> Vec<String> {
    let (was, is) = (entries(was), entries(is));
    let keys: BTreeSet<&str> = was.iter().chain(&is).map(|(key, _)| &**key).collect();
    let value = |entries: &[(String, String)], key| {
        entries.iter().find_map(|(name, value)| (name == key).then(|| value.clone()))
    };
    keys.into_iter()
        .filter_map(|key| match (value(&was, key), value(&is, key)) {
            (was, is) if was == is => None,
            (was, is) => {
                let [was, is] = [was, is].map(|value| value.unwrap_or_else(|| "missing".to_owned()));
                Some(format!("{key} was {was}, is {is}"))
            }
        })
        .collect()
}

/// Full keys and the text of their values; a single entry if the text is not TOML.
fn entries(text: &str) -> Vec<(String, String)> {
    let mut entries = Vec::new();
    match DeTable::parse(text) {
        Ok(root) => gather(text, "", root.get_ref(), &mut entries),
        Err(_) => entries.push(("the file".to_owned(), "damaged".to_owned())),
    }
    entries
}

fn gather(text: &str, above: &str, table: &DeTable<'_>, entries: &mut Vec<(String, String)>) {
    for (key, value) in table {
        let key =
            if above.is_empty() { key.get_ref().to_string() } else { format!("{above}.{}", key.get_ref()) };
        match value.get_ref() {
            DeValue::Table(inner) => gather(text, &key, inner, entries),
            _ => entries.push((fit(&key), fit(text.get(value.span()).unwrap_or_default()))),
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
