//! The unevenness of a web in one air from what two of its filaments have in common.
//!
//! ```text
//! points of a block → products of pairs at some distances and lags → correlations → the part of CV² that neighbours make
//! ```
//!
//! It is told by pairs alone and so checks the map, in which thousands of filaments lie.              theory.md (83a)

use super::Beam;
use crate::fibre::Place;
use crate::threads::each;
use crate::web::{Edges, SharedVariance, Sheet};
use std::f64::consts::{SQRT_2, TAU};

/// Filaments whose pairs are looked at, spread over the beam.
const REFERENCES: usize = 64;
/// Filaments over all of whose neighbours the sum is taken.
const SUMMED: usize = 16;
/// Smallest distance of filaments that is looked at, in parts of the farthest one.
const NEAREST: f64 = 1.0 / 40.0;
/// Most places of rows along the machine direction; more are a slot.
const ROWS: usize = 8;
/// How far the distance of a pair may be from that which is looked at, in parts of it.
const OFF: f64 = 0.25;
/// Fewest pairs that tell a correlation.
const FEWEST: usize = 4;
/// Lags along the filament, in units of [`LAG`].
const LAGS: [usize; 14] = [0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 40, 48, 64];
/// Shortest lag, in ways from inlet to belt.
const LAG: f64 = 0.008;
/// Smallest variance of a distance; less is rounding [m²].
const SMALLEST: f64 = 1e-16;

/// Pairs at some distances, with the sums over what both have laid.
#[derive(Debug)]
pub(super) struct Pairs {
    /// Distances that are looked at, along z and along y, from zero on [m].
    distances: [Vec<f64>; 2],
    /// For each distance along z and each along y.
    nodes: Vec<Vec<Pair>>,
    references: Vec<usize>,
    /// Points from one lag to the next.
    unit: usize,
    /// The last deviations of each filament, as many as the longest lag needs; none of one that has no partner.
    points: Vec<Option<Vec<[f64; 2]>>>,
    /// Number of these.
    before: usize,
}

/// Mean deviation of each filament, in machine and in cross direction [m], and whether it was lost.
type Deviations<'a> = (&'a [[f64; 2]], &'a [bool]);

/// Two filaments.
#[derive(Debug)]
struct Pair {
    filaments: [usize; 2],
    /// Products of the deviations in machine and in cross direction, and their number, at each lag.
    products: [([f64; 2], u64); LAGS.len()],
}

/// Covariances in machine and in cross direction at each lag [m²].
type Covariances = [[f64; 2]; LAGS.len()];

impl Pairs {
    /// * `farthest` – distance across at which filaments have nothing in common any more [m]
    pub(super) fn new(beam: &Beam<'_>, farthest: f64, sheet: &Sheet) -> Self {
        let places = beam.places;
        let way = beam.case.line.map_or(0.0, |line| line.distance);
        let farthest = match sheet.edges {
            Edges::Periodic => farthest.min(0.5 * sheet.width),
            Edges::Cut => farthest,
        };
        let first = places.first().map_or(0.0, |place| place.y);
        let mut rows: Vec<f64> = places.iter().map(|place| (place.y - first).abs()).collect();
        rows.sort_by(f64::total_cmp);
        rows.dedup();
        let pitch = sheet.width / places.len() as f64;
        let doubled = |nearest: f64, limit: f64| {
            let doubled = (0..).map(move |n: i32| nearest * f64::from(n).exp2());
            [0.0]
                .into_iter()
                .chain(doubled.take_while(move |distance| nearest > 0.0 && *distance <= limit))
                .collect()
        };
        let nearest = NEAREST * farthest;
        let distances: [Vec<f64>; 2] = match rows.len() <= ROWS {
            true => [doubled(nearest.max(pitch * rows.len() as f64), farthest), rows],
            false => {
                [doubled(nearest.max(pitch), farthest), doubled(nearest, rows.last().copied().unwrap_or(0.0))]
            }
        };
        let references = references(places, farthest, sheet);
        let pair = |reference: usize, wanted: [f64; 2]| {
            let filaments = [reference, partner(places, reference, wanted, sheet)?];
            Some(Pair { filaments, products: [([0.0; 2], 0); LAGS.len()] })
        };
        let node =
            |wanted: [f64; 2]| references.iter().filter_map(|reference| pair(*reference, wanted)).collect();
        let [z, y] = &distances;
        let nodes: Vec<Vec<Pair>> =
            z.iter().flat_map(|z| y.iter().map(move |y| [*z, *y])).map(node).collect();
        let unit = (LAG * way / beam.case.fibre.rest_length()).round().max(1.0) as usize;
        let mut points = vec![None; places.len()];
        for filament in nodes.iter().flatten().flat_map(|pair| pair.filaments) {
            points[filament] = Some(Vec::new());
        }
        Self { points, distances, nodes, references, unit, before: 0 }
    }

