//! Autocorrelation of a series that is never stored.

/// Sums of lagged products of a series, about a reference near its mean.
///
/// Lags are multiples of `stride` samples. Samples that lie a multiple of `stride` apart form one of `stride`
/// interleaved series; each keeps its last `lags` samples.
#[derive(Clone, Debug)]
pub(super) struct LaggedProducts {
    stride: usize,
    /// Number of lags, lag zero included.
    lags: usize,
    reference: f64,
    count: u64,
    sum: f64,
    products: Vec<f64>,
    /// Sum of the first `k·stride` samples, for each lag `k` reached so far.
    first: Vec<f64>,
    recent: Vec<Recent>,
}

/// The last samples of a series, the newest first.
#[derive(Clone, Debug)]
struct Recent {
    /// Every sample stands at two places, so that the last ones always lie in a row.
    twice: Vec<f64>,
    newest: usize,
}

impl Recent {
    fn new(lags: usize) -> Self {
        Self { twice: vec![0.0; 2 * lags], newest: 0 }
    }

    fn push(&mut self, x: f64) -> &[f64] {
        let lags = self.twice.len() / 2;
        self.newest = (self.newest + lags - 1) % lags;
        self.twice[self.newest] = x;
        self.twice[self.newest + lags] = x;
        self.samples()
    }

    fn samples(&self) -> &[f64] {
        &self.twice[self.newest..self.newest + self.twice.len() / 2]
    }
}

impl LaggedProducts {
    /// * `stride` – samples from one lag to the next, one or more
    /// * `lags` – number of lags, lag zero included, one or more
    pub(super) fn new(stride: usize, lags: usize) -> Self {
        Self {
            stride,
            lags,
            reference: 0.0,
            count: 0,
            sum: 0.0,
            products: vec![0.0; lags],
            first: vec![0.0],
            recent: vec![Recent::new(lags); stride],
        }
    }

    pub(super) fn add(&mut self, value: f64) {
        if self.count == 0 {
            self.reference = value;
        }
        let x = value - self.reference;
        // Places that no sample has taken yet are zero and add nothing.
        let recent = self.recent[(self.count % self.stride as u64) as usize].push(x);
        for (product, before) in self.products.iter_mut().zip(recent) {
            *product += x * before;
        }
        self.sum += x;
        self.count += 1;
        if self.count.is_multiple_of(self.stride as u64) && self.first.len() < self.lags {
            self.first.push(self.sum);
        }
    }

    /// Samples from one lag to the next.
    pub(super) const fn stride(&self) -> usize {
        self.stride
    }

    /// Number of samples.
    pub(super) const fn count(&self) -> u64 {
        self.count
    }

    /// Mean; NaN without samples.
    pub(super) fn mean(&self) -> f64 {
        self.reference + self.sum / self.count as f64
    }

    /// `⟨(x_i − x̄)(x_{i+k} − x̄)⟩` for each lag that has a pair, divided by the number of pairs; x̄ is the
    /// mean of all samples.
    pub(super) fn covariances(&self) -> Vec<f64> {
        let n = self.count as f64;
        let mean = self.sum / n;
        let mut last = 0.0;
        let pairs =
            |lag: usize| self.count.checked_sub((lag * self.stride) as u64).filter(|pairs| *pairs > 0);
        (0..self.lags)
            .map_while(|lag| {
                let pairs = pairs(lag)? as f64;
                let covariance = (self.products[lag] - mean * (2.0 * self.sum - last - self.first[lag]))
                    / pairs
                    + mean * mean;
                last += self.recent.iter().map(|recent| recent.samples()[lag]).sum::<f64>();
                Some(covariance)
            })
            .collect()
    }
}

/// The lag at which an autocorrelation first falls to ½, by linear interpolation, in steps of the lag; NaN if
/// it does not.
pub(super) fn half_lag(coefficients: &[f64]) -> f64 {
    let at = coefficients.windows(2).position(|pair| pair[1] <= 0.5);
    at.map_or(f64::NAN, |at| {
        let (above, below) = (coefficients[at], coefficients[at + 1]);
        at as f64 + (above - 0.5) / (above - below)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_covariances_are_those_of_the_stored_series() {
        let values: Vec<f64> = (0..997).map(|i| 3.0 + f64::from(i * i % 101) * 0.01).collect();
        for (stride, lags) in [(1, 1), (1, 40), (3, 40), (7, 300)] {
            for n in [1, 2, 20, 300, 997] {
                let mut sums = LaggedProducts::new(stride, lags);
                values[..n].iter().for_each(|x| sums.add(*x));
                let mean = values[..n].iter().sum::<f64>() / n as f64;
                assert!((sums.mean() - mean).abs() < 1e-13 && sums.count() == n as u64);
                let found = sums.covariances();
                assert_eq!(found.len(), lags.min((n - 1) / stride + 1), "{stride} {lags} {n}");
                for (lag, found) in found.iter().enumerate() {
                    let pairs = n - lag * stride;
                    let product = |i: usize| (values[i] - mean) * (values[i + lag * stride] - mean);
                    let wanted = (0..pairs).map(product).sum::<f64>() / pairs as f64;
                    // Rounding of a few hundred sums of numbers near 1.
                    assert!(
                        (found - wanted).abs() < 1e-12,
                        "{stride} {lags} {n} at {lag}: {found}, {wanted}"
                    );
                }
            }
        }
    }

    #[test]
    fn half_lag_is_interpolated() {
        assert!((half_lag(&[1.0, 0.8, 0.4, 0.6, 0.1]) - 1.75).abs() < 1e-14);
        assert_eq!(half_lag(&[1.0, 0.5]), 1.0);
        assert!(
            half_lag(&[1.0, 0.8]).is_nan() && half_lag(&[]).is_nan() && half_lag(&[f64::NAN; 3]).is_nan()
        );
    }
}
