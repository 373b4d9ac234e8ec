//! Turbulence made window by window, so that it never repeats and its memory does not grow.
//!
//! A window is one sum of cosines with random phases of its own. It is used for one repeat time at most:
//!
//! ```text
//! window 0   ──────────────╲
//! window 1                ╱───────╲
//! window 2                         ╱───────╲         a quarter of the repeat time each: one fades out as cos θ
//!            0    ¼   ½   ¾   1                        while the next fades in as sin θ
//! ```
//!
//! Both are independent, so `cos² θ + sin² θ = 1` keeps the variance at every instant.   theory.md (50)
//!
//! A block of samples ends where a window begins. What fades out behind its end is kept for the block that
//! follows, so that each window is made only once.

use super::super::Air;
use super::sampling::{Sampling, Stream};
use super::synthesis::{SPREAD, SampleGrid, Share, Synthesis};
use spunlaid_ground::{Isa, Lanes, PerLane};
use std::ops::Range;
use std::sync::Arc;

/// Samples before time zero that the interpolation needs there.
const BEFORE: i64 = SPREAD as i64 / 2 - 1;

/// Computing time for each harmonic and each of the `log2` of the samples in a window, in steps of elements
/// of the explicit schemes. 0.25 to 0.31 were measured up to this many harmonics, whose transform fits into a
/// cache, and 0.5 to 1 beyond.
const IN_CACHE: f64 = 0.3;
const BEYOND_CACHE: f64 = 0.6;
const FITTING: usize = 1 << 15;

/// The fluctuation of eight fibres as samples, made in blocks.
#[derive(Clone, Debug)]
pub(super) struct Windows {
    isa: Isa,
    sampling: Sampling,
    /// Clones share it and the samples, so that a step on trial copies neither.
    streams: Arc<PerLane<Stream>>,
    grid: SampleGrid,
    /// `[sample][eddy][component]`
    block: Arc<Vec<Lanes>>,
    /// The samples of the block that are complete; sample `m` is at the time `m` spacings.
    samples: Range<i64>,
    /// The window that begins where these end. What the one before it adds to later samples follows them in the block.
    next: Option<i64>,
    /// The last sample that is needed until the horizon.
    last: i64,
}

impl Windows {
    pub(super) fn new(isa: Isa, sampling: Sampling, streams: PerLane<Stream>, horizon: f64) -> Self {
        Self::on(isa, SampleGrid::new(&sampling, false), sampling, streams, horizon)
    }

    /// Only one window, which repeats after its repeat time with the opposite sign.
    pub(super) fn repeating(isa: Isa, sampling: Sampling, streams: PerLane<Stream>, horizon: f64) -> Self {
        Self::on(isa, SampleGrid::new(&sampling, true), sampling, streams, horizon)
    }

    fn on(isa: Isa, grid: SampleGrid, sampling: Sampling, streams: PerLane<Stream>, horizon: f64) -> Self {
        let last = sample_count(horizon, grid.spacing) - BEFORE;
        let (block, streams) = (Arc::default(), Arc::new(streams));
        Self { isa, sampling, streams, grid, block, samples: 0..0, next: None, last }
    }

    pub(super) fn spacing(&self) -> f64 {
        self.grid.spacing
    }

    /// The `SPREAD` samples around the time `interval` spacings and the one after it, `[sample][eddy][component]`.
    #[inline(always)]
    pub(super) fn samples(&mut self, interval: u64) -> &[Lanes] {
        let columns = 3 * self.sampling.eddies;
        let first = interval as i64 - BEFORE;
        if first < self.samples.start || first + SPREAD as i64 > self.samples.end {
            self.go_to(first);
        }
        &self.block[(first - self.samples.start) as usize * columns..][..SPREAD * columns]
    }

    #[inline(never)]
    fn go_to(&mut self, first: i64) {
        let last = match self.last {
            last if first < last => last,
            _ if self.grid.repeats => first + self.grid.period as i64,
            _ => i64::MAX,
        };
        self.make(self.grid.block(first, last));
    }