    /// Adds points that all filaments have laid.
    ///
    /// * `waiting` – of each filament: deviations from the straight trace, in machine and in cross direction [m]
    /// * `count` – how many of them are added
    pub(super) fn add(&mut self, waiting: &[Vec<[f64; 2]>], count: usize) {
        let longest = LAGS[LAGS.len() - 1] * self.unit;
        let before = self.before;
        for (points, waiting) in self.points.iter_mut().zip(waiting) {
            points.iter_mut().for_each(|points| points.extend(waiting.iter().take(count)));
        }
        for Pair { filaments, products } in self.nodes.iter_mut().flatten() {
            let [a, b] = filaments.map(|filament| self.points[filament].as_deref().unwrap_or_default());
            for (lag, (sums, number)) in LAGS.iter().map(|lag| lag * self.unit).zip(products) {
                for (earlier, later) in [(a, b), (b, a)] {
                    let start = before.max(lag);
                    let (Some(earlier), Some(later)) = (earlier.get(start - lag..), later.get(start..))
                    else {
                        continue;
                    };
                    for (earlier, later) in earlier.iter().zip(later) {
                        (0..2).for_each(|d| sums[d] += earlier[d] * later[d]);
                    }
                    *number += later.len() as u64;
                }
            }
        }
        self.before = (before + count).min(longest);
        for points in self.points.iter_mut().flatten() {
            points.drain(..points.len().saturating_sub(longest));
        }
    }

    /// The part of CV² that neighbours make together, over patches of each side of the sheet; empty if the
    /// filaments lie too far apart to tell it.
    ///
    /// * `means` – deviation of each filament, in machine and in cross direction [m]
    pub(super) fn variances(
        &self,
        beam: &Beam<'_>,
        sheet: &Sheet,
        (means, lost): Deviations<'_>,
        threads: usize,
    ) -> Vec<SharedVariance> {
        let covariances = |pairs: &Vec<Pair>| {
            let alive = pairs.iter().filter(|pair| pair.filaments.iter().all(|filament| !lost[*filament]));
            let pairs: Vec<&Pair> = alive.collect();
            let at = |lag: usize| {
                [0, 1].map(|d| {
                    let covariance = |pair: &&Pair| {
                        let ((sums, number), [a, b]) = (pair.products[lag], pair.filaments);
                        sums[d] / number as f64 - means[a][d] * means[b][d]
                    };
                    pairs.iter().map(covariance).sum::<f64>() / pairs.len() as f64
                })
            };
            (pairs.len() >= FEWEST).then(|| std::array::from_fn(at))
        };
        let Some(covariances) = self.nodes.iter().map(covariances).collect::<Option<Vec<Covariances>>>()
        else {
            return Vec::new();
        };
        let known = covariances.iter().flatten().flatten().all(|covariance| covariance.is_finite());
        let (Some(line), true) = (beam.case.line, known) else { return Vec::new() };
        let lag = self.unit as f64 * beam.case.fibre.rest_length() * line.belt_ratio();
        let alive: Vec<usize> = self.references.iter().copied().filter(|filament| !lost[*filament]).collect();
        let alive: Vec<usize> = alive.iter().copied().step_by(alive.len().div_ceil(SUMMED).max(1)).collect();
        let sums = each(threads, alive.len(), |i| {
            let mut sums = vec![0.0; sheet.patches.len()];
            for (other, place) in beam.places.iter().enumerate().filter(|(other, _)| *other != alive[i]) {
                let here = beam.places[alive[i]];
                let (z, y) = (across(here, *place, sheet), place.y - here.y);
                let Some(near) = self.at(&covariances, [z.abs(), y.abs()]) else { continue };
                // A filament that is fed elsewhere along the belt comes down elsewhere.
                let offset =
                    [z + means[other][1] - means[alive[i]][1], y + means[other][0] - means[alive[i]][0]];
                let pair = BeltPair { offset, variance: covariances[0][0], covariances: near, lag };
                sums.iter_mut().zip(&sheet.patches).for_each(|(sum, patch)| *sum += pair.overlap(*patch));
            }
            sums
        });
        let per_width = sheet.width / beam.places.len() as f64 / alive.len() as f64;
        let variance = |number: usize| SharedVariance {
            layer: 0,
            patch: sheet.patches[number],
            variance: per_width * sums.iter().map(|sums| sums[number]).sum::<f64>(),
        };
        (0..sheet.patches.len()).map(variance).collect()
    }

