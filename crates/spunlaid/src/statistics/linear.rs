//! Small vectors and matrices.

/// Adds a multiple of a row to the sums.
pub(crate) fn add(sums: &mut [f64], factor: f64, row: &[f64]) {
    sums.iter_mut().zip(row).for_each(|(sum, x)| *sum += factor * x);
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The inverse of a symmetric positive definite matrix, by Gauss and Jordan.
///
/// # Errors
/// The column of a singular matrix that follows from the columns before it, up to rounding.
pub(crate) fn inverse(mut matrix: Vec<Vec<f64>>) -> Result<Vec<Vec<f64>>, usize> {
    let size = matrix.len();
    let scale: Vec<f64> = (0..size).map(|i| matrix[i][i]).collect();
    let mut inverse: Vec<Vec<f64>> =
        (0..size).map(|i| (0..size).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    for pivot in 0..size {
        // The remaining diagonal is the part of this column that no earlier one explains.
        let value = matrix[pivot][pivot];
        if value.is_nan() || value <= 1e-9 * scale[pivot] {
            return Err(pivot);
        }
        for row in [&mut matrix[pivot], &mut inverse[pivot]] {
            row.iter_mut().for_each(|x| *x /= value);
        }
        let (from_matrix, from_inverse) = (matrix[pivot].clone(), inverse[pivot].clone());
        for other in (0..size).filter(|other| *other != pivot) {
            let factor = matrix[other][pivot];
            for (row, from) in [(&mut matrix[other], &from_matrix), (&mut inverse[other], &from_inverse)] {
                row.iter_mut().zip(from).for_each(|(x, y)| *x -= factor * y);
            }
        }
    }
    Ok(inverse)
}
