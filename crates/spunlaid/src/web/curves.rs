//! Curves that fibres have laid, to be laid again in a web.

use super::points::Points;
use crate::error::Fault;
use crate::lanes::Lanes;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;
use std::sync::Arc;

/// Laid curves of one line, seen from their straight traces.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    spacing: f64,
    belt_ratio: f64,
    /// Of each curve the points (ξ₁, ξ₂) [m].
    curves: Vec<Vec<[f64; 2]>>,
    /// How far they hang together, if they were flown in one air.
    one_air: Option<OneAir>,
}

/// How far curves that were flown in one air hang together.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct OneAir {
    /// Number of the group of neighbours of each curve. Groups are so wide that one hardly knows of another.
    pub(crate) groups: Vec<usize>,
    /// Length of fed fibre after which gusts are forgotten [m].
    pub(crate) memory: f64,
}

impl Curves {
    /// Fewest pieces of a curve.
    const FEWEST: usize = 16;

    /// Curves from their points on the belt.
    ///
    /// * `spacing` – fed length from point to point [m]
    /// * `belt_ratio` – speed of the belt over speed of the feed
    /// * `curves` – of each fibre the places (md, cd) of its points on the belt [m], in the order of feed
    ///
    /// # Errors
    /// If there is no curve, or one of less than 16 pieces or with a point that is not finite.
    pub fn new(spacing: f64, belt_ratio: f64, mut curves: Vec<Vec<[f64; 2]>>) -> Result<Self, Fault> {
        let usable = |curve: &Vec<[f64; 2]>| {
            curve.len() > Self::FEWEST && curve.iter().flatten().all(|x| x.is_finite())
        };
        let known = spacing > 0.0 && spacing.is_finite() && belt_ratio > 0.0 && belt_ratio.is_finite();
        if !known || curves.is_empty() || !curves.iter().all(usable) {
            return Err(no_curves());
        }
        for curve in &mut curves {
            for (i, point) in curve.iter_mut().enumerate() {
                point[0] += belt_ratio * spacing * i as f64;
            }
            let middle = [0, 1].map(|axis| curve.iter().map(|p| p[axis]).sum::<f64>() / curve.len() as f64);
            for point in curve.iter_mut() {
                // The place under the nozzle is where the curve is on average.
                *point = [point[0] - middle[0], point[1] - middle[1]];
            }
        }
        Ok(Self { spacing, belt_ratio, curves, one_air: None })
    }

    /// The same curves, known to hang together.
    pub(crate) fn in_one_air(self, one_air: OneAir) -> Self {
        Self { one_air: Some(one_air), ..self }
    }

    pub(super) const fn one_air(&self) -> Option<&OneAir> {
        self.one_air.as_ref()
    }

    /// Fed length from point to point [m].
    pub const fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Speed of the belt over speed of the feed.
    pub const fn belt_ratio(&self) -> f64 {
        self.belt_ratio
    }

    /// Each curve for itself.
    pub(super) fn single(&self) -> impl Iterator<Item = Self> + '_ {
        self.curves.iter().map(|curve| Self { curves: vec![curve.clone()], one_air: None, ..*self })
    }

    /// The points (ξ₁, ξ₂) of each curve [m].
    pub(super) fn curves(&self) -> &[Vec<[f64; 2]>] {
        &self.curves
    }

    /// Fed length of the shortest curve [m].
    pub(super) fn length(&self) -> f64 {
        self.pieces() as f64 * self.spacing
    }

    /// Pieces of the shortest curve.
    fn pieces(&self) -> usize {
        self.curves.iter().map(|curve| curve.len() - 1).min().unwrap_or(0)
    }

    /// Spread about the straight trace in cross direction [m].
    pub(super) fn sigma_cd(&self) -> f64 {
        let points = self.curves.iter().map(Vec::len).sum::<usize>() as f64;
        (self.curves.iter().flatten().map(|p| p[1] * p[1]).sum::<f64>() / points).sqrt()
    }

    /// Squared mean of `e^{ikξ₂}` over all points.
    pub(super) fn power_across(&self, wave: f64) -> f64 {
        let points = self.curves.iter().map(Vec::len).sum::<usize>() as f64;
        let parts = self.curves.iter().flatten().map(|p| (libm::cos(wave * p[1]), libm::sin(wave * p[1])));
        let (re, im) = parts.fold((0.0, 0.0), |sum, part| (sum.0 + part.0, sum.1 + part.1));
        (re * re + im * im) / (points * points)
    }

    /// Farthest distance from the straight trace in cross direction, and longest piece on a belt that stands,
    /// in either direction [m].
    pub(super) fn reach(&self) -> [f64; 2] {
        let far = self.curves.iter().flatten().map(|p| p[1].abs());
        let pieces = self.curves.iter().flat_map(|curve| curve.windows(2));
        let long = pieces.map(|p| (p[1][0] - p[0][0]).abs().max((p[1][1] - p[0][1]).abs()));
        [far.fold(0.0, f64::max), long.fold(0.0, f64::max)]
    }
}

/// Up to eight filaments made of stretches of curves, chosen at random. All stretches begin and end together.
pub(super) struct Stretches {
    curves: Arc<Curves>,
    random: ChaCha8Rng,
    filaments: usize,
    /// Curve and first point of the present stretch.
    from: Vec<(usize, usize)>,
    /// Points of the present stretch, and those that have been asked for.
    length: usize,
    taken: usize,
}

impl Stretches {
    pub(super) fn new(curves: Arc<Curves>, random: ChaCha8Rng, filaments: usize) -> Self {
        Self { curves, random, filaments, from: Vec::new(), length: 0, taken: 0 }
    }

    /// A whole number below `count`. The share by which some are likelier is below 2⁻³².
    fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.random.next_u64()) * count as u128) >> 64) as usize
    }

    fn choose(&mut self, pieces: usize) {
        let most = self.curves.pieces();
        let stretch = pieces.min(most);
        self.from.clear();
        for _ in 0..self.filaments {
            let curve = self.below(self.curves.curves.len());
            let spare = self.curves.curves[curve].len() - stretch;
            let start = self.below(spare);
            self.from.push((curve, start));
        }
        (self.length, self.taken) = (stretch + 1, 0);
    }
}

impl Points for Stretches {
    fn next(&mut self, pieces: usize, points: &mut [[Lanes; 2]]) -> usize {
        if self.taken == self.length {
            self.choose(pieces);
        }
        // A stretch goes on from the last point that was given.
        let first = self.taken.saturating_sub(1);
        let count = points.len().min(self.length - first).min(pieces + 1);
        for (i, point) in points[..count].iter_mut().enumerate() {
            *point = [0, 1].map(|axis| {
                Lanes::from_fn(|lane| {
                    let (curve, start) = self.from[if lane < self.filaments { lane } else { 0 }];
                    self.curves.curves[curve][start + first + i][axis]
                })
            });
        }
        self.taken = first + count;
        count
    }
}

/// The fault of curves that cannot be laid.
pub(super) fn no_curves() -> Fault {
    Fault::new(
        "there are no laid curves, or they are too short: each needs more than 16 points at a spacing above zero",
        "fly the case for longer (run.duration)",
    )
}
