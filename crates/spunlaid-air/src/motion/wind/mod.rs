//! The wind along eight fibres as time goes on.
//!
//! ```text
//! windows (random phases, one window after the other), or stretches of a record → samples, evenly spaced in time
//!   → values and slopes at the ends of a cell → a cubic within the cell → the velocity at any time
//! ```
//!
//! A wind makes its samples as the time goes on. It keeps one block of them, so its memory does not grow with
//! the duration of the flight.

mod sampling;
mod stretches;
mod synthesis;
mod windows;

use self::stretches::Stretches;
use self::synthesis::{SPREAD, Taper};
use self::windows::Windows;
use super::Air;
pub use sampling::Sampling;
pub use sampling::{Stream, StreamKey};
use spunlaid_ground::{Error, Isa, Lanes, PerLane, Register, Task, Vec3, Wide};

/// Cubics per sample spacing of a synthesised signal. A record has one per spacing.
const CELLS: u64 = 16;
/// Likewise where a step is longer than one of these cells, so that each step would make cubics: error 2e-5 of the rms.
const LONG_CELLS: u64 = 4;

/// The wind along up to eight fibres, mean flow and fluctuation, as a function of time.
///
/// A component of an eddy is `u(t) = √2 Σ A_n cos(ω_n t + φ_n)`, `n = 0 … N_h−1`, `ω_n = (n+½)Δω`
/// (theory.md (16)), or a stretch of a record. Before that sum repeats, the wind passes to another one with
/// random phases of its own (theory.md (50)), so it never repeats.
///
/// Between samples each component is a cubic in time within a cell, through values and slopes at the cell's
/// two ends. The cubic is 64 or more cells to the shortest period: error `(π/32)⁴/384 · u/3 < 1e-7 u`.
/// theory.md (19)
#[derive(Clone, Debug)]
pub struct Wind {
    isa: Isa,
    signal: Signal,
    eddies: usize,
    /// Time between samples [s].
    spacing: f64,
    /// Mean velocity along x of each eddy [m/s].
    mean: Vec<Lanes>,
    /// Weights of the `SPREAD` samples for value and slope (per cell) at the cell ends.
    weights: Vec<[(f64, f64); SPREAD]>,
    cells_per_sample: u64,
    cell: Option<u64>,
    /// Value and slope at the two ends of the cell, `[eddy][component]`.
    start: Vec<(Lanes, Lanes)>,
    end: Vec<(Lanes, Lanes)>,
    /// Coefficients of the cubic in the cell's own time from 0 to 1.
    cubic: Vec<[[Lanes; 4]; 3]>,
}

/// Where the samples come from.
#[derive(Clone, Debug)]
enum Signal {
    Synthesised(Windows),
    Measured(Stretches),
}

impl Wind {
    /// The wind of a uniform flow along the fibres of up to eight lanes, whose eddies are all alike and
    /// independent.
    ///
    /// * `horizon` – the time for which samples are made at first [s]; they are made for later times when these
    ///   are asked for
    ///
    /// # Errors
    /// As of [`Wind::along`].
    pub fn uniform(isa: Isa, lanes: &[(Air, StreamKey)], eddies: usize, horizon: f64) -> Result<Self, Error> {
        Self::along(isa, Stream::uniform(lanes, eddies), horizon)
    }

    /// One sum of cosines alone, as the paper has it: the fluctuation repeats after [`Air::repeat_time`] with the
    /// opposite sign.
    ///
    /// # Errors
    /// As of [`Wind::along`], and for air with records.
    pub fn repeating(isa: Isa, streams: Vec<Stream>, horizon: f64) -> Result<Self, Error> {
        let (sampling, streams) = Sampling::from_streams(streams)?;
        if !sampling.records.is_empty() {
            return Err(Error::flight("repeating turbulence is made from harmonics", "leave air.record out"));
        }
        let mean = means(&sampling, &streams);
        let windows = Windows::repeating(isa, sampling, streams, horizon);
        Ok(Self::with_signal(isa, windows.spacing(), mean, Signal::Synthesised(windows)))
    }

