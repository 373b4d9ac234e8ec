//! The entries of a study file, each with its place, and the problems found in them.

use super::super::entry::{Entry, in_order, kind, root};
use super::super::source::Source;
use super::super::values::integer;
use crate::case::keys::TABLES;
use crate::error::{Error, Fault, Finding, Problem, nearest_word};
use crate::layers::WEB_TABLES;
use crate::layers::full_names::without_numbers;
use crate::sort::sort_by_key;
use std::borrow::Cow;
use std::collections::BTreeMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

const KEYS: [&str; 12] = [
    "version",
    "case",
    "web",
    "spinline",
    "design",
    "points",
    "replicates",
    "common_phases",
    "seed",
    "set",
    "vary",
    "link",
];

/// Reads a study file and collects its problems.
pub(super) struct Reader<'a> {
    pub(super) source: Source<'a>,
    pub(super) entries: BTreeMap<String, Entry<'a>>,
    pub(super) problems: Vec<Problem>,
    /// Keys that are missing only because they are misspelt.
    excused: Vec<&'static str>,
}

impl<'a> Reader<'a> {
    /// Splits the file into its entries.
    ///
    /// # Errors
    /// When the text is not TOML.
    pub(super) fn new(text: &'a str, name: &str) -> Result<Self, Error> {
        let source = Source::new(text, name);
        let root = root(&source, text)?;
        // A study names its web; a web has tables.
        let is_of_web = |key: &str, value: &DeValue<'_>| {
            WEB_TABLES.contains(&key) && !TABLES.contains(&key) && value.is_table()
        };
        if let Some((key, _)) = root.iter().find(|(key, value)| is_of_web(key.get_ref(), value.get_ref())) {
            let (place, key) = (source.place(key.span().start), format!("[{}]", key.get_ref()));
            let what = Fault::new(
                "is a table of the file of a web",
                "a study names its web, as in web = \"web.toml\". To lay a single web, name its file itself",
            );
            let what = what.option("`spunlaid web`");
            return Err(vec![Finding { place, key, value: None, what }].into());
        }
        let mut reader = Self { source, entries: BTreeMap::new(), problems: Vec::new(), excused: Vec::new() };
        let mut tables = Vec::new();
        for (key, value) in root {
            let (at, name) = (key.span().start, key.into_inner());
            let entry = reader.entry(at, value);
            // A study names its spinline; a spinline is a table.
            let is_table = name == "spinline" && entry.value.is_table();
            if KEYS.contains(&name.as_ref()) && !is_table {
                reader.entries.insert(name.into_owned(), entry);
            } else {
                if TABLES.contains(&name.as_ref()) {
                    tables.push((entry, name.into_owned()));
                    continue;
                }
                let advice = match nearest_word(&name, KEYS.into_iter()) {
                    Some(key) => {
                        reader.excused.push(key);
                        format!("did you mean {key}?")
                    }
                    None => format!("the keys are {} and {}", KEYS[..11].join(", "), KEYS[11]),
                };
                reader.reject(&entry, &name, unknown_key(advice));
            }
        }
        sort_by_key(&mut tables, |(entry, _)| entry.at);
        if let Some((entry, name)) = tables.first() {
            if !reader.entries.contains_key("case") {
                // The file is a case, so all other problems would only repeat this one.
                reader.problems.clear();
                reader.excused.push("case");
            }
            let fault = Fault::new(
                "is a table of a case file",
                "a study names its case, as in case = \"table1.toml\". To fly a single case, name the case itself",
            );
            reader.reject(entry, &format!("[{name}]"), fault.option("`spunlaid run`"));
        }
        Ok(reader)
    }

    pub(super) fn entry(&self, at: usize, value: Spanned<DeValue<'a>>) -> Entry<'a> {
        Entry::from_file(&self.source, at, value)
    }

    pub(super) fn reject(&mut self, entry: &Entry<'_>, key: &str, fault: Fault) {
        self.problems.push(entry.problem(key, fault));
    }

    /// Notes a problem of the whole file.
    pub(super) fn reject_whole(&mut self, key: &str, what: Fault) {
        let place = self.source.whole();
        self.problems.push(Finding { place, key: key.to_owned(), value: None, what });
    }

    /// Notes that a required key is missing, unless it is misspelt.
    pub(super) fn missing(&mut self, key: &str, line: &str) {
        if !self.excused.contains(&key) {
            self.reject_whole(key, missing(line));
        }
    }

    pub(super) fn wrong_type(&mut self, entry: &Entry<'_>, key: &str, wanted: &str) {
        self.reject(entry, key, Fault::wrong_type(kind(&entry.value), wanted));
    }

    /// Whether a problem has been noted.
    pub(super) fn has_problems(&self) -> bool {
        !self.problems.is_empty()
    }

    /// All problems, in the order of the file.
    pub(super) fn rejected(self) -> Error {
        let mut problems = self.problems;
        problems.sort_by(|a, b| a.place.cmp(&b.place));
        problems.into()
    }

    pub(super) fn whole(&mut self, key: &str, least: u64, most: u64) -> Option<u64> {
        let entry = self.entries.remove(key)?;
        self.whole_in(&entry, key, least, most)
    }

    pub(super) fn whole_in(&mut self, entry: &Entry<'_>, key: &str, least: u64, most: u64) -> Option<u64> {
        match &entry.value {
            DeValue::Integer(number) => match integer(number) {
                Some(number) if (least..=most).contains(&number) => return Some(number),
                _ => self.reject(entry, key, Fault::out_of_range(least, most)),
            },
            _ => self.wrong_type(entry, key, "a whole number without quotes, like 10"),
        }
        None
    }

    pub(super) fn truth(&mut self, key: &str) -> Option<bool> {
        let entry = self.entries.remove(key)?;
        if let DeValue::Boolean(truth) = entry.value {
            return Some(truth);
        }
        self.wrong_type(&entry, key, "true or false, without quotes");
        None
    }

    /// The entries of a table in the order of the file; `air.velocity = …` and `"air.velocity" = …` are equal.
    pub(super) fn flat(&mut self, table: DeTable<'a>) -> Vec<(String, Entry<'a>)> {
        let mut flat = Vec::new();
        self.gather("", table, &mut flat);
        sort_by_key(&mut flat, |(_, entry)| entry.at);
        flat
    }

    fn gather(&mut self, before: &str, table: DeTable<'a>, flat: &mut Vec<(String, Entry<'a>)>) {
        for ((at, key), value) in in_order(table) {
            let (full, entry) = (format!("{before}{key}"), self.entry(at, value));
            let is_table = full == "layer" || before == "layer." || is_table(&full);
            match entry.value {
                DeValue::Table(inner) if is_table => self.gather(&format!("{full}."), inner, flat),
                value => flat.push((full, Entry { value, ..entry })),
            }
        }
    }
}

