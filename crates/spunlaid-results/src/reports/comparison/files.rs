//! `comparison.json` and its table: what differs between two runs, and whether it is beyond chance.

use crate::effects::difference_text;
use crate::files::measured::{known, mean};
use crate::numbers::plus_minus;
use serde_json::{Value as Json, json};
use spunlaid_ground::{Difference, Estimate, Unit};

/// Two runs, measure by measure.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Names of the runs: what is compared, and with what.
    pub run: String,
    /// Name of the result that the others are compared with.
    pub against: String,
    /// How many pairs of replicates there are, if the runs are compared pair by pair.
    pub pairs: Option<usize>,
    /// Why so, in words.
    pub reason: String,
    /// What the errors in the table are.
    pub errors: &'static str,
    /// Measure by measure.
    pub measures: Vec<ComparedMeasure>,
    /// Where the streaks of a scan may come from, if the other one is a line.
    pub causes: Vec<Cause>,
}

/// A streak or a period, or what the line would make: its name, what the line says of it, and the same for files.
#[derive(Clone, Debug)]
pub struct Cause {
    pub(super) what: String,
    pub(super) words: String,
    pub(super) json: Json,
}

/// A measure of two runs.
#[derive(Clone, Debug)]
pub struct ComparedMeasure {
    /// Its name for the reader.
    pub label: String,
    /// Its name in `comparison.json`.
    pub column: String,
    /// The unit in which it is shown.
    pub unit: Unit,
    /// Of the run that is compared with, and of the other; NaN where one has none.
    pub means: [Estimate; 2],
    /// None where there are too few replicates for an error, or there is a doubt.
    pub difference: Option<Difference>,
    /// What a verdict of no significance follows from, if the standard errors alone do not show it.
    pub remark: Option<String>,
    /// Why one of the numbers is not to be had, so that nothing is said about the difference.
    pub doubt: Option<String>,
}

/// The comparisons as JSON, in SI units.
///
/// * `notes` – what is missing, and why
pub fn summary(comparisons: &[Comparison], notes: &[String]) -> String {
    // Of patches that a web does not have, the mean is null; a web has no number of replicates.
    let of_one = |estimate: &Estimate| {
        let finite = estimate.values.iter().filter(|value| value.is_finite()).count();
        let mut object = mean(estimate);
        if !estimate.values.is_empty() {
            object["n"] = finite.into();
        }
        object
    };
    let measure = |compared: &ComparedMeasure| {
        let ([against, run], difference) = (&compared.means, compared.difference);
        let mut object = json!({
            "against": of_one(against),
            "run": of_one(run),
            "difference": difference.map(|d| d.value),
            "standard_error": difference.map(|d| d.standard_error),
            // Half the width of the 95 % interval.
            "half_width": difference.map(|d| d.half_width()),
            "significant": difference.map(|d| d.is_significant()),
        });
        for (name, why) in [("remark", &compared.remark), ("no_verdict", &compared.doubt)] {
            why.iter().for_each(|why| object[name] = why.as_str().into());
        }
        (compared.column.clone(), object)
    };
    let comparison = |comparison: &Comparison| {
        let causes: Vec<&Json> = comparison.causes.iter().map(|cause| &cause.json).collect();
        let mut json = json!({
            "run": comparison.run,
            "against": comparison.against,
            "paired": comparison.pairs.is_some(),
            "pairs": comparison.pairs,
            "reason": comparison.reason,
            "measures": comparison.measures.iter().map(measure).collect::<Json>(),
        });
        if !causes.is_empty() {
            json["streaks"] = json!(causes);
        }
        json
    };
    let comparisons: Json = comparisons.iter().map(comparison).collect();
    let notes = (!notes.is_empty()).then_some(notes);
    crate::files::versioned_json(1, known(json!({"comparisons": comparisons, "notes": notes})))
}

impl Comparison {
    /// How many measures differ beyond chance, of how many.
    pub fn significant(&self) -> (usize, usize) {
        let known: Vec<bool> = self
            .measures
            .iter()
            .filter_map(|measure| measure.difference.map(|d| d.is_significant()))
            .collect();
        (known.iter().filter(|is| **is).count(), known.len())
    }
}

impl ComparedMeasure {
    /// Both means, the difference with its sign, and the verdict, in the unit of the measure.
    pub fn cells(&self) -> [String; 4] {
        let factor = self.unit.per_si;
        let mean = |estimate: &Estimate| {
            plus_minus(estimate.mean * factor, estimate.standard_error.map(|error| error * factor))
        };
        let difference = self.difference.map_or_else(|| "–".to_owned(), |d| difference_text(&d, factor));
        let verdict = match self.difference {
            None => self.doubt.clone().unwrap_or_else(|| "too few data".to_owned()),
            Some(d) if d.value == 0.0 && d.standard_error == 0.0 => "the same".to_owned(),
            Some(d) if d.is_significant() => "significant".to_owned(),
            Some(_) => {
                self.remark.iter().fold("not significant".to_owned(), |v, remark| format!("{v}: {remark}"))
            }
        };
        [mean(&self.means[0]), mean(&self.means[1]), difference, verdict]
    }
}