    fn make(&mut self, samples: Range<i64>) {
        let grid = self.grid;
        let columns = 3 * self.sampling.eddies;
        let mut windows = grid.windows(&samples);
        let mut block = match self.next {
            Some(next) if self.samples.contains(&samples.start) => {
                windows.start = next;
                let passed = (samples.start - self.samples.start) as usize * columns;
                match Arc::try_unwrap(std::mem::take(&mut self.block)) {
                    Ok(mut block) => {
                        block.drain(..passed);
                        block
                    }
                    Err(shared) => shared[passed..].to_vec(),
                }
            }
            // Free the old block first, so that the two are never in memory together.
            _ => {
                self.block = Arc::default();
                Vec::new()
            }
        };
        self.next = (windows.end.saturating_mul(grid.hop()) == samples.end).then_some(windows.end);
        let end = if self.next.is_some() { samples.end + grid.fade() as i64 } else { samples.end };
        let rows = (end - samples.start) as usize;
        block.reserve_exact((rows * columns).saturating_sub(block.len()));
        block.resize(rows * columns, Lanes::ZERO);
        for window in windows {
            let heard = |row: usize| grid.share(window, samples.start + row as i64);
            let Some(first) = (0..rows).find(|&row| heard(row).is_some()) else { continue };
            let shares: Vec<(usize, Share)> = (first..rows).map_while(heard).collect();
            let into = &mut block[first * columns..];
            let (sampling, streams) = (&self.sampling, &*self.streams);
            self.isa.run(Synthesis { sampling, streams, window: window as u64, grid, shares, into });
        }
        (self.block, self.samples) = (Arc::new(block), samples);
    }

    /// Computing time to make the samples of an eddy until a time [s], in steps of elements of the explicit
    /// schemes: of the transforms of three components, for each window.
    pub(super) fn cost(air: &Air, time: f64) -> f64 {
        let grid = SampleGrid::new(&Sampling::new(air, 1), false);
        let windows = 1.0 + (time / (grid.hop() as f64 * grid.spacing)).floor();
        let each = if air.harmonics > FITTING { BEYOND_CACHE } else { IN_CACHE };
        3.0 * windows * air.harmonics as f64 * f64::from(grid.period.ilog2()) * each
    }

    /// Memory of the samples [bytes].
    pub(super) fn memory(air: &Air, eddies: usize, horizon: f64) -> f64 {
        let grid = SampleGrid::new(&Sampling::new(air, eddies), false);
        let wanted = (horizon / grid.spacing).ceil() + SPREAD as f64 + 1.0;
        let samples = if wanted > grid.hop() as f64 { (grid.period + SPREAD) as f64 } else { wanted };
        samples * eddies as f64 * 3.0 * size_of::<Lanes>() as f64
    }
}

/// Samples needed to interpolate anywhere in `[0, horizon]`.
fn sample_count(horizon: f64, spacing: f64) -> i64 {
    let intervals = (horizon / spacing).ceil();
    // Samples beyond this number are made later, when they are needed.
    let intervals = if intervals > 0.0 && intervals < 1e15 { intervals as i64 } else { 0 };
    intervals + SPREAD as i64 + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_the_windows_keep_the_variance_at_every_sample() {
        let grid = SampleGrid { period: 64, spacing: 1.0, repeats: false };
        for sample in -3..400 {
            let parts = grid.windows(&(sample..sample + 1));
            let sum: f64 = parts
                .filter_map(|window| grid.share(window, sample))
                .map(|(_, share)| match share {
                    Share::Whole | Share::Opposite => 1.0,
                    Share::Part(part) => part * part,
                })
                .sum();
            assert!((sum - 1.0).abs() < 1e-15, "sample {sample}: {sum}");
        }
    }

    #[test]
    fn blocks_follow_one_another_and_hold_what_is_asked_for() {
        let grid = SampleGrid { period: 64, spacing: 1.0, repeats: false };
        let mut first = -BEFORE;
        for _ in 0..10 {
            let block = grid.block(first, i64::MAX);
            assert!(
                block.end - block.start >= SPREAD as i64 && block.end - block.start <= 48 + 2 * SPREAD as i64
            );
            first = block.end - SPREAD as i64 + 1;
        }
    }
}
