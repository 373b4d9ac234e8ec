//! Turbulence by random-phase synthesis.

use super::interpolation::{SPREAD, Taper};
use super::stretches::{Stretch, stretches};
use super::{Air, EddyTurbulence};
use crate::fft::{Complex, InverseTransform, WideComplex, unit};
use crate::lanes::{Isa, Lanes, Register, Task, WIDTH, Wide, cos_sin_turn};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::{PI, SQRT_2};

/// What the random phases of a fibre are drawn from. Equal keys give equal turbulence, bit for bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StreamKey {
    /// Master seed of the run.
    pub seed: u64,
    /// Index of the replicate.
    pub replicate: u64,
}

impl StreamKey {
    /// Random numbers of one velocity component of one eddy.
    pub(super) fn stream(self, eddy: u64, component: usize) -> ChaCha8Rng {
        let mut key = [0; 32];
        for (bytes, word) in key.chunks_exact_mut(8).zip([self.seed, self.replicate, eddy, component as u64])
        {
            bytes.copy_from_slice(&word.to_le_bytes());
        }
        ChaCha8Rng::from_seed(key)
    }
}

/// A number of [0, 1).
fn uniform(stream: &mut ChaCha8Rng) -> f64 {
    (stream.next_u64() >> 11) as f64 * (0.5 * f64::EPSILON)
}

/// Two independent numbers of the standard normal distribution (Box and Muller).
fn normal(stream: &mut ChaCha8Rng) -> (f64, f64) {
    let radius = (-2.0 * libm::log(1.0 - uniform(stream))).sqrt();
    let angle = 2.0 * PI * uniform(stream);
    (radius * libm::cos(angle), radius * libm::sin(angle))
}

/// The turbulence of one fibre: where it comes from.
#[derive(Clone, Copy, Debug)]
pub struct Stream<'a> {
    /// The air.
    pub air: &'a Air,
    /// What the turbulence of each eddy is made of, see [`Air::turbulence_of_eddies`].
    pub turbulence_of_eddies: &'a [EddyTurbulence],
    /// What its phases are drawn from.
    pub key: StreamKey,
}

/// The velocity fluctuation along eight fibres over a run, evenly sampled.
///
/// A component of an eddy is `u(t) = √2 Σ A_n cos(ω_n t + φ_n)`, `n = 0 … N_h−1`, `ω_n = (n+½)Δω`
/// (theory.md (16)), or a stretch of a record. [`Wind`](super::Wind) restores it at any time.
#[derive(Clone, Debug)]
pub struct Turbulence {
    pub(super) signal: Signal,
    pub(super) eddies: usize,
    /// Time between samples [s].
    pub(super) spacing: f64,
    /// Mean velocity along x of each eddy [m/s].
    pub(super) mean: Vec<Lanes>,
}

/// Where the samples are.
#[derive(Clone, Debug)]
pub(super) enum Signal {
    /// `[sample][eddy][component]`, sample 0 at the time `−(SPREAD/2 − 1)` spacings.
    Synthesised(Vec<Lanes>),
    /// `[eddy][component]`
    Measured(Vec<Stretch>),
}

impl Turbulence {
    /// Synthesises the turbulence of a uniform flow over `[0, duration]` [s] for the fibres of up to eight
    /// lanes, whose eddies are all alike and independent.
    ///
    /// Lanes left over repeat the first. The air of all lanes must agree in cut-off frequency and
    /// number of harmonics.
    pub fn synthesise(isa: Isa, lanes: &[(Air, StreamKey)], eddies: usize, duration: f64) -> Self {
        let turbulence_of_eddies: Vec<Vec<EddyTurbulence>> =
            lanes.iter().map(|(air, _)| vec![air.eddy_turbulence(); eddies]).collect();
        let streams = lanes
            .iter()
            .zip(&turbulence_of_eddies)
            .map(|((air, key), turbulence_of_eddies)| Stream { air, turbulence_of_eddies, key: *key });
        Self::of(isa, &streams.collect::<Vec<_>>(), duration)
    }

    /// The turbulence of up to eight fibres over `[0, duration]` [s].
    ///
    /// Lanes left over repeat the first. All must agree in cut-off frequency, number of harmonics, number of
    /// eddies, and in their records and whether they have any.
    pub fn of(isa: Isa, lanes: &[Stream<'_>], duration: f64) -> Self {
        let pick = |i: usize| &lanes[if i < lanes.len() { i } else { 0 }];
        let eddies = lanes[0].turbulence_of_eddies.len();
        let mean =
            (0..eddies).map(|eddy| Lanes::from_fn(|i| pick(i).turbulence_of_eddies[eddy].mean)).collect();
        let (signal, spacing) = match lanes[0].air.records.first() {
            Some(record) => (Signal::Measured(stretches(lanes, duration)), record.interval),
            None => {
                let spacing = grid(lanes[0].air).1;
                (Signal::Synthesised(isa.run(Synthesis { lanes, duration })), spacing)
            }
        };
        Self { signal, eddies, spacing, mean }
    }

    /// Memory of the samples of one bundle of eight fibres [bytes].
    pub fn memory(air: &Air, eddies: usize, duration: f64) -> f64 {
        if !air.records.is_empty() {
            return eddies as f64 * 3.0 * size_of::<Stretch>() as f64;
        }
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
    lanes: &'a [Stream<'a>],
    duration: f64,
}

impl Task for Synthesis<'_> {
    type Output = Vec<Lanes>;

