//! Turbulence by random-phase synthesis.

use super::Air;
use super::interpolation::{SPREAD, Taper};
use crate::fft::{Complex, InverseTransform, WideComplex, unit};
use crate::lanes::{Isa, Lanes, Register, Task, WIDTH, Wide, cos_sin_turn};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// What the random phases of a fibre are drawn from. Equal keys give equal turbulence, bit for bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StreamKey {
    /// Master seed of the run.
    pub seed: u64,
    /// Index of the replicate.
    pub replicate: u64,
}

impl StreamKey {
    /// Random phases, in turns of [0, 1), of one velocity component of one eddy.
    fn phases(self, eddy: usize, component: usize) -> impl FnMut() -> f64 {
        let mut key = [0; 32];
        for (bytes, word) in
            key.chunks_exact_mut(8).zip([self.seed, self.replicate, eddy as u64, component as u64])
        {
            bytes.copy_from_slice(&word.to_le_bytes());
        }
        let mut stream = ChaCha8Rng::from_seed(key);
        move || (stream.next_u64() >> 11) as f64 * (0.5 * f64::EPSILON)
    }
}

/// Samples of the velocity fluctuation along eight fibres over a run.
///
/// A component of an eddy is `u(t) = √2 Σ A_n cos(ω_n t + φ_n)`, `n = 0 … N_h−1`, `ω_n = (n+½)Δω`
/// (theory.md (16)), known here by evenly spaced samples from which [`Wind`](super::Wind) restores
/// it at any time.
#[derive(Clone, Debug)]
pub struct Turbulence {
    /// `[sample][eddy][component]`, sample 0 at the time `−(SPREAD/2 − 1)` spacings.
    pub(super) samples: Vec<Lanes>,
    pub(super) eddies: usize,
    pub(super) spacing: f64,
    pub(super) mean: Lanes,
}

impl Turbulence {
    /// Synthesises the turbulence over `[0, duration]` [s] for the fibres of up to eight lanes.
    ///
    /// Lanes left over repeat the first. The air of all lanes must agree in cut-off frequency and
    /// number of harmonics.
    pub fn synthesise(isa: Isa, lanes: &[(Air, StreamKey)], eddies: usize, duration: f64) -> Self {
        isa.run(Synthesis { lanes, eddies, duration })
    }

    /// Memory of the samples of one bundle of eight fibres [bytes].
    pub fn memory(air: &Air, eddies: usize, duration: f64) -> f64 {
        let (_, spacing) = grid(air);
        ((duration / spacing).ceil() + SPREAD as f64 + 1.0) * eddies as f64 * 3.0 * size_of::<Lanes>() as f64
    }
}

/// Number of samples in a repeat time, four or more for each harmonic, and their spacing [s].
fn grid(air: &Air) -> (usize, f64) {
    let samples = 4 * air.harmonics.next_power_of_two();
    (samples, air.repeat_time() / samples as f64)
}

struct Synthesis<'a> {
    lanes: &'a [(Air, StreamKey)],
    eddies: usize,
    duration: f64,
}

impl Task for Synthesis<'_> {
    type Output = Turbulence;

    #[inline(always)]
    fn call<S: Register>(self) -> Turbulence {
        let pick = |i: usize| &self.lanes[if i < self.lanes.len() { i } else { 0 }];
        let air = &pick(0).0;
        let harmonics = air.harmonics;
        let (period, spacing) = grid(air);
        let half = period / 2;
        let transform = InverseTransform::new(half);
        let taper = Taper::new();
        // √2 A_n over the taper's own transform, so that interpolation with it restores the harmonic.
        let amplitude: Vec<Lanes> = (0..harmonics)
            .map(|n| {
                let turns_per_sample = (n as f64 + 0.5) / period as f64;
                let scale = std::f64::consts::SQRT_2 / taper.transform(turns_per_sample);
                Lanes::from_fn(|i| pick(i).0.spectrum().amplitude(n, harmonics) * scale)
            })
            .collect();
        let turn_back: Vec<(f64, f64)> = (0..half).map(|m| unit(-0.25 * m as f64 / half as f64)).collect();

        let count = sample_count(self.duration, spacing);
        let columns = 3 * self.eddies;
        let mut samples = vec![Lanes::ZERO; count * columns];
        let mut bins = vec![Complex::default(); half];
        let mut scratch = bins.clone();
        let mut wave = bins.clone();
        for column in 0..columns {
            let mut phases: [_; WIDTH] = std::array::from_fn(|i| pick(i).1.phases(column / 3, column % 3));
            bins.fill(Complex::default());
            for (n, a) in amplitude.iter().enumerate() {
                let phase = Lanes::from_fn(|i| phases[i]());
                let (cos, sin) = cos_sin_turn(Wide::<S>::load(&phase));
                // Half the size for a real signal of half-odd frequencies: theory.md (18).
                let (bin, sign) = if n % 2 == 0 { ((half - n / 2) % half, -1.0) } else { (n / 2 + 1, 1.0) };
                let a = Wide::load(a);
                let sum = WideComplex::load(&bins[bin]);
                let sum = WideComplex {
                    re: a.mul_add(cos, sum.re),
                    im: (a * Wide::splat(sign)).mul_add(sin, sum.im),
                };
                bins[bin] = sum.store();
            }
            transform.pass::<S>(&mut bins, &mut scratch);
            for ((wave, bin), &back) in wave.iter_mut().zip(&bins).zip(&turn_back) {
                *wave = WideComplex::<S>::load(bin).times(back).store();
            }
            for (k, row) in samples.chunks_exact_mut(columns).enumerate() {
                // The signal changes sign from one repeat time to the next.
                let m = k as isize - (SPREAD as isize / 2 - 1);
                let (laps, m) = (m.div_euclid(period as isize), m.rem_euclid(period as isize) as usize);
                let value = Wide::<S>::load(if m < half { &wave[m].re } else { &wave[m - half].im });
                row[column] = if laps % 2 == 0 { value } else { -value }.store();
            }
        }
        Turbulence { samples, eddies: self.eddies, spacing, mean: Lanes::from_fn(|i| pick(i).0.velocity) }
    }
}

/// Samples needed to interpolate anywhere in `[0, duration]`.
fn sample_count(duration: f64, spacing: f64) -> usize {
    (duration / spacing).ceil() as usize + SPREAD + 1
}
