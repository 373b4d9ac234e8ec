//! The light of a picture, pixel by pixel: what is missing, the level of the lamp, and its shading.

use super::picture::Picture;
use crate::map::Map;
use spunlaid_ground::Fault;
use spunlaid_ground::units::{rounded, shortest};

/// One pixel in so many may be filled in.
pub(super) const FILLED: usize = 100;

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

/// The logarithm of the light that comes through, over that of the lamp if there is a picture of it; NaN
/// where there is none.
pub(super) fn logs(picture: &Picture, lamp: Option<&Picture>) -> Vec<f64> {
    let log = |level: &f64| if level.is_finite() && *level > 0.0 { libm::log(*level) } else { f64::NAN };
    let mut logs: Vec<f64> = picture.values.iter().map(log).collect();
    if let Some(lamp) = lamp {
        let scale = lamp.scale_to(picture);
        logs.iter_mut().zip(&lamp.values).for_each(|(light, lamp)| *light -= log(&(scale * lamp)));
    }
    logs
}

/// Refuses a picture of the lamp of another size.
pub(super) fn same_size(picture: &Picture, lamp: Option<&Picture>) -> Result<(), Fault> {
    let wanted = picture.whole().sides;
    let found = lamp.map_or(picture.whole().sides, |lamp| lamp.whole().sides);
    if wanted == found {
        return Ok(());
    }
    let message = format!(
        "has {} × {} pixels, but the image of the lamp without web has {} × {}",
        wanted[0], wanted[1], found[0], found[1]
    );
    Err(Fault::new(message, "take both with the same camera from the same position").option("--lamp"))
}

/// The grey level of the lamp without web, or of the thickest web in reflected light.
pub(super) fn white_level(
    picture: &Picture,
    white: Option<f64>,
    lamp: Option<&Picture>,
) -> Result<f64, Fault> {
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
    // Over a picture of the lamp, all light is one.
    if lamp.is_some() {
        return Ok(1.0);
    }
    white.map_or_else(|| largest_level(picture), Ok)
}

/// The largest level that the file can hold, if it is known.
fn largest_level(picture: &Picture) -> Result<f64, Fault> {
    let advice =
        "give the level of the lamp without web, in reflected light of a web too thick to see through";
    let Some(largest) = picture.full_scale else {
        let message = "holds numbers without a largest grey level, so the level of the lamp is not known, \
            and with an assumed value every CV would be wrong by the same factor";
        return Err(
            Fault::new(message, format!("{advice}, or an image of the lamp")).option("--white, --lamp")
        );
    };
    let Some(bits) = picture.fewer_bits else { return Ok(largest) };
    let possible = (1u32 << bits) - 1;
    Err(Fault::new(
        format!(
            "has no level above {possible}, though the file has 16 bits: it is not known whether a camera \
            of {bits} bits made it or the image is dark. With a wrong level of the lamp every CV would \
            be wrong by the same factor"
        ),
        format!("{advice}: {possible} if the camera has {bits} bits, otherwise {largest}"),
    )
    .option("--white"))
}

/// Largest shading that is believed to be that of a lamp and a lens, brightest over darkest place. By the law
/// of the fourth power of the cosine a lens that sees 54° darkens so much towards its corners.
const MOST_SHADING: f64 = 1.6;

/// The shading that is to be taken out, if any.
pub(super) fn believed_shading(
    logs: &[f64],
    columns: usize,
    lamp: Option<&Picture>,
    keep_shading: bool,
) -> Result<Option<Shading>, Fault> {
    if keep_shading || lamp.is_some() {
        return Ok(None);
    }
    let shading = Shading::fit(logs, columns);
    if shading.range() > libm::log(MOST_SHADING) {
        let [found, most] =
            [libm::expm1(shading.range()), MOST_SHADING - 1.0].map(|share| (100.0 * share).round());
        return Err(Fault::new(
            format!(
                "becomes brighter by {found} % from its darkest to its brightest part, and a lamp and a \
                lens make {most} % at most. The bare lamp may be visible next to the web, or the web \
                itself changes; the image does not show which"
            ),
            "give an image of the lamp without web, or cut out the web, or say that the lamp is uniform",
        )
        .option("--lamp, --keep-shading"));
    }
    Ok(Some(shading))
}

/// How many values are missing, if they are few enough to be filled in.
pub(super) fn unusable(values: &[f64], what: &'static str, advice: &'static str) -> Result<usize, Fault> {
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
pub(super) fn mean_of(values: &[f64]) -> f64 {
    let finite = || values.iter().filter(|value| !value.is_nan());
    finite().sum::<f64>() / finite().count() as f64
}

/// `0.25 %`.
pub(super) fn per_cent(share: f64) -> String {
    format!("{} %", shortest(rounded(100.0 * share, 1)))
}

/// Powers of the place across and along the picture, term by term.
const TERMS: [[usize; 2]; 6] = [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2]];
/// Highest sum of two powers, and one more.
const POWERS: usize = 5;

