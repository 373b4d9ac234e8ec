//! What a fit has found: the values with their intervals, the profile of the misfit, and whether such webs
//! can look like the scan at all.

use super::interval::{Ends, IntervalEnd};
use super::parameter::Parameter;
use super::search::{SearchState, residuals_of};
use super::surface::{Surface, in_place_of_the_scan};
use super::texture::Texture;
use super::values::Values;
use super::webs::Webs;
use super::weights::{Matrix, gain, information, misfit, unexplained, weights};

/// What was found.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The keys with their values.
    pub keys: Vec<FittedKey>,
    /// Correlations of the errors of the values, key by key.
    pub correlations: Vec<Vec<f64>>,
    /// Keys that the data cannot distinguish: their indices, and what a rise of the first by a tenth is made
    /// up for with.
    pub alike: Vec<InseparableKeys>,
    /// What was compared.
    pub numbers: Vec<FittedNumber>,
    /// The misfit at the start and at the end.
    pub misfit: [f64; 2],
    /// Number of simulated webs that would have a larger misfit than the scan, if each of them were taken as the scan.
    pub worse: u64,
    /// Simulated webs of each trial.
    pub webs: u64,
    /// All trials.
    pub trials: Vec<FitTrial>,
    /// Whether the search has ended because its steps had become short.
    pub settled: bool,
    /// Sensitivity whose webs could not be laid: their values, and why.
    pub refused: Vec<(Vec<f64>, String)>,
}

/// A trial.
#[derive(Clone, Debug, PartialEq)]
pub struct FitTrial {
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
    /// What is known of the ends of the interval.
    pub ends: [IntervalEnd; 2],
    /// The least misfit for other values of this key: value [SI] and misfit.
    pub profile: Vec<(f64, f64)>,
    /// Why the value is not to be trusted, if so.
    pub warning: Option<KeyWarning>,
}

/// Why the value of a key is not to be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyWarning {
    /// It changes nothing of what is compared.
    NoEffect,
    /// The interval is as wide as the range: the data do not know it.
    Unknown,
    /// It lies at an end of its range.
    AtEnd,
}

/// Two keys that the data cannot distinguish.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InseparableKeys {
    /// Indices of the keys.
    pub keys: [usize; 2],
    /// Correlation of their errors.
    pub correlation: f64,
    /// When the coordinate of the first key grows by one, that of the second changes by this number. For
    /// logarithmic coordinates it is the ratio of the relative changes of the two keys.
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
    /// Standard deviation of its logarithm from one simulated web to another: a scan of such a web is as far
    /// off by chance.
    pub scatter: f64,
    /// Standard error of its logarithm by the few filaments that are simulated for all and by the surrogate.
    pub model_error: f64,
}

impl FittedNumber {
    /// How far the scan is from the fit, in standard deviations of a single web.
    pub fn residual(&self) -> f64 {
        libm::log(self.scan / self.found) / self.scatter
    }
}

/// Correlation from which two keys cannot be distinguished.
const ALIKE: f64 = 0.95;
/// The results of the place at which the search has ended.
///
/// * `ends` – of the intervals, of each key that changes something
/// * `others` – standard errors of the logarithms by causes other than chance
pub(super) fn collect_results(
    webs: &Webs<'_>,
    place: &SearchState,
    values: Values,
    ends: &[Ends],
    others: &Matrix,
) -> Fit {
    let Values { coordinates, surface, profiles, far } = values;
    let fit = Fit {
        keys: keys(webs, &surface, ends, &coordinates, profiles),
        correlations: Vec::new(),
        alike: Vec::new(),
        numbers: numbers(webs, place, &surface, others),
        misfit: [0, place.trial].map(|trial| misfit(&place.weights, &residuals_of(webs, trial))),
        worse: count_larger_misfits(webs, place, &surface, others),
        webs: webs.count,
        trials: trials(webs, place),
        settled: place.settled || far < 1.0,
        refused: webs.refused.iter().map(|(values, error)| (values.clone(), error.to_string())).collect(),
    };
    let (correlations, alike) = correlate_keys(&surface, &place.weights, webs.parameters.len());
    Fit { correlations, alike, ..fit }
}

