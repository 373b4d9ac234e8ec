//! The design of a study: which keys vary, and how many points they make.

use super::super::entry::Entry;
use super::reader::Reader;
use super::{Base, MOST_FIBRES, MOST_POINTS, MOST_POINTS_UNASKED, Varied};
use crate::case::keys::nearest_word;
use crate::error::{Fault, StudyFault};
use crate::study::{Design, Factor};
use toml::de::DeValue;

impl Reader<'_> {
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

    /// The key with this name; `None` if a study cannot vary it, after noting the problem.
    pub(super) fn varied(&mut self, base: &dyn Base, entry: &Entry<'_>, name: &str) -> Option<Varied> {
        let key = base.varied(name);
        key.map_err(|advice| self.reject(entry, name, StudyFault::NotVaried { advice })).ok()
    }

    /// The keys that vary.
    pub(super) fn factors(&mut self, design: Design, base: &dyn Base) -> Vec<Factor> {
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
            let Some(varied) = self.varied(base, &entry, &key) else {
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
