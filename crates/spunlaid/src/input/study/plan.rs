//! The plan of a study: its file, checked as far as it can be before its points are made.

use super::super::document::AUTO;
use super::super::entry::{Entry, in_order};
use super::super::open::Open;
use super::super::values::integer;
use super::super::write::quoted;
use super::super::{FORMAT_VERSION, Overrides};
use super::reader::Reader;
use super::{
    MOST_FIBRES, MOST_POINTS, MOST_POINTS_UNASKED, StudyChanges, Varied, level, links, numeric, varied,
};
use crate::case::keys::{self, Key, Kind, nearest_word};
use crate::error::{Fault, Finding, StudyFault};
use crate::study::{Design, Factor, Link, MEASURES, Point, Replicates, Study};
use crate::units::Dimension;
use toml::de::DeValue;

/// Largest number of replicates of a point.
const MOST_REPLICATES: u64 = 1_000_000;

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
            self.reject_whole("case", StudyFault::Missing { line });
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
                    self.reject(&version, "version", Fault::NewerVersion { known });
                    return false;
                }
                _ => self.reject(&version, "version", Fault::OutOfRange { least: 1, most: u64::from(known) }),
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
            self.reject(entry, name, StudyFault::NotVaried { advice: super::advice(name) });
        }
        let is_word = |word: &str| word == AUTO || key.kind.words().contains(&word);
        if matches!(key.kind, Kind::File(_)) && !entry.value.as_str().is_some_and(is_word) {
            self.reject(entry, name, StudyFault::FileSet);
        }
    }

    /// Refuses keys that are both set and varied or linked.
    fn check_once(&mut self, set: &[(String, String)], factors: &[Factor], links: &[Link]) {
        let varied = factors.iter().map(|factor| factor.key).chain(links.iter().map(|link| link.key));
        for key in varied.filter(|key| set.iter().any(|(set, _)| set == key)) {
            self.reject_whole(key, StudyFault::SetTwice);
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
                self.reject_whole("replicates", StudyFault::Replicates { asked, most: MOST_REPLICATES });
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

    pub(super) fn design(&mut self, entry: Option<&Entry<'_>>) -> Design {
        const NAMES: [&str; 5] = ["grid", "one-at-a-time", "paired", "latin-hypercube", "sobol"];
        let points_entry = self.entries.remove("points");
        let points = points_entry.as_ref().and_then(|entry| self.whole_in(entry, "points", 1, MOST_POINTS));
        let Some(entry) = entry else {
            let line = "design = \"grid\" (or \"one-at-a-time\", \"paired\", \"latin-hypercube\", \"sobol\")";
            self.reject_whole("design", StudyFault::Missing { line });
            return Design::Grid;
        };
        let DeValue::String(text) = &entry.value else {
            self.wrong_type(
                entry,
                "design",
                "\"grid\", \"one-at-a-time\", \"paired\", \"latin-hypercube\" or \"sobol\"",
            );
            return Design::Grid;
        };
        let draws = matches!(text.as_ref(), "latin-hypercube" | "sobol");
        let design = match text.as_ref() {
            "grid" => Design::Grid,
            "one-at-a-time" => Design::OneAtATime,
            "paired" => Design::Paired,
            "latin-hypercube" => Design::LatinHypercube(points.unwrap_or(1)),
            "sobol" => Design::Sobol(points.unwrap_or(1)),
            other => {
                let nearest = nearest_word(other, NAMES.into_iter());
                let nearest = nearest.map(|name| format!("\"{name}\""));
                self.reject(entry, "design", Fault::NotOneOf { nearest, allowed: NAMES.to_vec() });
                return Design::Grid;
            }
        };
        match points_entry {
            None if draws => {
                self.reject_whole(
                    "points",
                    StudyFault::Missing { line: "points = 64, the number of points of the design" },
                );
            }
            Some(points) if !draws => {
                let advice = format!(
                    "the number of points of design = \"{text}\" follows from its values; remove this key"
                );
                self.reject(&points, "points", StudyFault::UnknownKey { advice });
            }
            _ => {}
        }
        design
    }

    fn replicates(&mut self, base: &Open) -> Replicates {
        const MOST: u64 = MOST_REPLICATES;
        const KEYS: [&str; 3] = ["at_least", "at_most", "until"];
        let Some(entry) = self.entries.remove("replicates") else {
            return Replicates::fixed(base.case.run.replicates);
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
                "until" => until = self.until(entry),
                other => {
                    let advice = nearest_word(other, KEYS.into_iter()).map_or_else(
                        || "the keys are at_least, at_most and until".to_owned(),
                        |key| format!("did you mean {key}?"),
                    );
                    self.reject(&entry, &name, StudyFault::UnknownKey { advice });
                }
            }
        }
        let line = "[replicates] until = { amplitude_y = \"5 %\" }, the wanted standard error as a fraction of the mean";
        if until.is_empty() && self.problems.is_empty() {
            self.reject_whole("replicates.until", StudyFault::Missing { line });
        }
        let at_most = bounds[1].unwrap_or(100);
        let at_least = bounds[0].unwrap_or_else(|| at_most.min(8));
        if let Some(entry) = least.filter(|_| at_least > at_most) {
            self.reject(&entry, "replicates.at_least", StudyFault::MoreThanMost { most: at_most });
        }
        Replicates { at_least, at_most, until }
    }

    fn until(&mut self, entry: Entry<'a>) -> Vec<(usize, f64)> {
        let DeValue::Table(table) = entry.value else {
            self.wrong_type(&entry, "replicates.until", "a table, like { amplitude_y = \"5 %\" }");
            return Vec::new();
        };
        let mut until = Vec::new();
        for ((at, name), value) in in_order(table) {
            let key = format!("replicates.until.{name}");
            let entry = self.entry(at, value);
            let Some(measure) = MEASURES.iter().position(|measure| measure.name == name) else {
                let names = MEASURES.map(|measure| measure.name);
                let advice = nearest_word(&name, names.into_iter()).map_or_else(
                    || format!("the results are {}", names.join(", ")),
                    |name| format!("did you mean {name}?"),
                );
                self.reject(&entry, &key, StudyFault::UnknownResult { advice });
                continue;
            };
            match super::super::values::number(Dimension::Ratio, &entry.value) {
                Ok(fraction) if fraction > 0.0 && fraction < 1.0 => until.push((measure, fraction)),
                Ok(_) => self.reject(&entry, &key, StudyFault::NoFraction),
                Err(fault) => self.reject(&entry, &key, fault),
            }
        }
        until
    }

    fn links(&mut self, factors: &[Factor], base: &Open) -> Vec<Link> {
        let Some(entry) = self.entries.remove("link") else {
            return Vec::new();
        };
        let DeValue::Table(table) = entry.value else {
            self.wrong_type(&entry, "link", "a table, [link]");
            return Vec::new();
        };
        let (mut links, mut entries) = (Vec::new(), Vec::new());
        for (key, entry) in self.flat(table) {
            let Some(linked) = self.varied(&entry, &key) else {
                continue;
            };
            if numeric(linked.name).is_none() {
                self.reject(&entry, &key, StudyFault::WordsLinked);
                continue;
            }
            if factors.iter().any(|factor| factor.key == linked.name) {
                self.reject(&entry, &key, StudyFault::Twice);
                continue;
            }
            if links.iter().any(|link: &Link| link.key == linked.name) {
                let entry = Entry { shown: None, ..entry };
                self.reject(&entry, "", Fault::Duplicate { key });
                continue;
            }
            let DeValue::String(text) = &entry.value else {
                self.wrong_type(
                    &entry,
                    &key,
                    "a formula in quotes, like \"air.velocity / (4 * air.length_scale)\"",
                );
                continue;
            };
            match links::read(linked, text) {
                Ok(link) => {
                    links.push(link);
                    entries.push(entry);
                }
                Err(fault) => self.reject(&entry, &key, fault),
            }
        }
        let keys = factors.iter().map(|factor| factor.key).chain(links.iter().map(|link| link.key));
        let keys: Vec<&str> = keys.collect();
        for (link, entry) in links.iter().zip(&entries) {
            if let Some(name) = links::unwritten(link, &keys, base) {
                let purpose = "use it in a formula";
                let (place, key) = (entry.place.clone(), name.to_owned());
                let what = StudyFault::NotWritten { purpose }.into();
                self.problems.push(Finding { place, key, value: None, what });
            }
        }
        if let Err((link, fault)) = links::order(&links) {
            self.reject(&entries[link], links[link].key, fault);
        }
        links
    }

    /// The key of a case; `None` if a study cannot vary it, after noting the problem.
    fn varied(&mut self, entry: &Entry<'_>, name: &str) -> Option<&'static Key> {
        let key = varied(name);
        if key.is_none() {
            self.reject(entry, name, StudyFault::NotVaried { advice: super::advice(name) });
        }
        key
    }

    /// The keys that vary.
    ///
    /// * `find` – a key by its name; `None` if it cannot vary, after noting the problem
    pub(super) fn factors(
        &mut self,
        design: Design,
        mut find: impl FnMut(&mut Self, &Entry<'_>, &str) -> Option<Varied>,
    ) -> Vec<Factor> {
        let Some(entry) = self.entries.remove("vary") else {
            let line =
                "[vary] and below it a key and its values, like \"air.velocity\" = [\"5 m/s\", \"10 m/s\"]";
            self.reject_whole("vary", StudyFault::Missing { line });
            return Vec::new();
        };
        let DeValue::Table(table) = entry.value else {
            self.wrong_type(&entry, "vary", "a table, [vary]");
            return Vec::new();
        };
        let flat = self.flat(table);
        if flat.is_empty() {
            let entry = Entry { value: DeValue::Boolean(true), ..entry };
            self.reject(&entry, "[vary]", StudyFault::NothingVaries);
        }
        let mut factors = Vec::new();
        for (key, entry) in flat {
            let Some(varied) = find(self, &entry, &key) else {
                continue;
            };
            if factors.iter().any(|factor: &Factor| factor.key == varied.name) {
                let entry = Entry { shown: None, ..entry };
                self.reject(&entry, "", Fault::Duplicate { key });
                continue;
            }
            if let Some(levels) = self.levels(varied, entry, design) {
                factors.push(varied.factor(levels));
            }
        }
        factors
    }

    /// Checks the factors together.
    ///
    /// * `base` – values of the factors before they vary; NaN for none
    pub(super) fn combination(
        &mut self,
        entry: &Entry<'_>,
        design: Design,
        factors: &[Factor],
        base: &[f64],
    ) {
        let (found, most) = (factors.len(), design.most_factors());
        if found > most {
            self.reject(entry, "design", StudyFault::TooManyFactors { found, design: design.name(), most });
        }
        if let (Design::Paired, Some(first)) = (design, factors.first()) {
            let wanted = first.levels.count();
            for factor in factors.iter().filter(|factor| factor.levels.count() != wanted) {
                let found = factor.levels.count();
                self.reject_whole(factor.key, StudyFault::Unpaired { found, first: first.key, wanted });
            }
        }
        if design == Design::OneAtATime {
            for (factor, base) in factors.iter().zip(base) {
                if base.is_nan() {
                    let purpose = "vary it around this value";
                    self.reject_whole(factor.key, StudyFault::NotWritten { purpose });
                }
            }
        }
    }

    /// Checks the number of points, and that of fibres.
    pub(super) fn size(&mut self, entry: &Entry<'_>, count: f64, asked: Option<u64>, replicates: u64) {
        let exact = count as u64;
        if count > MOST_POINTS as f64 {
            let points = if count < 1e15 { exact.to_string() } else { format!("{count:.1e}") };
            let advice = format!(
                "at most {MOST_POINTS} are possible: vary fewer keys or values, or write design = \"latin-hypercube\""
            );
            let most = MOST_POINTS_UNASKED;
            self.reject(entry, "design", StudyFault::TooManyPoints { points, most, advice });
        } else if let Some(asked) = asked.filter(|asked| *asked != exact) {
            self.reject(entry, "design", StudyFault::OtherPoints { points: exact, asked });
        } else if exact > MOST_POINTS_UNASKED && asked.is_none() {
            let advice = format!("request {exact} points by this number");
            let (points, most) = (exact.to_string(), MOST_POINTS_UNASKED);
            self.reject(entry, "design", StudyFault::TooManyPoints { points, most, advice });
        }
        let fibres = count * replicates as f64;
        if fibres > MOST_FIBRES as f64 && count <= MOST_POINTS as f64 {
            let most = MOST_FIBRES as f64;
            self.reject(entry, "design", StudyFault::TooManyFibres { fibres, most });
        }
    }
}

/// The value of a factor in the base case; NaN if it has none.
pub(super) fn of_base(base: &Open, factor: &Factor) -> f64 {
    let value =
        |key| if factor.words.is_empty() { base.number(key) } else { level(key, &key.get(&base.case)?) };
    varied(factor.key).and_then(value).unwrap_or(f64::NAN)
}
