//! The plan of a study: its file, checked as far as it can be before its points are made.

use super::super::Overrides;
use super::super::entry::{Entry, VERSION, check_version};
use super::super::overrides::AUTO;
use super::super::write::quoted;
use super::fixed_keys::advice;
use super::reader::{self, Reader, not_varied, set_twice};
use super::replicates::MOST_REPLICATES;
use super::{Base, StudyChanges, links};
use crate::case::keys::{self, Kind};
use crate::error::{Fault, FileKind};
use crate::layers::full_names::{are_alternatives, is_replaced};
use crate::study::{Design, Factor, Link, Point, Quantity, Replicates, Study};
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
    /// Their results are indices into the quantities.
    pub(super) replicates: Replicates,
    pub(super) quantities: Vec<Quantity>,
}

impl Plan {
    pub(super) fn study(self, points: Vec<Point>) -> Study {
        let Self { factors, links, design, seed, common_phases, mut replicates, quantities: before, .. } =
            self;
        let quantities = Study::quantities_of(&points);
        // Points may have patches that the web before them has not.
        for (index, _) in &mut replicates.until {
            let is_same = |quantity: &Quantity| quantity.name == before[*index].name;
            *index = quantities.iter().position(is_same).unwrap_or(*index);
        }
        Study { factors, links, design, seed, common_phases, replicates, points, quantities }
    }
}

impl<'a> Reader<'a> {
    /// The name of the case or web to vary; `None` if it is missing or the file is newer, after noting the problem.
    pub(super) fn base(&mut self) -> Option<(String, FileKind)> {
        // A newer format may mean other things, so nothing else is said then.
        if let Some(Err(problem)) = self.entries.remove(VERSION).map(|entry| check_version(&entry)) {
            self.problems = vec![*problem];
            return None;
        }
        const BASES: [(&str, FileKind, &str); 3] = [
            ("case", FileKind::Case, "the path of a case file, in quotes"),
            ("web", FileKind::Web, "the path of the file of a web, in quotes"),
            ("spinline", FileKind::Spinline, "the path of the file of a spinline, in quotes"),
        ];
        let mut named = BASES.into_iter().filter_map(|base| Some((base, self.entries.remove(base.0)?)));
        let (first, second) = (named.next(), named.next());
        drop(named);
        let Some(((key, kind, wanted), entry)) = first else {
            self.missing("case", "case = \"table1.toml\" (the case to vary, beside this file)");
            return None;
        };
        if let Some(((other, ..), _)) = second {
            let fault = Fault::new(
                format!("stands beside {other}"),
                "a study varies a case, a web or a spinline, so keep one of them",
            );
            self.reject(&entry, key, fault);
            return None;
        }
        let name = entry.value.as_str().map(|name| (name.to_owned(), kind));
        if name.is_none() {
            self.wrong_type(&entry, key, wanted);
        }
        name
    }

    /// The keys that are the same at all points, with their values as text: those of the file, and then those asked for
    /// from outside, which replace them.
    pub(super) fn set(&mut self, asked: Overrides<'_>, base: FileKind) -> Vec<(String, String)> {
        let mut set: Vec<(String, String)> = Vec::new();
        if let Some(entry) = self.entries.remove("set") {
            let DeValue::Table(table) = entry.value else {
                self.wrong_type(&entry, "set", "a table, [set]");
                return set;
            };
            for (key, entry) in self.flat(table) {
                self.check_set(&key, &entry, base);
                set.push((key, entry.text.to_owned()));
            }
        }
        let is_given = |(_, text): &&(String, String)| text.trim().trim_matches('"') != AUTO;
        let names: Vec<&str> = asked.values.iter().filter(is_given).map(|(key, _)| key.trim()).collect();
        set.retain(|(other, _)| !is_replaced(other, &names));
        for (key, text) in asked.values {
            let key = key.trim().to_owned();
            let entry = Entry::from_override(asked.word, text);
            self.check_set(&key, &entry, base);
            let value_text = if DeValue::parse(text).is_ok() { text.clone() } else { quoted(text) };
            set.retain(|(other, _)| *other != key);
            set.push((key, value_text));
        }
        set
    }

    /// Refuses to set what a study takes from elsewhere.
    fn check_set(&mut self, name: &str, entry: &Entry<'_>, base: FileKind) {
        let Some(key) = keys::find(name).filter(|_| base != FileKind::Web) else {
            return;
        };
        if key.relations.in_study.is_some() {
            self.reject(entry, name, not_varied(advice(name)));
        }
        let is_word = |word: &str| word == AUTO || key.kind.words().contains(&word);
        if matches!(key.kind, Kind::File(_)) && !entry.value.as_str().is_some_and(is_word) {
            let fault = Fault::new("names a file, which a study takes from its case", "write it there");
            self.reject(entry, name, fault);
        }
    }

    /// Refuses keys that are both set and varied or linked.
    fn check_once(&mut self, base: &dyn Base, set: &[(String, String)], factors: &[Factor], links: &[Link]) {
        let full = |name: &str| base.varied(name).map_or_else(|_| name.to_owned(), |key| key.name);
        let set: Vec<String> = set.iter().map(|(name, _)| full(name)).collect();
        let varied = factors.iter().map(|factor| &factor.key).chain(links.iter().map(|link| &link.key));
        for key in varied {
            if let Some(other) = set.iter().find(|set| *set == key || are_alternatives(set, key)) {
                self.reject_whole(key, set_twice(key, other));
            }
        }
    }

    /// The plan; `None` if the file has problems.
    ///
    /// * `set` – the keys that are the same at all points
    pub(super) fn plan(
        &mut self,
        base: &dyn Base,
        set: &[(String, String)],
        changes: &StudyChanges<'_>,
    ) -> Option<Plan> {
        let design_entry = self.entries.remove("design");
        let design = self.design(design_entry.as_ref());
        let seed = self.whole("seed", 0, u64::MAX).unwrap_or(base.seed_and_replicates().0);
        let common_phases = self.truth("common_phases").unwrap_or(true);
        let mut replicates = self.replicates(base);
        if let Some(asked) = changes.replicates {
            if !(1..=MOST_REPLICATES).contains(&asked) {
                self.reject_whole("replicates", reader::replicates(asked, MOST_REPLICATES));
            }
            replicates = Replicates::fixed(asked);
        }
        let factors = self.factors(design, base);
        let links = self.links(&factors, base);
        self.check_once(base, set, &factors, &links);
        if !self.problems.is_empty() {
            return None;
        }
        let order = links::order(&links).ok()?;
        if let Some(entry) = &design_entry {
            let base: Vec<f64> = factors.iter().map(|factor| base_value(base, factor)).collect();
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
            quantities: base.quantities(),
        })
    }
}

/// The value of a factor before anything varies; NaN if it has none.
pub(super) fn base_value(base: &dyn Base, factor: &Factor) -> f64 {
    base.varied(&factor.key).map_or(f64::NAN, |key| base.value(&key))
}
