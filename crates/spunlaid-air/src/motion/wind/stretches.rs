//! Assigns stretches of a record to the eddies.

use super::super::{EddyTurbulence, Measured};
use super::sampling::{Sampling, Stream};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;
use spunlaid_ground::{Lanes, PerLane, Register, WIDTH, Wide};
use std::sync::Arc;

/// The fluctuation of eight fibres as stretches of records.
///
/// The stretches last until the horizon. A longer flight passes to other stretches, which are chosen in the same
/// way: they fade in over [`FADE`] integral times while the old ones fade out.  theory.md (50)
#[derive(Clone, Debug)]
pub(super) struct Stretches {
    sampling: Sampling,
    streams: Arc<PerLane<Stream>>,
    /// Time that a stretch lasts for [s].
    horizon: f64,
    /// Samples from one choice of stretches to the next.
    hop: u64,
    /// Samples in which one choice passes into the next.
    fade: u64,
    chosen: u64,
    /// `[eddy][component]`, the current stretches and the previous ones.
    now: Vec<RecordStretch>,
    before: Vec<RecordStretch>,
}

/// How many integral times it takes to pass from one stretch to the next.
const FADE: f64 = 5.0;

impl Stretches {
    /// * `sampling` – with at least one record
    pub(super) fn new(sampling: Sampling, streams: PerLane<Stream>, horizon: f64) -> Self {
        let record = &sampling.records[0];
        let samples = |time: f64| (time / record.interval).ceil().clamp(1.0, 1e15) as u64;
        // The last cubic within the horizon ends at the sample after it.
        let (hop, fade) = (samples(horizon) + 2, samples(FADE * record.integral_time));
        let now = stretches(&sampling, &streams, 0, horizon);
        let (before, streams) = (now.clone(), Arc::new(streams));
        Self { sampling, streams, horizon, hop, fade: fade.min(hop), chosen: 0, now, before }
    }

    /// Value and slope (per sample interval) of every component of every eddy at a sample.
    #[inline(always)]
    pub(super) fn values_and_slopes<S: Register>(&mut self, sample: u64, into: &mut [(Lanes, Lanes)]) {
        let choice = sample / self.hop;
        if choice != self.chosen {
            self.choose(choice);
        }
        let local = sample - choice * self.hop;
        if choice == 0 || local >= self.fade {
            for (into, stretch) in into.iter_mut().zip(&self.now) {
                let (value, slope) = stretch.value_and_slope::<S>(local as usize);
                *into = (value.store(), slope.store());
            }
            return;
        }
        let angle = std::f64::consts::FRAC_PI_2 * (local as f64 + 0.5) / self.fade as f64;
        let (new, old) = (Wide::splat(libm::sin(angle)), Wide::splat(libm::cos(angle)));
        for (into, (now, before)) in into.iter_mut().zip(self.now.iter().zip(&self.before)) {
            let a = now.value_and_slope::<S>(local as usize);
            let b = before.value_and_slope::<S>((local + self.hop) as usize);
            *into = (new.mul_add(a.0, old * b.0).store(), new.mul_add(a.1, old * b.1).store());
        }
    }

    #[inline(never)]
    fn choose(&mut self, choice: u64) {
        let stretched = |choice| stretches(&self.sampling, &self.streams, choice, self.horizon);
        (self.now, self.before) = (stretched(choice), stretched(choice.saturating_sub(1)));
        self.chosen = choice;
    }

    /// Memory of the stretches [bytes]; the records themselves are shared by all fibres.
    pub(super) fn memory(eddies: usize) -> f64 {
        2.0 * eddies as f64 * 3.0 * size_of::<RecordStretch>() as f64
    }
}

/// A component of an eddy's velocity fluctuation as a stretch of a record, for eight fibres.
#[derive(Clone, Debug)]
struct RecordStretch {
    values: Arc<[f64]>,
    /// The sample at time zero of each fibre.
    start: [usize; WIDTH],
    /// Rms of each fibre's fluctuation [m/s].
    rms: Lanes,
}

