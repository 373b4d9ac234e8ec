//! The values that a factor takes: a list, or a range.

use super::super::document::Named;
use super::super::entry::{Entry, kind};
use super::reader::Reader;
use super::{VariedKey, level};
use crate::case::keys::Value;
use crate::error::{Fault, Finding, nearest_word};
use crate::study::{Design, Levels, RANGE, Spacing, Study};
use toml::de::{DeTable, DeValue};

/// Whole numbers up to this one are the same as floating-point numbers.
const LARGEST_WHOLE: u64 = 1 << 50;

impl<'a> Reader<'a> {
    /// The values of a factor; `None` if they cannot be read, after noting the problems.
    pub(super) fn levels(
        &mut self,
        varied: &VariedKey,
        named: Named<'a, Study>,
        design: Design,
    ) -> Option<Levels> {
        let Named { row, mut entry, .. } = named;
        let words = varied.words();
        let fault = match std::mem::replace(&mut entry.value, DeValue::Boolean(true)) {
            DeValue::Array(list) if list.is_empty() => Fault::new(
                "has no values",
                "list some, as in [\"5 m/s\", \"10 m/s\"], or write { from, to, steps }",
            ),
            DeValue::Array(list) => {
                let level = |value: toml::Spanned<DeValue<'a>>| {
                    let entry = self.entry(value.span().start, value, None);
                    self.level(varied, &varied.name, &entry)
                };
                // All of them are looked at.
                let levels: Vec<Option<f64>> = list.into_iter().map(level).collect();
                return levels.into_iter().collect::<Option<_>>().map(Levels::List);
            }
            DeValue::Table(_) if !words.is_empty() => {
                let words: Vec<String> = words.iter().take(2).map(|word| format!("\"{word}\"")).collect();
                let remedy = format!("list them, as in [{}]", words.join(", "));
                Fault::new("takes words, which have no range", remedy)
            }
            DeValue::Table(table) => return self.range(varied, &entry, table, design),
            other => Fault::wrong_type(kind(&other), row.kind.wanted()),
        };
        self.reject(&varied.name, &entry, fault);
        None
    }

    /// A value of a key that varies as a number.
    fn level(&mut self, varied: &VariedKey, name: &str, entry: &Entry<'_>) -> Option<f64> {
        let words = varied.words();
        let word = entry.value.as_str().and_then(|word| words.iter().position(|one| *one == word));
        let read = match (word, entry.value.as_str()) {
            (Some(place), _) => Ok(place as f64),
            (None, Some(other)) if !words.is_empty() => {
                Err(Fault::not_one_of(nearest_word(other, words.iter().copied()), &words))
            }
            _ => self.as_kind(varied.kind, entry).and_then(|value| match value {
                Value::Whole(number) if number > LARGEST_WHOLE => Err(Fault::out_of_range(1, LARGEST_WHOLE)),
                value => level(varied.kind, &value).ok_or_else(|| Fault::not_one_of(None, &words)),
            }),
        };
        read.map_err(|fault| self.reject(name, entry, fault)).ok()
    }

    fn range(
        &mut self,
        varied: &VariedKey,
        whole: &Entry<'a>,
        table: DeTable<'a>,
        design: Design,
    ) -> Option<Levels> {
        let (name, problems) = (|key: &str| format!("{}.{key}", varied.name), self.problems());
        self.take_table(&name(""), RANGE, table, None);
        self.read_entries();
        let mut ends = [None; 2];
        for Named { row, name, entry } in self.named(RANGE) {
            ends[usize::from(row.short() == "to")] = self.level(varied, &name, &entry);
        }
        if self.problems() > problems {
            return None;
        }
        let [Some(from), Some(to)] = ends else {
            let missing = [("from", "first"), ("to", "last")].into_iter().zip(ends);
            for ((key, which), _) in missing.filter(|(_, end)| end.is_none()) {
                let what = Fault::missing("", &format!("{key} = with the {which} value"));
                let (place, key) = (whole.place.clone(), name(key));
                self.key_values.problems.push(Finding { place, key, value: None, what });
            }
            return None;
        };
        let steps = self.key_values.integer(&name("steps"));
        let is_log = self.key_values.text(&name("spacing")).as_deref() == Some(Spacing::Logarithmic.name());
        let spacing = if is_log { Spacing::Logarithmic } else { Spacing::Linear };
        let name = design.name();
        let fault = match steps {
            None if !design.draws() => Fault::new(
                format!("has no steps, which design = \"{name}\" needs"),
                "add steps = 5, or list the values",
            ),
            Some(_) if design.draws() => Fault::new(
                format!("has steps, but design = \"{name}\" draws its values from the range"),
                "leave steps out",
            ),
            _ if from == to => {
                Fault::new("has two equal ends", "write two different ends, or a list of one value")
            }
            _ if spacing == Spacing::Logarithmic && (from <= 0.0 || to <= 0.0) => Fault::new(
                "has logarithmic spacing, which needs both ends above zero",
                "write spacing = \"linear\"",
            ),
            _ => return Some(Levels::Range { from, to, steps, spacing }),
        };
        self.reject(&varied.name, whole, fault);
        None
    }
}