    #[inline(always)]
    fn call<S: Register>(self) -> Vec<Lanes> {
        let eddies = self.lanes[0].turbulence_of_eddies.len();
        let (period, spacing) = grid(self.lanes[0].air);
        let half = period / 2;
        let transform = InverseTransform::new(half);
        let turn_back: Vec<(f64, f64)> = (0..half).map(|m| unit(-0.25 * m as f64 / half as f64)).collect();
        let mut harmonics = Harmonics::new(self.lanes, period);

        let count = sample_count(self.duration, spacing);
        let columns = 3 * eddies;
        let mut samples = vec![Lanes::ZERO; count * columns];
        let mut bins = vec![Complex::default(); half];
        let mut scratch = bins.clone();
        let mut wave = bins.clone();
        for column in 0..columns {
            harmonics.enter(column / 3, column % 3);
            bins.fill(Complex::default());
            for (n, (a, phase)) in harmonics.each(column % 3).enumerate() {
                let (cos, sin) = cos_sin_turn(Wide::<S>::load(phase));
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
        samples
    }
}

/// Amplitudes and phases of the harmonics of one eddy after the other, from the root down.
struct Harmonics<'a> {
    lanes: &'a [Stream<'a>],
    /// √2 over the taper's own transform, so that interpolation with it restores the harmonic.
    scale: Vec<f64>,
    /// By component.
    amplitude: [Vec<Lanes>; 3],
    /// By component, in turns.
    phase: [Vec<Lanes>; 3],
}

impl<'a> Harmonics<'a> {
    fn new(lanes: &'a [Stream<'a>], period: usize) -> Self {
        let (harmonics, taper) = (lanes[0].air.harmonics, Taper::new());
        let turns_per_sample = |n: usize| (n as f64 + 0.5) / period as f64;
        let scale = (0..harmonics).map(|n| SQRT_2 / taper.transform(turns_per_sample(n))).collect();
        let zero = || std::array::from_fn(|_| vec![Lanes::ZERO; harmonics]);
        Self { lanes, scale, amplitude: zero(), phase: zero() }
    }

    /// Goes on to a component of an eddy.
    fn enter(&mut self, eddy: usize, component: usize) {
        for lane in 0..WIDTH {
            if lane < self.lanes.len() {
                self.enter_lane(lane, eddy, component);
            } else {
                for of in [&mut self.amplitude[component], &mut self.phase[component]] {
                    of.iter_mut().for_each(|of| of.0[lane] = of.0[0]);
                }
            }
        }
    }

    fn enter_lane(&mut self, lane: usize, eddy: usize, component: usize) {
        let Stream { air, turbulence_of_eddies, key } = self.lanes[lane];
        let eddy_turbulence = &turbulence_of_eddies[eddy];
        // Most eddies sound alike.
        let like_above = eddy > 0 && turbulence_of_eddies[eddy - 1].same_spectrum(eddy_turbulence);
        if !like_above {
            let amplitudes = eddy_turbulence.spectrum(air, component).amplitudes();
            let amplitudes = amplitudes.into_iter().chain(std::iter::repeat(0.0));
            for ((of, a), scale) in self.amplitude[component].iter_mut().zip(amplitudes).zip(&self.scale) {
                of.0[lane] = a * scale;
            }
        }
        let mut stream = key.stream(eddy as u64, component);
        let phase = self.phase[component].iter_mut().map(|of| &mut of.0[lane]);
        match eddy_turbulence.carried {
            None => phase.for_each(|phase| *phase = uniform(&mut stream)),
            // What arrives later lags behind; what is forgotten walks away at random: theory.md (47).
            Some(time) => {
                let lag = time / air.repeat_time();
                let step = (2.0 * eddy_turbulence.forgotten).sqrt() / (2.0 * PI);
                let mut spare = None;
                for (n, phase) in phase.enumerate() {
                    let walk = match spare.take() {
                        _ if step == 0.0 => 0.0,
                        Some(walk) => walk,
                        None => {
                            let (walk, other) = normal(&mut stream);
                            spare = Some(other);
                            walk
                        }
                    };
                    let turned = *phase - (n as f64 + 0.5) * lag + step * walk;
                    *phase = turned - turned.floor();
                }
            }
        }
    }

    /// Amplitude and phase [turns] of each harmonic of a component.
    fn each(&self, component: usize) -> impl Iterator<Item = (&Lanes, &Lanes)> {
        self.amplitude[component].iter().zip(&self.phase[component])
    }
}

/// Samples needed to interpolate anywhere in `[0, duration]`.
fn sample_count(duration: f64, spacing: f64) -> usize {
    (duration / spacing).ceil() as usize + SPREAD + 1
}
