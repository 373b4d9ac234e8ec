//! Small vibrations: frequencies of a discrete chain from its matrices, and from its flight.

/// Eigenvalues, smallest first, and eigenvectors (by row) of a symmetric matrix: Jacobi's rotations.
pub fn symmetric_eigen(mut a: Vec<Vec<f64>>) -> (Vec<f64>, Vec<Vec<f64>>) {
    let n = a.len();
    let mut q: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| f64::from(i == j)).collect()).collect();
    for _ in 0..60 {
        let off: f64 = (0..n).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| a[i][j].powi(2)).sum();
        let all: f64 = a.iter().flatten().map(|x| x * x).sum();
        if off < 1e-30 * all {
            break;
        }
        for i in 1..n {
            for j in 0..i {
                if a[i][j] == 0.0 {
                    continue;
                }
                let tau = (a[i][i] - a[j][j]) / (2.0 * a[i][j]);
                let t = tau.signum() / (tau.abs() + (1.0 + tau * tau).sqrt());
                let c = 1.0 / (1.0 + t * t).sqrt();
                let s = t * c;
                for row in &mut a {
                    let (x, y) = (row[j], row[i]);
                    (row[j], row[i]) = (c * x - s * y, s * x + c * y);
                }
                for k in 0..n {
                    let (x, y) = (a[j][k], a[i][k]);
                    (a[j][k], a[i][k]) = (c * x - s * y, s * x + c * y);
                    let (x, y) = (q[j][k], q[i][k]);
                    (q[j][k], q[i][k]) = (c * x - s * y, s * x + c * y);
                }
            }
        }
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| a[i][i].total_cmp(&a[j][j]));
    (order.iter().map(|&i| a[i][i]).collect(), order.iter().map(|&i| q[i].clone()).collect())
}

/// Frequencies [Hz] and mode shapes (displacements) of `M q'' = −K q`, `M` diagonal.
pub fn vibrations(stiffness: &[Vec<f64>], mass: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
    let n = mass.len();
    let scaled =
        (0..n).map(|i| (0..n).map(|j| stiffness[i][j] / (mass[i] * mass[j]).sqrt()).collect()).collect();
    let (values, vectors) = symmetric_eigen(scaled);
    let frequency = |w2: &f64| w2.max(0.0).sqrt() / (2.0 * std::f64::consts::PI);
    let shape = |q: Vec<f64>| q.iter().zip(mass).map(|(x, m)| x / m.sqrt()).collect();
    (values.iter().map(frequency).collect(), vectors.into_iter().map(shape).collect())
}

/// Frequency [Hz] of an oscillation about zero from the first and last of its upward passages,
/// linear between samples.
pub fn frequency_of(samples: &[f64], interval: f64) -> f64 {
    let passages: Vec<f64> = samples
        .windows(2)
        .enumerate()
        .filter(|(_, w)| w[0] < 0.0 && w[1] >= 0.0)
        .map(|(i, w)| (i as f64 + w[0] / (w[0] - w[1])) * interval)
        .collect();
    assert!(passages.len() > 2, "too few oscillations to measure");
    (passages.len() - 1) as f64 / (passages[passages.len() - 1] - passages[0])
}
