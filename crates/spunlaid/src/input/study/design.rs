//! The design of a study: which keys vary, and how many points they make.

use super::super::document::Named;
use super::reader::{Reader, not_varied, not_written};
use super::{Base, MOST_FIBRES, MOST_POINTS_UNASKED, VariedKey};
use crate::error::{Fault, Finding};
use crate::study::{Design, Factor, MOST_POINTS, Study};

impl<'a> Reader<'a> {
    pub(super) fn design(&mut self) -> Design {
        let points = self.key_values.integer("points");
        let name = self.key_values.text("design").unwrap_or_default();
        let all = Design::all(points.unwrap_or(1)).into_iter();
        // One that is unknown or missing has been noted.
        let Some(design) = all.into_iter().find(|design| design.name() == name) else { return Design::Grid };
        let is_told = self.key_values.get("points").is_some() || self.key_values.is_excused("points");
        let fault = match (design.draws(), is_told) {
            (true, false) => Fault::missing("", "points = 64, the number of points of the design"),
            (false, true) => Fault::new(
                format!("does not fit design = \"{name}\", whose number of points follows from its values"),
                "leave it out",
            ),
            _ => return design,
        };
        self.key_values.reject("points", fault);
        design
    }

    /// The key that is named; `None` if a study cannot vary it or it is one of some others, after noting the problem.
    pub(super) fn varied(
        &mut self,
        base: &dyn Base,
        named: &Named<'a, Study>,
        others: &[&str],
    ) -> Option<VariedKey> {
        let Named { name, entry, .. } = named;
        match base.varied(name) {
            Ok(key) if others.contains(&&*key.name) => {
                let (place, value) = (entry.place.clone(), None);
                let what = Fault::duplicate(name);
                self.key_values.problems.push(Finding { place, key: String::new(), value, what });
                None
            }
            key => key.map_err(|advice| self.reject(name, entry, not_varied(advice))).ok(),
        }
    }

    /// The keys that vary.
    pub(super) fn factors(&mut self, design: Design, base: &dyn Base) -> Vec<Factor> {
        let mut factors: Vec<Factor> = Vec::new();
        for named in self.named("vary") {
            let keys: Vec<&str> = factors.iter().map(|factor| &*factor.key).collect();
            let Some(varied) = self.varied(base, &named, &keys) else { continue };
            if let Some(levels) = self.levels(&varied, named, design) {
                factors.push(varied.factor(levels));
            }
        }
        factors
    }

    /// Checks the factors together.
    ///
    /// * `base` – values of the factors before they vary; NaN for none
    pub(super) fn combination(&mut self, design: Design, factors: &[Factor], base: &[f64]) {
        if let (Design::Paired, Some(first)) = (design, factors.first()) {
            let wanted = first.levels.count();
            for factor in factors.iter().filter(|factor| factor.levels.count() != wanted) {
                let found = factor.levels.count();
                let fault = Fault::new(
                    format!("has {found} values, but \"{}\" has {wanted}", first.key),
                    "paired lists must have the same length",
                );
                self.key_values.reject(&factor.key, fault);
            }
        }
        if design == Design::OneAtATime {
            for (factor, base) in factors.iter().zip(base) {
                if base.is_nan() {
                    self.key_values.reject(&factor.key, not_written("vary it around this value"));
                }
            }
        }
    }

    /// Checks the number of points, and that of fibres.
    pub(super) fn size(&mut self, count: f64, asked: Option<u64>, replicates: u64) {
        let exact = count as u64;
        if count > MOST_POINTS as f64 {
            let points = if count < 1e15 { exact.to_string() } else { format!("{count:.1e}") };
            let advice = format!(
                "at most {MOST_POINTS} are possible: vary fewer keys or values, or write design = \"latin-hypercube\""
            );
            self.key_values.reject("design", too_many_points(&points, advice));
        } else if let Some(asked) = asked.filter(|asked| *asked != exact) {
            let fault = Fault::new(
                format!("makes {exact} points, but {asked} were requested"),
                format!("request {exact} points"),
            );
            self.key_values.reject("design", fault.option("--points"));
        } else if exact > MOST_POINTS_UNASKED && asked.is_none() {
            let advice = format!("request {exact} points by this number");
            self.key_values.reject("design", too_many_points(&exact.to_string(), advice));
        }
        let fibres = count * replicates as f64;
        if fibres > MOST_FIBRES as f64 && count <= MOST_POINTS as f64 {
            let most = MOST_FIBRES as f64;
            let fault = Fault::new(
                format!("needs {fibres:.1e} fibres in total; at most {most:e} are possible"),
                "reduce the replicates or the points",
            );
            self.key_values.reject("design", fault);
        }
    }
}

/// The fault of a design of more points than are flown without a request.
fn too_many_points(points: &str, remedy: String) -> Fault {
    let message =
        format!("makes {points} points; more than {MOST_POINTS_UNASKED} must be requested by their number");
    Fault::new(message, remedy).option("--points")
}
