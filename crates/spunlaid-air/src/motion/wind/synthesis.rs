//! A window of turbulence by random-phase synthesis.

use super::sampling::{Sampling, Stream};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;
use spunlaid_ground::fft::roots;
use spunlaid_ground::lanes::cos_sin_turn;
use spunlaid_ground::random::uniform;
use spunlaid_ground::{Complex, InverseTransform, Lanes, PerLane, Register, Task, WIDTH, Wide, WideComplex};
use std::f64::consts::{PI, SQRT_2};
use std::ops::Range;

/// The samples of one window of random phases.
pub(super) struct Synthesis<'a> {
    pub(super) sampling: &'a Sampling,
    pub(super) streams: &'a PerLane<Stream>,
    pub(super) window: u64,
    pub(super) grid: SampleGrid,
    /// For each sample, which sample of the window it takes and with which factor.
    pub(super) shares: Vec<(usize, Share)>,
    /// The samples that they are added to, `[sample][eddy][component]`.
    pub(super) into: &'a mut [Lanes],
}

impl Task for Synthesis<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        let eddies = self.sampling.eddies;
        let period = self.grid.period;
        let half = period / 2;
        let transform = InverseTransform::new(half);
        let turn_back = roots::<S>(half, -0.25 / half as f64);
        let mut harmonics = Harmonics::new(self.sampling, self.streams, self.window, period);

        let columns = 3 * eddies;
        let mut bins = vec![Complex::default(); half];
        let mut scratch = bins.clone();
        let mut wave = bins.clone();
        for column in 0..columns {
            harmonics.enter::<S>(column / 3, column % 3);
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
            for (row, &(m, share)) in self.into.chunks_exact_mut(columns).zip(&self.shares) {
                let value = Wide::<S>::load(if m < half { &wave[m].re } else { &wave[m - half].im });
                row[column] = match share {
                    Share::Whole => value,
                    Share::Opposite => -value,
                    Share::Part(part) => value.mul_add(Wide::splat(part), Wide::load(&row[column])),
                }
                .store();
            }
        }
    }
}

/// Amplitudes and phases of the harmonics of one eddy after the other, from the root down.
struct Harmonics<'a> {
    streams: &'a PerLane<Stream>,
    window: u64,
    /// √2 over the taper's own transform, so that interpolation with it restores the harmonic.
    scale: Vec<f64>,
    /// By component.
    amplitude: [Vec<Lanes>; 3],
    /// By component, in turns.
    phase: [Vec<Lanes>; 3],
    /// Number of harmonics up to the cut-off, by component and lane.
    within_cutoff: [[usize; WIDTH]; 3],
    /// Whether the air of a lane has the spectrum of the first lane's.
    alike: Vec<bool>,
}

impl<'a> Harmonics<'a> {
    fn new(sampling: &Sampling, streams: &'a PerLane<Stream>, window: u64, period: usize) -> Self {
        let (harmonics, taper) = (sampling.harmonics, Taper::new());
        let turns_per_sample = |n: usize| (n as f64 + 0.5) / period as f64;
        let scale = (0..harmonics).map(|n| SQRT_2 / taper.transform(turns_per_sample(n))).collect();
        let zero = || std::array::from_fn(|_| vec![Lanes::ZERO; harmonics]);
        let first = &streams.lane(0).air;
        let alike = |stream: &Stream| {
            stream.air.spectrum == first.spectrum && stream.air.repeat_time() == first.repeat_time()
        };
        let alike = streams.iter().map(alike).collect();
        let within_cutoff = [[0; WIDTH]; 3];
        Self { streams, window, scale, amplitude: zero(), phase: zero(), within_cutoff, alike }
    }

    /// Moves on to a component of an eddy.
    #[inline(always)]
    fn enter<S: Register>(&mut self, eddy: usize, component: usize) {
        let (mut lag, mut turn) = (Lanes::ZERO, Lanes::ZERO);
        for (lane, Stream { air, eddies, key }) in self.streams.iter().enumerate() {
            let turbulence = &eddies[eddy];
            // Most eddies have the same spectrum.
            let like_above = eddy > 0 && eddies[eddy - 1].same_spectrum(turbulence);
            // So have most lanes, whose air is that of the first.
            let like_first = self.alike[lane] && self.streams.lane(0).eddies[eddy].same_spectrum(turbulence);
            if !like_above && like_first && lane > 0 {
                self.amplitude[component].iter_mut().for_each(|harmonic| harmonic.0[lane] = harmonic.0[0]);
                self.within_cutoff[component][lane] = self.within_cutoff[component][0];
            } else if !like_above {
                let amplitudes = turbulence.spectrum(air, component).amplitudes();
                self.within_cutoff[component][lane] = amplitudes.len();
                let amplitudes = amplitudes.into_iter().chain(std::iter::repeat(0.0));
                for ((harmonic, a), scale) in
                    self.amplitude[component].iter_mut().zip(amplitudes).zip(&self.scale)
                {
                    harmonic.0[lane] = a * scale;
                }
            }
            match turbulence.carried {
                None => {
                    let mut stream = key.stream(self.window, eddy as u64, component);
                    self.phase[component]
                        .iter_mut()
                        .for_each(|harmonic| harmonic.0[lane] = uniform(&mut stream));
                }
                Some(time) => {
                    lag.0[lane] = time / air.repeat_time();
                    turn.0[lane] = libm::acos(libm::exp(-turbulence.decay_times)) / (2.0 * PI);
                }
            }
        }
        if self.streams.any(|stream| stream.eddies[eddy].carried.is_some()) {
            self.carry::<S>(eddy, component, lag, turn);
        }
        for lane in self.streams.fibres()..WIDTH {
            for numbers in [&mut self.amplitude[component], &mut self.phase[component]] {
                numbers.iter_mut().for_each(|harmonic| harmonic.0[lane] = harmonic.0[0]);
            }
        }
    }

