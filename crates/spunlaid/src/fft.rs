//! Fourier transform of eight signals side by side.

use crate::lanes::{Lanes, cos_sin_turn, one_at_a_time};

/// Complex numbers of eight lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complex {
    /// Real part.
    pub re: Lanes,
    /// Imaginary part.
    pub im: Lanes,
}

impl Complex {
    /// `e^{2πi·turns}` in every lane.
    pub fn unit(turns: f64) -> Self {
        let (re, im) = cos_sin_turn(Lanes::splat(turns));
        Self { re, im }
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self { re: self.re - other.re, im: self.im - other.im }
    }

    /// Product.
    #[inline(always)]
    pub fn times(self, other: Self) -> Self {
        Self {
            re: self.re.mul_add(other.re, -(self.im * other.im)),
            im: self.re.mul_add(other.im, self.im * other.re),
        }
    }
}

/// Unscaled inverse Fourier transform `y_m = Σ_n x_n e^{2πi nm/M}`, `M` a power of two.
///
/// Stockham's radix-2 form: no bit reversal, unit stride, one pass per factor of two.
#[derive(Clone, Debug)]
pub struct InverseTransform {
    /// `e^{2πi k/M}`, `k < M/2`, as (cosine, sine).
    roots: Vec<(f64, f64)>,
}

impl InverseTransform {
    /// For signals of `size` samples, a power of two.
    pub fn new(size: usize) -> Self {
        debug_assert!(size.is_power_of_two());
        let roots = (0..size / 2)
            .map(|k| {
                let root = Complex::unit(k as f64 / size as f64);
                (root.re.0[0], root.im.0[0])
            })
            .collect();
        Self { roots }
    }

    /// Transforms `data` in place, with `scratch` of the same size.
    #[inline(always)]
    pub fn run(&self, data: &mut Vec<Complex>, scratch: &mut Vec<Complex>) {
        let size = data.len();
        let mut stride = 1;
        let mut half = size / 2;
        while half >= 1 {
            for p in 0..half {
                let (cos, sin) = self.roots[p * stride];
                let root = Complex { re: Lanes::splat(cos), im: Lanes::splat(sin) };
                let upper = &data[stride * p..][..stride];
                let lower = &data[stride * (p + half)..][..stride];
                let (even, odd) = scratch[2 * stride * p..][..2 * stride].split_at_mut(stride);
                for q in 0..stride {
                    one_at_a_time();
                    even[q] = upper[q].plus(lower[q]);
                    odd[q] = upper[q].minus(lower[q]).times(root);
                }
            }
            std::mem::swap(data, scratch);
            stride *= 2;
            half /= 2;
        }
    }
}
