//! A series of any length, of which a limited number of values is kept.

/// Evenly spaced values of a series that is not kept: every value, until they are too many; then every
/// second, every fourth and so on. Quantiles of a long series are found in them.
#[derive(Clone, Debug, PartialEq)]
pub struct EvenSample<T> {
    values: Vec<T>,
    every: u64,
    count: u64,
}

impl<T> Default for EvenSample<T> {
    fn default() -> Self {
        Self { values: Vec::new(), every: 1, count: 0 }
    }
}

impl<T> EvenSample<T> {
    /// Most values that are kept. A series that is not longer is kept whole; of a longer one, half as many at
    /// least are kept.
    pub const MOST: usize = 1 << 14;

    /// Takes the next value of the series.
    pub fn push(&mut self, value: T) {
        if self.count.is_multiple_of(self.every) {
            if self.values.len() == Self::MOST {
                let mut index = 0_usize;
                self.values.retain(|_| {
                    index += 1;
                    !index.is_multiple_of(2)
                });
                // The length was even, so this value is one of those that stay.
                self.every *= 2;
            }
            self.values.push(value);
        }
        self.count += 1;
    }

    /// The values that are kept, in their order.
    pub fn values(&self) -> &[T] {
        &self.values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_series_is_kept_evenly_and_a_short_one_whole() {
        let most = EvenSample::<u64>::MOST as u64;
        for (length, every) in
            [(5, 1), (most, 1), (most + 1, 2), (2 * most, 2), (2 * most + 1, 4), (1_000_000, 64)]
        {
            let mut thinned = EvenSample::default();
            (0..length).for_each(|value| thinned.push(value));
            let wanted: Vec<u64> = (0..length).step_by(every).collect();
            assert!(thinned.values() == wanted && wanted.len() as u64 <= most, "{length}");
        }
    }
}
