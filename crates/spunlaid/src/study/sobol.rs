//! Sobol's low-discrepancy sequence.
//!
//! Direction numbers: S. Joe and F. Y. Kuo, Constructing Sobol sequences with better two-dimensional
//! projections, SIAM J. Sci. Comput. 30 (2008) 2635–2654, the first of `new-joe-kuo-6.21201`.

/// Largest number of dimensions.
pub(super) const MOST_DIMENSIONS: usize = 21;
const BITS: usize = 32;

/// For dimensions 2 and above: the coefficients of the primitive polynomial as bits of a number, and the first
/// direction numbers, one for each degree.
const TABLE: [(u32, &[u32]); MOST_DIMENSIONS - 1] = [
    (0, &[1]),
    (1, &[1, 3]),
    (1, &[1, 3, 1]),
    (2, &[1, 1, 1]),
    (1, &[1, 1, 3, 3]),
    (4, &[1, 3, 5, 13]),
    (2, &[1, 1, 5, 5, 17]),
    (4, &[1, 1, 5, 5, 5]),
    (7, &[1, 1, 7, 11, 19]),
    (11, &[1, 1, 5, 1, 1]),
    (13, &[1, 1, 1, 3, 11]),
    (14, &[1, 3, 5, 5, 31]),
    (1, &[1, 3, 3, 9, 7, 49]),
    (13, &[1, 1, 1, 15, 21, 21]),
    (16, &[1, 3, 1, 13, 27, 49]),
    (19, &[1, 1, 1, 15, 7, 5]),
    (22, &[1, 3, 1, 15, 13, 25]),
    (25, &[1, 1, 5, 5, 19, 61]),
    (1, &[1, 3, 7, 11, 23, 15, 103]),
    (4, &[1, 3, 7, 13, 13, 15, 69]),
];

/// One dimension of the sequence.
#[derive(Clone, Debug)]
pub(super) struct Sobol {
    directions: [u32; BITS],
}

impl Sobol {
    /// Dimension `0 … 20`; larger numbers give the last dimension.
    pub(super) fn dimension(dimension: usize) -> Self {
        let mut directions = [0; BITS];
        match dimension.checked_sub(1).map(|i| TABLE[i.min(TABLE.len() - 1)]) {
            None => {
                for (bit, v) in directions.iter_mut().enumerate() {
                    *v = 1 << (BITS - 1 - bit);
                }
            }
            Some((coefficients, first)) => {
                let degree = first.len();
                for bit in 0..BITS {
                    directions[bit] = if bit < degree {
                        first[bit] << (BITS - 1 - bit)
                    } else {
                        let oldest = directions[bit - degree];
                        let newer = (1..degree).filter(|k| coefficients >> (degree - 1 - k) & 1 == 1);
                        newer.fold(oldest ^ (oldest >> degree), |v, k| v ^ directions[bit - k])
                    };
                }
            }
        }
        Self { directions }
    }

    /// Coordinate of a point, in [0, 1).
    pub(super) fn at(&self, index: u64) -> f64 {
        let gray = index ^ (index >> 1);
        let bits = self.directions.iter().enumerate().filter(|(bit, _)| gray >> bit & 1 == 1);
        f64::from(bits.fold(0, |x, (_, v)| x ^ v)) / (1u64 << BITS) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_first_points() {
        // Bratley & Fox (1988), Antonov and Saleev's order, as every implementation has them.
        let found: Vec<[f64; 3]> =
            (0..8).map(|i| std::array::from_fn(|d| Sobol::dimension(d).at(i))).collect();
        let expected = [
            [0.0, 0.0, 0.0],
            [0.5, 0.5, 0.5],
            [0.75, 0.25, 0.25],
            [0.25, 0.75, 0.75],
            [0.375, 0.375, 0.625],
            [0.875, 0.875, 0.125],
            [0.625, 0.125, 0.875],
            [0.125, 0.625, 0.375],
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn published_hundredth_point_in_all_dimensions() {
        // From another implementation of the same direction numbers (scipy.stats.qmc.Sobol, unscrambled).
        let found: Vec<f64> = (0..MOST_DIMENSIONS).map(|d| Sobol::dimension(d).at(100)).collect();
        assert_eq!(found, HUNDREDTH);
    }

    #[rustfmt::skip]
    const HUNDREDTH: [f64; MOST_DIMENSIONS] = [0.4140625, 0.2578125, 0.7734375, 0.7265625, 0.8828125, 0.7421875, 0.0234375, 0.4765625, 0.6328125, 0.6953125, 0.4609375, 0.6796875, 0.4765625, 0.8515625, 0.3203125, 0.4921875, 0.6796875, 0.7421875, 0.8359375, 0.3359375, 0.7578125];

    #[test]
    fn every_dimension_fills_every_stratum() {
        for dimension in 0..MOST_DIMENSIONS {
            let sobol = Sobol::dimension(dimension);
            let mut strata: Vec<u64> = (0..1024).map(|i| (sobol.at(i) * 1024.0) as u64).collect();
            strata.sort_unstable();
            assert_eq!(strata, (0..1024).collect::<Vec<_>>(), "dimension {dimension}");
        }
    }
}
