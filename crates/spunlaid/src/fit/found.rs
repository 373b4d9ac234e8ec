//! What a fit has found: the values with their intervals, the profile of the misfit, and whether such webs can look like the scan at all.

use super::parameter::Parameter;
use super::polynomials::Polynomials;
use super::search::{Place, rest};
use super::surface::{Surface, in_place_of_the_scan};
use super::texture::Texture;
use super::webs::Webs;
use super::weights::{Matrix, gain, information, misfit, unexplained};
use crate::error::Error;
use crate::statistics::linear::inverse;
use crate::statistics::student_t_95;

/// What was found.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The keys with their values.
    pub keys: Vec<FittedKey>,
    /// Correlations of the errors of the values, key by key.
    pub correlations: Vec<Vec<f64>>,
    /// Keys that the data cannot tell apart: their indices, and what a rise of the first by a tenth is made up for with.
    pub alike: Vec<InseparableKeys>,
    /// What was compared.
    pub numbers: Vec<FittedNumber>,
    /// The misfit at the start and at the end.
    pub misfit: [f64; 2],
    /// So many of the simulated webs, each taken as the scan, would have had a larger misfit.
    pub worse: u64,
    /// Simulated webs of each trial.
    pub webs: u64,
    /// All trials.
    pub trials: Vec<FitTrial>,
    /// Whether the search has ended because its steps had become short.
    pub settled: bool,
    /// Trials whose webs could not be laid: their values, and why.
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
pub struct InseparableKeys {
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
const PROFILE: [f64; 5] = [-2.0, -1.0, 0.0, 1.0, 2.0];

/// Most steps on the polynomials, each from where the last one ended.
const MOST: usize = 20;

/// What a search has found, and how far the best values are from where it ended.
pub(super) struct Found {
    pub(super) fit: Fit,
    /// Coordinates of the values.
    pub(super) at: Vec<f64>,
    /// Their distance from the place [standard errors].
    pub(super) far: f64,
}

/// Makes the results of the place at which a search has ended. Trials around it tell the profiles, and all of them together the values.
///
/// * `other_errors` – standard errors of the logarithms by causes other than chance, each common to all numbers
///
/// # Errors
/// As [`Webs::trial`].
pub(super) fn found(webs: &mut Webs<'_>, place: &Place, other_errors: &Matrix) -> Result<Found, Error> {
    let here = webs.trials[place.trial].clone();
    let all = (0..webs.parameters.len()).collect();
    let rough = Surface::new(webs, place, all, (here.mean.clone(), &place.slopes), other_errors);
    let mut profiles = vec![Vec::new(); webs.parameters.len()];
    let mut reach = vec![0.0; webs.parameters.len()];
    for (own, key) in rough.known.iter().enumerate() {
        let error = rough.errors.standard_error(own);
        (profiles[*key], reach[*key]) = profile(webs, place, &rough, (own, error))?;
    }
    let mut step = vec![0.0; reach.len()];
    let mut exact = rough;
    let known: Vec<f64> = reach.iter().map(|reach| if *reach > 0.0 { *reach } else { 1.0 }).collect();
    if let Some(polynomials) = Polynomials::new(webs, place, &known) {
        for _ in 0..MOST {
            let (numbers, slopes) = polynomials.at(&step);
            let next = Surface::new(webs, place, exact.known.clone(), (numbers, &slopes), other_errors);
            let further = next.step(webs, place, &step);
            exact = next;
            // No further than trials have been.
            let to: Vec<f64> = (step.iter().zip(&further).zip(&known))
                .map(|((step, further), reach)| (step + 0.7 * further).clamp(-reach, *reach))
                .collect();
            let is_still = to.iter().zip(&step).all(|(to, from)| (to - from).abs() < 1e-6);
            step = to;
            if is_still {
                break;
            }
        }
    } else {
        step = exact.step(webs, place, &step);
    }
    let distance = |(own, key): (usize, &usize)| step[*key].abs() / exact.errors.standard_error(own);
    let far = exact.known.iter().enumerate().map(distance).fold(0.0, f64::max);
    let at: Vec<f64> = here.at.iter().zip(&step).map(|(here, step)| here + step).collect();
    let fit = Fit {
        keys: keys(webs, &exact, &at, profiles),
        correlations: Vec::new(),
        alike: Vec::new(),
        numbers: numbers(webs, place, &exact),
        misfit: [0, place.trial].map(|trial| misfit(&place.weights, &rest(webs, trial))),
        worse: worse(webs, place, &exact),
        webs: webs.count,
        trials: trials(webs, place),
        settled: place.settled || far < 1.0,
        refused: webs.refused.iter().map(|(values, error)| (values.clone(), error.to_string())).collect(),
    };
    let (correlations, alike) = together(&exact, &place.weights, webs.parameters.len());
    Ok(Found { fit: Fit { correlations, alike, ..fit }, at, far })
}

/// Values of a key with their least misfits, and how far from the place polynomials hold.
type Profile = (Vec<(f64, f64)>, f64);

/// The least misfit for other values of a key, and how far from the place they are.
fn profile(
    webs: &mut Webs<'_>,
    place: &Place,
    surface: &Surface,
    (own, error): (usize, f64),
) -> Result<Profile, Error> {
    let known = &surface.known;
    let here = webs.trials[place.trial].at.clone();
    let information = information(&place.weights, &surface.slopes);
    // The others follow as is best.
    let others: Vec<usize> = (0..known.len()).filter(|other| *other != own).collect();
    let of_others: Matrix =
        others.iter().map(|i| others.iter().map(|j| information[*i][*j]).collect()).collect();
    let follow: Vec<f64> = (inverse(of_others).unwrap_or_default().iter())
        .map(|row| -row.iter().zip(&others).map(|(share, i)| share * information[*i][own]).sum::<f64>())
        .collect();
    let key = known[own];
    let parameter = webs.parameters[key].clone();
    let [low, high] = parameter.ends();
    let slopes: Matrix = others.iter().map(|i| surface.slopes[*i].clone()).collect();
    let gain = gain(&place.weights, &slopes);
    let mut profile = Vec::new();
    let mut reach = 0.0_f64;
    for distance in PROFILE {
        let step = (here[key] + distance * error).clamp(low, high) - here[key];
        if !step.is_finite() || (distance != 0.0 && step.abs() < 0.1 * error) {
            continue;
        }
        let mut at = here.clone();
        at[key] += step;
        for (i, follow) in others.iter().zip(&follow) {
            let [low, high] = webs.parameters[known[*i]].ends();
            at[known[*i]] = (at[known[*i]] + follow * step).clamp(low, high);
        }
        if let Some(trial) = webs.trial(&at)? {
            // What is left for the others to do is little, and straight lines serve.
            let rest = rest(webs, trial);
            let left = gain.as_ref().map_or_else(|_| rest.clone(), |gain| unexplained(gain, &slopes, &rest));
            profile.push((parameter.value(at[key]), misfit(&place.weights, &left)));
            // Polynomials of second order hold within a standard error.
            if distance.abs() <= 1.0 {
                reach = reach.max(step.abs());
            }
        }
    }
    profile.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok((profile, 1.05 * reach))
}

/// The keys with their values and intervals.
fn keys(webs: &Webs<'_>, surface: &Surface, at: &[f64], profiles: Vec<Vec<(f64, f64)>>) -> Vec<FittedKey> {
    let t = student_t_95(webs.count - 1);
    let key = |(key, profile): (usize, Vec<(f64, f64)>)| {
        let parameter = &webs.parameters[key];
        let (parameter, value) = (parameter.clone(), parameter.value(at[key]));
        let Some(own) = surface.known.iter().position(|known| *known == key) else {
            let interval = Err("it changes nothing of what is compared".to_owned());
            return FittedKey { parameter, value, interval, profile, doubt: Some(KeyDoubt::NoEffect) };
        };
        let half = t * surface.errors.standard_error(own);
        let [low, high] = parameter.ends();
        let ends = [at[key] - half, at[key] + half];
        let near = |end: f64| (at[key] - end).abs() < 1e-9 * (high - low);
        let doubt = if ends[0] <= low && ends[1] >= high {
            Some(KeyDoubt::Unknown)
        } else {
            (near(low) || near(high)).then_some(KeyDoubt::AtEnd)
        };
        let in_range = ends.map(|end| parameter.value(end.clamp(low, high)));
        let interval = webs.target.doubt().map_or(Ok(in_range), |doubt| Err(doubt.to_owned()));
        FittedKey { parameter, value, interval, profile, doubt }
    };
    profiles.into_iter().enumerate().map(key).collect()
}

/// Correlations of the errors of all keys, and the keys that cannot be told apart.
fn together(surface: &Surface, weights: &Matrix, keys: usize) -> (Matrix, Vec<InseparableKeys>) {
    let Surface { known, slopes, errors, .. } = surface;
    let information = information(weights, slopes);
    let mut correlations: Matrix =
        (0..keys).map(|i| (0..keys).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    let mut alike = Vec::new();
    for (i, key) in known.iter().enumerate() {
        for (j, other) in known.iter().enumerate().filter(|(j, _)| *j != i) {
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
fn numbers(webs: &Webs<'_>, place: &Place, surface: &Surface) -> Vec<FittedNumber> {
    let trial = &webs.trials[place.trial];
    let number = |i: usize| {
        let mean = trial.mean[i];
        let squares = trial.webs.iter().map(|web| (web[i] - mean).powi(2)).sum::<f64>();
        FittedNumber {
            texture: webs.target.textures.all[i],
            scan: libm::exp(webs.target.logarithms[i]),
            start: libm::exp(webs.trials[0].mean[i]),
            found: libm::exp(surface.here[i]),
            scatter: (squares / (trial.webs.len() as f64 - 1.0)).sqrt(),
        }
    };
    (0..webs.target.logarithms.len()).map(number).collect()
}

/// How many webs of the place, each taken as the scan, leave a larger misfit.
fn worse(webs: &Webs<'_>, place: &Place, surface: &Surface) -> u64 {
    let rest: Vec<f64> =
        webs.target.logarithms.iter().zip(&surface.here).map(|(scan, here)| scan - here).collect();
    let of_scan = misfit(&place.weights, &unexplained(&surface.gain, &surface.slopes, &rest));
    let is_worse = |web: &usize| {
        let (weights, apart) = in_place_of_the_scan(webs, place, *web);
        let gain = gain(&weights, &surface.slopes).unwrap_or_else(|_| surface.gain.clone());
        misfit(&weights, &unexplained(&gain, &surface.slopes, &apart)) >= of_scan
    };
    (0..webs.trials[place.trial].webs.len()).filter(is_worse).count() as u64
}

/// All trials with their misfits.
fn trials(webs: &Webs<'_>, place: &Place) -> Vec<FitTrial> {
    let trial = |trial: usize| FitTrial {
        values: webs.trials[trial].values.clone(),
        misfit: misfit(&place.weights, &rest(webs, trial)),
    };
    (0..webs.trials.len()).map(trial).collect()
}
