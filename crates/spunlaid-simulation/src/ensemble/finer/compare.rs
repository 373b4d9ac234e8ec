//! What differs between the flights of a check.

use super::flights::{Flight, Path};
use super::{Change, FinerCheck, FinerPlan, OF_MEASURES, OF_THE_END, OF_THE_LAID, Statistic, Unchecked};
use spunlaid_ground::Estimate;

/// Amplitude below which the fibre does not move but for rounding, as a share of its length.
const ROUNDING: f64 = 1e-12;
/// Standard errors by which a change is surely away from something.
const SURE: f64 = 2.0;

impl FinerPlan {
    /// Compares its flights, or the last one with paths of the run. An error is the reason why nothing can be said.
    pub(super) fn compare(
        &self,
        paths: &[Option<Path>],
        flights: &[Flight],
    ) -> Result<FinerCheck, Unchecked> {
        let check = FinerCheck {
            refined: self.refined,
            scheme: self.fine.run.scheme,
            time_step: self.fine.run.time_step,
            element_length: self.fine.fibre.rest_length(),
            duration: self.fine.run.duration(),
            is_fed: self.fine.line.is_some(),
            is_resolved: self.is_resolved(),
            has_scheme_of_run: self.has_scheme_of_run,
            replicates: flights.first().map_or(0, |flight| flight.trajectories.len()),
            share_of_run: self.share_of_run,
            path: None,
            changes: Vec::new(),
            of_measures: Vec::new(),
        };
        let found = match flights {
            [fine] => self.compare_paths(check, paths, &fine.paths),
            [coarse, fine] => self.compare_statistics(check, [coarse, fine, fine]),
            [coarse, fine, finest] => self.compare_statistics(check, [coarse, fine, finest]),
            _ => return Err(Unchecked::Stopped),
        };
        found.ok_or_else(|| {
            let why = match &self.fine.line {
                Some(_) => "the fibre laid nothing down",
                None => "the free end does not move across the flow",
            };
            Unchecked::Other(why.to_owned())
        })
    }

    /// Length below which the fibre does not move but for rounding [m].
    fn least(&self) -> f64 {
        ROUNDING * self.fine.fibre.length
    }

    /// The paths of the run beside those of the finer flight; none where no free end moves.
    fn compare_paths(
        &self,
        mut check: FinerCheck,
        coarse: &[Option<Path>],
        fine: &[Option<Path>],
    ) -> Option<FinerCheck> {
        let (mut apart, mut amplitudes) = (Vec::new(), Vec::new());
        // A fibre that the run has lost has no path.
        for (coarse, fine) in coarse.iter().zip(fine).filter_map(|(a, b)| a.as_ref().zip(b.as_ref())) {
            let fine = &fine[..coarse.len().min(fine.len())];
            let amplitude = amplitude(fine);
            if amplitude > self.least() {
                apart.push(rms_distance(coarse, fine) / amplitude);
                amplitudes.push(self::amplitude(coarse) / amplitude - 1.0);
            }
        }
        if apart.is_empty() || apart.iter().chain(&amplitudes).any(|value| !value.is_finite()) {
            return None;
        }
        check.replicates = apart.len();
        check.path = Some(Estimate::new(apart));
        check.changes = vec![Change::new(&OF_THE_END[0], Estimate::new(amplitudes))];
        Some(check)
    }

    /// The statistics of the flights, the last of which is finer still or the second one again; none where the fibre
    /// does not move.
    fn compare_statistics(&self, mut check: FinerCheck, flights: [&Flight; 3]) -> Option<FinerCheck> {
        let statistics = if check.is_fed { OF_THE_LAID } else { OF_THE_END };
        let change = |statistic: &'static Statistic| self.change(statistic, flights);
        check.changes = statistics.iter().filter_map(change).collect();
        check.of_measures = OF_MEASURES.iter().filter_map(change).collect();
        let moves = check.changes.first().is_some_and(|change| change.statistic == &statistics[0]);
        moves.then_some(check)
    }

