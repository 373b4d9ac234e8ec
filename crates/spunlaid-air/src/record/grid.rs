//! Times that are rounded to a grid, such as whole milliseconds, which is not much finer than the step between samples.
//!
//! The times of an even clock, rounded to a grid of size `g`, lie within a strip of height `g` above a
//! straight line over the number of the sample. Its slope is the interval. A missing sample lifts all later
//! times by an interval, out of the strip.

use spunlaid_ground::{Dimension, Fault};

/// Rows whose time is known, with the time [s].
pub(super) type Known = Vec<(usize, f64)>;

/// Largest deviation of a time step from the usual one, as a share of it.
pub(super) const JITTER: f64 = 0.01;
/// Fewest rows that give a rounded clock.
const FEWEST: usize = 32;
/// Grids below this share of the step do not matter.
const FINE: f64 = 0.02;
/// A grid of so many units of the last written digit is none of rounding.
const DIGITS: f64 = 9.0;
/// Share of steps of one grid from which the grid is taken for the interval, and other steps for gaps.
const PLAIN: f64 = 0.75;

/// The grid to which times are rounded.
#[derive(Clone, Copy, Debug)]
pub(super) struct TimeGrid {
    /// Distance between its points [s].
    pub(super) size: f64,
    /// Whether times are written with more digits than it needs, so that writing did not round them to it.
    is_exact: bool,
}

impl TimeGrid {
    /// The coarsest grid that all times lie on, if it is not fine; by Euclid's algorithm with a tolerance.
    ///
    /// * `unit` – unit of the last digit as the times are written [s]
    pub(super) fn of(known: impl Iterator<Item = (usize, f64)>, unit: f64, usual: f64) -> Option<Self> {
        let mut size: f64 = 0.0;
        let mut before: Option<f64> = None;
        for (_, time) in known {
            let Some(last) = before.replace(time) else { continue };
            let step = time - last;
            let noise = 4.0 * f64::EPSILON * time.abs().max(last.abs()) + 1e-6 * unit;
            let (mut large, mut small) = if size == 0.0 { (step, 0.0) } else { (size, step % size) };
            while small > noise * (1.0 + step / large) && large - small > noise * (1.0 + step / large) {
                (large, small) = (small, large % small);
            }
            size = large;
            if size < FINE * usual {
                return None;
            }
        }
        (size > 0.0).then_some(Self { size, is_exact: size > DIGITS * unit })
    }

    /// Rows before which samples are missing, and how many; none if the times do not give.
    pub(super) fn place(self, known: &[(usize, f64)]) -> Option<Vec<(usize, usize)>> {
        if self.is_interval(known) {
            return Some(self.skips(known).map(|(row, grids, rows)| (row, grids - rows)).collect());
        }
        if known.len() < FEWEST {
            return None;
        }
        let interval = self.interval_of_longest_stretch(known)?;
        self.follow(known, interval)
    }

    /// Steps over more points of the grid than rows: the row, and both numbers.
    fn skips(self, known: &[(usize, f64)]) -> impl Iterator<Item = (usize, usize, usize)> {
        known.windows(2).filter_map(move |pair| {
            let grids = ((pair[1].1 - pair[0].1) / self.size).round() as usize;
            let rows = pair[1].0 - pair[0].0;
            (grids > rows).then_some((pair[1].0, grids, rows))
        })
    }

    /// Whether the grid is the interval itself: nearly all steps are one grid, and writing did not round the
    /// times to it, or the others do not come as regularly as rounding would have it.
    fn is_interval(self, known: &[(usize, f64)]) -> bool {
        let rows: Vec<f64> = self.skips(known).map(|(row, ..)| row as f64).collect();
        if (rows.len() as f64) > ((1.0 - PLAIN) * (known.len() - 1) as f64).max(2.0) {
            return false;
        }
        if self.is_exact {
            return true;
        }
        let runs: Vec<f64> = rows.windows(2).map(|rows| rows[1] - rows[0]).collect();
        if runs.len() < 2 {
            return true;
        }
        let mean = runs.iter().sum::<f64>() / runs.len() as f64;
        let square = runs.iter().map(|run| (run - mean) * (run - mean)).sum::<f64>() / runs.len() as f64;
        square.sqrt() > 0.4 * mean
    }

