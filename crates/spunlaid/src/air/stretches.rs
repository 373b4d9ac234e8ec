//! Which stretch of a record which eddy flies in.

use super::synthesis::Stream;
use super::{EddyTurbulence, Measured};
use crate::lanes::{Lanes, Register, WIDTH, Wide};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;
use std::sync::Arc;

/// A component of an eddy's velocity fluctuation as a stretch of a record, for eight fibres.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    values: Arc<[f64]>,
    /// The sample at time zero of each fibre.
    start: [usize; WIDTH],
    /// Rms of each fibre's fluctuation [m/s].
    rms: Lanes,
}

impl Stretch {
    /// The fluctuation so many samples after time zero, and its rise over a sample interval there: the cubics
    /// between samples are Catmull and Rom's.
    #[inline(always)]
    pub(super) fn value_and_slope<S: Register>(&self, sample: usize) -> (Wide<S>, Wide<S>) {
        let at = |lane: usize, ahead: usize| {
            let i = (self.start[lane] + sample + ahead).saturating_sub(1);
            self.values[i.min(self.values.len() - 1)]
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
pub(super) fn stretches(lanes: &[Stream<'_>], duration: f64) -> Vec<Stretch> {
    let pick = |i: usize| &lanes[if i < lanes.len() { i } else { 0 }];
    let starts: Vec<Vec<[usize; 3]>> = lanes.iter().map(|stream| starts(stream, duration)).collect();
    let first = pick(0);
    let mut stretches = Vec::new();
    for (eddy, _) in first.turbulence_of_eddies.iter().enumerate() {
        let record = record_of(first, eddy);
        let (_, directions) = record.directions();
        for (direction, (_, component)) in directions.into_iter().enumerate() {
            stretches.push(Stretch {
                values: Arc::clone(&record.components[component]),
                start: std::array::from_fn(|i| starts[if i < lanes.len() { i } else { 0 }][eddy][direction]),
                rms: Lanes::from_fn(|i| pick(i).turbulence_of_eddies[eddy].rms),
            });
        }
    }
    stretches
}

fn record_of<'a>(stream: &Stream<'a>, eddy: usize) -> &'a Measured {
    let records = &stream.air.records;
    &records[if records.len() == 1 { 0 } else { eddy.min(records.len() - 1) }]
}

/// Where the stretches of a fibre's eddies start, in samples of their record, by direction.
fn starts(stream: &Stream<'_>, duration: f64) -> Vec<[usize; 3]> {
    let convected =
        stream.turbulence_of_eddies.iter().any(|eddy_turbulence| eddy_turbulence.carried.is_some());
    let mut random = stream.key.stream(u64::MAX, 0);
    let mut drawn = Vec::new();
    let mut earlier = 0.0;
    let delay: f64 =
        stream.turbulence_of_eddies.iter().filter_map(|eddy_turbulence| eddy_turbulence.carried).sum();
    let shared = stream.air.records.len() == 1 && !convected;
    (stream.turbulence_of_eddies.iter().enumerate())
        .map(|(eddy, eddy_turbulence): (usize, &EddyTurbulence)| {
            let record = record_of(stream, eddy);
            let (each, directions) = record.directions();
            if eddy == 0 || !shared && !convected {
                let room = (record.samples() as f64 - record.stretch(duration + delay)).max(0.0);
                let wanted = if shared { each * stream.turbulence_of_eddies.len() } else { each };
                drawn = scattered(room as usize + 1, wanted, &mut random);
                drawn.iter_mut().for_each(|start| *start += 1 + (delay / record.interval) as usize);
            }
            earlier += eddy_turbulence.carried.unwrap_or(0.0);
            let back = (earlier / record.interval).round() as usize;
            let first = if shared { each * eddy } else { 0 };
            directions.map(|(stretch, _)| drawn[first + stretch].saturating_sub(back))
        })
        .collect()
}

/// So many of the numbers below `room`, evenly spaced around the ring of them from a random one on, in random
/// order.
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
