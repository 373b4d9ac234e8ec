//! The curves of a curtain on a lattice of places, from which sheets of any size are made.

use super::filling::Covariances;
use super::flown_curves::farthest;
use super::{Curtain, FlownCurves};
use spunlaid_ground::Fault;
use spunlaid_ground::place::Inlet;
use std::f64::consts::FRAC_PI_2;

/// Most places along the machine direction that are rows; more are a slot.
const ROWS: usize = 8;
/// Fewest levels on which a slot is filled. They are at most a mean distance of simulated filaments apart, which is the
/// shortest scale of a filling: between levels farther apart a cubic would lose what distinguishes filaments of
/// different depth, and lay them more alike.
const LEVELS: usize = 6;
/// Distance of the lattice across, in mean distances of simulated filaments: between those the curves are smooth.
const COLUMN: f64 = 0.5;
/// Half lags in a piece, in a fade from piece to piece, and in the shortest library.
const PIECE: f64 = 20.0;
const FADE: f64 = 2.0;
const SHORTEST: f64 = 12.0;
/// Half distances in a fade across, and fades in the narrowest library.
const FADE_ACROSS: f64 = 2.0;
const NARROWEST: f64 = 3.0;

/// All that a flight reports of a curtain: its curves on a lattice, without their mean.
#[derive(Clone, Debug)]
pub struct Library {
    /// Of a level, for each column; then of the next level.
    curves: Vec<[Vec<f32>; 2]>,
    columns: usize,
    pub(super) levels: Levels,
    pub(super) turn: f64,
    pub(super) spacing: f64,
    pub(super) belt_ratio: f64,
    /// On the ring to which the curves are closed: their end fades into their begin.
    pub(super) points: usize,
    /// Points of a piece and of the fade to the next one.
    pub(super) piece: usize,
    pub(super) fade: usize,
    /// Width of a fade [m].
    pub(super) fade_across: f64,
    missing: [f64; 2],
    reach: [f64; 2],
    /// No filament of the curtain is farther from its mean in machine direction [m].
    farthest: f64,
}

/// The places of the lattice along the machine direction, and the mean deviation at each.
#[derive(Clone, Debug)]
pub(super) struct Levels {
    y: Vec<f64>,
    means: Vec<[f64; 2]>,
    /// Whether filaments hang anywhere between them.
    is_slot: bool,
}

impl Levels {
    fn of(simulated: &FlownCurves) -> Self {
        let mut y: Vec<f64> = simulated.places().iter().map(|place| place.y).collect();
        y.sort_by(f64::total_cmp);
        y.dedup();
        let is_slot = y.len() > ROWS;
        if is_slot {
            let (first, depth) = (y[0], simulated.depth());
            let steps = ((depth / simulated.mean_distance()).ceil() as usize).max(LEVELS - 1);
            y = (0..=steps).map(|i| first + depth * i as f64 / steps as f64).collect();
        }
        let means = y.iter().map(|y| [0, 1].map(|d| simulated.mean(d, *y))).collect();
        Self { y, means, is_slot }
    }

    /// The levels that a filament follows from, with their weights; None where a row was not simulated.
    pub(super) fn around(&self, y: f64) -> Option<Vec<(usize, f64)>> {
        if self.is_slot {
            let last = self.y.len() - 1;
            let step = (self.y[last] - self.y[0]) / last as f64;
            let at = ((y - self.y[0]) / step).clamp(0.0, last as f64);
            let first = (at.floor() as usize).saturating_sub(1).min(last - 3);
            return Some((first..).zip(cubic(at - first as f64 - 1.0)).collect());
        }
        let row = self.y.iter().position(|row| (row - y).abs() <= 1e-9)?;
        Some(vec![(row, 1.0)])
    }

    /// Mean deviation, in machine and in cross direction [m].
    pub(super) fn mean(&self, around: &[(usize, f64)]) -> [f64; 2] {
        [0, 1].map(|d| around.iter().map(|(level, weight)| weight * self.means[*level][d]).sum())
    }
}