    /// The interval of the longest stretch of rows in which no sample is missing; none if all are short.
    fn interval_of_longest_stretch(self, known: &[(usize, f64)]) -> Option<f64> {
        let mut longest = (0, f64::NAN);
        let mut from = 0;
        while known.len() - from > longest.0.max(FEWEST) {
            let rest = &known[from..];
            let fits = |count: usize| {
                let (interval, height) = strip(&rest[..count], self.size);
                height <= self.tallest(interval)
            };
            // The longest that fits is between these.
            let (mut short, mut long) = (2, 4.min(rest.len()));
            while long > short && fits(long) {
                (short, long) = (long, (2 * long).min(rest.len()));
            }
            while long - short > 1 {
                let middle = short.midpoint(long);
                if fits(middle) { short = middle } else { long = middle }
            }
            if short > longest.0 {
                longest = (short, strip(&rest[..short], self.size).0);
            }
            from += short;
        }
        (longest.0 >= FEWEST).then_some(longest.1)
    }

    /// Height of a strip that an even clock may need [s].
    fn tallest(self, interval: f64) -> f64 {
        self.size + (2.0 * JITTER * interval).min(0.5 * (interval - self.size).max(0.0)) + 1e-6 * self.size
    }

    /// Follows the strip through all rows.
    fn follow(self, known: &[(usize, f64)], interval: f64) -> Option<Vec<(usize, usize)>> {
        let margin = 0.5 * (interval - self.size);
        if margin <= 0.0 {
            return None;
        }
        let (first_row, mut low) = *known.first()?;
        let (mut lost, mut all) = (Vec::new(), 0usize);
        let mut placed = Vec::with_capacity(known.len());
        for (row, time) in known {
            let above = |all: usize| time - (row - first_row + all) as f64 * interval;
            let over = above(all) - (low + self.size);
            if over > margin {
                let missing = ((over - margin) / interval).ceil();
                all += missing as usize;
                lost.push((*row, missing as usize));
            }
            let height = above(all);
            // The strip goes along with a clock that drifts.
            low = low.min(height).max(height - self.size);
            placed.push((row + all, *time));
        }
        let (interval, height) = strip(&placed, self.size);
        (height <= self.tallest(interval) + margin).then_some(lost)
    }

    /// The doubt about rounded times of which every so many-th steps over a point of the grid: so do those of
    /// an even clock, and those of a faster one that lacks rows as regularly.
    ///
    /// * `interval` – as it was found [s]
    pub(super) fn regular(self, known: &[(usize, f64)], interval: f64) -> Option<Fault> {
        let mut rows = Vec::new();
        for (row, grids, spanned) in self.skips(known) {
            // A gap, or a clock too slow to be taken for a faster one.
            if grids - spanned > 1 {
                return None;
            }
            rows.push(row);
        }
        let every = rows.get(1)?.checked_sub(*rows.first()?)?;
        let is_regular =
            rows.windows(2).all(|pair| (pair[1] - pair[0]).abs_diff(every) <= 1) && rows.len() > 3;
        if interval < 1.01 * self.size || every < 2 || !is_regular {
            return None;
        }
        let rate = |interval: f64| Dimension::Frequency.pretty_to(1.0 / interval, 4);
        let (points, grid) = (every + 1, Dimension::Time.pretty_to(self.size, 3));
        Some(Fault::new(
            format!(
                "the times are rounded to {grid}, and about one in {points} points of this grid has no row: this is \
                a uniform clock of {}, as is assumed, or one of {} that lacks rows as regularly",
                rate(interval),
                rate(self.size)
            ),
            "if rows are lacking, write them without a velocity; if none is, give the sampling rate",
        ))
    }

    /// The fault of rounded times that fit no even clock.
    pub(super) fn doubt(self) -> Fault {
        Fault::new(
            format!(
                "the times are rounded to {}, which is too coarse to show which samples are missing",
                Dimension::Time.pretty_to(self.size, 3)
            ),
            "write the times with more digits, or give the sampling rate if no sample is missing",
        )
        .option("--rate")
    }
}

/// The slope and the height of the lowest strip around points, whose slope is about that between the first
/// and the last.
///
/// * `grid` – height that is to be expected
fn strip(points: &[(usize, f64)], grid: f64) -> (f64, f64) {
    let (Some((first_row, first)), Some((row, time))) = (points.first(), points.last()) else {
        return (f64::NAN, f64::INFINITY);
    };
    let samples = (row - first_row) as f64;
    let middle = (time - first) / samples;
    let height = |slope: f64| {
        let above = points.iter().map(|(row, time)| time - first - (row - first_row) as f64 * slope);
        let (low, high) = above.fold((0.0f64, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
        high - low
    };
    // The height is convex in the slope.
    let mut from = middle - 2.0 * grid / samples;
    let mut to = middle + 2.0 * grid / samples;
    for _ in 0..24 {
        let third = (to - from) / 3.0;
        if height(from + third) < height(to - third) { to -= third } else { from += third }
    }
    let slope = 0.5 * (from + to);
    (slope, height(slope))
}