    /// Covariances at a distance, linear between those that are known; None beyond them.
    fn at(&self, covariances: &[Covariances], distance: [f64; 2]) -> Option<Covariances> {
        let around = |known: &[f64], distance: f64| {
            let after = known.partition_point(|known| *known <= distance);
            // Across the slot the farthest distance stands for those beyond it.
            let [before, after] = [after - 1, after.min(known.len() - 1)];
            let step = known[after] - known[before];
            (before, after, if step > 0.0 { (distance - known[before]) / step } else { 0.0 })
        };
        let [z, y] = &self.distances;
        if distance[0] > z[z.len() - 1] {
            return None;
        }
        let (z, y, rows) = (around(z, distance[0]), around(y, distance[1]), y.len());
        let parts = [
            (z.0, y.0, (1.0 - z.2) * (1.0 - y.2)),
            (z.1, y.0, z.2 * (1.0 - y.2)),
            (z.0, y.1, (1.0 - z.2) * y.2),
            (z.1, y.1, z.2 * y.2),
        ];
        let mut sum = [[0.0; 2]; LAGS.len()];
        for (z, y, share) in parts {
            for (sum, known) in
                sum.as_flattened_mut().iter_mut().zip(covariances[z * rows + y].as_flattened())
            {
                *sum += share * known;
            }
        }
        Some(sum)
    }
}

/// Two filaments whose places on the belt are jointly normal.
struct BeltPair {
    /// Mean distance of what they lay at the same time, along z and along y [m].
    offset: [f64; 2],
    /// Of the places of each, in machine and in cross direction [m²].
    variance: [f64; 2],
    covariances: Covariances,
    /// Belt that passes in the shortest lag [m].
    lag: f64,
}

impl BeltPair {
    /// `∫ dv [T(v + y, 2σ₁²(1 − C₁)) T(z, 2σ₂²(1 − C₂)) − T(v + y, 2σ₁²) T(z, 2σ₂²)]` over the belt v that
    /// passes between the two, with [`overlap`] T.
    fn overlap(&self, side: f64) -> f64 {
        let [z, y] = self.offset;
        let both =
            |v: f64, variance: [f64; 2]| overlap(v + y, variance[0], side) * overlap(z, variance[1], side);
        let at = |v: f64, lag: usize| {
            let rest = [0, 1].map(|d| 2.0 * (self.variance[d] - self.covariances[lag][d]));
            both(v, rest) - both(v, self.variance.map(|variance| 2.0 * variance))
        };
        let value = |lag: usize| {
            let v = self.lag * LAGS[lag] as f64;
            at(v, lag) + at(-v, lag)
        };
        let values: [f64; LAGS.len()] = std::array::from_fn(value);
        let steps = LAGS.windows(2).zip(values.windows(2));
        steps
            .map(|(lags, values)| 0.5 * (lags[1] - lags[0]) as f64 * self.lag * (values[0] + values[1]))
            .sum()
    }
}

/// Mean of `max(0, 1 − |d|/side)/side` over normal distances d: the density of the place that two squares share.
///
/// * `apart` – mean of the distances [m]
/// * `variance` – of the distances [m²]
fn overlap(apart: f64, variance: f64, side: f64) -> f64 {
    let sigma = variance.max(SMALLEST).sqrt();
    // The mean of what is above zero.
    let above = |mean: f64| {
        let z = mean / sigma;
        let density = libm::exp(-0.5 * z * z) / TAU.sqrt();
        0.5 * mean * libm::erfc(-z / SQRT_2) + sigma * density
    };
    (above(apart + side) - 2.0 * above(apart) + above(apart - side)) / (side * side)
}

/// Distance of one place from another across the web, the shorter way round [m].
fn across(from: Place, to: Place, sheet: &Sheet) -> f64 {
    let z = to.z - from.z;
    match sheet.edges {
        Edges::Periodic => z - sheet.width * (z / sheet.width).round(),
        Edges::Cut => z,
    }
}

/// Filaments spread over the beam, which have neighbours on both sides.
fn references(places: &[Place], farthest: f64, sheet: &Sheet) -> Vec<usize> {
    let [first, last] = [places.first(), places.last()].map(|place| place.map_or(0.0, |place| place.z));
    let inner = |place: &Place| {
        sheet.edges == Edges::Periodic || (place.z - farthest >= first && place.z + farthest <= last)
    };
    let inner: Vec<usize> = (0..places.len()).filter(|filament| inner(&places[*filament])).collect();
    let count = inner.len().min(REFERENCES);
    (0..count).map(|i| inner[i * inner.len() / count]).collect()
}

/// The filament whose distance from another one is nearest to what is looked for, along z and along y.
fn partner(places: &[Place], reference: usize, wanted: [f64; 2], sheet: &Sheet) -> Option<usize> {
    if wanted == [0.0; 2] {
        return Some(reference);
    }
    let off = |filament: usize| {
        let (here, there) = (places[reference], places[filament]);
        let found = [across(here, there, sheet).abs(), (there.y - here.y).abs()];
        let size = wanted[0].max(wanted[1]);
        let off = [0, 1].map(|axis| (found[axis] - wanted[axis]).abs() / size);
        off[0].max(off[1])
    };
    let others = (0..places.len()).filter(|filament| *filament != reference);
    let nearest = others.map(|filament| (off(filament), filament)).min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.filter(|(off, _)| *off <= OFF).map(|(_, filament)| filament)
}