impl Library {
    /// # Errors
    /// If the edges of the simulated curtain are not periodic, or if it is too narrow or too short for pieces
    /// that know nothing of each other.
    pub fn new(simulated: &FlownCurves, threads: usize) -> Result<Self, Fault> {
        let Some(turn) = simulated.turn() else {
            return Err(Fault::new(
                "a sheet of tiles is made from filaments with periodic edges, and these end at edges that cut",
                "simulate the filaments with web.edges = \"periodic\"",
            ));
        };
        let half_lag = half_lag(simulated);
        let points = simulated.points();
        if (points as f64) < SHORTEST * half_lag {
            let spacing = simulated.spacing();
            return Err(Fault::new(
                format!(
                    "the simulated curves are {:.2} m long, and their correlation falls to one half over \
                    {:.3} m; pieces of them would resemble each other",
                    points as f64 * spacing,
                    half_lag * spacing
                ),
                format!("simulate {:.2} m of fibre or more", SHORTEST * half_lag * spacing),
            ));
        }
        let covariances = Covariances::fit(simulated, threads);
        let half = covariances.smooth.each_ref().map(|covariance| covariance.half_distance(0.5 * turn));
        let fade_across = FADE_ACROSS * half[0].max(half[1]);
        if turn < NARROWEST * fade_across {
            return Err(Fault::new(
                format!(
                    "the simulated curtain is {:.0} mm wide, and filaments are correlated by half over \
                    {:.0} mm; tiles of it would resemble each other",
                    turn * 1e3,
                    half[0].max(half[1]) * 1e3
                ),
                format!("simulate a width of {:.0} mm or more", NARROWEST * fade_across * 1e3),
            ));
        }
        let columns = (turn / (COLUMN * simulated.mean_distance())).ceil() as usize;
        let levels = Levels::of(simulated);
        let place = |y: f64, column: usize| Inlet { y, z: column as f64 * turn / columns as f64 };
        let lattice = levels.y.iter().flat_map(|y| (0..columns).map(|column| place(*y, column)));
        let filling = simulated.fill_by(&covariances, lattice.collect(), threads);
        let mut curves = filling.compute(threads);
        for (number, curve) in curves.iter_mut().enumerate() {
            for (values, mean) in curve.iter_mut().zip(levels.means[number / columns]) {
                values.iter_mut().for_each(|value| *value -= mean as f32);
            }
        }
        let (fade, longest) = ((FADE * half_lag).ceil() as usize, PIECE * half_lag);
        curves.iter_mut().flatten().for_each(|values| close(values, fade));
        let farthest = MOST_WITHIN * MOST * farthest(&curves);
        let points = points - fade;
        Ok(Self {
            curves,
            columns,
            levels,
            turn,
            spacing: simulated.spacing(),
            belt_ratio: simulated.belt_ratio(),
            points,
            piece: (longest as usize).min(points / 2),
            fade,
            fade_across,
            missing: filling.missing(),
            reach: simulated.reach(),
            farthest,
        })
    }

    /// The part of the variance that the simulated filaments do not give, in machine and in cross direction.
    pub fn missing(&self) -> [f64; 2] {
        self.missing
    }

    /// The smallest and the largest deviation in machine direction, each counted from the middle of the slot [m].
    pub(super) fn reach(&self) -> [f64; 2] {
        self.reach
    }

    /// No deviation of a filament from the mean at its place is larger in machine direction [m].
    pub(super) fn farthest(&self) -> f64 {
        self.farthest
    }

    /// The curves of the lattice that a filament follows from, with their weights.
    ///
    /// * `around` – levels with their weights
    pub(super) fn near(&self, z: f64, around: &[(usize, f64)]) -> Vec<(&[Vec<f32>; 2], f32)> {
        let at = z.rem_euclid(self.turn) / self.turn * self.columns as f64;
        let first = at.floor();
        let across = cubic(at - first);
        let of_level = |(level, weight): &(usize, f64)| {
            let (level, weight) = (*level, *weight);
            across.into_iter().enumerate().map(move |(i, share)| {
                let column = (first as usize + self.columns + i - 1) % self.columns;
                (&self.curves[level * self.columns + column], (weight * share) as f32)
            })
        };
        around.iter().flat_map(of_level).collect()
    }
}

/// Parts of a curve at the points of its fade; that of what it follows is the same from the other end.
pub(super) fn fade_in(fade: usize) -> impl Iterator<Item = f32> {
    (0..fade).map(move |i| libm::sin(FRAC_PI_2 * (i as f64 + 0.5) / fade as f64) as f32)
}

/// Closes a curve to a ring: its last points fade into the first ones, so that each part of it is drawn as often as
/// any other.
fn close(values: &mut Vec<f32>, fade: usize) {
    let parts: Vec<f32> = fade_in(fade).collect();
    let end = values.split_off(values.len() - fade);
    for (i, (value, last)) in values.iter_mut().zip(end).enumerate() {
        *value = parts[i] * *value + parts[fade - 1 - i] * last;
    }
}

/// Largest sum of the sizes of the weights of a cubic: between its inner two values, where filaments across
/// lie, and between any two, where those of a slot do.
const MOST_WITHIN: f64 = 1.25;
const MOST: f64 = 1.64;

/// Weights of four values at −1, 0, 1 and 2 for the cubic through them.
fn cubic(at: f64) -> [f64; 4] {
    let [before, next, last] = [at + 1.0, at - 1.0, at - 2.0];
    [-at * next * last / 6.0, before * next * last / 2.0, -before * at * last / 2.0, before * at * next / 6.0]
}

/// Points after which half of the correlation along the curves is left, in the direction that remembers
/// longer; at most as many as the curves have.
fn half_lag(simulated: &FlownCurves) -> f64 {
    let [md, cd] = [0, 1].map(|d| {
        let product = |lag: usize| {
            let of = |(filament, place): (usize, &Inlet)| {
                let values = simulated.deviations(filament, d);
                let mean = simulated.mean(d, place.y);
                let pairs = values.iter().zip(&values[lag..]);
                pairs.map(|(a, b)| (f64::from(*a) - mean) * (f64::from(*b) - mean)).sum::<f64>()
            };
            simulated.places().iter().enumerate().map(of).sum::<f64>() / (simulated.points() - lag) as f64
        };
        let (whole, mut before) = (product(0), 1.0);
        for lag in 1..simulated.points() {
            let now = product(lag) / whole;
            if now <= 0.5 {
                return lag as f64 - (0.5 - now) / (before - now);
            }
            before = now;
        }
        simulated.points() as f64
    });
    md.max(cd)
}
