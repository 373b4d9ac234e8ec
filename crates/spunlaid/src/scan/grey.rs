//! Whether numbers that are taken as basis weights are grey levels.

use super::picture::Picture;
use crate::error::Fault;
use crate::units::shortest;

/// Largest levels of pictures, and how the numbers of a file may be related to them: whole, or parts of one.
const LEVELS: [(f64, f64); 4] =
    [(255.0, 1.0), (65_535.0, 1.0), (255.0, 1.0 / 255.0), (65_535.0, 1.0 / 65_535.0)];
/// A number is a level if it is so near to it [levels].
const NEAR: f64 = 0.01;
/// Fewest different levels of a picture.
const FEWEST: usize = 16;
/// Units in which weights are whole numbers, in kg/m²: grams, tenths of them and so on.
const UNITS: [f64; 4] = [1e-3, 1e-4, 1e-5, 1e-6];
/// The mean of a map lies so near to that of its sheet.
const SAME: f64 = 0.1;

/// The doubt that a map holds grey levels: all numbers are levels of 8 or 16 bits, and their mean is not that
/// of the sheet in a usual unit.
///
/// * `mean` – of the sheet, if it is known [kg/m²]
/// * `is_assumed` – whether nobody has said that they are weights
pub(super) fn grey_levels(picture: &Picture, mean: Option<f64>, is_assumed: bool) -> Option<Fault> {
    if picture.weight_of_black.is_some() {
        return None;
    }
    let values = || picture.values.iter().copied().filter(|value| value.is_finite());
    let largest = values().fold(0.0, f64::max);
    let is_level =
        |step: f64, value: f64| value >= 0.0 && (value / step - (value / step).round()).abs() < NEAR;
    let fits =
        |(full, step): &(f64, f64)| largest <= full * step && values().all(|value| is_level(*step, value));
    let (full, step) = LEVELS.into_iter().find(fits)?;
    let mut seen: Vec<u32> = values().map(|value| (value / step).round() as u32).collect();
    seen.sort_unstable();
    seen.dedup();
    let found = values().sum::<f64>() / values().count() as f64;
    let is_same = |unit: &f64| mean.is_some_and(|mean| (found * unit / mean - 1.0).abs() < SAME);
    if seen.len() < FEWEST || UNITS.iter().any(is_same) {
        return None;
    }
    let bits = if full == 255.0 { 8 } else { 16 };
    let message = format!(
        "all numbers are levels of {bits} bits, up to {}, as those of a picture; {}",
        shortest(largest),
        if is_assumed {
            "if they are grey levels and no basis weights, every CV is wrong, so no interval is given"
        } else {
            "they are taken as basis weights, as you said"
        }
    );
    let remedy = if is_assumed { "say what they are (--light transmitted or --light weight)" } else { "" };
    Some(Fault::new(message, remedy))
}
