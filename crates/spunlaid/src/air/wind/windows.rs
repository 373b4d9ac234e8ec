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
//! A block of samples ends where a window begins. What fades out behind its end is kept for the block that follows, so that
//! each window is made only once.

use super::super::Air;
use super::sampling::Sampling;
use super::synthesis::{Stream, Synthesis};
use super::taper::SPREAD;
use crate::company::PerLane;
use crate::lanes::{Isa, Lanes};
use std::ops::Range;
use std::sync::Arc;

/// Samples before time zero that the interpolation needs there.
const BEFORE: i64 = SPREAD as i64 / 2 - 1;

/// The fluctuation of eight fibres as samples, made in blocks.
#[derive(Clone, Debug)]
pub(super) struct Windows {
    isa: Isa,
    sampling: Sampling,
    /// Clones share it and the samples, so that a step on trial copies neither.
    streams: Arc<PerLane<Stream>>,
    grid: Grid,
    /// `[sample][eddy][component]`
    block: Arc<Vec<Lanes>>,
    /// The samples of the block that are complete; sample `m` is at the time `m` spacings.
    samples: Range<i64>,
    /// The window that begins where these end. What the one before it adds to later samples follows them in the block.
    next: Option<i64>,
    /// The last sample that is needed until the horizon.
    last: i64,
}

/// How the samples are divided among the windows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// Samples in a repeat time, four or more for each harmonic.
    pub(super) period: usize,
    /// Time between samples [s].
    spacing: f64,
    /// Whether there is only one window, which repeats.
    repeats: bool,
}

impl Grid {
    fn of(sampling: &Sampling, repeats: bool) -> Self {
        let period = 4 * sampling.harmonics.next_power_of_two();
        Self { period, spacing: sampling.repeat_time() / period as f64, repeats }
    }

    /// Samples in which one window fades out and the next one in.
    fn fade(&self) -> usize {
        self.period / 4
    }

    /// Samples from the start of one window to that of the next.
    fn hop(&self) -> i64 {
        if self.repeats { i64::MAX } else { (self.period - self.fade()) as i64 }
    }

    /// The block of samples that begins at `first`. It ends at the next start of a window after its eighth sample,
    /// or at `last`.
    fn block(&self, first: i64, last: i64) -> Range<i64> {
        let hop = self.hop();
        let eighth = first + SPREAD as i64;
        let end = (eighth.max(0) / hop).saturating_add(1).saturating_mul(hop);
        first..end.min(last.max(eighth))
    }

    /// The windows that the samples lie in.
    fn windows(&self, samples: &Range<i64>) -> Range<i64> {
        let hop = self.hop();
        (samples.start.max(0) / hop - 1).max(0)..(samples.end - 1).max(0) / hop + 1
    }

    /// The sample of a window that a sample uses, and the factor; `None` if the window does not contribute.
    ///
    /// The sample of the window lies within its repeat time; a sample before time zero or, where the window
    /// repeats, later is that of the opposite sign half a full period away.
    fn share(&self, window: i64, sample: i64) -> Option<(usize, Share)> {
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

impl Windows {
    pub(super) fn new(isa: Isa, sampling: Sampling, streams: PerLane<Stream>, horizon: f64) -> Self {
        Self::on(isa, Grid::of(&sampling, false), sampling, streams, horizon)
    }

    /// Only one window, which repeats after its repeat time with the opposite sign.
    pub(super) fn repeating(isa: Isa, sampling: Sampling, streams: PerLane<Stream>, horizon: f64) -> Self {
        Self::on(isa, Grid::of(&sampling, true), sampling, streams, horizon)
    }

    fn on(isa: Isa, grid: Grid, sampling: Sampling, streams: PerLane<Stream>, horizon: f64) -> Self {
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

    /// Memory of the samples [bytes].
    pub(super) fn memory(air: &Air, eddies: usize, horizon: f64) -> f64 {
        let grid = Grid::of(&Sampling::of(air, eddies), false);
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
        let grid = Grid { period: 64, spacing: 1.0, repeats: false };
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
        let grid = Grid { period: 64, spacing: 1.0, repeats: false };
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
