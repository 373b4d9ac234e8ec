//! Amplitude and frequency of free ends while they fly, in batches of equal duration, and how sure they are.

use spunlaid::flight::EndNodeMotion;
use spunlaid::lanes::WIDTH;
use std::array::from_fn;

/// The number of batches at which neighbours become one.
const MOST: usize = 64;

/// Batches of each fibre that an estimate of the error needs at least.
const LEAST: usize = 4;

/// A value over eight fibres, and its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RunningEstimate {
    pub(super) value: f64,
    /// `None` before the first batch.
    pub(super) error: Option<f64>,
}

/// What the free ends did in one batch, each lane on its own.
#[derive(Clone, Copy, Debug)]
struct Batch {
    mean: [f64; WIDTH],
    variance: [f64; WIDTH],
    frequency: [f64; WIDTH],
}

impl Batch {
    fn joined(a: &Self, b: &Self) -> Self {
        let half = |a: &[f64; WIDTH], b: &[f64; WIDTH]| from_fn(|i| 0.5 * (a[i] + b[i]));
        let variance = half(&a.variance, &b.variance);
        Self {
            mean: half(&a.mean, &b.mean),
            variance: from_fn(|i| variance[i] + (0.5 * (a.mean[i] - b.mean[i])).powi(2)),
            frequency: half(&a.frequency, &b.frequency),
        }
    }
}

/// The motion of eight free ends along y or along z. Its memory does not grow: when there are many batches, each two of
/// them become one.
#[derive(Clone, Debug, Default)]
pub(super) struct Batches {
    batches: Vec<Batch>,
    /// The batch that is being put together from those of the first duration.
    filling: Option<OpenBatch>,
    /// How often neighbours have become one.
    merged: u32,
}

#[derive(Clone, Copy, Debug)]
struct OpenBatch {
    so_far: Batch,
    /// Batches of the first duration in it.
    holds: u32,
}

impl Batches {
    /// Adds one batch of the first duration.
    ///
    /// * `motions` – of the eight fibres within it
    /// * `of` – amplitude, frequency and mean of a motion in the direction wanted
    pub(super) fn add(
        &mut self,
        motions: &[EndNodeMotion; WIDTH],
        quantities: fn(&EndNodeMotion) -> [f64; 3],
    ) {
        let motions = motions.each_ref().map(quantities);
        let batch = Batch {
            mean: motions.map(|[_, _, mean]| mean),
            variance: motions.map(|[amplitude, ..]| amplitude * amplitude),
            frequency: motions.map(|[_, frequency, _]| frequency),
        };
        let count = 1 << self.merged;
        let filling = match self.filling.take() {
            None => OpenBatch { so_far: batch, holds: 1 },
            Some(filling) => filling.with(&batch),
        };
        if filling.holds < count {
            self.filling = Some(filling);
            return;
        }
        self.batches.push(filling.so_far);
        if self.batches.len() == MOST {
            self.batches = self.batches.chunks_exact(2).map(|two| Batch::joined(&two[0], &two[1])).collect();
            self.merged += 1;
        }
    }

    /// The standard deviation over all the time, as a run computes it, averaged over the fibres.
    pub(super) fn amplitude(&self) -> RunningEstimate {
        let count = self.batches.len() as f64;
        let mean: [f64; WIDTH] = from_fn(|i| self.batches.iter().map(|b| b.mean[i]).sum::<f64>() / count);
        let square = |b: &Batch, i: usize| b.variance[i] + (b.mean[i] - mean[i]).powi(2);
        let amplitude: [f64; WIDTH] =
            from_fn(|i| (self.batches.iter().map(|b| square(b, i)).sum::<f64>() / count).sqrt());
        // To first order, a batch moves the root of the mean square by half its own share of it.
        let shares: Vec<[f64; WIDTH]> = (self.batches.iter())
            .map(|b| {
                from_fn(|i| {
                    if amplitude[i] > 0.0 { 0.5 * (amplitude[i] + square(b, i) / amplitude[i]) } else { 0.0 }
                })
            })
            .collect();
        RunningEstimate { value: amplitude.iter().sum::<f64>() / WIDTH as f64, error: standard_error(shares) }
    }

    /// Half the number of sign changes per second, averaged over the fibres.
    pub(super) fn frequency(&self) -> RunningEstimate {
        let values: Vec<[f64; WIDTH]> = self.batches.iter().map(|b| b.frequency).collect();
        RunningEstimate { value: mean_of(&values), error: standard_error(values) }
    }
}

impl OpenBatch {
    fn with(self, batch: &Batch) -> Self {
        let share = 1.0 / f64::from(self.holds + 1);
        let a = &self.so_far;
        let mix = |a: f64, b: f64| a + share * (b - a);
        let variance = |i: usize| {
            mix(a.variance[i], batch.variance[i])
                + share * (1.0 - share) * (batch.mean[i] - a.mean[i]).powi(2)
        };
        let so_far = Batch {
            mean: from_fn(|i| mix(a.mean[i], batch.mean[i])),
            variance: from_fn(variance),
            frequency: from_fn(|i| mix(a.frequency[i], batch.frequency[i])),
        };
        Self { so_far, holds: self.holds + 1 }
    }
}

fn mean_of(values: &[[f64; WIDTH]]) -> f64 {
    values.iter().flatten().sum::<f64>() / (values.len() * WIDTH) as f64
}

