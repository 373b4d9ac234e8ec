//! Turns a picture into a map of basis weight.

use super::ScanWarning;
use super::levels::{Shading, above_zero, believed_shading, logs, mean_of, unusable, white_level};
use super::picture::Picture;
use super::spots::{Spots, spots};
use crate::map::Map;
use spunlaid_ground::Fault;
use spunlaid_ground::units::{rounded, shortest};

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
    /// Light that a web on a black ground throws back.
    Reflected {
        /// Mean basis weight of the sheet, if it is known [kg/m²].
        mean: Option<f64>,
        /// Grey level of such fibres where they lie so thick that no ground is seen; by default the largest
        /// level that the file can hold.
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
    /// What is only an assumed value about the lamp, if anything.
    pub(super) fn assumption(&self, light: Light) -> Option<ScanWarning> {
        let is_white =
            matches!(light, Light::Transmitted { white: None, .. } | Light::Reflected { white: None, .. })
                && self.white.is_some();
        let shading = self.shading.is_some().then_some(ScanWarning::Shading);
        if is_white { Some(ScanWarning::White) } else { shading }
    }
}

/// Quanta of a cell of the mean weight.
const QUANTA: f64 = 1e6;
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
    let logs = logs(picture, correction.lamp);
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
            let column = (at % picture.columns).wrapping_sub(left);
            let row = (at / picture.columns).wrapping_sub(top);
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
    let (Light::Transmitted { mean, .. } | Light::Reflected { mean, .. } | Light::Weight { mean }) = light;
    above_zero("a mean basis weight [kg/m²]", mean)?;
    match light {
        Light::Transmitted { white, .. } => transmitted(picture, mean, white, correction, masked),
        Light::Reflected { white, .. } => reflected(picture, mean, white, correction),
        Light::Weight { .. } => weights(picture, mean),
    }
}

/// What to do about pixels without a value.
const fn advice(picture: &Picture, usual: &'static str) -> &'static str {
    if picture.transparent > 0 { "cut out a part of the image without transparent pixels" } else { usual }
}

fn transmitted(
    picture: &Picture,
    mean: Option<f64>,
    white: Option<f64>,
    Correction { lamp, keep_shading }: Correction<'_>,
    masked: &[bool],
) -> Result<WeighedPicture, Fault> {
    let white = white_level(picture, white, lamp)?;
    let levels = || picture.values.iter().copied().filter(|level| level.is_finite());
    let mut logs = logs(picture, lamp);
    let advice = advice(picture, "let more light through, or expose for longer");
    let filled = unusable(&logs, "black or without a value", advice)?;
    logs.iter_mut().zip(masked).filter(|(_, is)| **is).for_each(|(log, _)| *log = f64::NAN);
    let mean_log = mean_of(&logs);
    let density = libm::log(white) - mean_log;
    // What is left of rounding is no web.
    if density.is_nan() || density <= 1e-9 {
        return Err(Fault::new(
            format!(
                "is no darker than the lamp without web: its mean grey level is {}, \
            and that of the lamp {}",
                shortest(rounded(libm::exp(mean_log), 4)),
                shortest(white)
            ),
            "give the level of \
            the lamp without web at the same exposure, or say that the values are basis \
            weights",
        )
        .option("--white, --lamp, --light weight"));
    }
    let web = || picture.values.iter().zip(&logs).filter(|(_, log)| !log.is_nan()).map(|(level, _)| level);
    let inverse = web().map(|level| level.powi(-2)).sum::<f64>();
    let per_noise = (inverse / web().count() as f64).sqrt() / density;
    let shading = believed_shading(&logs, picture.columns, lamp, keep_shading)?;
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

/// From the light that a web on a black ground throws back. Fibres that scatter light and absorb none give,
/// in a layer of weight `m`, the reflectance `R = S m/(1 + S m)`, so `m` is proportional to `R/(1 − R)`.
///
/// Source: P. Kubelka, New contributions to the optics of intensely light-scattering materials, J. Opt. Soc.
/// Am. 38 (1948) 448–457.
fn reflected(
    picture: &Picture,
    mean: Option<f64>,
    white: Option<f64>,
    Correction { lamp, keep_shading }: Correction<'_>,
) -> Result<WeighedPicture, Fault> {
    let white = white_level(picture, white, lamp)?;
    let mut logs = logs(picture, lamp);
    let advice = advice(picture, "let more light fall on it, or expose for longer");
    let filled = unusable(&logs, "black or without a value", advice)?;
    let shading = believed_shading(&logs, picture.columns, lamp, keep_shading)?;
    let mean_log = mean_of(&logs);
    if let Some(shading) = &shading {
        for (row, logs) in logs.chunks_exact_mut(picture.columns).enumerate() {
            logs.iter_mut().zip(shading.row(row)).for_each(|(log, lamp)| *log += mean_log - lamp);
        }
    }
    let reflectances = || logs.iter().map(|log| libm::exp(*log) / white);
    let saturated = reflectances().filter(|reflectance| *reflectance >= 1.0).count();
    let weight =
        |reflectance: f64| if reflectance < 1.0 { reflectance / (1.0 - reflectance) } else { f64::NAN };
    let mut weights: Vec<f64> = reflectances().map(weight).collect();
    unusable(&weights, "as light as the thickest web or lighter", "give a higher level of the thickest web")
        .map_err(|fault| fault.option("--white"))?;
    let heaviness = mean_of(&weights);
    // Of m over the level: 1/(white (1 − R)²) = (1 + m)²/white.
    let squares: Vec<f64> = weights.iter().map(|weight| ((1.0 + weight).powi(2) / white).powi(2)).collect();
    let per_noise = mean_of(&squares).sqrt() / heaviness;
    weights.iter_mut().for_each(|weight| *weight /= heaviness);
    let (map, _) = map(picture, weights, mean.unwrap_or(1.0))?;
    Ok(WeighedPicture {
        map,
        mean_known: mean.is_some(),
        white: lamp.is_none().then_some(white),
        density: None,
        shading,
        pixels: Pixels { filled, saturated, lighter: 0 },
        per_noise,
    })
}

fn weights(picture: &Picture, mean: Option<f64>) -> Result<WeighedPicture, Fault> {
    let usable = |weight: f64| if weight.is_finite() && weight >= 0.0 { weight } else { f64::NAN };
    let mut weights: Vec<f64> = picture.weights().map(usable).collect();
    let advice = advice(picture, "cut out a part of the map where the gauge has seen the web");
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

/// Fills in the missing values of a row, on a straight line between their neighbours; a row without any is of
/// the mean weight.
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
