//! Turns a picture into a map of basis weight.

use super::doubt::Doubt;
use super::picture::Picture;
use super::shading::Shading;
use super::spots::{Spots, spots};
use crate::error::Fault;
use crate::units::shortest;
use crate::web::Map;

/// What the values of a picture mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Light that has come through the web.
    Transmitted {
        /// Mean basis weight of the sheet, if it is known [kg/m²].
        mean: Option<f64>,
        /// Grey level of the lamp without web; by default the largest level that the file can hold.
        white: Option<f64>,
    },
    /// Basis weights.
    Weight {
        /// Mean basis weight of the sheet; by default the values are in kg/m² [kg/m²].
        mean: Option<f64>,
    },
}

/// Pixels that needed care.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pixels {
    /// Pixels without a value, black ones included: filled in along their row.
    pub filled: usize,
    /// Pixels of the largest grey level, where the light may have been more.
    pub saturated: usize,
    /// Pixels lighter than the lamp without web: they count as empty.
    pub lighter: usize,
}

/// A picture turned into a map.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct WeighedPicture {
    /// The map; its edges are cut, not closed. Without a known mean, the mean is 1 kg/m².
    pub(super) map: Map,
    /// Whether the mean of the map is that of the sheet.
    pub(super) mean_known: bool,
    /// Grey level of the lamp without web; none for basis weights, and where there is a picture of the lamp.
    pub(super) white: Option<f64>,
    /// Mean optical density `ln(white/level)`; none for basis weights.
    pub(super) density: Option<f64>,
    /// Logarithm of the lamp over the picture, as far as it was taken out.
    pub(super) shading: Option<Shading>,
    /// Pixels that needed care.
    pub(super) pixels: Pixels,
    /// Standard deviation of the relative basis weight of a pixel for a noise of one level.
    pub(super) per_noise: f64,
}

impl WeighedPicture {
    /// What is only a guess about the lamp, if anything.
    pub(super) fn guess(&self, light: Light) -> Option<Doubt> {
        let is_white = matches!(light, Light::Transmitted { white: None, .. }) && self.white.is_some();
        let shading = self.shading.is_some().then_some(Doubt::Shading);
        if is_white { Some(Doubt::White) } else { shading }
    }
}

/// Quanta of a cell of the mean weight.
const QUANTA: f64 = 1e6;
/// One pixel in so many may be filled in.
const FILLED: usize = 100;

/// How an uneven lamp is taken out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Correction<'a> {
    /// The lamp without web.
    pub(super) lamp: Option<&'a Picture>,
    /// Whether the lamp is taken as even.
    pub(super) keep_shading: bool,
}

/// Most rounds in which shading and spots are separated.
const ROUNDS: usize = 4;

/// The parts of a picture in transmitted light that are not web.
pub(super) fn beside(picture: &Picture, light: Light, correction: Correction<'_>) -> Result<Spots, Fault> {
    let logs = logs(picture, correction.lamp)?;
    let (lamp, given) = match light {
        _ if correction.lamp.is_some() => (0.0, true),
        Light::Transmitted { white: Some(white), .. } => (libm::log(white), true),
        _ => (mean_of(&logs), false),
    };
    let densities = |shading: Option<&Shading>| -> Vec<f64> {
        let row = |(row, logs): (usize, &[f64])| -> Vec<f64> {
            match shading {
                Some(shading) => logs.iter().zip(shading.row(row)).map(|(log, lamp)| lamp - log).collect(),
                None => logs.iter().map(|log| lamp - log).collect(),
            }
        };
        logs.chunks_exact(picture.columns).enumerate().flat_map(row).collect()
    };
    if correction.lamp.is_some() || correction.keep_shading {
        return spots(&densities(None), picture.columns, given);
    }
    // What is no web must not bend the polynomial of the lamp.
    let mut web = logs.clone();
    let mut last = None;
    for _ in 0..ROUNDS {
        let shading = Shading::fit(&web, picture.columns);
        let found = spots(&densities(Some(&shading)), picture.columns, false)?;
        if last.as_ref() == Some(&found) {
            break;
        }
        web.copy_from_slice(&logs);
        let ([left, top], [across, along]) = (found.web.corner, found.web.sides);
        for (at, log) in web.iter_mut().enumerate() {
            let (column, row) =
                ((at % picture.columns).wrapping_sub(left), (at / picture.columns).wrapping_sub(top));
            let is_web = column < across && row < along;
            if !is_web || found.dark.get(row * across + column).copied().unwrap_or(false) {
                *log = f64::NAN;
            }
        }
        last = Some(found);
    }
    Ok(last.unwrap_or_else(|| Spots::none(picture)))
}