/// The standard error of the mean of batches that may be correlated in time: neighbours are joined again and
/// again until only a few are left, and the largest error of all levels is taken. Batches that are long
/// enough are independent, and joining them changes nothing; shorter ones would promise too much. With fewer
/// batches, only the spread over the fibres is left.
///
/// Source: H. Flyvbjerg, H. G. Petersen, Journal of Chemical Physics 91 (1989) 461–466.
fn standard_error(mut values: Vec<[f64; WIDTH]>) -> Option<f64> {
    let mut largest = error_of_independent(&over_fibres(&values));
    while values.len() >= LEAST {
        let error = error_of_independent(&values.iter().flatten().copied().collect::<Vec<f64>>());
        largest = largest.into_iter().chain(error).reduce(f64::max);
        values = values.chunks_exact(2).map(|two| from_fn(|i| 0.5 * (two[0][i] + two[1][i]))).collect();
    }
    largest
}

/// The error that the spread over the fibres tells, where there is nothing better.
fn over_fibres(values: &[[f64; WIDTH]]) -> Vec<f64> {
    if values.is_empty() || values.len() >= LEAST {
        return Vec::new();
    }
    (0..WIDTH).map(|i| values.iter().map(|v| v[i]).sum::<f64>() / values.len() as f64).collect()
}

fn error_of_independent(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    (values.len() > 1).then(|| (squares / (n - 1.0) / n).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniform numbers from 0 to 1 (Knuth's linear congruence), and a normal one of twelve of them.
    struct Chance(u64);

    impl Chance {
        fn uniform(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        }

        fn normal(&mut self) -> f64 {
            (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
        }
    }

    const OF: fn(&EndNodeMotion) -> [f64; 3] = |m| [m.amplitude_y, m.frequency_y, m.mean.y];

    /// The motion of a piece of a signal.
    fn motion(piece: &[f64]) -> EndNodeMotion {
        let n = piece.len() as f64;
        let mean = piece.iter().sum::<f64>() / n;
        let variance = piece.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
        let mut motion =
            EndNodeMotion { amplitude_y: variance.sqrt(), frequency_y: piece[0], ..Default::default() };
        motion.mean.y = mean;
        motion
    }

    /// Batches of eight first-order autoregressive signals of unit variance, and the amplitude of each over
    /// all the time.
    fn batches(chance: &mut Chance, memory: f64, pieces: usize, length: usize) -> (Batches, [f64; WIDTH]) {
        let mut signals: [Vec<f64>; WIDTH] = Default::default();
        for signal in &mut signals {
            let mut x = chance.normal();
            for _ in 0..pieces * length {
                x = memory * x + (1.0 - memory * memory).sqrt() * chance.normal();
                signal.push(x);
            }
        }
        let mut batches = Batches::default();
        for piece in 0..pieces {
            batches.add(&from_fn(|i| motion(&signals[i][piece * length..][..length])), OF);
        }
        (batches, signals.each_ref().map(|signal| motion(signal).amplitude_y))
    }

    /// Number of batches of the first duration that count.
    fn counted(batches: &Batches) -> u64 {
        (batches.batches.len() as u64) << batches.merged
    }

    #[test]
    fn analytic_amplitude_is_that_of_all_the_time_however_it_is_cut() {
        // 8 · 64 pieces are joined four times; rounding only.
        for pieces in [1, 5, 63, 64, 512] {
            let (found, whole) = batches(&mut Chance(1), 0.9, pieces, 20);
            let expected = whole.iter().sum::<f64>() / WIDTH as f64;
            assert_eq!(counted(&found), pieces as u64);
            assert!(
                (found.amplitude().value / expected - 1.0).abs() < 1e-12,
                "{pieces}: {:?}, {expected}",
                found.amplitude()
            );
            assert!(found.batches.len() < MOST);
        }
    }

    #[test]
    fn an_unfinished_batch_does_not_count_yet() {
        let (found, _) = batches(&mut Chance(1), 0.9, 65, 20);
        assert_eq!((counted(&found), found.filling.map(|f| f.holds)), (64, Some(1)));
    }

    #[test]
    fn stat_errors_cover_the_truth_although_batches_are_correlated() {
        // The signals have unit variance and remember 20 samples; a batch of 10 samples is half of that. An
        // honest ± covers the truth in 68 % of all cases, ±2 in 95 %; of 400 cases the share is known to 2.3
        // %, and the largest error of several levels is rather too large than too small.
        let mut chance = Chance(5);
        let (mut once, mut twice, cases) = (0, 0, 400);
        for _ in 0..cases {
            let (found, _) = batches(&mut chance, (-0.05_f64).exp(), 256, 10);
            let amplitude = found.amplitude();
            let error = amplitude.error.unwrap();
            // Within 2560 samples the mean takes 40/2560 of the variance with it.
            let truth = (1.0 - 40.0 / 2560.0_f64).sqrt();
            once += usize::from((amplitude.value - truth).abs() < error);
            twice += usize::from((amplitude.value - truth).abs() < 2.0 * error);
        }
        let share = |count: usize| count as f64 / f64::from(cases);
        assert!((0.66..0.88).contains(&share(once)), "{}", share(once));
        assert!(share(twice) > 0.94, "{}", share(twice));
    }

    #[test]
    fn few_batches_are_judged_by_the_fibres_and_none_not_at_all() {
        let none = Batches::default();
        assert_eq!(none.frequency().error, None);
        assert!(none.amplitude().value.is_nan());
        let mut one = Batches::default();
        one.add(&from_fn(|i| motion(&[i as f64])), OF);
        // 0 … 7: variance 6, over eight.
        let frequency = one.frequency();
        assert_eq!(frequency.value, 3.5);
        assert!((frequency.error.unwrap() - (6.0_f64 / 8.0).sqrt()).abs() < 1e-15);
        assert_eq!(one.amplitude(), RunningEstimate { value: 0.0, error: Some(0.0) });
    }
}
