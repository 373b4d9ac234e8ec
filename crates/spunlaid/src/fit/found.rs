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
const PROFILE: [f64; 5] = [-2.0, -1.0, 0.0, 1.0, 2.0];

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

/// What the trials around a place say together.
struct Surface {
    /// Indices of the keys that change something.
    known: Vec<usize>,
    /// Logarithms of the numbers at the values.
    here: Vec<f64>,
    /// Slopes of the numbers by each of these keys.
    slopes: Matrix,
    /// What numbers do to the values.
    gain: Matrix,
    errors: Errors,
}

impl Surface {
    /// * `known` – indices of the keys that may change something
    /// * `slopes` – by each key
    /// * `other_errors` – of the logarithms, by causes other than chance
    fn new(
        webs: &Webs<'_>,
        place: &Place,
        mut known: Vec<usize>,
        (here, slopes): (Vec<f64>, &Matrix),
        other_errors: &Matrix,
    ) -> Self {
        let (slopes, gain_of_all) = loop {
            let slopes: Matrix = known.iter().map(|key| slopes[*key].clone()).collect();
            match gain(&place.weights, &slopes) {
                Ok(gain) => break (slopes, gain),
                // A key that changes nothing has no value of its own.
                Err(key) => known.remove(key),
            };
        };
        let by_chance = webs.trials[place.trial].webs.iter().enumerate().map(|(i, _)| {
            let (weights, apart) = in_place_of_the_scan(webs, place, i);
            let gain = gain(&weights, &slopes).unwrap_or_else(|_| gain_of_all.clone());
            gain.iter().map(|row| dot(row, &apart)).collect()
        });
        let by_chance = by_chance.collect();
        let causes = other_errors.iter().chain(&webs.target.camera);
        let others = causes.map(|errors| gain_of_all.iter().map(|row| dot(row, errors)).collect()).collect();
        let errors = Errors { by_chance, others };
        Self { known, here, slopes, gain: gain_of_all, errors }
    }

    /// The step to the values with the least misfit, by key.
    ///
    /// * `from` – the step from the place to where these numbers are
    fn step(&self, webs: &Webs<'_>, place: &Place, from: &[f64]) -> Vec<f64> {
        let at = webs.trials[place.trial].at.iter().zip(from).map(|(place, from)| place + from);
        let at: Vec<f64> = at.collect();
        let rest: Vec<f64> =
            webs.target.logarithms.iter().zip(&self.here).map(|(scan, here)| scan - here).collect();
        let mut step = vec![0.0; at.len()];
        for (key, row) in self.known.iter().zip(&self.gain) {
            let [low, high] = webs.parameters[*key].ends();
            step[*key] = (at[*key] + dot(row, &rest)).clamp(low, high) - at[*key];
        }
        step
    }
}

/// A web of a trial as if it were the scan and the others were all that were laid: the weights by these, and how far it is from them.
fn in_place_of_the_scan(webs: &Webs<'_>, place: &Place, web: usize) -> (Matrix, Vec<f64>) {
    let all = &webs.trials[place.trial].webs;
    let others = || all.iter().enumerate().filter(move |(other, _)| *other != web).map(|(_, web)| web);
    let weights = weights(others(), &webs.target.camera).unwrap_or_else(|| place.weights.clone());
    let mean = mean_of(others());
    (weights, all[web].iter().zip(&mean).map(|(web, mean)| web - mean).collect())
}

/// The numbers around a place as polynomials of second order through the means of all trials there.
struct Polynomials {
    /// Powers of the coordinates in each term, by the coordinates that are multiplied: none, one or two.
    terms: Vec<Vec<usize>>,
    /// Of each number, the factor of each term.
    factors: Matrix,
}