    /// The wind of up to eight fibres. Lanes left over repeat the first.
    ///
    /// * `horizon` – as of [`Wind::uniform`]; stretches of records are chosen so that they last until then
    ///
    /// # Errors
    /// No fibre or more than eight, and fibres that do not agree in number of eddies, cut-off frequency, number
    /// of harmonics and records; an air without harmonics.
    pub fn along(isa: Isa, streams: Vec<Stream>, horizon: f64) -> Result<Self, Error> {
        let (sampling, streams) = Sampling::from_streams(streams)?;
        Ok(Self::sampled(isa, sampling, streams, horizon))
    }

    /// The wind of fibres that have a sampling in common.
    pub fn sampled(isa: Isa, sampling: Sampling, streams: PerLane<Stream>, horizon: f64) -> Self {
        let mean = means(&sampling, &streams);
        let (signal, spacing) = match sampling.records.first() {
            Some(record) => {
                let spacing = record.interval;
                (Signal::Measured(Stretches::new(sampling, streams, horizon)), spacing)
            }
            None => {
                let windows = Windows::new(isa, sampling, streams, horizon);
                let spacing = windows.spacing();
                (Signal::Synthesised(windows), spacing)
            }
        };
        Self::with_signal(isa, spacing, mean, signal)
    }

    fn with_signal(isa: Isa, spacing: f64, mean: Vec<Lanes>, signal: Signal) -> Self {
        let eddies = mean.len();
        let columns = 3 * eddies;
        let cells_per_sample = match signal {
            Signal::Synthesised(_) => CELLS,
            Signal::Measured(_) => 1,
        };
        Self {
            isa,
            signal,
            eddies,
            spacing,
            mean,
            weights: weights(cells_per_sample),
            cells_per_sample,
            cell: None,
            start: vec![(Lanes::ZERO, Lanes::ZERO); columns],
            end: vec![(Lanes::ZERO, Lanes::ZERO); columns],
            cubic: vec![[[Lanes::ZERO; 4]; 3]; eddies],
        }
    }

    /// The same wind for steps of `h` [s]. Where a step is longer than a cell there are fewer cubics: the error of the
    /// interpolation is `(π/8)⁴/384 · u/3 = 2e-5 u`.                            theory.md (19)
    pub fn for_steps_of(mut self, h: f64) -> Self {
        if matches!(self.signal, Signal::Synthesised(_)) && h * CELLS as f64 > self.spacing {
            (self.weights, self.cells_per_sample) = (weights(LONG_CELLS), LONG_CELLS);
        }
        self
    }

    /// Number of eddies.
    pub(crate) const fn eddies(&self) -> usize {
        self.eddies
    }

    /// Memory of the samples that a flight of eight fibres keeps [bytes].
    pub fn memory(air: &Air, eddies: usize, horizon: f64) -> f64 {
        if air.records.is_empty() { Windows::memory(air, eddies, horizon) } else { Stretches::memory(eddies) }
    }

    /// Computing time to make the samples of an eddy until a time [s], in steps of elements of the explicit
    /// schemes; zero for measured air.
    pub fn cost(air: &Air, time: f64) -> f64 {
        if air.records.is_empty() { Windows::cost(air, time) } else { 0.0 }
    }

    /// Makes the samples around time 0.
    pub(crate) fn prepare(&mut self) {
        if let Signal::Synthesised(windows) = &mut self.signal {
            windows.samples(0);
        }
    }

    /// Velocity of the air in each eddy [m/s] at time `t` [s] of the run, mean flow included. Times before 0
    /// count as 0.
    ///
    /// Fastest when times come in order.
    pub fn at(&mut self, t: f64) -> Vec<Vec3<Lanes>> {
        self.isa.run(At { t: t.max(0.0), wind: self })
    }