    /// How a statistic changes; none where it is not defined, or is nothing but rounding.
    fn change(&self, statistic: &'static Statistic, flights: [&Flight; 3]) -> Option<Change> {
        let [coarse, fine, finest] = flights.map(|flight| &flight.trajectories);
        let each = coarse.iter().zip(fine).zip(finest);
        let each = each.map(|((a, b), c)| [a, b, c].map(|simulated| statistic.measure(simulated)));
        let each: Vec<[f64; 3]> = each.filter(|of| of.iter().all(|value| value.is_finite())).collect();
        let is_rounding = each.iter().all(|of| of[1].abs() <= self.least());
        let size = size_of_both_signs(&each);
        let change = |a: usize, b: usize| {
            let pairs: Vec<[f64; 2]> = each.iter().map(|of| [of[a], of[b]]).collect();
            size.map_or_else(|| ratio(&pairs), |size| Some(differences(&pairs, size)))
        };
        let estimate = change(0, 1).filter(|_| !is_rounding)?;
        let mut found = Change { size, ..Change::new(statistic, estimate) };
        if let Some((finest, next)) = self.finest.as_ref().zip(change(1, 2)) {
            found.is_second_order = self.resolves_eddies && shows_second_order(&found.estimate, &next);
            found.from_quarter = change(0, 2).map(|estimate| (finest.fibre.rest_length(), estimate));
        }
        Some(found)
    }
}

/// Root mean square of a statistic that has both signs; none of one that keeps its sign. The mean of such a statistic
/// may be close to zero accidentally, so that no change is a fraction of it.
fn size_of_both_signs(each: &[[f64; 3]]) -> Option<f64> {
    let all = || each.iter().flat_map(|of| &of[..2]);
    let has_both_signs = all().any(|value| *value > 0.0) && all().any(|value| *value < 0.0);
    has_both_signs.then(|| (all().map(|value| value * value).sum::<f64>() / all().count() as f64).sqrt())
}

/// Differences of pairs of the same turbulence, as fractions of a size.
fn differences(pairs: &[[f64; 2]], size: f64) -> Estimate {
    Estimate::new(pairs.iter().map(|[a, b]| (a - b) / size).collect())
}

/// Whether a change falls fourfold with the next halving, as it does of second order: four times the next one is
/// surely more than half and less than one and a half of it. Of first order it is twice as much.
fn shows_second_order(change: &Estimate, next: &Estimate) -> bool {
    // Both are of the same replicates, so that their difference has an error of its own.
    let errors_above = |share: f64| {
        let pairs = change.values.iter().zip(&next.values);
        let above = Estimate::new(pairs.map(|(change, next)| 4.0 * next - share * change).collect());
        change.mean.signum() * above.mean / above.standard_error.unwrap_or(f64::INFINITY)
    };
    errors_above(0.5) > SURE && errors_above(1.5) < -SURE
}

/// Ratio of the means minus one, from pairs of the same turbulence. Its standard error is that of the ratio
/// estimator: of the mean of `aᵢ − R bᵢ`, over the mean of `b`. The values are `R − 1 + (aᵢ − R bᵢ)/b̄`.
///                                                                                             theory.md (58)
fn ratio(pairs: &[[f64; 2]]) -> Option<Estimate> {
    let sum = |which: usize| pairs.iter().map(|pair| pair[which]).sum::<f64>();
    let ratio = sum(0) / sum(1);
    let mean = sum(1) / pairs.len() as f64;
    let values: Vec<f64> = pairs.iter().map(|[a, b]| ratio - 1.0 + (a - ratio * b) / mean).collect();
    (!values.is_empty() && values.iter().all(|value| value.is_finite())).then(|| Estimate::new(values))
}

/// Rms distance of a path from its mean [m].
fn amplitude(path: &[[f64; 2]]) -> f64 {
    let count = path.len() as f64;
    let mean = [0, 1].map(|axis| path.iter().map(|point| point[axis]).sum::<f64>() / count);
    rms_distance(path, &vec![mean; path.len()])
}

fn rms_distance(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2));
    (squares.sum::<f64>() / a.len() as f64).sqrt()
}
