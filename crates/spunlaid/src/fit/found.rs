//! What a fit has found: the values with their intervals, the profile of the misfit, and whether such webs can look like the scan at all.

use super::parameter::Parameter;
use super::search::{Place, rest};
use super::texture::Texture;
use super::webs::Webs;
use super::weights::{Matrix, gain, information, mean_of, misfit, unexplained, weights};
use crate::error::Error;
use crate::statistics::linear::{dot, inverse};
use crate::statistics::student_t_95;

/// What was found.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The keys with their values.
    pub keys: Vec<FittedKey>,
    /// Correlations of the errors of the values, key by key.
    pub correlations: Vec<Vec<f64>>,
    /// Keys that the data cannot tell apart: their indices, and what a rise of the first by a tenth is made up for with.
    pub alike: Vec<Alike>,
    /// What was compared.
    pub numbers: Vec<FittedNumber>,
    /// The misfit at the start and at the end.
    pub misfit: [f64; 2],
    /// So many of the simulated webs, each taken as the scan, would have had a larger misfit.
    pub worse: u64,
    /// Simulated webs of each trial.
    pub webs: u64,
    /// All trials.
    pub trials: Vec<TrialOfFit>,
    /// Whether the search has ended because its steps had become short.
    pub settled: bool,
    /// Trials whose webs could not be laid: their values, and why.
    pub refused: Vec<(Vec<f64>, String)>,
}

/// A trial.
#[derive(Clone, Debug, PartialEq)]
pub struct TrialOfFit {
    /// Values of the keys [SI].
    pub values: Vec<f64>,
    /// Its misfit.
    pub misfit: f64,
}

/// A key with its value.
#[derive(Clone, Debug)]
pub struct FittedKey {
    /// The key.
    pub parameter: Parameter,
    /// Its value [SI].
    pub value: f64,
    /// The 95 % confidence interval, cut at the range of the key [SI], or why none can be given.
    pub interval: Result<[f64; 2], String>,
    /// The least misfit for other values of this key: value [SI] and misfit.
    pub profile: Vec<(f64, f64)>,
    /// Why the value is not to be trusted, if so.
    pub doubt: Option<KeyDoubt>,
}

/// Why the value of a key is not to be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyDoubt {
    /// It changes nothing of what is compared.
    NoEffect,
    /// The interval is as wide as the range: the data do not know it.
    Unknown,
    /// It lies at an end of its range.
    AtEnd,
}

/// Two keys that the data cannot tell apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alike {
    /// Indices of the keys.
    pub keys: [usize; 2],
    /// Correlation of their errors.
    pub correlation: f64,
    /// By so many steps of its coordinate the second changes when the first grows by one: of logarithms, the ratio of their relative changes.
    pub per_first: f64,
}

/// A number of the scan and of the simulated webs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FittedNumber {
    /// What it is.
    pub texture: Texture,
    /// Of the scan.
    pub scan: f64,
    /// Mean of the simulated webs of the start.
    pub start: f64,
    /// Mean of the simulated webs with the values that were found.
    pub found: f64,
    /// Standard deviation of its logarithm from one simulated web to another: a scan of such a web is as far off by chance.
    pub scatter: f64,
}

impl FittedNumber {
    /// How far the scan is from the fit, in standard deviations of a single web.
    pub fn residual(&self) -> f64 {
        libm::log(self.scan / self.found) / self.scatter
    }
}

/// Correlation from which two keys cannot be told apart.
const ALIKE: f64 = 0.95;
/// The profile is found at these distances from the value [standard errors].
const PROFILE: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];
/// A profile whose standard error differs by more than this factor from the straight one is not used.
const FAR: f64 = 3.0;

/// The errors of the values: what each cause does to the coordinates.
struct Errors {
    /// What each simulated web, taken as the scan, would do to the coordinates [by web].
    by_chance: Matrix,
    /// What other causes do [by cause].
    others: Matrix,
}

impl Errors {
    /// Covariance of the errors of two coordinates.
    fn covariance(&self, i: usize, j: usize) -> f64 {
        let n = self.by_chance.len() as f64;
        // A web differs from the mean of the others by n/(n − 1) of its variance, the scan from the mean of all by (n + 1)/n.
        let scale = (n - 1.0) * (n + 1.0) / (n * n);
        let chance = self.by_chance.iter().map(|web| web[i] * web[j]).sum::<f64>() / n * scale;
        chance + self.others.iter().map(|cause| cause[i] * cause[j]).sum::<f64>()
    }

    fn standard_error(&self, i: usize) -> f64 {
        self.covariance(i, i).sqrt()
    }
}

