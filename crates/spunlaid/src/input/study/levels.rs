//! The values that a factor takes: a list, or a range.

use super::super::entry::{Entry, in_order, kind};
use super::super::values::{integer, number};
use super::VariedKey;
use super::reader::{Reader, missing, unknown_key};
use crate::case::keys::Value;
use crate::error::{Fault, nearest_word};
use crate::study::{Design, Levels, Spacing};
use toml::de::DeValue;

/// Largest number of values in a list or range.
const MOST_VALUES: u64 = 10_000_000;

impl<'a> Reader<'a> {
    /// The values of a factor; `None` if they cannot be read, after noting the problems.
    pub(super) fn levels(&mut self, varied: &VariedKey, entry: Entry<'a>, design: Design) -> Option<Levels> {
        match entry.value {
            DeValue::Array(list) => {
                let mut values = Vec::with_capacity(list.len());
                let mut sound = !list.is_empty();
                for value in list {
                    let entry = self.entry(value.span().start, value);
                    let value = self.value(varied, &varied.name, &entry);
                    sound &= value.is_some();
                    values.extend(value);
                }
                if values.is_empty() && !sound {
                    if entry.shown.as_ref().is_some_and(|text| text.trim_matches(['[', ']', ' ']).is_empty())
                    {
                        let entry = Entry { value: DeValue::Boolean(true), ..entry };
                        let fault = Fault::new(
                            "has no values",
                            "list some, as in [\"5 m/s\", \"10 m/s\"], or write { from, to, steps }",
                        );
                        self.reject(&entry, &varied.name, fault);
                    }
                    return None;
                }
                sound.then_some(Levels::List(values))
            }
            DeValue::Table(_) if !varied.words().is_empty() => {
                let words = varied.words();
                let words: Vec<String> = words.iter().take(2).map(|word| format!("\"{word}\"")).collect();
                let remedy = format!("list them, as in [{}]", words.join(", "));
                self.reject(&entry, &varied.name, Fault::new("takes words, which have no range", remedy));
                None
            }
            DeValue::Table(_) => self.range(varied, entry, design),
            _ => {
                let wanted = "a list of values, or { from, to, steps }; a formula belongs in [link]";
                self.wrong_type(&entry, &varied.name, wanted);
                None
            }
        }
    }

    fn value(&mut self, varied: &VariedKey, key: &str, entry: &Entry<'_>) -> Option<f64> {
        let words = varied.words();
        let read = match &entry.value {
            DeValue::String(word) if !words.is_empty() => words
                .iter()
                .position(|one| one == word)
                .map(|i| i as f64)
                .ok_or_else(|| Fault::not_one_of(nearest_word(word, words.iter().copied()), &words)),
            value if !words.is_empty() => {
                let wanted = format!("one of the words {}", words.join(", "));
                Err(Fault::wrong_type(kind(value), wanted))
            }
            value if !varied.is_whole() => number(varied.dimension(), value)
                .and_then(|value| varied.kind.fault(&Value::Number(value)).map_or(Ok(value), Err)),
            DeValue::Integer(number) => match integer(number) {
                Some(number) if (1..=1 << 50).contains(&number) => Ok(number as f64),
                _ => Err(Fault::out_of_range(1, 1 << 50)),
            },
            value => {
                let wanted = "whole numbers without quotes, like 256";
                Err(Fault::wrong_type(kind(value), wanted))
            }
        };
        read.map_err(|fault| self.reject(entry, key, fault)).ok()
    }

    fn range(&mut self, varied: &VariedKey, entry: Entry<'a>, design: Design) -> Option<Levels> {
        const KEYS: [&str; 4] = ["from", "to", "steps", "spacing"];
        let mut whole = entry;
        let DeValue::Table(table) = std::mem::replace(&mut whole.value, DeValue::Boolean(true)) else {
            return None;
        };
        let (mut ends, mut steps, mut spacing, mut sound) = ([None; 2], None, Spacing::Linear, true);
        for ((at, name), value) in in_order(table) {
            let (key, entry) = (format!("{}.{name}", varied.name), self.entry(at, value));
            match name.as_str() {
                "from" | "to" => {
                    let value = self.value(varied, &key, &entry);
                    sound &= value.is_some();
                    ends[usize::from(name == "to")] = value;
                }
                "steps" => match &entry.value {
                    DeValue::Integer(number)
                        if integer(number).is_some_and(|n| (2..=MOST_VALUES).contains(&n)) =>
                    {
                        steps = integer(number);
                    }
                    _ => {
                        self.reject(&entry, &key, Fault::out_of_range(2, MOST_VALUES));
                        sound = false;
                    }
                },
                "spacing" => match &entry.value {
                    DeValue::String(text) if text == "linear" => {}
                    DeValue::String(text) if text == "log" => spacing = Spacing::Logarithmic,
                    _ => {
                        self.reject(&entry, &key, Fault::not_one_of(None, &["linear", "log"]));
                        sound = false;
                    }
                },
                other => {
                    let advice = nearest_word(other, KEYS.into_iter()).map_or_else(
                        || "a range has the keys from, to, steps and spacing".to_owned(),
                        |key| format!("did you mean {key}?"),
                    );
                    self.reject(&entry, &key, unknown_key(advice));
                    sound = false;
                }
            }
        }
        if !sound {
            return None;
        }
        let [Some(from), Some(to)] = ends else {
            whole.shown = None;
            for (end, line) in
                ends.into_iter().zip(["from = with the first value", "to = with the last value"])
            {
                if end.is_none() {
                    let key = format!("{}.{}", varied.name, &line[..line.find(' ').unwrap_or(0)]);
                    self.reject(&whole, &key, missing(line));
                }
            }
            return None;
        };
        let name = design.name();
        let fault = match steps {
            None if !design.draws() => Some(Fault::new(
                format!("has no steps, which design = \"{name}\" needs"),
                "add steps = 5, or list the values",
            )),
            Some(_) if design.draws() => Some(Fault::new(
                format!("has steps, but design = \"{name}\" draws its values from the range"),
                "leave steps out",
            )),
            _ if from == to => {
                Some(Fault::new("has two equal ends", "write two different ends, or a list of one value"))
            }
            _ if spacing == Spacing::Logarithmic && (from <= 0.0 || to <= 0.0) => Some(Fault::new(
                "has logarithmic spacing, which needs both ends above zero",
                "write spacing = \"linear\"",
            )),
            _ => None,
        };
        match fault {
            Some(fault) => {
                self.reject(&whole, &varied.name, fault);
                None
            }
            None => Some(Levels::Range { from, to, steps, spacing }),
        }
    }
}
