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

/// The solution of equations with a symmetric positive definite matrix, by Cholesky; None if it is not
/// definite. Only the diagonal and what lies below it is looked at.
pub(crate) fn solve_positive(mut matrix: Vec<Vec<f64>>, mut sides: Vec<f64>) -> Option<Vec<f64>> {
    let size = sides.len();
    for i in 0..size {
        for j in 0..=i {
            let rest = matrix[i][j] - dot(&matrix[i][..j], &matrix[j][..j]);
            matrix[i][j] = if i == j { rest.sqrt() } else { rest / matrix[j][j] };
        }
        if matrix[i][i].is_nan() || matrix[i][i] <= 0.0 {
            return None;
        }
        sides[i] = (sides[i] - dot(&matrix[i][..i], &sides[..i])) / matrix[i][i];
    }
    for i in (0..size).rev() {
        let later: f64 = (i + 1..size).map(|j| matrix[j][i] * sides[j]).sum();
        sides[i] = (sides[i] - later) / matrix[i][i];
    }
    Some(sides)
}
