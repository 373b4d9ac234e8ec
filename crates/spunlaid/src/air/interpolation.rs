//! From evenly spaced samples back to the velocity at any time.

use super::Turbulence;
use super::synthesis::Signal;
use crate::lanes::{Lanes, Plain, Register, Wide};
use crate::vec3::Vec3;
use std::f64::consts::PI;

/// How many samples an interpolated value rests on.
pub(super) const SPREAD: usize = 8;
/// Cells of a cubic per sample spacing of a synthesised signal. Of a record each spacing is one.
const CELLS: u64 = 16;

/// The Kaiser-Bessel taper `φ(x) = I₀(β √(1−(2x/w)²))/I₀(β)`, |x| ≤ w/2 = SPREAD/2 sample spacings.
///
/// A signal of frequencies up to a quarter of the sampling rate, each divided by the taper's transform
/// there, is restored by a sum over the eight nearest samples to 1e-7 of its rms. theory.md (19)
pub(super) struct Taper {
    beta: f64,
}

impl Taper {
    pub(super) fn new() -> Self {
        // The widest main lobe that still ends before the first image, at ¾ of the sampling rate.
        Self { beta: PI * SPREAD as f64 * 0.75 }
    }

    /// Fourier transform at a frequency in turns per sample, `w sinh(s)/(s I₀(β))`, `s² = β²−(πwν)²`.
    pub(super) fn transform(&self, frequency: f64) -> f64 {
        let w = SPREAD as f64;
        let a = PI * w * frequency;
        let s = (self.beta * self.beta - a * a).sqrt();
        w * libm::sinh(s) / (s * bessel_i0_and_slope(self.beta).0)
    }

    /// `φ` and `dφ/dx` at `x` sample spacings.
    fn value_and_slope(&self, x: f64) -> (f64, f64) {
        let w = SPREAD as f64;
        let inside = 1.0 - (2.0 * x / w).powi(2);
        if inside < 0.0 {
            return (0.0, 0.0);
        }
        let scale = bessel_i0_and_slope(self.beta).0;
        let (value, slope_over_z) = bessel_i0_and_slope(self.beta * inside.sqrt());
        // dφ/dx = I₁(z) dz/dx with z = β√inside: dz/dx = −β² 4x/(w² z).
        let slope = -slope_over_z * self.beta * self.beta * 4.0 * x / (w * w);
        (value / scale, slope / scale)
    }
}

/// Modified Bessel function `I₀(z)` and `I₁(z)/z`, by their series.
fn bessel_i0_and_slope(z: f64) -> (f64, f64) {
    let quarter = z * z / 4.0;
    let (mut i0, mut i1_over_z) = (0.0, 0.0);
    let mut term = 1.0;
    let mut k = 0.0;
    while term > 1e-20 * i0 {
        i0 += term;
        i1_over_z += 0.5 * term / (k + 1.0);
        k += 1.0;
        term *= quarter / (k * k);
    }
    (i0, i1_over_z)
}

/// The wind along eight fibres as time goes on: each velocity component a cubic in time within a cell,
/// through values and slopes at the cell's two ends.
///
/// The cubic is 64 or more cells to the shortest period: error `(π/32)⁴/384 · u/3 < 1e-7 u`. theory.md (19)
#[derive(Clone, Debug)]
pub struct Wind<'a> {
    turbulence: &'a Turbulence,
    /// Weights of the `SPREAD` samples for value and slope (per cell) at the `CELLS` cell ends.
    weights: Vec<[(f64, f64); SPREAD]>,
    cells_per_sample: u64,
    cell: Option<u64>,
    /// Value and slope at the two ends of the cell, `[eddy][component]`.
    start: Vec<(Lanes, Lanes)>,
    end: Vec<(Lanes, Lanes)>,
    /// Coefficients of the cubic in the cell's own time from 0 to 1.
    cubic: Vec<[[Lanes; 4]; 3]>,
}

impl<'a> Wind<'a> {
    /// The wind of some turbulence and its mean flow.
    pub fn new(turbulence: &'a Turbulence) -> Self {
        let taper = Taper::new();
        let weights = (0..CELLS)
            .map(|cell| {
                std::array::from_fn(|tap| {
                    let fraction = cell as f64 / CELLS as f64;
                    let x = fraction - (tap as f64 - (SPREAD as f64 / 2.0 - 1.0));
                    let (value, slope) = taper.value_and_slope(x);
                    (value, slope / CELLS as f64)
                })
            })
            .collect();
        let columns = 3 * turbulence.eddies;
        let cells_per_sample = match turbulence.signal {
            Signal::Synthesised(_) => CELLS,
            Signal::Measured(_) => 1,
        };
        Self {
            turbulence,
            weights,
            cells_per_sample,
            cell: None,
            start: vec![(Lanes::ZERO, Lanes::ZERO); columns],
            end: vec![(Lanes::ZERO, Lanes::ZERO); columns],
            cubic: vec![[[Lanes::ZERO; 4]; 3]; turbulence.eddies],
        }
    }