/// Turns a picture into a map. What is masked is no web.
pub(super) fn weigh(
    picture: &Picture,
    light: Light,
    correction: Correction<'_>,
    masked: &[bool],
) -> Result<WeighedPicture, Fault> {
    let (Light::Transmitted { mean, .. } | Light::Weight { mean }) = light;
    above_zero("a mean basis weight [kg/m²]", mean)?;
    match light {
        Light::Transmitted { white, .. } => transmitted(picture, mean, white, correction, masked),
        Light::Weight { .. } => weights(picture, mean),
    }
}

/// Refuses a setting that is not above zero.
pub(super) fn above_zero(name: &'static str, value: Option<f64>) -> Result<(), Fault> {
    match value {
        Some(value) if !(value.is_finite() && value > 0.0) => Err(Fault::new(
            format!("cannot be read with {name} = {}", shortest(value)),
            "give a number above zero",
        )),
        _ => Ok(()),
    }
}

/// The logarithm of the light that comes through, over that of the lamp if there is a picture of it; NaN where there is none.
fn logs(picture: &Picture, lamp: Option<&Picture>) -> Result<Vec<f64>, Fault> {
    let log = |level: &f64| if level.is_finite() && *level > 0.0 { libm::log(*level) } else { f64::NAN };
    let mut logs: Vec<f64> = picture.values.iter().map(log).collect();
    if let Some(lamp) = lamp {
        let [found, wanted] = [lamp, picture].map(|picture| [picture.columns, picture.rows]);
        if found != wanted {
            return Err(Fault::new(
                format!(
                    "has {} × {} pixels, but the picture of the lamp without web has {} × {}",
                    wanted[0], wanted[1], found[0], found[1]
                ),
                "take both with the same camera from the same place",
            )
            .option("--lamp"));
        }
        let scale = lamp.scale_to(picture);
        logs.iter_mut().zip(&lamp.values).for_each(|(light, lamp)| *light -= log(&(scale * lamp)));
    }
    Ok(logs)
}

fn transmitted(
    picture: &Picture,
    mean: Option<f64>,
    white: Option<f64>,
    Correction { lamp, keep_shading }: Correction<'_>,
    masked: &[bool],
) -> Result<WeighedPicture, Fault> {
    above_zero("a level of the lamp", white)?;
    if let (Some(white), Some(largest)) = (white, picture.full_scale)
        && white > largest
    {
        let [white, largest] = [white, largest].map(shortest);
        return Err(Fault::new(
            format!("holds grey levels up to {largest}, but the lamp without web is said to have the level {white}"),
            format!("give the level of the lamp in this file, at most {largest}"),
        )
        .option("--white"));
    }
    let levels = || picture.values.iter().copied().filter(|level| level.is_finite());
    let white = white.or(picture.full_scale).unwrap_or_else(|| levels().fold(0.0, f64::max));
    // Over a picture of the lamp, all light is one.
    let white = if lamp.is_some() { 1.0 } else { white };
    let mut logs = logs(picture, lamp)?;
    let advice = "let more light through, or expose for longer";
    let filled = unusable(&logs, "black or without a value", advice)?;
    logs.iter_mut().zip(masked).filter(|(_, is)| **is).for_each(|(log, _)| *log = f64::NAN);
    let mean_log = mean_of(&logs);
    let density = libm::log(white) - mean_log;
    // What is left of rounding is no web.
    if density.is_nan() || density <= 1e-9 {
        return Err(Fault::new(format!("is no darker than the lamp without web: its mean grey level is {}, and that of the lamp {}", shortest(libm::exp(mean_log)), shortest(white)), "give the level of the lamp without web at the same exposure, or say that the values are basis weights").option("--white, --lamp, --light weight"));
    }
    let web = || picture.values.iter().zip(&logs).filter(|(_, log)| !log.is_nan()).map(|(level, _)| level);
    let inverse = web().map(|level| level.powi(-2)).sum::<f64>();
    let per_noise = (inverse / web().count() as f64).sqrt() / density;
    let shading = (!keep_shading && lamp.is_none()).then(|| Shading::fit(&logs, picture.columns));
    for (row, logs) in logs.chunks_exact_mut(picture.columns).enumerate() {
        match &shading {
            Some(shading) => logs.iter_mut().zip(shading.row(row)).for_each(|(log, lamp)| *log -= lamp),
            None => logs.iter_mut().for_each(|log| *log -= mean_log),
        }
    }
    logs.iter_mut().for_each(|log| *log = 1.0 - *log / density);
    let saturated = picture.full_scale.map_or(0, |most| levels().filter(|level| *level >= most).count());
    let (map, lighter) = map(picture, logs, mean.unwrap_or(1.0))?;
    Ok(WeighedPicture {
        map,
        mean_known: mean.is_some(),
        white: lamp.is_none().then_some(white),
        density: Some(density),
        shading,
        pixels: Pixels { filled, saturated, lighter },
        per_noise,
    })
}

