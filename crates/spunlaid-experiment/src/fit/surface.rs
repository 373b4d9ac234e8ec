//! What the trials around a place say together: the numbers there, their slopes, and how far off values are.

use super::search::SearchState;
use super::webs::Webs;
use super::weights::{Matrix, gain, mean_of, weights};
use spunlaid_ground::statistics::dot;

/// The errors of the values: what each cause does to the coordinates.
pub(super) struct Errors {
    /// What each simulated web, taken as the scan, would do to the coordinates [by web].
    by_chance: Matrix,
    /// What other causes do [by cause].
    others: Matrix,
}

impl Errors {
    /// Covariance of the errors of two coordinates.
    pub(super) fn covariance(&self, i: usize, j: usize) -> f64 {
        let n = self.by_chance.len() as f64;
        // A web differs from the mean of the others by n/(n − 1) of its variance, the scan from the mean of
        // all by (n + 1)/n.
        let scale = (n - 1.0) * (n + 1.0) / (n * n);
        let chance = self.by_chance.iter().map(|web| web[i] * web[j]).sum::<f64>() / n * scale;
        chance + self.others.iter().map(|cause| cause[i] * cause[j]).sum::<f64>()
    }

    pub(super) fn standard_error(&self, i: usize) -> f64 {
        self.covariance(i, i).sqrt()
    }
}

/// What the trials around a place say together.
pub(super) struct Surface {
    /// Indices of the keys that change something.
    pub(super) keys: Vec<usize>,
    /// Logarithms of the numbers at the values.
    pub(super) numbers: Vec<f64>,
    /// Slopes of the numbers by each of these keys.
    pub(super) slopes: Matrix,
    /// What numbers do to the values.
    pub(super) gain: Matrix,
    pub(super) errors: Errors,
}

impl Surface {
    /// * `keys` – indices of the keys that may change something
    /// * `slopes` – by each key
    /// * `other_errors` – of the logarithms, by causes other than chance
    pub(super) fn new(
        webs: &Webs<'_>,
        place: &SearchState,
        mut keys: Vec<usize>,
        numbers: Vec<f64>,
        slopes: &Matrix,
        other_errors: &Matrix,
    ) -> Self {
        let (slopes, gain_of_all) = loop {
            let slopes: Matrix = keys.iter().map(|key| slopes[*key].clone()).collect();
            match gain(&place.weights, &slopes) {
                Ok(gain) => break (slopes, gain),
                // A key that changes nothing has no value of its own.
                Err(key) => keys.remove(key),
            };
        };
        let by_chance = webs.trials[place.trial].webs.iter().enumerate().map(|(i, _)| {
            let (weights, apart) = in_place_of_the_scan(webs, place, i, &webs.target.camera);
            let gain = gain(&weights, &slopes).unwrap_or_else(|_| gain_of_all.clone());
            gain.iter().map(|row| dot(row, &apart)).collect()
        });
        let by_chance = by_chance.collect();
        let causes = other_errors.iter().chain(&webs.target.camera);
        let others = causes.map(|errors| gain_of_all.iter().map(|row| dot(row, errors)).collect()).collect();
        let errors = Errors { by_chance, others };
        Self { keys, numbers, slopes, gain: gain_of_all, errors }
    }

    /// The step to the values with the least misfit, by key.
    ///
    /// * `from` – the step from the place to where these numbers are
    pub(super) fn step(&self, webs: &Webs<'_>, place: &SearchState, from: &[f64]) -> Vec<f64> {
        let at = webs.trials[place.trial].coordinates.iter().zip(from).map(|(place, from)| place + from);
        let at: Vec<f64> = at.collect();
        let residuals: Vec<f64> =
            webs.target.logarithms.iter().zip(&self.numbers).map(|(scan, number)| scan - number).collect();
        let mut step = vec![0.0; at.len()];
        for (key, row) in self.keys.iter().zip(&self.gain) {
            let [low, high] = webs.parameters[*key].ends();
            step[*key] = (at[*key] + dot(row, &residuals)).clamp(low, high) - at[*key];
        }
        step
    }
}

/// A web of a trial as if it were the scan and the others were all that were laid: the weights by these, and
/// how far it is from them.
///
/// * `errors` – standard errors of the logarithms by further causes
pub(super) fn in_place_of_the_scan(
    webs: &Webs<'_>,
    place: &SearchState,
    web: usize,
    errors: &[Vec<f64>],
) -> (Matrix, Vec<f64>) {
    let all = &webs.trials[place.trial].webs;
    let others = || all.iter().enumerate().filter(move |(other, _)| *other != web).map(|(_, web)| web);
    let weights = weights(others(), errors).unwrap_or_else(|| place.weights.clone());
    let mean = mean_of(others());
    (weights, all[web].iter().zip(&mean).map(|(web, mean)| web - mean).collect())
}
