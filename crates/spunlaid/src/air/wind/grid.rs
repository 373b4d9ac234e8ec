//! How samples are divided among the windows of random phases.

use super::sampling::Sampling;
use super::synthesis::SPREAD;
use std::ops::Range;

/// How the samples are divided among the windows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// Samples in a repeat time, four or more for each harmonic.
    pub(super) period: usize,
    /// Time between samples [s].
    pub(super) spacing: f64,
    /// Whether there is only one window, which repeats.
    pub(super) repeats: bool,
}

impl Grid {
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
