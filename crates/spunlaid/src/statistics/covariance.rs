//! Two values that vary together.

/// Running variances and covariance of pairs of values (Welford).
#[derive(Clone, Copy, Debug, Default)]
pub struct Covariance {
    count: f64,
    mean: [f64; 2],
    squares: [f64; 2],
    product: f64,
}

impl Covariance {
    /// Takes the next pair.
    pub fn add(&mut self, pair: [f64; 2]) {
        self.count += 1.0;
        let off = [pair[0] - self.mean[0], pair[1] - self.mean[1]];
        for (mean, off) in self.mean.iter_mut().zip(off) {
            *mean += off / self.count;
        }
        let rest = [pair[0] - self.mean[0], pair[1] - self.mean[1]];
        for ((squares, off), rest) in self.squares.iter_mut().zip(off).zip(rest) {
            *squares += off * rest;
        }
        self.product += off[0] * rest[1];
    }

    /// The correlation coefficient; NaN if one of the values does not vary.
    pub fn correlation(&self) -> f64 {
        self.product / (self.squares[0] * self.squares[1]).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::Covariance;

    #[test]
    fn analytic_correlation_of_a_few_pairs() {
        let mut pairs = Covariance::default();
        assert!(pairs.correlation().is_nan());
        [[1.0, 2.0], [2.0, 1.0], [3.0, 4.0], [4.0, 3.0]].into_iter().for_each(|pair| pairs.add(pair));
        // Deviations −1.5, −0.5, 0.5, 1.5 and −0.5, −1.5, 1.5, 0.5: products 3, squares 5 and 5.
        assert!((pairs.correlation() - 0.6).abs() < 1e-15);
        let mut far_from_zero = Covariance::default();
        [1.0, 2.0, 4.0].into_iter().for_each(|x| far_from_zero.add([1e6 + x, -3.0 * x]));
        assert!((far_from_zero.correlation() + 1.0).abs() < 1e-9);
    }
}
