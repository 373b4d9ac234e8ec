//! Overrides: each finds the layer, table and row of its key.

use super::Overrides;
use super::document::Document;
use super::entry::Entry;
use spunlaid_fibre::case::keys::TableList;
use spunlaid_ground::Fault;

/// The value of an override that removes a key, so that its default applies.
pub(super) const AUTO: &str = "auto";

/// Where the key of an override stands.
struct Target {
    /// What comes before it in its full name.
    before: String,
    table: &'static str,
    /// Its name there.
    name: String,
}

impl<'a, T> Document<'a, T> {
    /// Takes what is set from one place. It replaces what stands in the file or was set before, also in other
    /// words. The value `auto` removes a key.
    pub(super) fn take_overrides(&mut self, Overrides { values, word, .. }: &Overrides<'a>) {
        let mut set = Vec::new();
        for (key, text) in *values {
            let (key, entry) = (key.trim(), || Entry::from_override(word, text));
            let targets = self.targets(key).map_err(|what| entry().problem(key, what));
            let targets = targets.unwrap_or_else(|problem| {
                self.key_values.problems.push(problem);
                Vec::new()
            });
            for Target { before, table, name } in targets {
                let full = format!("{before}{name}");
                let path = format!("{table}.{name}");
                let is_known = self.keys.find(&path).is_some() || self.keys.list(&path).is_some();
                if is_known && text.trim().trim_matches('"') == AUTO {
                    self.key_values.remove(&full);
                    self.key_values.taken_out.push(full);
                } else {
                    self.take(&before, table, &name, entry());
                    set.extend(is_known.then_some(full));
                }
            }
        }
        self.key_values.give_way(&set.iter().map(String::as_str).collect::<Vec<_>>());
    }

    /// Where a key stands: one of a layer, without its number, in all layers that have it, or else in all layers.
    ///
    /// # Errors
    /// As [`Self::target`].
    fn targets(&self, key: &str) -> Result<Vec<Target>, Fault> {
        let table = key.split('.').next().unwrap_or(key);
        let has_table = |list: &&TableList| list.tables.contains(&table) && !list.common.contains(&table);
        let Some(list) = self.keys.lists.iter().find(has_table).filter(|_| self.layered) else {
            return Ok(vec![self.target(key)?]);
        };
        let count = self.key_values.number(list.name).map_or(0, |count| count as u64);
        let all = (1..=count).map(|number| self.target(&format!("{}.{number}.{key}", list.name)));
        let all: Vec<Target> = all.collect::<Result<_, _>>()?;
        let has_it =
            |target: &Target| self.key_values.get(&format!("{}{}", target.before, target.name)).is_some();
        let is_there = all.iter().any(has_it);
        Ok(all.into_iter().filter(|target| !is_there || has_it(target)).collect())
    }

    /// Where a key stands.
    ///
    /// # Errors
    /// If it is of an entry of a list that is not there.
    fn target(&self, key: &str) -> Result<Target, Fault> {
        let mut before = String::new();
        let mut table = "";
        let mut rest = key;
        while let Some((name, after)) = rest.split_once('.') {
            let path = if table.is_empty() { name.to_owned() } else { format!("{table}.{name}") };
            if let Some(list) = self.keys.list(&path) {
                let (number, after) = self.numbered(&format!("{before}{name}"), list, after)?;
                // A file without a list at its top has one entry of it all the same.
                if self.layered || !before.is_empty() {
                    before += &format!("{name}.{number}.");
                    table = list.name;
                }
                rest = after;
            } else if let Some(inner) = self.keys.table_in(table, name) {
                before += &format!("{name}.");
                (table, rest) = (inner, after);
            } else {
                break;
            }
        }
        Ok(Target { before, table, name: rest.to_owned() })
    }

    /// The number of an entry of a list, which an override gives by its number or its name, and the rest of its key.
    fn numbered<'k>(&self, full: &str, list: &TableList, key: &'k str) -> Result<(u64, &'k str), Fault> {
        let count = self.key_values.number(full).map_or(0, |count| count as u64);
        let after = |name: &str| key.strip_prefix(name)?.strip_prefix('.');
        let is_alone = count == 0 && !list.tables.is_empty() && !self.layered;
        let by_number = (1..=count.max(u64::from(is_alone)))
            .find_map(|number| Some((number, after(&number.to_string())?)));
        let by_name = || {
            let name = |number| self.key_values.text(&format!("{full}.{number}.name"));
            (1..=count).find_map(|number| Some((number, after(&name(number)?)?)))
        };
        by_number.or_else(by_name).ok_or_else(|| no_entry(full, count, list))
    }
}

/// The fault of a key of an entry that a list, of so many entries, does not have.
pub(super) fn no_entry(full: &str, count: u64, list: &TableList) -> Fault {
    let there = match (count, list.tables) {
        (0, []) => format!("write {}", list.wanted),
        (0, _) => "it has no [[layer]], so write the key without layer".to_owned(),
        (1, _) => format!("it has one, {full}.1"),
        (_, []) => format!("it has {full}.1 to {full}.{count}"),
        _ => format!("it has {full}.1 to {full}.{count}, which may also be called by their names"),
    };
    Fault::new(format!("is of {} that the file does not have", list.entry), there)
}