/// The keys with their values and intervals.
fn keys(
    webs: &Webs<'_>,
    surface: &Surface,
    ends: &[Ends],
    coordinates: &[f64],
    profiles: Vec<Vec<(f64, f64)>>,
) -> Vec<FittedKey> {
    let key = |(key, mut profile): (usize, Vec<(f64, f64)>)| {
        let parameter = &webs.parameters[key];
        let (parameter, value) = (parameter.clone(), parameter.value(coordinates[key]));
        let Some(index) = surface.keys.iter().position(|known| *known == key) else {
            let interval = Err("it has no effect on what is compared".to_owned());
            let ends = [IntervalEnd::OfRange; 2];
            let warning = Some(KeyWarning::NoEffect);
            return FittedKey { parameter, value, interval, ends, profile, warning };
        };
        let [low, high] = parameter.ends();
        profile.extend(&ends[index].profile);
        profile.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        let Ends { coordinates: interval, kinds: ends, .. } = &ends[index];
        let near = |end: f64| (coordinates[key] - end).abs() < 1e-9 * (high - low);
        let warning = if *ends == [IntervalEnd::OfRange; 2] {
            Some(KeyWarning::Unknown)
        } else {
            (near(low) || near(high)).then_some(KeyWarning::AtEnd)
        };
        let interval = interval.map(|end| parameter.value(end));
        let interval = webs.target.warning().map_or(Ok(interval), |warning| Err(warning.to_owned()));
        FittedKey { parameter, value, interval, ends: *ends, profile, warning }
    };
    profiles.into_iter().enumerate().map(key).collect()
}

/// Correlations of the errors of all keys, and the keys that cannot be distinguished.
fn correlate_keys(surface: &Surface, weights: &Matrix, count: usize) -> (Matrix, Vec<InseparableKeys>) {
    let Surface { keys, slopes, errors, .. } = surface;
    let information = information(weights, slopes);
    let mut correlations: Matrix =
        (0..count).map(|i| (0..count).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    let mut alike = Vec::new();
    for (i, key) in keys.iter().enumerate() {
        for (j, other) in keys.iter().enumerate().filter(|(j, _)| *j != i) {
            let scale = errors.standard_error(i) * errors.standard_error(j);
            let correlation = (errors.covariance(i, j) / scale).clamp(-1.0, 1.0);
            correlations[*key][*other] = correlation;
            if i < j && correlation.abs() >= ALIKE {
                let per_first = -information[i][j] / information[j][j];
                alike.push(InseparableKeys { keys: [*key, *other], correlation, per_first });
            }
        }
    }
    (correlations, alike)
}

/// What was compared.
fn numbers(webs: &Webs<'_>, place: &SearchState, surface: &Surface, others: &Matrix) -> Vec<FittedNumber> {
    let trial = &webs.trials[place.trial];
    let number = |i: usize| {
        let mean = trial.mean[i];
        let squares = trial.webs.iter().map(|web| (web[i] - mean).powi(2)).sum::<f64>();
        FittedNumber {
            texture: webs.target.textures.all[i],
            scan: libm::exp(webs.target.logarithms[i]),
            start: libm::exp(webs.trials[0].mean[i]),
            found: libm::exp(surface.numbers[i]),
            scatter: (squares / (trial.webs.len() as f64 - 1.0)).sqrt(),
            model_error: others.iter().map(|cause| cause[i] * cause[i]).sum::<f64>().sqrt(),
        }
    };
    (0..webs.target.logarithms.len()).map(number).collect()
}

/// How many webs of the place, each taken as the scan, leave a larger misfit.
///
/// * `others` – standard errors of the logarithms by causes other than chance
fn count_larger_misfits(webs: &Webs<'_>, place: &SearchState, surface: &Surface, others: &Matrix) -> u64 {
    let all = &webs.trials[place.trial].webs;
    let causes: Matrix = others.iter().chain(&webs.target.camera).cloned().collect();
    let left = |weights: &Matrix, apart: &[f64]| {
        let gain = gain(weights, &surface.slopes).unwrap_or_else(|_| surface.gain.clone());
        misfit(weights, &unexplained(&gain, &surface.slopes, apart))
    };
    let apart: Vec<f64> =
        webs.target.logarithms.iter().zip(&surface.numbers).map(|(scan, here)| scan - here).collect();
    let of_scan = left(&weights(all.iter(), &causes).unwrap_or_else(|| place.weights.clone()), &apart);
    let is_worse = |web: &usize| {
        let (weights, mut apart) = in_place_of_the_scan(webs, place, *web, &causes);
        // A scan is off by these causes as well, to either side.
        for (cause, errors) in causes.iter().enumerate() {
            let side = if (*web >> cause) & 1 == 0 { 1.0 } else { -1.0 };
            apart.iter_mut().zip(errors).for_each(|(apart, error)| *apart += side * error);
        }
        left(&weights, &apart) >= of_scan
    };
    (0..all.len()).filter(is_worse).count() as u64
}

/// All trials with their misfits.
fn trials(webs: &Webs<'_>, place: &SearchState) -> Vec<FitTrial> {
    let trial = |trial: usize| FitTrial {
        values: webs.trials[trial].values.clone(),
        misfit: misfit(&place.weights, &residuals_of(webs, trial)),
    };
    (0..webs.trials.len()).map(trial).collect()
}
