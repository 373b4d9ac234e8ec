//! What differs between the flights of a check.

use super::flights::{Flight, Path};
use super::{Change, FinerCheck, FinerPlan, OF_THE_END, OF_THE_LAID, Unchecked};
use crate::statistics::Estimate;

/// Amplitude below which the fibre does not move but for rounding, as a share of its length.
const ROUNDING: f64 = 1e-12;

impl FinerPlan {
    /// Compares its flights, or the last one with paths of the run. An error is the reason why nothing can be said.
    pub(super) fn compare(
        &self,
        paths: &[Option<Path>],
        flights: &[Flight],
    ) -> Result<FinerCheck, Unchecked> {
        let (Some(coarse), Some(fine)) = (flights.first(), flights.last()) else {
            return Err(Unchecked::Stopped);
        };
        let still = || {
            let fed = self.fine.line.is_some();
            let why = if fed {
                "the fibre laid nothing down"
            } else {
                "the free end does not move across the flow"
            };
            Unchecked::Other(why.to_owned())
        };
        let least = ROUNDING * self.fine.fibre.length;
        let mut check = FinerCheck {
            refined: self.refined,
            scheme: self.fine.run.scheme,
            time_step: self.fine.run.time_step,
            element_length: self.fine.fibre.rest_length(),
            duration: self.fine.run.duration(),
            is_fed: self.fine.line.is_some(),
            is_resolved: self.is_resolved(),
            replicates: fine.trajectories.len(),
            share_of_run: self.share_of_run,
            path: None,
            changes: Vec::new(),
        };
        if self.coarse.is_none() {
            let (mut apart, mut amplitudes) = (Vec::new(), Vec::new());
            // A fibre that the run has lost has no path.
            let pairs = paths.iter().zip(&fine.paths);
            for (coarse, fine) in pairs.filter_map(|(coarse, fine)| coarse.as_ref().zip(fine.as_ref())) {
                let fine = &fine[..coarse.len().min(fine.len())];
                let amplitude = amplitude(fine);
                if amplitude > least {
                    apart.push(rms_distance(coarse, fine) / amplitude);
                    amplitudes.push(self::amplitude(coarse) / amplitude - 1.0);
                }
            }
            if apart.is_empty() || apart.iter().chain(&amplitudes).any(|value| !value.is_finite()) {
                return Err(still());
            }
            check.replicates = apart.len();
            check.path = Some(Estimate::new(apart));
            check.changes = vec![Change { statistic: &OF_THE_END[0], estimate: Estimate::new(amplitudes) }];
            return Ok(check);
        }
        let statistics = if self.fine.line.is_some() { OF_THE_LAID } else { OF_THE_END };
        for statistic in statistics {
            let pairs = coarse
                .trajectories
                .iter()
                .zip(&fine.trajectories)
                .map(|(coarse, fine)| [statistic.measure(coarse), statistic.measure(fine)]);
            let pairs: Vec<[f64; 2]> =
                pairs.filter(|pair| pair.iter().all(|value| value.is_finite())).collect();
            // Of a fibre that does not move, rounding has no meaning.
            let moves = statistic.name == "frequency" || pairs.iter().all(|pair| pair[1] > least);
            if let Some(estimate) = ratio(&pairs).filter(|_| moves) {
                check.changes.push(Change { statistic, estimate });
            }
        }
        let moves = check.changes.first().is_some_and(|change| change.statistic == &statistics[0]);
        if moves { Ok(check) } else { Err(still()) }
    }
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
