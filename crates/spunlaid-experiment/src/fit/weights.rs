//! How much each number counts: the inverse of their covariance from web to web, and what follows from it for
//! the sought values.

use spunlaid_ground::statistics::{dot, inverse};

/// Share of a covariance that is taken away, so that few webs do not seem to know how numbers go together.
const SHRUNK: f64 = 0.1;

/// A square or rectangular matrix, row by row.
pub(super) type Matrix = Vec<Vec<f64>>;

/// The mean of some rows.
pub(super) fn mean_of<'a>(rows: impl Iterator<Item = &'a Vec<f64>> + Clone) -> Vec<f64> {
    let count = rows.clone().count() as f64;
    let length = rows.clone().next().map_or(0, Vec::len);
    (0..length).map(|i| rows.clone().map(|row| row[i]).sum::<f64>() / count).collect()
}

/// The weights of numbers that scatter like those of some webs, and of which the scan gives each with further
/// errors: the inverse of their covariance.
///
/// * `errors` – standard errors by each further cause, common to all numbers
///
/// None if a number is the same in all webs.
pub(super) fn weights<'a>(
    webs: impl Iterator<Item = &'a Vec<f64>> + Clone,
    errors: &[Vec<f64>],
) -> Option<Matrix> {
    let mean = mean_of(webs.clone());
    let degrees = webs.clone().count() as f64 - 1.0;
    let covariance = |i: usize, j: usize| {
        let products = webs.clone().map(|web| (web[i] - mean[i]) * (web[j] - mean[j]));
        let share = if i == j { 1.0 } else { 1.0 - SHRUNK };
        let common = errors.iter().map(|error| error[i] * error[j]).sum::<f64>();
        share * products.sum::<f64>() / degrees + common
    };
    let size = mean.len();
    inverse((0..size).map(|i| (0..size).map(|j| covariance(i, j)).collect()).collect()).ok()
}

/// `rᵀ W r`.
pub(super) fn misfit(weights: &Matrix, rest: &[f64]) -> f64 {
    weights.iter().zip(rest).map(|(row, one)| one * dot(row, rest)).sum()
}

/// `Jᵀ W J` of the slopes `J` [by key, then by number].
pub(super) fn information(weights: &Matrix, slopes: &Matrix) -> Matrix {
    let weighted: Matrix =
        slopes.iter().map(|slope| weights.iter().map(|row| dot(row, slope)).collect()).collect();
    slopes.iter().map(|slope| weighted.iter().map(|other| dot(slope, other)).collect()).collect()
}

/// What numbers that are off by one each do to the sought values, theory.md (101): `(Jᵀ W J)⁻¹ Jᵀ W` [by key,
/// then by number].
///
/// # Errors
/// The key whose slopes follow from those of the keys before it, or are zero.
pub(super) fn gain(weights: &Matrix, slopes: &Matrix) -> Result<Matrix, usize> {
    let inverse = inverse(information(weights, slopes))?;
    let weighted: Matrix =
        slopes.iter().map(|slope| weights.iter().map(|row| dot(row, slope)).collect()).collect();
    let row = |row: &Vec<f64>| {
        (0..weights.len())
            .map(|i| row.iter().zip(&weighted).map(|(share, other)| share * other[i]).sum())
            .collect()
    };
    Ok(inverse.iter().map(row).collect())
}

/// The numbers without the part that other values of the keys explain.
pub(super) fn unexplained(gain: &Matrix, slopes: &Matrix, numbers: &[f64]) -> Vec<f64> {
    let steps: Vec<f64> = gain.iter().map(|row| dot(row, numbers)).collect();
    let explained = |i: usize| slopes.iter().zip(&steps).map(|(slope, step)| slope[i] * step).sum::<f64>();
    numbers.iter().enumerate().map(|(i, number)| number - explained(i)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gain_finds_the_values_that_made_the_numbers() {
        let webs: Vec<Vec<f64>> = (0..12)
            .map(|k| (0..4).map(|i| f64::from((k * 7 + i * i * 5 + k * k * i) % 11)).collect())
            .collect();
        let weights = weights(webs.iter(), &[]).expect("weights");
        let slopes = vec![vec![1.0, 0.5, 0.2, 0.1], vec![0.0, 1.0, -1.0, 2.0]];
        let gain = gain(&weights, &slopes).expect("a gain");
        let numbers: Vec<f64> = (0..4).map(|i| 3.0 * slopes[0][i] - 2.0 * slopes[1][i]).collect();
        for (row, value) in gain.iter().zip([3.0, -2.0]) {
            assert!((dot(row, &numbers) - value).abs() < 1e-12);
        }
        assert!(unexplained(&gain, &slopes, &numbers).iter().all(|rest| rest.abs() < 1e-12));
        assert_eq!(super::gain(&weights, &vec![slopes[0].clone(), vec![0.0; 4]]), Err(1));
    }
}