fn weights(picture: &Picture, mean: Option<f64>) -> Result<WeighedPicture, Fault> {
    let usable = |weight: f64| if weight.is_finite() && weight >= 0.0 { weight } else { f64::NAN };
    let mut weights: Vec<f64> = picture.weights().map(usable).collect();
    let advice = "cut out a part of the map where the gauge has seen the web";
    let filled = unusable(&weights, "negative or without a value", advice)?;
    let found = mean_of(&weights);
    if !found.is_finite() || found <= 0.0 {
        return Err(no_weight(found));
    }
    weights.iter_mut().for_each(|weight| *weight /= found);
    let (map, _) = map(picture, weights, mean.unwrap_or(found))?;
    Ok(WeighedPicture {
        map,
        mean_known: true,
        white: None,
        density: None,
        shading: None,
        pixels: Pixels { filled, ..Pixels::default() },
        per_noise: 1.0 / found,
    })
}

/// How many values are missing, if they are few enough to be filled in.
fn unusable(values: &[f64], what: &'static str, advice: &'static str) -> Result<usize, Fault> {
    let unusable = values.iter().filter(|value| value.is_nan()).count();
    if unusable > values.len() / FILLED {
        return Err(Fault::new(
            format!("has {unusable} pixels of {} that are {what}", values.len()),
            format!("at most one in a hundred can be filled from its neighbours; {advice}"),
        ));
    }
    let first = values.iter().copied().find(|value| !value.is_nan());
    if values.iter().all(|value| value.is_nan() || Some(*value) == first) {
        return Err(Fault::new("has the same value everywhere", "is it the right file?"));
    }
    Ok(unusable)
}

/// The mean of the values that are there.
fn mean_of(values: &[f64]) -> f64 {
    let finite = || values.iter().filter(|value| !value.is_nan());
    finite().sum::<f64>() / finite().count() as f64
}

/// The map of relative weights, and how many were below zero.
fn map(picture: &Picture, mut weights: Vec<f64>, mean: f64) -> Result<(Map, usize), Fault> {
    weights.chunks_exact_mut(picture.columns).for_each(fill);
    let lighter = weights.iter().filter(|weight| **weight < 0.0).count();
    // A cast takes what is below zero as zero.
    let cells: Vec<u32> = weights.iter().map(|weight| (weight * QUANTA).round() as u32).collect();
    let mut map = Map {
        columns: picture.columns,
        rows: picture.rows,
        cell: picture.pixel,
        quantum: 1.0,
        closed: [false; 2],
        cells,
    };
    if map.total() == 0 {
        return Err(no_weight(0.0));
    }
    map.quantum = mean / map.basis_weight();
    Ok((map, lighter))
}

/// Fills in the missing values of a row, on a straight line between their neighbours; a row without any is of the mean weight.
fn fill(row: &mut [f64]) {
    let mut before = None;
    let mut at = 0;
    while at < row.len() {
        if !row[at].is_nan() {
            (before, at) = (Some(at), at + 1);
            continue;
        }
        let after = (at..row.len()).find(|i| !row[*i].is_nan());
        let end = after.unwrap_or(row.len());
        let value = |i: Option<usize>| i.map(|i| row[i]);
        let (left, right) = match (value(before), value(after)) {
            (Some(left), Some(right)) => (left, right),
            (None, None) => (1.0, 1.0),
            (Some(one), None) | (None, Some(one)) => (one, one),
        };
        let gap = (end - at + 1) as f64;
        for (i, missing) in row[at..end].iter_mut().enumerate() {
            *missing = left + (right - left) * (i + 1) as f64 / gap;
        }
        at = end;
    }
}

/// The fault of basis weights that are not above zero.
fn no_weight(mean: f64) -> Fault {
    let mean = shortest(mean);
    Fault::new(
        format!("has a mean basis weight of {mean}, which must be above zero"),
        "is it a map of basis weight?",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_pixels_lie_on_the_line_between_their_neighbours() {
        const NONE: f64 = f64::NAN;
        let mut rows = [[NONE, 2.0, NONE, NONE, 5.0, NONE], [NONE; 6], [1.0, NONE, 2.0, 3.0, NONE, NONE]];
        rows.iter_mut().for_each(|row| fill(row));
        assert_eq!(rows, [[2.0, 2.0, 3.0, 4.0, 5.0, 5.0], [1.0; 6], [1.0, 1.5, 2.0, 3.0, 3.0, 3.0]]);
    }
}
