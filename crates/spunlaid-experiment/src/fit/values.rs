//! The values that are most like the scan: by polynomials through all trials near the place at which a search
//! has ended.

use super::polynomials::Polynomials;
use super::search::{SearchState, residuals_of};
use super::surface::Surface;
use super::webs::Webs;
use super::weights::{Matrix, gain, information, misfit, unexplained};
use spunlaid_ground::Error;
use spunlaid_ground::statistics::inverse;

/// Other values of a key are tried at these distances from the place [standard errors].
const PROFILE: [f64; 3] = [-1.0, 0.0, 1.0];
/// Most steps on the polynomials, each from where the last one ended.
const MOST: usize = 20;

/// The best values of all keys.
pub(super) struct Values {
    /// Coordinates.
    pub(super) coordinates: Vec<f64>,
    /// What is known there.
    pub(super) surface: Surface,
    /// The least misfit for other values of a key: value [SI] and misfit; by key.
    pub(super) profiles: Vec<Vec<(f64, f64)>>,
    /// The distance from the place [standard errors].
    pub(super) far: f64,
}

/// Finds the values around the place at which a search has ended.
///
/// * `other_errors` – standard errors of the logarithms by causes other than chance, each common to all numbers
///
/// # Errors
/// As [`Webs::trial`].
pub(super) fn values(
    webs: &mut Webs<'_>,
    place: &SearchState,
    other_errors: &Matrix,
) -> Result<Values, Error> {
    let start = webs.trials[place.trial].clone();
    let all = (0..webs.parameters.len()).collect();
    let mut surface = Surface::new(webs, place, all, start.mean.clone(), &place.slopes, other_errors);
    let mut profiles = vec![Vec::new(); webs.parameters.len()];
    let mut reach = vec![1.0; webs.parameters.len()];
    for (index, key) in surface.keys.iter().enumerate() {
        let error = surface.errors.standard_error(index);
        (profiles[*key], reach[*key]) = profile(webs, place, &surface, index, error)?;
    }
    let polynomials = Polynomials::new(webs, place, &reach);
    let mut step = vec![0.0; reach.len()];
    for _ in 0..MOST {
        let (numbers, slopes) = polynomials.at(&step);
        surface = Surface::new(webs, place, surface.keys.clone(), numbers, &slopes, other_errors);
        let further = surface.step(webs, place, &step);
        // No further than trials have been.
        let to: Vec<f64> = (step.iter().zip(&further).zip(&reach))
            .map(|((step, further), reach)| (step + 0.7 * further).clamp(-reach, *reach))
            .collect();
        let is_still = to.iter().zip(&step).all(|(to, from)| (to - from).abs() < 1e-6);
        step = to;
        if is_still {
            break;
        }
    }
    let distance = |(index, key): (usize, &usize)| step[*key].abs() / surface.errors.standard_error(index);
    let far = surface.keys.iter().enumerate().map(distance).fold(0.0, f64::max);
    let mut coordinates =
        start.coordinates.iter().zip(&step).map(|(start, step)| start + step).collect::<Vec<_>>();
    // Where all trials beside the place were refused, the polynomials may lead to where no web can be laid.
    if webs.simulator.set(&webs.values(&coordinates)).is_err() {
        coordinates = start.coordinates;
    }
    Ok(Values { coordinates, surface, profiles, far })
}

/// Values of a key with their least misfits, and how far from the place they are.
type Profile = (Vec<(f64, f64)>, f64);

/// The least misfit for other values of a key, and how far from the place polynomials hold.
fn profile(
    webs: &mut Webs<'_>,
    place: &SearchState,
    surface: &Surface,
    index: usize,
    error: f64,
) -> Result<Profile, Error> {
    let keys = &surface.keys;
    let start = webs.trials[place.trial].coordinates.clone();
    let information = information(&place.weights, &surface.slopes);
    // The others follow as is best.
    let others: Vec<usize> = (0..keys.len()).filter(|other| *other != index).collect();
    let of_others: Matrix =
        others.iter().map(|i| others.iter().map(|j| information[*i][*j]).collect()).collect();
    let follow: Vec<f64> = (inverse(of_others).unwrap_or_default().iter())
        .map(|row| -row.iter().zip(&others).map(|(share, i)| share * information[*i][index]).sum::<f64>())
        .collect();
    let key = keys[index];
    let [low, high] = webs.parameters[key].ends();
    let mut profile = Vec::new();
    let mut reach = 0.0_f64;
    for distance in PROFILE {
        let step = (start[key] + distance * error).clamp(low, high) - start[key];
        if !step.is_finite() || (distance != 0.0 && step.abs() < 0.1 * error) {
            continue;
        }
        let mut at = start.clone();
        at[key] += step;
        for (i, follow) in others.iter().zip(&follow) {
            let [low, high] = webs.parameters[keys[*i]].ends();
            at[keys[*i]] = (at[keys[*i]] + follow * step).clamp(low, high);
        }
        if let Some(trial) = webs.trial(&at)? {
            profile.push((
                webs.parameters[key].value(at[key]),
                least_misfit(webs, place, surface, index, trial),
            ));
            reach = reach.max((webs.trials[trial].coordinates[key] - start[key]).abs());
        }
    }
    // A whole number may have no other value so near.
    Ok((profile, if reach > 0.0 { 1.05 * reach } else { 1.0 }))
}

/// The misfit of a trial if all keys but one took their best values. Little is left for them to do, and
/// straight lines serve.
pub(super) fn least_misfit(
    webs: &Webs<'_>,
    place: &SearchState,
    surface: &Surface,
    index: usize,
    trial: usize,
) -> f64 {
    let others = surface.slopes.iter().enumerate().filter(|(other, _)| *other != index);
    let slopes: Matrix = others.map(|(_, slopes)| slopes.clone()).collect();
    let residuals = residuals_of(webs, trial);
    let left = match gain(&place.weights, &slopes) {
        Ok(gain) => unexplained(&gain, &slopes, &residuals),
        Err(_) => residuals,
    };
    misfit(&place.weights, &left)
}
