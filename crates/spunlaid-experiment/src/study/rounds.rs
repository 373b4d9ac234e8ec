//! Statistics of the points of a study, and how many replicates each of them still needs.

use super::batch::Batch;
use super::journal::Journal;
use super::measures::Quantity;
use super::{Replicates, Study};
use spunlaid_ground::{Error, ErrorRole, Estimate};
use spunlaid_simulation::MEASURES;

/// Statistics of a point over its replicates.
#[derive(Clone, Debug, PartialEq)]
pub struct PointResults {
    /// Replicates measured.
    pub n: u64,
    /// Fibres lost: their computation diverged, or they did not reach the belt.
    pub lost: u64,
    /// Index of each of the study's quantities that is known, with its mean and standard error, which is NaN if it is
    /// not known. A study has many points, and many quantities that apply to none of them.
    known: Box<[u16]>,
    numbers: Box<[[f64; 2]]>,
}

impl PointResults {
    /// * `mean` – of each of the study's quantities; NaN without any replicate
    /// * `errors` – standard error of each mean; NaN if it is not known
    pub fn new(n: u64, lost: u64, mean: &[f64], errors: &[f64]) -> Self {
        let is_known = |i: &usize| !mean[*i].is_nan();
        let known: Vec<usize> = (0..mean.len()).filter(is_known).collect();
        let numbers = known.iter().map(|&i| [mean[i], errors[i]]).collect();
        Self { n, lost, known: known.iter().map(|&i| i as u16).collect(), numbers }
    }

    fn numbers(&self, quantity: usize) -> [f64; 2] {
        let at = self.known.binary_search_by_key(&quantity, |known| usize::from(*known));
        at.map_or([f64::NAN; 2], |at| self.numbers[at])
    }

    /// Mean of a quantity, by its index; NaN without any replicate.
    pub fn mean(&self, quantity: usize) -> f64 {
        self.numbers(quantity)[0]
    }

    /// Standard error of the mean of a quantity; NaN if it is not known.
    pub fn error(&self, quantity: usize) -> f64 {
        self.numbers(quantity)[1]
    }

    /// Mean and standard error of a measure of fibres. None without a measure of this name.
    pub fn find(&self, name: &str) -> Option<(f64, Option<f64>)> {
        let index = MEASURES.iter().position(|measure| measure.name == name)?;
        Some((self.mean(index), self.standard_error(index)))
    }

    /// Standard error of the mean of a quantity, by its index; `None` if it is not known, as that of a single fibre.
    pub fn standard_error(&self, quantity: usize) -> Option<f64> {
        Some(self.error(quantity)).filter(|error| !error.is_nan())
    }

    /// The error of the mean of a quantity by all its causes; None if one of them is not known, or if it has
    /// no other than the standard error.
    pub fn total_error(&self, quantities: &[Quantity], quantity: usize) -> Option<f64> {
        let further = || quantities[quantity].further_errors();
        let whole = further().map(|error| self.mean(error)).fold(self.error(quantity), f64::hypot);
        Some(whole).filter(|whole| further().next().is_some() && whole.is_finite())
    }
}

/// Statistics of a point over all its replicates.
///
/// # Errors
/// When the journal cannot be read.
pub fn results_of_point(study: &Study, journal: &mut Journal, point: usize) -> Result<PointResults, Error> {
    results_of(&study.quantities, journal, point, u64::MAX)
}

fn results_of(
    quantities: &[Quantity],
    journal: &mut Journal,
    point: usize,
    replicates: u64,
) -> Result<PointResults, Error> {
    let records = journal.records(point, replicates)?;
    let measured: Vec<_> = records.iter().filter_map(|record| record.outcome.measured()).collect();
    let estimate = |i: usize| Estimate::new(measured.iter().map(|values| values[i]).collect());
    let estimates: Vec<Estimate> = (0..quantities.len()).map(estimate).collect();
    let scatter = |i: usize| estimates[i].standard_error.unwrap_or(f64::NAN);
    let error = |i: usize| {
        let count = measured.len() as f64;
        // Webs whose counts are equal by chance have an error all the same.
        let is_one = count == 1.0 || scatter(i) == 0.0;
        let of_one = quantities[i].errors.iter().find(|(role, _)| *role == ErrorRole::OfOne);
        let of_one = of_one.filter(|_| is_one).map(|(_, other)| estimates[*other].mean);
        let of_one = of_one.filter(|error| error.is_finite());
        let of_one = of_one.map(|error| error / count.sqrt());
        of_one.unwrap_or_else(|| scatter(i))
    };
    let mean: Vec<f64> = estimates.iter().map(|estimate| estimate.mean).collect();
    let errors: Vec<f64> = (0..quantities.len()).map(error).collect();
    Ok(PointResults::new(measured.len() as u64, (records.len() - measured.len()) as u64, &mean, &errors))
}

