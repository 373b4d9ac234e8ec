//! The plan of a study: its file, checked as far as it can be before its points are made.

use super::super::document::AUTO;
use super::super::entry::Entry;
use super::super::open::Open;
use super::super::values::integer;
use super::super::write::quoted;
use super::super::{FORMAT_VERSION, Overrides};
use super::reader::{self, Reader, not_varied, set_twice};
use super::replicates::MOST_REPLICATES;
use super::{StudyChanges, Varied, level, links, varied};
use crate::case::keys::{self, Kind};
use crate::error::Fault;
use crate::study::{Design, Factor, Link, Point, Replicates, Study};
use toml::de::DeValue;

/// A study before its points are made.
pub(super) struct Plan {
    pub(super) factors: Vec<Factor>,
    pub(super) links: Vec<Link>,
    /// An order in which the links can be evaluated.
    pub(super) order: Vec<usize>,
    pub(super) design: Design,
    pub(super) seed: u64,
    pub(super) common_phases: bool,
    pub(super) replicates: Replicates,
}

impl Plan {
    pub(super) fn study(self, points: Vec<Point>) -> Study {
        let Self { factors, links, design, seed, common_phases, replicates, .. } = self;
        Study { factors, links, design, seed, common_phases, replicates, points }
    }
}

impl<'a> Reader<'a> {
    /// The name of the case; `None` if it is missing or the file is newer, after noting the problem.
    pub(super) fn case(&mut self) -> Option<String> {
        if !self.version() {
            return None;
        }
        let line = "case = \"table1.toml\" (the case to vary, beside this file)";
        let Some(entry) = self.entries.remove("case") else {
            self.missing("case", line);
            return None;
        };
        match &entry.value {
            DeValue::String(text) => Some(text.clone().into_owned()),
            _ => {
                self.wrong_type(&entry, "case", "the path of a case file, in quotes");
                None
            }
        }
    }

    /// Checks the version; false if the file is newer, after noting the problem.
    pub(super) fn version(&mut self) -> bool {
        if let Some(version) = self.entries.remove("version") {
            let known = FORMAT_VERSION;
            let number = match &version.value {
                DeValue::Integer(number) => integer(number),
                _ => None,
            };
            match number {
                Some(number) if (1..=u64::from(known)).contains(&number) => {}
                Some(number) if number > u64::from(known) => {
                    self.problems.clear();
                    self.reject(&version, "version", Fault::newer_version(known));
                    return false;
                }
                _ => self.reject(&version, "version", Fault::out_of_range(1, u64::from(known))),
            }
        }
        true
    }

    /// The keys that are the same at all points, with their values as text: those of the file, and then those asked for
    /// from outside, which replace them.
    pub(super) fn set(&mut self, asked: Overrides<'_>) -> Vec<(String, String)> {
        let mut set: Vec<(String, String)> = Vec::new();
        if let Some(entry) = self.entries.remove("set") {
            let DeValue::Table(table) = entry.value else {
                self.wrong_type(&entry, "set", "a table, [set]");
                return set;
            };
            for (key, entry) in self.flat(table) {
                self.check_set(&key, &entry);
                set.push((key, entry.text.to_owned()));
            }
        }
        for (key, text) in asked.values {
            let key = key.trim().to_owned();
            let entry = Entry::of_override(asked.word, text);
            self.check_set(&key, &entry);
            let written = if DeValue::parse(text).is_ok() { text.clone() } else { quoted(text) };
            set.retain(|(other, _)| *other != key);
            set.push((key, written));
        }
        set
    }

    /// Refuses to set what a study takes from elsewhere.
    fn check_set(&mut self, name: &str, entry: &Entry<'_>) {
        let Some(key) = keys::find(name) else {
            return;
        };
        if matches!(key.name, "run.replicates" | "run.seed") {
            self.reject(entry, name, not_varied(super::advice(name)));
        }
        let is_word = |word: &str| word == AUTO || key.kind.words().contains(&word);
        if matches!(key.kind, Kind::File(_)) && !entry.value.as_str().is_some_and(is_word) {
            let fault = Fault::new("names a file, which a study takes from its case", "write it there");
            self.reject(entry, name, fault);
        }
    }

    /// Refuses keys that are both set and varied or linked.
    fn check_once(&mut self, set: &[(String, String)], factors: &[Factor], links: &[Link]) {
        let varied = factors.iter().map(|factor| factor.key).chain(links.iter().map(|link| link.key));
        for key in varied.filter(|key| set.iter().any(|(set, _)| set == key)) {
            self.reject_whole(key, set_twice());
        }
    }

    /// The plan; `None` if the file has problems.
    ///
    /// * `set` – the keys that are the same at all points
    pub(super) fn plan(
        &mut self,
        base: &Open,
        set: &[(String, String)],
        changes: &StudyChanges<'_>,
    ) -> Option<Plan> {
        let design_entry = self.entries.remove("design");
        let design = self.design(design_entry.as_ref());
        let seed = self.whole("seed", 0, u64::MAX).unwrap_or(base.case.run.seed);
        let common_phases = self.truth("common_phases").unwrap_or(true);
        let mut replicates = self.replicates(base);
        if let Some(asked) = changes.replicates {
            if !(1..=MOST_REPLICATES).contains(&asked) {
                self.reject_whole("replicates", reader::replicates(asked, MOST_REPLICATES));
            }
            replicates = Replicates::fixed(asked);
        }
        let factors =
            self.factors(design, |reader, entry, name| reader.varied(entry, name).map(Varied::from));
        let links = self.links(&factors, base);
        self.check_once(set, &factors, &links);
        if !self.problems.is_empty() {
            return None;
        }
        let order = links::order(&links).ok()?;
        if let Some(entry) = &design_entry {
            let base: Vec<f64> = factors.iter().map(|factor| of_base(base, factor)).collect();
            self.combination(entry, design, &factors, &base);
            if self.problems.is_empty() {
                let count = design.count(&factors, &base);
                self.size(entry, count, changes.points, replicates.at_most);
            }
        }
        self.problems.is_empty().then_some(Plan {
            factors,
            links,
            order,
            design,
            seed,
            common_phases,
            replicates,
        })
    }
}

/// The value of a factor in the base case; NaN if it has none.
pub(super) fn of_base(base: &Open, factor: &Factor) -> f64 {
    let value =
        |key| if factor.words.is_empty() { base.number(key) } else { level(key, &key.get(&base.case)?) };
    varied(factor.key).and_then(value).unwrap_or(f64::NAN)
}