    /// Velocity of the air in each eddy [m/s] at time `t` [s] of the run, mean flow included.
    ///
    /// Fastest when times come in order.
    pub fn at(&mut self, t: f64) -> Vec<Vec3<Lanes>> {
        let eddies = self.turbulence.eddies as u32;
        let gust = self.blow::<Plain>(t);
        (0..eddies).map(|eddy| gust.velocity(eddy).store()).collect()
    }

    /// [`Wind::at`] for the kernel, to be asked eddy by eddy.
    #[inline(always)]
    pub(crate) fn blow<S: Register>(&mut self, t: f64) -> EddyVelocities<'_, S> {
        let cells = t / self.turbulence.spacing * self.cells_per_sample as f64;
        let cell = cells as u64;
        if self.cell != Some(cell) {
            self.enter::<S>(cell);
        }
        EddyVelocities { cubic: &self.cubic, s: Wide::splat(cells - cell as f64) }
    }

    #[inline(always)]
    fn enter<S: Register>(&mut self, cell: u64) {
        if cell == 0 || self.cell != Some(cell - 1) {
            self.move_end::<S>(cell);
        }
        std::mem::swap(&mut self.start, &mut self.end);
        self.move_end::<S>(cell + 1);
        let (two, three) = (Wide::<S>::splat(2.0), Wide::<S>::splat(3.0));
        for (column, (cubic, (a, b))) in
            self.cubic.as_flattened_mut().iter_mut().zip(self.start.iter().zip(&self.end)).enumerate()
        {
            let a = (Wide::load(&a.0), Wide::load(&a.1));
            let b = (Wide::load(&b.0), Wide::load(&b.1));
            let rise = b.0 - a.0;
            let mean =
                if column % 3 == 0 { Wide::load(&self.turbulence.mean[column / 3]) } else { Wide::zero() };
            *cubic = [
                (a.0 + mean).store(),
                a.1.store(),
                three.mul_add(rise, -two.mul_add(a.1, b.1)).store(),
                two.neg_mul_add(rise, a.1 + b.1).store(),
            ];
        }
        self.cell = Some(cell);
    }

    /// Puts the value and slope at a cell's start into `end`.
    #[inline(always)]
    fn move_end<S: Register>(&mut self, cell: u64) {
        let samples = match &self.turbulence.signal {
            Signal::Synthesised(samples) => samples,
            Signal::Measured(stretches) => {
                for (end, stretch) in self.end.iter_mut().zip(stretches) {
                    let (value, slope) = stretch.value_and_slope::<S>(cell as usize);
                    *end = (value.store(), slope.store());
                }
                return;
            }
        };
        let columns = self.end.len();
        let first = (cell / CELLS) as usize;
        let weights = &self.weights[(cell % CELLS) as usize];
        let samples = &samples[first * columns..][..SPREAD * columns];
        for (column, end) in self.end.iter_mut().enumerate() {
            let (mut value, mut slope) = (Wide::<S>::zero(), Wide::<S>::zero());
            for (tap, &(for_value, for_slope)) in weights.iter().enumerate() {
                let sample = Wide::load(&samples[tap * columns + column]);
                value = sample.mul_add(Wide::splat(for_value), value);
                slope = sample.mul_add(Wide::splat(for_slope), slope);
            }
            *end = (value.store(), slope.store());
        }
    }
}

/// The wind at one instant.
#[derive(Clone, Copy)]
pub(crate) struct EddyVelocities<'a, S: Register> {
    cubic: &'a [[[Lanes; 4]; 3]],
    s: Wide<S>,
}

impl<S: Register> EddyVelocities<'_, S> {
    /// Velocity of the air in an eddy [m/s].
    #[inline(always)]
    pub(crate) fn velocity(&self, eddy: u32) -> Vec3<Wide<S>> {
        let [x, y, z] = &self.cubic[eddy as usize];
        Vec3::new(self.along(x), self.along(y), self.along(z))
    }

    #[inline(always)]
    fn along(&self, [c0, c1, c2, c3]: &[Lanes; 4]) -> Wide<S> {
        let s = self.s;
        Wide::load(c3).mul_add(s, Wide::load(c2)).mul_add(s, Wide::load(c1)).mul_add(s, Wide::load(c0))
    }
}