/// The rounds of a study. In each round, all points get the replicates that they are known to need.
///
/// The decision for a point depends on its own replicates only, never on threads, machines or interruptions.
#[derive(Clone, Debug)]
pub struct Rounds {
    required: Vec<u64>,
    /// Points that may need more replicates.
    open: Vec<bool>,
}

impl Rounds {
    /// The first round of a study.
    pub fn new(study: &Study) -> Self {
        let points = study.points.len();
        Self {
            required: vec![study.replicates.at_least; points],
            open: vec![!study.replicates.until.is_empty(); points],
        }
    }

    /// Number of replicates of each point in this round.
    pub fn required(&self) -> &[u64] {
        &self.required
    }

    /// The replicates of every point that the journal does not hold yet.
    pub fn missing(&self, journal: &Journal) -> Vec<Batch> {
        let of_point = |(point, wanted): (usize, &u64)| {
            let lacking: Vec<u64> = (0..*wanted).filter(|i| !journal.holds(point, *i)).collect();
            let batches = lacking.chunk_by(|a, b| a + 1 == *b);
            batches
                .map(|all| Batch { point, replicates: all[0]..all[0] + all.len() as u64 })
                .collect::<Vec<_>>()
        };
        self.required.iter().enumerate().flat_map(of_point).collect()
    }

    /// Goes on to the next round, once the journal holds all fibres of this one. False if the study is complete.
    ///
    /// # Errors
    /// When the journal cannot be read.
    pub fn next(&mut self, study: &Study, journal: &mut Journal) -> Result<bool, Error> {
        let mut more = false;
        for point in 0..self.open.len() {
            if self.open[point] {
                let results = results_of(&study.quantities, journal, point, self.required[point])?;
                let next = more_replicates(&study.replicates, &results, self.required[point]);
                self.open[point] = next.is_some();
                self.required[point] = next.unwrap_or(self.required[point]);
                more |= self.open[point];
            }
        }
        Ok(more)
    }
}

/// The number of replicates that a point needs instead of `simulated`; `None` if these are enough.
fn more_replicates(replicates: &Replicates, results: &PointResults, simulated: u64) -> Option<u64> {
    // A point that loses its fibres would lose more of them.
    if simulated >= replicates.at_most || results.lost > 0 && results.n < 2 {
        return None;
    }
    let needed = |&(measure, fraction): &(usize, f64)| {
        let error = results.standard_error(measure).unwrap_or(f64::INFINITY);
        let allowed = fraction * results.mean(measure).abs();
        if error <= allowed { 0.0 } else { results.n as f64 * (error / allowed).powi(2) }
    };
    let needed = replicates.until.iter().map(needed).fold(0.0, f64::max);
    // An estimate from few fibres is rough, so the number at most doubles in a round.
    (needed > 0.0).then(|| {
        let most = simulated.saturating_mul(2).min(replicates.at_most);
        (needed.ceil() as u64).clamp((simulated + 1).min(most), most)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replicates_grow_to_what_the_error_asks_for() {
        let replicates = Replicates { at_least: 4, at_most: 100, until: vec![(0, 0.1)] };
        let results = |n: u64, mean: f64, error: f64| PointResults::new(n, 0, &[mean], &[error]);
        assert_eq!(more_replicates(&replicates, &results(4, 1.0, 0.1), 4), None);
        assert_eq!(more_replicates(&replicates, &results(4, -1.0, 0.1), 4), None);
        assert_eq!(more_replicates(&replicates, &results(4, 1.0, 0.12), 4), Some(6));
        assert_eq!(more_replicates(&replicates, &results(4, 1.0, 0.1000001), 4), Some(5));
        assert_eq!(more_replicates(&replicates, &results(4, 1.0, 5.0), 4), Some(8));
        assert_eq!(more_replicates(&replicates, &results(4, 0.0, 5.0), 4), Some(8));
        assert_eq!(more_replicates(&replicates, &results(80, 1.0, 5.0), 80), Some(100));
        assert_eq!(more_replicates(&replicates, &results(100, 1.0, 5.0), 100), None);
        assert_eq!(more_replicates(&replicates, &results(4, 0.0, 0.0), 4), None);
        let nothing = PointResults { n: 0, lost: 4, ..results(0, f64::NAN, f64::NAN) };
        assert_eq!(more_replicates(&replicates, &nothing, 4), None);
    }
}