/// The smooth part of a picture: `Σ c u^k v^l` with places `u` across and `v` along the picture from −1 to 1.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shading {
    /// Coefficients of 1, u, v, u², uv, v².
    coefficients: [f64; 6],
    sides: [usize; 2],
}

/// The middle of a pixel, from −1 to 1.
fn place(pixel: usize, side: usize) -> f64 {
    (2 * pixel + 1) as f64 / side as f64 - 1.0
}

impl Shading {
    /// Least squares over the values that are numbers.
    pub(super) fn fit(values: &[f64], columns: usize) -> Self {
        let rows = values.len() / columns;
        let across: Vec<f64> = (0..columns).map(|column| place(column, columns)).collect();
        // Sums of u^k v^l, and of the values times u^k v^l.
        let (mut weights, mut moments) = ([[0.0; POWERS]; POWERS], [[0.0; 3]; 3]);
        for (row, values) in values.chunks_exact(columns).enumerate() {
            let (mut counts, mut sums) = ([0.0; POWERS], [0.0; 3]);
            for (u, value) in across.iter().zip(values).filter(|(_, value)| !value.is_nan()) {
                let powers = [1.0, *u, u * u, u * u * u, u * u * u * u];
                (0..POWERS).for_each(|k| counts[k] += powers[k]);
                (0..3).for_each(|k| sums[k] += value * powers[k]);
            }
            let (v, mut power) = (place(row, rows), 1.0);
            for l in 0..POWERS {
                (0..POWERS).for_each(|k| weights[k][l] += counts[k] * power);
                if l < 3 {
                    (0..3).for_each(|k| moments[k][l] += sums[k] * power);
                }
                power *= v;
            }
        }
        let matrix = TERMS.map(|[k, l]| TERMS.map(|[m, n]| weights[k + m][l + n]));
        Self { coefficients: solved(matrix, TERMS.map(|[k, l]| moments[k][l])), sides: [columns, rows] }
    }

    /// Its values in a row of the picture.
    pub(super) fn row(&self, row: usize) -> impl Iterator<Item = f64> {
        let [a, u, v, uu, uv, vv] = self.coefficients;
        let ([columns, rows], y) = (self.sides, place(row, self.sides[1]));
        debug_assert!(row < rows);
        let (constant, linear) = (a + v * y + vv * y * y, u + uv * y);
        (0..columns).map(move |column| {
            let x = place(column, columns);
            constant + linear * x + uu * x * x
        })
    }

    /// Difference between its largest and its smallest value.
    pub(super) fn range(&self) -> f64 {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        let step = |side: usize| side.div_ceil(64);
        for row in (0..self.sides[1]).step_by(step(self.sides[1])) {
            for value in self.row(row).step_by(step(self.sides[0])) {
                (least, most) = (least.min(value), most.max(value));
            }
        }
        most - least
    }
}

/// A map without a polynomial of second order, as that of a scan is when the shading of its lamp has been taken out.
pub fn flattened(map: &Map) -> Map {
    let mean = map.total() as f64 / map.cells.len() as f64;
    let weights: Vec<f64> = map.cells.iter().map(|cell| f64::from(*cell)).collect();
    let shading = Shading::fit(&weights, map.columns);
    let row = |(row, weights): (usize, &[f64])| -> Vec<u32> {
        weights
            .iter()
            .zip(shading.row(row))
            .map(|(weight, smooth)| (weight - smooth + mean).round() as u32)
            .collect()
    };
    let cells = weights.chunks_exact(map.columns).enumerate().flat_map(row).collect();
    Map { cells, ..map.clone() }
}

/// The solution of symmetric positive definite equations, by elimination without pivots.
fn solved(mut matrix: [[f64; 6]; 6], mut right: [f64; 6]) -> [f64; 6] {
    for i in 0..6 {
        for j in i + 1..6 {
            let factor = matrix[j][i] / matrix[i][i];
            (i..6).for_each(|k| matrix[j][k] -= factor * matrix[i][k]);
            right[j] -= factor * right[i];
        }
    }
    for i in (0..6).rev() {
        let known: f64 = (i + 1..6).map(|k| matrix[i][k] * right[k]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_is_found_in_spite_of_missing_values() {
        let (columns, rows) = (37, 23);
        let wanted = |column: usize, row: usize| {
            let (u, v) = (place(column, columns), place(row, rows));
            0.3 - 0.2 * u + 0.1 * v + 0.5 * u * u - 0.4 * u * v + 0.25 * v * v
        };
        let value = |i: usize| if i % 97 == 5 { f64::NAN } else { wanted(i % columns, i / columns) };
        let shading = Shading::fit(&(0..columns * rows).map(value).collect::<Vec<_>>(), columns);
        for row in 0..rows {
            for (column, found) in shading.row(row).enumerate() {
                assert!((found - wanted(column, row)).abs() < 1e-13, "{found} at {column}, {row}");
            }
        }
    }
}
