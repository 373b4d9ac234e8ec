//! The shading of the lamp: a polynomial of second order in both directions.

use crate::web::Map;

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