    /// [`Wind::at`] for the kernel, to be asked eddy by eddy.
    #[inline(always)]
    pub(super) fn blow<S: Register>(&mut self, t: f64) -> EddyVelocities<'_, S> {
        let cells = t / self.spacing * self.cells_per_sample as f64;
        let cell = cells as u64;
        if self.cell != Some(cell) {
            S::ISA.run(Enter { wind: self, cell });
        }
        EddyVelocities { cubic: &self.cubic, s: Wide::splat(cells - cell as f64) }
    }

    /// The wind at time `t` [s] of the run straight from the samples, for times of which hardly two lie in a
    /// cell: there are cubics of the weights, and none of each eddy. `None` if the wind is measured.
    #[inline(always)]
    pub(crate) fn among_samples<S: Register>(&mut self, t: f64) -> Option<InstantWind<'_, S>> {
        let Signal::Synthesised(windows) = &mut self.signal else { return None };
        let cells = t / self.spacing * self.cells_per_sample as f64;
        let cell = cells as u64;
        let s = Wide::splat(cells - cell as f64);
        let start = (cell % self.cells_per_sample) as usize;
        let mut weights = [Wide::zero(); SPREAD];
        for (weight, (a, b)) in
            weights.iter_mut().zip(self.weights[start].iter().zip(&self.weights[start + 1]))
        {
            let start = (Wide::splat(a.0), Wide::splat(a.1));
            *weight = along(cubic(start, (Wide::splat(b.0), Wide::splat(b.1))), s);
        }
        Some(InstantWind {
            samples: windows.samples(cell / self.cells_per_sample),
            mean: &self.mean,
            weights,
        })
    }

    /// Makes the cubics of a cell.
    #[inline(always)]
    fn enter<S: Register>(&mut self, cell: u64) {
        if cell == 0 || self.cell != Some(cell - 1) {
            self.move_end::<S>(cell);
        }
        std::mem::swap(&mut self.start, &mut self.end);
        self.move_end::<S>(cell + 1);
        for (column, (into, (a, b))) in
            self.cubic.as_flattened_mut().iter_mut().zip(self.start.iter().zip(&self.end)).enumerate()
        {
            // No closures here, because the compiler does not always inline them.
            let start = (Wide::<S>::load(&a.0), Wide::load(&a.1));
            let [c0, c1, c2, c3] = cubic(start, (Wide::load(&b.0), Wide::load(&b.1)));
            let mean = if column % 3 == 0 { Wide::load(&self.mean[column / 3]) } else { Wide::zero() };
            *into = [(c0 + mean).store(), c1.store(), c2.store(), c3.store()];
        }
        self.cell = Some(cell);
    }

    /// Puts the value and slope at a cell's start into `end`.
    #[inline(always)]
    fn move_end<S: Register>(&mut self, cell: u64) {
        let windows = match &mut self.signal {
            Signal::Synthesised(windows) => windows,
            Signal::Measured(stretches) => {
                stretches.values_and_slopes::<S>(cell, &mut self.end);
                return;
            }
        };
        let columns = self.end.len();
        let weights = &self.weights[(cell % self.cells_per_sample) as usize];
        let samples = windows.samples(cell / self.cells_per_sample);
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

/// [`Wind::at`].
struct At<'a> {
    wind: &'a mut Wind,
    t: f64,
}

impl Task for At<'_> {
    type Output = Vec<Vec3<Lanes>>;

    #[inline(always)]
    fn call<S: Register>(self) -> Self::Output {
        let mut velocities = vec![Vec3::ZERO; self.wind.eddies];
        let now = self.wind.blow::<S>(self.t);
        for (eddy, velocity) in (0..).zip(&mut velocities) {
            *velocity = now.velocity(eddy).store();
        }
        velocities
    }
}

/// [`Wind::enter`].
struct Enter<'a> {
    wind: &'a mut Wind,
    cell: u64,
}

impl Task for Enter<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        self.wind.enter::<S>(self.cell);
    }
}

/// Coefficients of the cubic from 0 to 1 through value and slope at both ends.
#[inline(always)]
fn cubic<S: Register>(start: (Wide<S>, Wide<S>), end: (Wide<S>, Wide<S>)) -> [Wide<S>; 4] {
    let (two, three) = (Wide::splat(2.0), Wide::splat(3.0));
    let rise = end.0 - start.0;
    let bend = three.mul_add(rise, -two.mul_add(start.1, end.1));
    [start.0, start.1, bend, two.neg_mul_add(rise, start.1 + end.1)]
}

/// The coefficients of a cubic.
#[inline(always)]
fn loaded<S: Register>([c0, c1, c2, c3]: &[Lanes; 4]) -> [Wide<S>; 4] {
    [Wide::load(c0), Wide::load(c1), Wide::load(c2), Wide::load(c3)]
}