impl RecordStretch {
    /// The fluctuation a number of samples after its start, and its rise over a sample interval there, for
    /// Catmull-Rom cubics between samples. At the end of a record it is read backwards.
    #[inline(always)]
    fn value_and_slope<S: Register>(&self, sample: usize) -> (Wide<S>, Wide<S>) {
        let last = self.values.len() - 1;
        let at = |lane: usize, ahead: usize| {
            let i = (self.start[lane] + sample + ahead).saturating_sub(1);
            self.values[if i <= last { i } else { (2 * last).saturating_sub(i) }]
        };
        let here = Lanes::from_fn(|lane| at(lane, 1));
        let rise = Lanes::from_fn(|lane| 0.5 * (at(lane, 2) - at(lane, 0)));
        let rms = Wide::load(&self.rms);
        (Wide::load(&here) * rms, Wide::load(&rise) * rms)
    }
}

/// The stretches of eight fibres, `[eddy][component]`.
///
/// The starts of the stretches of one record lie evenly spaced and in random order; where they begin is
/// random too, drawn from the fibre's key.
fn stretches(
    sampling: &Sampling,
    streams: &PerLane<Stream>,
    choice: u64,
    horizon: f64,
) -> Vec<RecordStretch> {
    let starts = streams.map(|stream| starts(sampling, stream, choice, horizon));
    let mut stretches = Vec::new();
    for eddy in 0..sampling.eddies {
        let record = record_of(sampling, eddy);
        let (_, directions) = record.directions();
        for (direction, (_, component)) in directions.into_iter().enumerate() {
            stretches.push(RecordStretch {
                values: Arc::clone(&record.components[component]),
                start: starts.each(|phases| phases[eddy][direction]),
                rms: streams.lanes(|stream| stream.eddies[eddy].rms),
            });
        }
    }
    stretches
}

fn record_of(sampling: &Sampling, eddy: usize) -> &Measured {
    let records = &sampling.records;
    &records[if records.len() == 1 { 0 } else { eddy.min(records.len() - 1) }]
}

/// Where the stretches of a fibre's eddies start, in samples of their record, by direction.
fn starts(sampling: &Sampling, stream: &Stream, choice: u64, horizon: f64) -> Vec<[usize; 3]> {
    let convected = stream.eddies.iter().any(|turbulence| turbulence.carried.is_some());
    let mut random = stream.key.stream(choice, u64::MAX, 0);
    let mut drawn = Vec::new();
    let mut earlier = 0.0;
    let delay: f64 = stream.eddies.iter().filter_map(|turbulence| turbulence.carried).sum();
    let shared = sampling.records.len() == 1 && !convected;
    (stream.eddies.iter().enumerate())
        .map(|(eddy, turbulence): (usize, &EddyTurbulence)| {
            let record = record_of(sampling, eddy);
            let (each, directions) = record.directions();
            if eddy == 0 || !shared && !convected {
                let room = (record.samples() as f64 - record.stretch(horizon + delay)).max(0.0);
                let wanted = if shared { each * stream.eddies.len() } else { each };
                drawn = scattered(room as usize + 1, wanted, &mut random);
                drawn.iter_mut().for_each(|start| *start += 1 + (delay / record.interval) as usize);
            }
            earlier += turbulence.carried.unwrap_or(0.0);
            let back = (earlier / record.interval).round() as usize;
            let first = if shared { each * eddy } else { 0 };
            directions.map(|(stretch, _)| drawn[first + stretch].saturating_sub(back))
        })
        .collect()
}

/// `count` evenly spaced numbers below `room`, in random order. The first is random, and the numbers wrap around
/// at `room`.
fn scattered(room: usize, count: usize, random: &mut ChaCha8Rng) -> Vec<usize> {
    let mut below = |n: usize| (random.next_u64() % n as u64) as usize;
    let shift = below(room);
    let mut spots: Vec<usize> =
        (0..count).map(|i| (shift + (i as f64 * room as f64 / count as f64) as usize) % room).collect();
    for i in (1..count).rev() {
        spots.swap(i, below(i + 1));
    }
    spots
}
