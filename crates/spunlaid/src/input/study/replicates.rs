//! How many replicates a point of a study has: a number, or until its results are as exact as asked.

use super::super::entry::{Entry, in_order};
use super::super::values;
use super::Base;
use super::reader::{Reader, unknown_key};
use crate::error::{Fault, nearest_word};
use crate::study::Replicates;
use crate::units::Dimension;
use toml::de::DeValue;

/// Largest number of replicates of a point.
pub(super) const MOST_REPLICATES: u64 = 1_000_000;

impl<'a> Reader<'a> {
    pub(super) fn replicates(&mut self, base: &dyn Base) -> Replicates {
        const MOST: u64 = MOST_REPLICATES;
        const KEYS: [&str; 3] = ["at_least", "at_most", "until"];
        let Some(entry) = self.entries.remove("replicates") else {
            return Replicates::fixed(base.seed_and_replicates().1);
        };
        let DeValue::Table(table) = entry.value else {
            return Replicates::fixed(self.whole_in(&entry, "replicates", 1, MOST).unwrap_or(1));
        };
        let (mut bounds, mut until, mut least) = ([None; 2], Vec::new(), None);
        for (key, value) in in_order(table) {
            let name = format!("replicates.{}", key.1);
            let entry = self.entry(key.0, value);
            match key.1.as_str() {
                "at_least" => {
                    bounds[0] = self.whole_in(&entry, &name, 2, MOST);
                    least = Some(entry);
                }
                "at_most" => bounds[1] = self.whole_in(&entry, &name, 2, MOST),
                "until" => until = self.until(entry, base),
                other => {
                    let advice = nearest_word(other, KEYS.into_iter()).map_or_else(
                        || "the keys are at_least, at_most and until".to_owned(),
                        |key| format!("did you mean {key}?"),
                    );
                    self.reject(&entry, &name, unknown_key(advice));
                }
            }
        }
        let line = "[replicates] until = { amplitude_y = \"5 %\" }, the wanted standard error as a fraction of the mean";
        if until.is_empty() && self.problems.is_empty() {
            self.missing("replicates.until", line);
        }
        let at_most = bounds[1].unwrap_or(100);
        let at_least = bounds[0].unwrap_or_else(|| at_most.min(8));
        if let Some(entry) = least.filter(|_| at_least > at_most) {
            let fault = Fault::new(format!("is larger than at_most = {at_most}"), "lower it");
            self.reject(&entry, "replicates.at_least", fault);
        }
        Replicates { at_least, at_most, until }
    }

    fn until(&mut self, entry: Entry<'a>, base: &dyn Base) -> Vec<(usize, f64)> {
        let DeValue::Table(table) = entry.value else {
            self.wrong_type(&entry, "replicates.until", "a table, like { amplitude_y = \"5 %\" }");
            return Vec::new();
        };
        let (mut until, quantities) = (Vec::new(), base.quantities());
        for ((at, name), value) in in_order(table) {
            let key = format!("replicates.until.{name}");
            let entry = self.entry(at, value);
            let Some(measure) = quantities.iter().position(|quantity| quantity.name == name) else {
                let names: Vec<&str> = quantities.iter().map(|quantity| &*quantity.name).collect();
                let advice = nearest_word(&name, names.iter().copied()).map_or_else(
                    || format!("the results are {}", names.join(", ")),
                    |name| format!("did you mean {name}?"),
                );
                self.reject(&entry, &key, Fault::new("is not the name of a result", advice));
                continue;
            };
            match values::number(Dimension::Ratio, &entry.value) {
                Ok(fraction) if fraction > 0.0 && fraction < 1.0 => until.push((measure, fraction)),
                Ok(_) => {
                    let fault = Fault::new(
                        "is not a fraction of the mean",
                        "write a number between 0 and 1, like 0.05 or \"5 %\"",
                    );
                    self.reject(&entry, &key, fault);
                }
                Err(fault) => self.reject(&entry, &key, fault),
            }
        }
        until
    }
}
