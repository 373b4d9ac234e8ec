//! Fourier transform of eight signals side by side.

use crate::lanes::{Isa, Lanes, Register, Task, WIDTH, Wide, cos_sin_turn};
use std::array::from_fn;
use std::ops::Range;

/// Complex numbers of eight lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complex {
    /// Real part.
    pub re: Lanes,
    /// Imaginary part.
    pub im: Lanes,
}

impl Complex {
    /// The transforms X and Y of the real and of the imaginary part of a signal, from its own at a place and that at
    /// the opposite one.
    pub fn of_both_parts(self, opposite: Self) -> [Self; 2] {
        let half = Lanes::splat(0.5);
        // X = (a + b*)/2, Y = (a − b*)/2i.
        [
            Self { re: half * (self.re + opposite.re), im: half * (self.im - opposite.im) },
            Self { re: half * (self.im + opposite.im), im: half * (opposite.re - self.re) },
        ]
    }
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

/// `e^{2πi·k·turns}` as (cosine, sine), `k < count`.
#[inline(always)]
pub fn roots<S: Register>(count: usize, turns: f64) -> Vec<(f64, f64)> {
    let mut roots = Vec::with_capacity(count.next_multiple_of(WIDTH));
    for first in (0..count).step_by(WIDTH) {
        let mut angles = Lanes::ZERO;
        for (i, angle) in angles.0.iter_mut().enumerate() {
            *angle = (first + i) as f64 * turns;
        }
        let (cos, sin) = cos_sin_turn(Wide::<S>::load(&angles));
        roots.extend(cos.store().0.into_iter().zip(sin.store().0));
    }
    roots.truncate(count);
    roots
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
        Self { roots: Isa::detect().run(RootsTask { size }) }
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
                    let a = WideComplex::<S>::load(&upper[q]);
                    let b = WideComplex::load(&lower[q]);
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

struct RootsTask {
    size: usize,
}

impl Task for RootsTask {
    type Output = Vec<(f64, f64)>;

    #[inline(always)]
    fn call<S: Register>(self) -> Vec<(f64, f64)> {
        roots::<S>(self.size / 2, 1.0 / self.size as f64)
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

/// Sums of `d_i d_{i+k}` over the samples `i` of each block for lags `k < lags`, `d` the difference from a reference;
/// `i+k` may be in a later block.
pub fn lagged_products(
    values: &[f64],
    reference: f64,
    blocks: &[Range<usize>],
    lags: usize,
) -> Vec<Vec<f64>> {
    // Pieces of `half` samples are correlated with twice as many, so that no lag below `half` wraps around.
    let half = lags.next_power_of_two().max(2);
    let size = 2 * half;
    let transform = InverseTransform::new(size);
    let mut sums = vec![vec![0.0; lags]; blocks.len()];
    let pieces: Vec<(usize, Range<usize>)> = (blocks.iter().enumerate())
        .flat_map(|(b, block)| {
            let end = block.end;
            block.clone().step_by(half).map(move |start| (b, start..end.min(start + half)))
        })
        .collect();
    let difference = |i: usize| values.get(i).map_or(0.0, |x| x - reference);
    for eight in pieces.chunks(WIDTH) {
        let piece: [Range<usize>; WIDTH] =
            from_fn(|lane| eight.get(lane).map_or(0..0, |(_, range)| range.clone()));
        let mut data: Vec<Complex> = (0..size)
            .map(|t| {
                let is_sample = |i: usize, most: usize| i < eight.len() && t < most;
                let at = |i: usize, most: usize| {
                    if is_sample(i, most) { difference(piece[i].start + t) } else { 0.0 }
                };
                Complex { re: Lanes::from_fn(|i| at(i, piece[i].len())), im: Lanes::from_fn(|i| at(i, size)) }
            })
            .collect();
        transform.run(&mut data);
        // X Y*, whose transform is `M Σ_n x_n y_{n+m}`.
        let cross = |m: usize| {
            let [x, y] = data[m].of_both_parts(data[(size - m) % size]);
            Complex { re: x.re * y.re + x.im * y.im, im: x.im * y.re - x.re * y.im }
        };
        let mut product: Vec<Complex> = (0..size).map(cross).collect();
        transform.run(&mut product);
        for (lane, (block, _)) in eight.iter().enumerate() {
            for (sum, c) in sums[*block].iter_mut().zip(&product) {
                *sum += c.re.0[lane] / size as f64;
            }
        }
    }
    sums
}