    /// The phases lag by the time of arrival, and turn to either side as the correlation decays: theory.md (47).
    ///
    /// * `lag` – by repeat times
    /// * `turn` – to either side [turns]
    #[inline(always)]
    fn carry<S: Register>(&mut self, eddy: usize, component: usize, lag: Lanes, turn: Lanes) {
        let mut streams = self.streams.each(|stream| stream.key.stream(self.window, eddy as u64, component));
        let (lag, mut harmonic) = (Wide::<S>::load(&lag), Wide::splat(0.5));
        for phases in self.phase[component].chunks_mut(64) {
            let mut sides = streams.each_mut().map(ChaCha8Rng::next_u64);
            for phase in phases {
                let mut side = turn;
                for (side, bits) in side.0.iter_mut().zip(&mut sides) {
                    *side = f64::from_bits(side.to_bits() ^ *bits << 63);
                    *bits >>= 1;
                }
                let turned = Wide::load(phase) - harmonic * lag + Wide::load(&side);
                *phase = (turned - turned.floor()).store();
                harmonic += Wide::splat(1.0);
            }
        }
    }

    /// Amplitude and phase [turns] of each harmonic of a component, up to the cut-off.
    fn each(&self, component: usize) -> impl Iterator<Item = (&Lanes, &Lanes)> {
        let within_cutoff = self.within_cutoff[component].iter().copied().max().unwrap_or(0);
        self.amplitude[component].iter().zip(&self.phase[component]).take(within_cutoff)
    }
}

/// Number of samples that an interpolated value is computed from.
pub(super) const SPREAD: usize = 8;

/// The Kaiser-Bessel taper `φ(x) = I₀(β √(1−(2x/w)²))/I₀(β)`, |x| ≤ w/2 = SPREAD/2 sample spacings.
///
/// The sum over the eight nearest samples restores a signal with frequencies up to a quarter of the sampling rate to
/// 1e-7 of its rms, if each frequency was divided by the taper's transform. theory.md (19)
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
    pub(super) fn value_and_slope(&self, x: f64) -> (f64, f64) {
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

/// How the samples are divided among the windows.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleGrid {
    /// Samples in a repeat time, four or more for each harmonic.
    pub(super) period: usize,
    /// Time between samples [s].
    pub(super) spacing: f64,
    /// Whether there is only one window, which repeats.
    pub(super) repeats: bool,
}

impl SampleGrid {
    pub(super) fn new(sampling: &Sampling, repeats: bool) -> Self {
        let period = 4 * sampling.harmonics.next_power_of_two();
        Self { period, spacing: sampling.repeat_time() / period as f64, repeats }
    }

    /// Samples in which one window fades out and the next one in.
    pub(super) fn fade(&self) -> usize {
        self.period / 4
    }

    /// Samples from the start of one window to that of the next.
    pub(super) fn hop(&self) -> i64 {
        if self.repeats { i64::MAX } else { (self.period - self.fade()) as i64 }
    }

    /// The block of samples that begins at `first`. It ends at the next start of a window after its eighth sample,
    /// or at `last`.
    pub(super) fn block(&self, first: i64, last: i64) -> Range<i64> {
        let hop = self.hop();
        let eighth = first + SPREAD as i64;
        let end = (eighth.max(0) / hop).saturating_add(1).saturating_mul(hop);
        first..end.min(last.max(eighth))
    }

    /// The windows that the samples lie in.
    pub(super) fn windows(&self, samples: &Range<i64>) -> Range<i64> {
        let hop = self.hop();
        (samples.start.max(0) / hop - 1).max(0)..(samples.end - 1).max(0) / hop + 1
    }

    /// The sample of a window that a sample uses, and the factor; `None` if the window does not contribute.
    ///
    /// The sample of the window lies within its repeat time; a sample before time zero or, where the window
    /// repeats, later is that of the opposite sign half a full period away.
    pub(super) fn share(&self, window: i64, sample: i64) -> Option<(usize, Share)> {
        let (period, fade) = (self.period as i64, self.fade() as i64);
        let local = sample - window.saturating_mul(self.hop());
        let laps = local.div_euclid(period);
        let place = local.rem_euclid(period) as usize;
        if self.repeats || window == 0 && local < 0 {
            return Some((place, if laps % 2 == 0 { Share::Whole } else { Share::Opposite }));
        }
        let angle = |step: i64| std::f64::consts::FRAC_PI_2 * (step as f64 + 0.5) / fade as f64;
        match local {
            l if !(0..period).contains(&l) => None,
            l if l < fade && window > 0 => Some((place, Share::Part(libm::sin(angle(l))))),
            l if l >= self.hop() => Some((place, Share::Part(libm::cos(angle(l - self.hop()))))),
            _ => Some((place, Share::Whole)),
        }
    }
}

/// The factor of a window at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Share {
    Whole,
    Opposite,
    Part(f64),
}
