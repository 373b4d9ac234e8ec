//! Computes the moments of a component, over the whole record or with a block left out.

/// Sums of powers of the difference from a reference.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Powers {
    count: f64,
    sums: [f64; 4],
}

impl Powers {
    pub(super) fn new(values: &[f64], reference: f64) -> Self {
        let mut sums = [0.0; 4];
        for value in values {
            let d = value - reference;
            let d2 = d * d;
            for (sum, power) in sums.iter_mut().zip([d, d2, d2 * d, d2 * d2]) {
                *sum += power;
            }
        }
        Self { count: values.len() as f64, sums }
    }

    pub(super) fn plus(&self, other: &Self, sign: f64) -> Self {
        let mut sum = *self;
        sum.count += sign * other.count;
        for (a, b) in sum.sums.iter_mut().zip(other.sums) {
            *a += sign * b;
        }
        sum
    }

    /// Moments about the mean. `reference` is what the powers are about.
    pub(super) fn moments(&self, reference: f64) -> Moments {
        let [a, b, c, d] = self.sums.map(|sum| sum / self.count);
        let variance = (b - a * a).max(0.0);
        let third = c - 3.0 * a * b + 2.0 * a * a * a;
        let fourth = d - 4.0 * a * c + 6.0 * a * a * b - 3.0 * a * a * a * a;
        Moments {
            mean: reference + a,
            rms: variance.sqrt(),
            skewness: third / (variance * variance.sqrt()),
            flatness: fourth / (variance * variance),
        }
    }
}

/// Moments of a component.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// Mean [m/s].
    pub mean: f64,
    /// Root mean square of the fluctuation `u = √(⟨u'²⟩)`, the sum divided by the number of samples [m/s].
    pub rms: f64,
    /// Skewness `⟨u'³⟩/u³` [-], 0 for a Gaussian.
    pub skewness: f64,
    /// Flatness `⟨u'⁴⟩/u⁴` [-], 3 for a Gaussian.
    pub flatness: f64,
}

impl Moments {
    /// The moments of a list of values.
    pub fn new(values: &[f64]) -> Self {
        let reference = values.iter().sum::<f64>() / values.len() as f64;
        Powers::new(values, reference).moments(reference)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_moments_of_four_samples() {
        // 1, 2, 4, 5 about 3: −2, −1, 1, 2.
        let moments = Moments::new(&[1.0, 2.0, 4.0, 5.0]);
        assert_eq!((moments.mean, moments.rms, moments.skewness), (3.0, 2.5f64.sqrt(), 0.0));
        assert!((moments.flatness - 8.5 / 6.25).abs() < 1e-15);
        // 0, 0, 0, 4 about 1: −1, −1, −1, 3; variance 3, third 6, fourth 21.
        let moments = Moments::new(&[0.0, 0.0, 0.0, 4.0]);
        assert!(
            (moments.skewness - 6.0 / 27f64.sqrt()).abs() < 1e-15
                && (moments.flatness - 21.0 / 9.0).abs() < 1e-15
        );
    }

    #[test]
    fn leaving_a_block_out_is_having_the_others() {
        let values: Vec<f64> = (0..30).map(|i| f64::from(i * i % 17)).collect();
        let (a, b) = values.split_at(12);
        let rest = Powers::new(&values, 5.0).plus(&Powers::new(a, 5.0), -1.0).moments(5.0);
        let alone = Moments::new(b);
        for (x, y) in [(rest.mean, alone.mean), (rest.rms, alone.rms), (rest.flatness, alone.flatness)] {
            assert!((x - y).abs() < 1e-12, "{x} {y}");
        }
    }
}
