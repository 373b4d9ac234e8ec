//! The design of a study: which keys vary, and how many points they make.

use super::super::entry::Entry;
use super::reader::{Reader, not_varied, not_written, unknown_key};
use super::{Base, MOST_FIBRES, MOST_POINTS, MOST_POINTS_UNASKED, VariedKey};
use crate::error::{Fault, nearest_word};
use crate::study::{Design, Factor};
use toml::de::DeValue;

impl Reader<'_> {
    pub(super) fn design(&mut self, entry: Option<&Entry<'_>>) -> Design {
        const NAMES: [&str; 5] = ["grid", "one-at-a-time", "paired", "latin-hypercube", "sobol"];
        let points_entry = self.entries.remove("points");
        let points = points_entry.as_ref().and_then(|entry| self.whole_in(entry, "points", 1, MOST_POINTS));
        let Some(entry) = entry else {
            let line = "design = \"grid\" (or \"one-at-a-time\", \"paired\", \"latin-hypercube\", \"sobol\")";
            self.missing("design", line);
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
                self.reject(entry, "design", Fault::not_one_of(nearest, &NAMES));
                return Design::Grid;
            }
        };
        match points_entry {
            None if draws => {
                self.missing("points", "points = 64, the number of points of the design");
            }
            Some(points) if !draws => {
                let advice = format!(
                    "the number of points of design = \"{text}\" follows from its values; remove this key"
                );
                self.reject(&points, "points", unknown_key(advice));
            }
            _ => {}
        }
        design
    }

    /// The key with this name; `None` if a study cannot vary it, after noting the problem.
    pub(super) fn varied(&mut self, base: &dyn Base, entry: &Entry<'_>, name: &str) -> Option<VariedKey> {
        let key = base.varied(name);
        key.map_err(|advice| self.reject(entry, name, not_varied(advice))).ok()
    }

    /// The keys that vary.
    pub(super) fn factors(&mut self, design: Design, base: &dyn Base) -> Vec<Factor> {
        let Some(entry) = self.entries.remove("vary") else {
            let line =
                "[vary] and below it a key and its values, like \"air.velocity\" = [\"5 m/s\", \"10 m/s\"]";
            self.missing("vary", line);
            return Vec::new();
        };
        let DeValue::Table(table) = entry.value else {
            self.wrong_type(&entry, "vary", "a table, [vary]");
            return Vec::new();
        };
        let flat = self.flat(table);
        if flat.is_empty() {
            let entry = Entry { value: DeValue::Boolean(true), ..entry };
            let fault = Fault::new(
                "names no key to vary",
                "write a key and its values, as in \"air.velocity\" = [\"5 m/s\", \"10 m/s\"]",
            );
            self.reject(&entry, "[vary]", fault);
        }
        let mut factors = Vec::new();
        for (key, entry) in flat {
            let Some(varied) = self.varied(base, &entry, &key) else {
                continue;
            };
            if factors.iter().any(|factor: &Factor| factor.key == varied.name) {
                let entry = Entry { shown: None, ..entry };
                self.reject(&entry, "", Fault::duplicate(&key));
                continue;
            }
            if let Some(levels) = self.levels(&varied, entry, design) {
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
            let message =
                format!("varies {found} keys; design = \"{}\" allows at most {most}", design.name());
            self.reject(entry, "design", Fault::new(message, "vary fewer keys, or choose another design"));
        }
        if let (Design::Paired, Some(first)) = (design, factors.first()) {
            let wanted = first.levels.count();
            for factor in factors.iter().filter(|factor| factor.levels.count() != wanted) {
                let found = factor.levels.count();
                let fault = Fault::new(
                    format!("has {found} values, but \"{}\" has {wanted}", first.key),
                    "paired lists must have the same length",
                );
                self.reject_whole(&factor.key, fault);
            }
        }
        if design == Design::OneAtATime {
            for (factor, base) in factors.iter().zip(base) {
                if base.is_nan() {
                    self.reject_whole(&factor.key, not_written("vary it around this value"));
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
            self.reject(entry, "design", too_many_points(&points, advice));
        } else if let Some(asked) = asked.filter(|asked| *asked != exact) {
            let fault = Fault::new(
                format!("makes {exact} points, but {asked} were requested"),
                format!("request {exact} points"),
            );
            self.reject(entry, "design", fault.option("--points"));
        } else if exact > MOST_POINTS_UNASKED && asked.is_none() {
            let advice = format!("request {exact} points by this number");
            self.reject(entry, "design", too_many_points(&exact.to_string(), advice));
        }
        let fibres = count * replicates as f64;
        if fibres > MOST_FIBRES as f64 && count <= MOST_POINTS as f64 {
            let most = MOST_FIBRES as f64;
            let fault = Fault::new(
                format!("needs {fibres:.1e} fibres in total; at most {most:e} are possible"),
                "reduce the replicates or the points",
            );
            self.reject(entry, "design", fault);
        }
    }
}

/// The fault of a design of more points than are flown without a request.
fn too_many_points(points: &str, remedy: String) -> Fault {
    let message =
        format!("makes {points} points; more than {MOST_POINTS_UNASKED} must be requested by their number");
    Fault::new(message, remedy).option("--points")
}
