//! Fourier transform of eight signals side by side.

use crate::lanes::{Isa, Lanes, Plain, Register, Task, Wide, cos_sin_turn};

/// Complex numbers of eight lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complex {
    /// Real part.
    pub re: Lanes,
    /// Imaginary part.
    pub im: Lanes,
}

/// [`Complex`] in registers.
#[derive(Clone, Copy)]
pub struct WideComplex<S: Register> {
    /// Real part.
    pub re: Wide<S>,
    /// Imaginary part.
    pub im: Wide<S>,
}

impl<S: Register> WideComplex<S> {
    /// From memory.
    #[inline(always)]
    pub fn load(z: &Complex) -> Self {
        Self { re: Wide::load(&z.re), im: Wide::load(&z.im) }
    }

    /// Into memory.
    #[inline(always)]
    pub fn store(self) -> Complex {
        Complex { re: self.re.store(), im: self.im.store() }
    }

    /// Product with one complex number, the same for every lane.
    #[inline(always)]
    pub fn times(self, (re, im): (f64, f64)) -> Self {
        let (re, im) = (Wide::splat(re), Wide::splat(im));
        Self { re: self.im.neg_mul_add(im, self.re * re), im: self.re.mul_add(im, self.im * re) }
    }
}

/// `e^{2πi·turns}` as (cosine, sine).
pub fn unit(turns: f64) -> (f64, f64) {
    let (cos, sin) = cos_sin_turn(Wide::<Plain>::splat(turns));
    (cos.store().0[0], sin.store().0[0])
}

/// Unscaled inverse Fourier transform `y_m = Σ_n x_n e^{2πi nm/M}`, `M` a power of two.
///
/// Stockham's radix-2 form, which needs no bit reversal and one pass per factor of two.
#[derive(Clone, Debug)]
pub struct InverseTransform {
    /// `e^{2πi k/M}`, `k < M/2`, as (cosine, sine).
    roots: Vec<(f64, f64)>,
}

impl InverseTransform {
    /// For signals of `size` samples, a power of two.
    pub fn new(size: usize) -> Self {
        debug_assert!(size.is_power_of_two());
        Self { roots: (0..size / 2).map(|k| unit(k as f64 / size as f64)).collect() }
    }

    /// Transforms `data` in place.
    pub fn run(&self, data: &mut Vec<Complex>) {
        let mut scratch = vec![Complex::default(); data.len()];
        Isa::detect().run(TransformTask { transform: self, data, scratch: &mut scratch });
    }

    /// Transforms `data` in place, with `scratch` of the same size.
    #[inline(always)]
    pub fn pass<S: Register>(&self, data: &mut Vec<Complex>, scratch: &mut Vec<Complex>) {
        let size = data.len();
        let mut stride = 1;
        let mut half = size / 2;
        while half >= 1 {
            for p in 0..half {
                let root = self.roots[p * stride];
                let upper = &data[stride * p..][..stride];
                let lower = &data[stride * (p + half)..][..stride];
                let (even, odd) = scratch[2 * stride * p..][..2 * stride].split_at_mut(stride);
                for q in 0..stride {
                    let (a, b) = (WideComplex::<S>::load(&upper[q]), WideComplex::load(&lower[q]));
                    even[q] = WideComplex { re: a.re + b.re, im: a.im + b.im }.store();
                    odd[q] = WideComplex { re: a.re - b.re, im: a.im - b.im }.times(root).store();
                }
            }
            std::mem::swap(data, scratch);
            stride *= 2;
            half /= 2;
        }
    }
}

struct TransformTask<'a> {
    transform: &'a InverseTransform,
    data: &'a mut Vec<Complex>,
    scratch: &'a mut Vec<Complex>,
}

impl Task for TransformTask<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        self.transform.pass::<S>(self.data, self.scratch);
    }
}