impl Polynomials {
    /// * `reach` – how far from the place trials count, by coordinate
    ///
    /// None if too few trials lie there.
    fn new(webs: &Webs<'_>, place: &Place, reach: &[f64]) -> Option<Self> {
        let keys = reach.len();
        let linear = || std::iter::once(Vec::new()).chain((0..keys).map(|i| vec![i]));
        let squares = || (0..keys).map(|i| vec![i, i]);
        let products = (0..keys).flat_map(|i| (i + 1..keys).map(move |j| vec![i, j]));
        let all = [
            linear().chain(squares()).chain(products).collect(),
            linear().chain(squares()).collect(),
            linear().collect::<Vec<Vec<usize>>>(),
        ];
        all.into_iter().find_map(|terms| Self::of_terms(webs, place, reach, terms))
    }

    fn of_terms(webs: &Webs<'_>, place: &Place, reach: &[f64], terms: Vec<Vec<usize>>) -> Option<Self> {
        let here = &webs.trials[place.trial].at;
        // In parts of the reach, so that all terms are of like size.
        let step = |at: &[f64]| -> Vec<f64> {
            at.iter().zip(here).zip(reach).map(|((at, here), reach)| (at - here) / reach).collect()
        };
        let around = webs.trials.iter().map(|trial| (step(&trial.at), &trial.mean));
        let around = around.filter(|(step, _)| step.iter().all(|step| step.abs() <= 1.0));
        let rows: Vec<(Vec<f64>, &Vec<f64>)> = around
            .map(|(step, mean)| (terms.iter().map(|term| value(term, &step)).collect(), mean))
            .collect();
        // A trial more than there are terms, so that chance does not decide.
        if rows.len() <= terms.len() {
            return None;
        }
        let sum = |term: &dyn Fn(&[f64], &[f64]) -> f64| {
            rows.iter().map(|(row, mean)| term(row, mean)).sum::<f64>()
        };
        let size = terms.len();
        let normal = (0..size).map(|i| (0..size).map(|j| sum(&|row, _| row[i] * row[j])).collect()).collect();
        let inverse = inverse(normal).ok()?;
        let scales: Vec<f64> =
            terms.iter().map(|term| term.iter().map(|key| reach[*key]).product::<f64>()).collect();
        let of_number = |number: usize| -> Vec<f64> {
            let moments: Vec<f64> = (0..size).map(|i| sum(&|row, mean| row[i] * mean[number])).collect();
            inverse.iter().zip(&scales).map(|(row, scale)| dot(row, &moments) / scale).collect()
        };
        let factors = (0..webs.target.logarithms.len()).map(of_number).collect();
        Some(Self { terms, factors })
    }

    /// The numbers a step away from the place, and their slopes there.
    fn at(&self, step: &[f64]) -> (Vec<f64>, Matrix) {
        let values: Vec<f64> = self.terms.iter().map(|term| value(term, step)).collect();
        let slope = |key: usize| {
            let of_term = |term: &Vec<usize>| {
                let without = |i: usize| {
                    term.iter().enumerate().filter(move |(j, _)| *j != i).map(|(_, key)| step[*key])
                };
                let own = (0..term.len()).filter(|i| term[*i] == key);
                own.map(|i| without(i).product::<f64>()).sum::<f64>()
            };
            let slopes: Vec<f64> = self.terms.iter().map(of_term).collect();
            self.factors.iter().map(|factors| dot(factors, &slopes)).collect()
        };
        (
            self.factors.iter().map(|factors| dot(factors, &values)).collect(),
            (0..step.len()).map(slope).collect(),
        )
    }
}

/// The product of the coordinates of a term.
fn value(term: &[usize], step: &[f64]) -> f64 {
    term.iter().map(|key| step[*key]).product()
}

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
fn together(surface: &Surface, weights: &Matrix, keys: usize) -> (Matrix, Vec<Alike>) {
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
                alike.push(Alike { keys: [*key, *other], correlation, per_first });
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
fn trials(webs: &Webs<'_>, place: &Place) -> Vec<TrialOfFit> {
    let trial = |trial: usize| TrialOfFit {
        values: webs.trials[trial].values.clone(),
        misfit: misfit(&place.weights, &rest(webs, trial)),
    };
    (0..webs.trials.len()).map(trial).collect()
}