/// Makes the results of the place at which a search has ended.
///
/// * `other_errors` – standard errors of the logarithms by causes other than chance, each common to all numbers
///
/// # Errors
/// As [`Webs::trial`].
pub(super) fn found(webs: &mut Webs<'_>, place: &Place, other_errors: &Matrix) -> Result<Fit, Error> {
    let all = webs.parameters.len();
    // Keys that change nothing have no value of their own.
    let mut known: Vec<usize> = (0..all).collect();
    let (slopes, gain_of_all) = loop {
        let slopes: Matrix = known.iter().map(|key| place.slopes[*key].clone()).collect();
        match gain(&place.weights, &slopes) {
            Ok(gain) => break (slopes, gain),
            Err(key) => known.remove(key),
        };
    };
    let trial = webs.trials[place.trial].clone();
    let rest_of_scan = rest(webs, place.trial);
    let (mut by_chance, mut worse) = (Vec::new(), 0);
    let scan_misfit = misfit(&place.weights, &unexplained(&gain_of_all, &slopes, &rest_of_scan));
    for (i, web) in trial.webs.iter().enumerate() {
        // Each web as if it were the scan, and the others were all that were laid.
        let others =
            || trial.webs.iter().enumerate().filter(move |(other, _)| *other != i).map(|(_, web)| web);
        let weights = weights(others(), &webs.target.camera).unwrap_or_else(|| place.weights.clone());
        let mean = mean_of(others());
        let apart: Vec<f64> = web.iter().zip(&mean).map(|(web, mean)| web - mean).collect();
        let gain = gain(&weights, &slopes).unwrap_or_else(|_| gain_of_all.clone());
        by_chance.push(gain.iter().map(|row| dot(row, &apart)).collect());
        worse += u64::from(misfit(&weights, &unexplained(&gain, &slopes, &apart)) >= scan_misfit);
    }
    let causes = other_errors.iter().chain(&webs.target.camera);
    let others = causes.map(|errors| gain_of_all.iter().map(|row| dot(row, errors)).collect()).collect();
    let errors = Errors { by_chance, others };
    let information = information(&place.weights, &slopes);

    let mut keys = Vec::new();
    for key in 0..all {
        let own = known.iter().position(|known| *known == key);
        keys.push(match own {
            Some(own) => fitted_key(webs, place, (key, own, &known), &errors, &information)?,
            None => {
                let parameter = webs.parameters[key].clone();
                let interval = Err("it changes nothing of what is compared".to_owned());
                let (value, doubt) = (trial.values[key], Some(KeyDoubt::NoEffect));
                FittedKey { parameter, value, interval, profile: Vec::new(), doubt }
            }
        });
    }
    let mut correlations: Matrix =
        (0..all).map(|i| (0..all).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    let mut alike = Vec::new();
    for (i, key) in known.iter().enumerate() {
        for (j, other) in known.iter().enumerate().filter(|(j, _)| *j != i) {
            let correlation = (errors.covariance(i, j)
                / (errors.standard_error(i) * errors.standard_error(j)))
            .clamp(-1.0, 1.0);
            correlations[*key][*other] = correlation;
            if i < j && correlation.abs() >= ALIKE {
                let per_first = -information[i][j] / information[j][j];
                alike.push(Alike { keys: [*key, *other], correlation, per_first });
            }
        }
    }
    let numbers = (0..webs.target.logarithms.len()).map(|i| {
        let mean = trial.mean[i];
        let squares = trial.webs.iter().map(|web| (web[i] - mean).powi(2)).sum::<f64>();
        FittedNumber {
            texture: webs.target.textures.all[i],
            scan: libm::exp(webs.target.logarithms[i]),
            start: libm::exp(webs.trials[0].mean[i]),
            found: libm::exp(mean),
            scatter: (squares / (trial.webs.len() as f64 - 1.0)).sqrt(),
        }
    });
    let misfit_of = |trial: usize| misfit(&place.weights, &rest(webs, trial));
    let trials = (0..webs.trials.len())
        .map(|trial| TrialOfFit { values: webs.trials[trial].values.clone(), misfit: misfit_of(trial) });
    Ok(Fit {
        keys,
        correlations,
        alike,
        numbers: numbers.collect(),
        misfit: [misfit_of(0), misfit_of(place.trial)],
        worse,
        webs: webs.count,
        trials: trials.collect(),
        settled: place.settled,
        refused: webs.refused.iter().map(|(values, error)| (values.clone(), error.to_string())).collect(),
    })
}

/// A key with its profile and its interval.
///
/// * `key` – its index, that among the keys that change something, and those keys
fn fitted_key(
    webs: &mut Webs<'_>,
    place: &Place,
    (key, own, known): (usize, usize, &[usize]),
    errors: &Errors,
    information: &Matrix,
) -> Result<FittedKey, Error> {
    let parameter = webs.parameters[key].clone();
    let here = webs.trials[place.trial].clone();
    let ends = parameter.ends();
    let error = errors.standard_error(own);
    // The others follow as is best.
    let others: Vec<usize> = (0..known.len()).filter(|other| *other != own).collect();
    let of_others: Matrix =
        others.iter().map(|i| others.iter().map(|j| information[*i][*j]).collect()).collect();
    let inverse = inverse(of_others).unwrap_or_default();
    let follow: Vec<f64> = inverse
        .iter()
        .map(|row| -row.iter().zip(&others).map(|(share, i)| share * information[*i][own]).sum::<f64>())
        .collect();
    // The misfit rises by this for the square of a step of the coordinate, if all is straight.
    let curvature = information[own][own]
        + others.iter().zip(&follow).map(|(i, follow)| information[own][*i] * follow).sum::<f64>();
    let least = misfit(&place.weights, &rest(webs, place.trial));
    let mut profile = vec![(0.0, least)];
    for step in PROFILE {
        let step = (here.at[key] + step * error).clamp(ends[0], ends[1]) - here.at[key];
        if step.abs() < 0.1 * error || !step.is_finite() {
            continue;
        }
        let mut at = here.at.clone();
        at[key] += step;
        for (i, follow) in others.iter().zip(&follow) {
            let [low, high] = webs.parameters[known[*i]].ends();
            at[known[*i]] = (at[known[*i]] + follow * step).clamp(low, high);
        }
        if let Some(trial) = webs.trial(&at)? {
            // What is left for the others to do is little, and straight lines serve.
            let slopes: Matrix = others.iter().map(|i| place.slopes[known[*i]].clone()).collect();
            let rest = rest(webs, trial);
            let left = match gain(&place.weights, &slopes) {
                Ok(gain) => unexplained(&gain, &slopes, &rest),
                Err(_) => rest,
            };
            profile.push((step, misfit(&place.weights, &left)));
        }
    }
    profile.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = student_t_95(webs.count - 1) * error;
    let ends_of_interval = interval(&profile, curvature, half).map(|step| here.at[key] + step);
    let is_unknown = ends_of_interval[0] <= ends[0] && ends_of_interval[1] >= ends[1];
    let near = |end: f64| (here.at[key] - end).abs() < 1e-9 * (ends[1] - ends[0]);
    let doubt = if is_unknown {
        Some(KeyDoubt::Unknown)
    } else {
        (near(ends[0]) || near(ends[1])).then_some(KeyDoubt::AtEnd)
    };
    let in_range = ends_of_interval.map(|end| parameter.value(end.clamp(ends[0], ends[1])));
    let interval = webs.target.doubt().map_or(Ok(in_range), |doubt| Err(doubt.to_owned()));
    let profile =
        profile.iter().map(|(step, misfit)| (parameter.value(here.at[key] + step), *misfit)).collect();
    Ok(FittedKey { value: here.values[key], parameter, interval, profile, doubt })
}

/// The ends of the interval as steps from the value: where the profile has risen by as much as it would at the ends of the straight interval, if
/// it were a parabola.
///
/// * `profile` – steps and misfits, the smallest step first
/// * `half` – half the straight interval
fn interval(profile: &[(f64, f64)], curvature: f64, half: f64) -> [f64; 2] {
    let least = profile.iter().map(|(_, misfit)| *misfit).fold(f64::INFINITY, f64::min);
    let here = profile.iter().find(|(step, _)| *step == 0.0).map_or(least, |(_, misfit)| *misfit);
    // Signed square roots of the rise lie on a straight line for a parabola.
    let root =
        |(step, misfit): &(f64, f64)| (*step, ((misfit - here).max(0.0) / curvature).sqrt().copysign(*step));
    let roots: Vec<(f64, f64)> = profile.iter().map(root).collect();
    let end = |sign: f64| {
        let side = || roots.iter().filter(move |(step, _)| step * sign > 0.0);
        let nearest = |a: &&(f64, f64), b: &&(f64, f64)| {
            let far = |point: &(f64, f64)| (point.1.abs() - half).abs();
            far(a).total_cmp(&far(b))
        };
        let per_step = side().min_by(nearest).map_or(1.0, |(step, root)| root / step);
        let per_step = if (1.0 / FAR..FAR).contains(&per_step) { per_step } else { 1.0 };
        sign * half / per_step
    };
    [end(-1.0), end(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_a_parabola_is_straight_and_that_of_a_steeper_side_is_shorter() {
        let parabola = |step: f64| (step, 7.0 + 4.0 * step * step);
        let profile: Vec<(f64, f64)> = [-0.2, -0.1, 0.0, 0.1, 0.2].map(parabola).into();
        let [low, high] = interval(&profile, 4.0, 0.15);
        assert!((low + 0.15).abs() < 1e-12 && (high - 0.15).abs() < 1e-12);
        let steeper = |step: f64| (step, 7.0 + if step > 0.0 { 16.0 } else { 4.0 } * step * step);
        let profile: Vec<(f64, f64)> = [-0.2, -0.1, 0.0, 0.1, 0.2].map(steeper).into();
        let [low, high] = interval(&profile, 4.0, 0.15);
        assert!((low + 0.15).abs() < 1e-12 && (high - 0.075).abs() < 1e-12);
    }
}
