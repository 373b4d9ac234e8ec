//! The values that are most like the scan: by polynomials through all trials near the place at which a search has ended.

use super::polynomials::Polynomials;
use super::search::{Place, rest};
use super::surface::Surface;
use super::webs::Webs;
use super::weights::{Matrix, gain, information, misfit, unexplained};
use crate::error::Error;
use crate::statistics::linear::inverse;

/// Other values of a key are tried at these distances from the place [standard errors].
const PROFILE: [f64; 3] = [-1.0, 0.0, 1.0];
/// Most steps on the polynomials, each from where the last one ended.
const MOST: usize = 20;

/// The best values of all keys.
pub(super) struct Values {
    /// Coordinates.
    pub(super) at: Vec<f64>,
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
pub(super) fn values(webs: &mut Webs<'_>, place: &Place, other_errors: &Matrix) -> Result<Values, Error> {
    let here = webs.trials[place.trial].clone();
    let all = (0..webs.parameters.len()).collect();
    let mut surface = Surface::new(webs, place, all, (here.mean.clone(), &place.slopes), other_errors);
    let mut profiles = vec![Vec::new(); webs.parameters.len()];
    let mut reach = vec![1.0; webs.parameters.len()];
    for (own, key) in surface.known.iter().enumerate() {
        let error = surface.errors.standard_error(own);
        (profiles[*key], reach[*key]) = profile(webs, place, &surface, (own, error))?;
    }
    let polynomials = Polynomials::new(webs, place, &reach);
    let mut step = vec![0.0; reach.len()];
    for _ in 0..MOST {
        let (numbers, slopes) = polynomials.at(&step);
        surface = Surface::new(webs, place, surface.known.clone(), (numbers, &slopes), other_errors);
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
    let distance = |(own, key): (usize, &usize)| step[*key].abs() / surface.errors.standard_error(own);
    let far = surface.known.iter().enumerate().map(distance).fold(0.0, f64::max);
    let at = here.at.iter().zip(&step).map(|(here, step)| here + step).collect();
    Ok(Values { at, surface, profiles, far })
}

/// Values of a key with their least misfits, and how far from the place they are.
type Profile = (Vec<(f64, f64)>, f64);

/// The least misfit for other values of a key, and how far from the place polynomials hold.
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
    let [low, high] = webs.parameters[key].ends();
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
            profile.push((
                webs.parameters[key].value(at[key]),
                least_misfit(webs, place, surface, (own, trial)),
            ));
            reach = reach.max((webs.trials[trial].at[key] - here[key]).abs());
        }
    }
    // A whole number may have no other value so near.
    Ok((profile, if reach > 0.0 { 1.05 * reach } else { 1.0 }))
}

/// The misfit of a trial if all keys but one took their best values. Little is left for them to do, and straight lines serve.
pub(super) fn least_misfit(
    webs: &Webs<'_>,
    place: &Place,
    surface: &Surface,
    (own, trial): (usize, usize),
) -> f64 {
    let others = surface.slopes.iter().enumerate().filter(|(other, _)| *other != own);
    let slopes: Matrix = others.map(|(_, slopes)| slopes.clone()).collect();
    let rest = rest(webs, trial);
    let left = match gain(&place.weights, &slopes) {
        Ok(gain) => unexplained(&gain, &slopes, &rest),
        Err(_) => rest,
    };
    misfit(&place.weights, &left)
}