/// Whether this is the full name of a table of a case or a web, which may be one of a layer: `air`, `layer.2.line`.
fn is_table(full: &str) -> bool {
    let in_layer = full.strip_prefix("layer.").and_then(|rest| rest.split_once('.'));
    let name = without_numbers(in_layer.map_or(full, |(_, rest)| rest));
    TABLES.contains(&&*name)
        || WEB_TABLES.contains(&&*name)
        || ["line.rows", "line.defects"].contains(&&*name)
}

/// A required key is missing.
///
/// * `line` – a line that would do
pub(super) fn missing(line: &str) -> Fault {
    Fault::new("is missing", format!("add {line}"))
}

/// No key of a study has this name.
pub(super) fn unknown_key(remedy: String) -> Fault {
    Fault::new("is not a key of a study file", remedy)
}

/// A study cannot vary, link or set this key.
pub(super) fn not_varied(remedy: impl Into<Cow<'static, str>>) -> Fault {
    Fault::new("cannot be set by a study", remedy)
}

/// A key that is both set and varied or linked.
///
/// * `by` – the key that sets it, which may be another one that gives it in other words
pub(super) fn set_twice(key: &str, by: &str) -> Fault {
    let by = if by == key { String::new() } else { format!(" by {by}") };
    Fault::new(format!("is set to one value for all points{by}, and varied or linked as well"), "keep one")
}

/// A number of replicates that is asked for, and that is out of range.
pub(super) fn replicates(asked: u64, most: u64) -> Fault {
    Fault::new(format!("= {asked} are asked for"), format!("ask for 1 to {most}"))
}

/// The case does not give the key a value of its own.
pub(super) fn not_written(purpose: &str) -> Fault {
    let message = "has no value in the case, where it follows from other keys";
    Fault::new(message, format!("write it there to {purpose}"))
}