/// The cubic with these coefficients.
#[inline(always)]
fn along<S: Register>([c0, c1, c2, c3]: [Wide<S>; 4], s: Wide<S>) -> Wide<S> {
    c3.mul_add(s, c2).mul_add(s, c1).mul_add(s, c0)
}

/// Weights of the `SPREAD` samples for value and slope (per cell) at both ends of each cell in a sample spacing.
fn weights(cells: u64) -> Vec<[(f64, f64); SPREAD]> {
    let taper = Taper::new();
    let of_cell = |cell: u64| {
        std::array::from_fn(|tap| {
            let fraction = cell as f64 / cells as f64;
            let x = fraction - (tap as f64 - (SPREAD as f64 / 2.0 - 1.0));
            let (value, slope) = taper.value_and_slope(x);
            (value, slope / cells as f64)
        })
    };
    (0..=cells).map(of_cell).collect()
}

/// Mean velocity along x of each eddy [m/s].
fn means(sampling: &Sampling, streams: &PerLane<Stream>) -> Vec<Lanes> {
    (0..sampling.eddies).map(|eddy| streams.lanes(|stream| stream.eddies[eddy].mean)).collect()
}

/// The wind at one instant, from the samples around it.
#[derive(Clone, Copy)]
pub(crate) struct InstantWind<'a, S: Register> {
    /// `[sample][eddy][component]`
    samples: &'a [Lanes],
    mean: &'a [Lanes],
    weights: [Wide<S>; SPREAD],
}

impl<S: Register> InstantWind<'_, S> {
    /// Velocity of the air in an eddy [m/s].
    #[inline(always)]
    pub(crate) fn velocity(&self, eddy: u32) -> Vec3<Wide<S>> {
        let (eddy, columns) = (eddy as usize, 3 * self.mean.len());
        let mut velocity = Vec3::new(Wide::load(&self.mean[eddy]), Wide::zero(), Wide::zero());
        for (tap, &weight) in self.weights.iter().enumerate() {
            let [x, y, z] = &self.samples[tap * columns + 3 * eddy..][..3] else { break };
            velocity.x = Wide::load(x).mul_add(weight, velocity.x);
            velocity.y = Wide::load(y).mul_add(weight, velocity.y);
            velocity.z = Wide::load(z).mul_add(weight, velocity.z);
        }
        velocity
    }
}

/// The wind at one instant, from the cubics of its cell.
#[derive(Clone, Copy)]
pub(crate) struct EddyVelocities<'a, S: Register> {
    cubic: &'a [[[Lanes; 4]; 3]],
    s: Wide<S>,
}

impl<S: Register> EddyVelocities<'_, S> {
    /// Velocity of the air in an eddy [m/s].
    #[inline(always)]
    pub(crate) fn velocity(&self, eddy: u32) -> Vec3<Wide<S>> {
        // No closures here, because the compiler does not inline them.
        let [x, y, z] = &self.cubic[eddy as usize];
        Vec3::new(along(loaded(x), self.s), along(loaded(y), self.s), along(loaded(z), self.s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Air, StreamKey};
    use spunlaid_ground::{Plain, WIDTH};

    #[test]
    fn analytic_the_wind_among_its_samples_is_that_of_the_cubics() {
        let air = Air { harmonics: 32, ..Air::uniform(20.0, 0.1, 16e-3, 940.0) };
        let streams: Vec<_> =
            (0..WIDTH as u64).map(|replicate| (air.clone(), StreamKey { seed: 1, replicate })).collect();
        let mut wind = Wind::uniform(Isa::detect(), &streams, 2, 0.0).unwrap();
        let mut largest = 0.0_f64;
        for i in 0..2000 {
            // Every part of a cell, over several windows.
            let t = f64::from(i) * 37.7e-6;
            let cubics = wind.at(t);
            let samples = wind.among_samples::<Plain>(t).unwrap();
            for (eddy, of_cubics) in (0..).zip(&cubics) {
                let of_samples = samples.velocity(eddy).store();
                for lane in 0..WIDTH {
                    largest = largest.max((of_samples.lane(lane) - of_cubics.lane(lane)).norm());
                }
            }
        }
        // Each of the two cubics is exact to 1e-7 of the rms of 2 m/s, in three components.
        assert!(largest < 2.0 * 1e-7 * 2.0 * 3.0_f64.sqrt(), "{largest:e}");
    }
}
