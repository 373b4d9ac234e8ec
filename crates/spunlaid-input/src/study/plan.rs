//! The plan of a study: its file, checked as far as it can be before its points are made.

use super::super::Overrides;
use super::super::document::Named;
use super::super::entry::Entry;
use super::super::overrides::AUTO;
use super::super::write::quoted;
use super::{Base, Reader, StudyChanges, advice, links, not_varied, set_twice, values_before};
use spunlaid_experiment::{
    Design, Factor, Link, MOST_REPLICATES, Point, Quantity, Replicates, Study, StudyClaim,
};
use spunlaid_fibre::case::keys::{self, Kind};
use spunlaid_ground::{Diagnostic, Fault, FileKind};
use spunlaid_simulation::layers::full_names::replaced_by;
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
    pub(super) claims: Vec<StudyClaim>,
}

impl Plan {
    pub(super) fn study(self, points: Vec<Point>) -> Study {
        let Self { factors, links, design, seed, common_phases, mut replicates, claims, .. } = self;
        let before = self.quantities;
        let quantities = Study::quantities_of(&points);
        // Points may have patches that the web before them has not.
        for (index, _) in &mut replicates.until {
            let is_same = |quantity: &Quantity| quantity.name == before[*index].name;
            *index = quantities.iter().position(is_same).unwrap_or(*index);
        }
        Study { factors, links, design, seed, common_phases, replicates, points, quantities, claims }
    }
}

impl Reader<'_> {
    /// The name of the case, web or spinline to vary; `None` if it is missing or no text, which has been noted.
    pub(super) fn base(&self) -> Option<(String, FileKind)> {
        const BASES: [(&str, FileKind); 3] =
            [("case", FileKind::Case), ("web", FileKind::Web), ("spinline", FileKind::Spinline)];
        BASES.into_iter().find_map(|(key, kind)| Some((self.key_values.text(key)?, kind)))
    }

    /// The keys that are the same at all points, with their values as text: those of the file, and then those asked for
    /// from outside, which replace them.
    pub(super) fn set(&mut self, asked: Overrides<'_>, base: FileKind) -> Vec<(String, String)> {
        let mut set: Vec<(String, String)> = Vec::new();
        for Named { name, entry, .. } in self.named("set") {
            self.check_set(&name, &entry, base);
            set.push((name, entry.text.to_owned()));
        }
        let is_given = |(_, text): &&(String, String)| text.trim().trim_matches('"') != AUTO;
        let names: Vec<&str> = asked.values.iter().filter(is_given).map(|(key, _)| key.trim()).collect();
        let is_displaced = replaced_by(&names, false);
        set.retain(|(other, _)| !is_displaced(other));
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
            self.reject(name, entry, not_varied(advice(name)));
        }
        let is_word = |word: &str| word == AUTO || key.kind.words().contains(&word);
        if matches!(key.kind, Kind::File(_)) && !entry.value.as_str().is_some_and(is_word) {
            let fault = Fault::new("names a file, which a study takes from its case", "write it there");
            self.reject(name, entry, fault);
        }
    }

    /// Refuses keys that are both set and varied or linked.
    fn check_once(&mut self, base: &dyn Base, set: &[(String, String)], factors: &[Factor], links: &[Link]) {
        let full = |name: &str| base.varied(name).map_or_else(|_| name.to_owned(), |key| key.name);
        let set: Vec<String> = set.iter().map(|(name, _)| full(name)).collect();
        let varied = factors.iter().map(|factor| &factor.key).chain(links.iter().map(|link| &link.key));
        for key in varied {
            let is_it = |set: &&String| {
                let displaces = |one: &str, other: &str| replaced_by(&[one], false)(other);
                **set == key.name || displaces(set, &key.name) || displaces(&key.name, set)
            };
            if let Some(other) = set.iter().find(is_it) {
                self.key_values.reject(&key.name, set_twice(&key.name, other));
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
        let design = self.design();
        let seed = self.key_values.integer("seed").unwrap_or(base.seed_and_replicates().0);
        let common_phases = self.value("common_phases") != Some("false".into());
        let mut replicates = self.replicates(base);
        if let Some(asked) = changes.replicates {
            if !(1..=MOST_REPLICATES).contains(&asked) {
                let message = format!("= {asked} are asked for");
                let fault = Fault::new(message, format!("ask for 1 to {MOST_REPLICATES}"));
                let (place, key) = (self.key_values.whole(), "replicates".to_owned());
                self.key_values.problems.push(Diagnostic { place, key, ..fault.into() });
            }
            replicates = Replicates::fixed(asked);
        }
        let factors = self.factors(design, base);
        let links = self.links(&factors, base);
        // A key that is wrong where it varies would be reported once more by each claim.
        let is_sound = self.problems() == 0;
        let claims = if is_sound { self.claims(&factors, &base.quantities()) } else { Vec::new() };
        self.check_once(base, set, &factors, &links);
        if self.problems() > 0 {
            return None;
        }
        let order = links::order(&links).ok()?;
        let values = values_before(base, &factors);
        self.combination(design, &factors, &values);
        if self.problems() == 0 {
            self.size(design.count(&factors, &values), changes.points, replicates.at_most);
        }
        (self.problems() == 0).then_some(Plan {
            factors,
            links,
            order,
            design,
            seed,
            common_phases,
            replicates,
            quantities: base.quantities(),
            claims,
        })
    }
}
