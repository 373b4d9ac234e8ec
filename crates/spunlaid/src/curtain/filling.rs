//! The curves of all filaments of a curtain, from those that were flown.

use super::covariance::Covariance;
use super::{Curtain, FlownCurves};
use crate::fibre::Place;
use crate::sort::sort_by_key;
use crate::statistics::linear::{dot, solve_positive};
use crate::threads::each;
use std::cmp::Reverse;

/// Flown filaments from which a curve follows.
const NEAREST: usize = 16;
/// Variance that a flown filament has for itself, in parts of its variance: keeps the equations solvable where filaments are flown at nearly one place.
const OWN: f64 = 0.002;

/// Filaments at any places, each the best linear estimate from the flown ones near it (simple kriging).
#[derive(Clone, Debug)]
pub struct Filling<'a> {
    flown: &'a FlownCurves,
    places: Vec<Place>,
    /// Of each filament, in machine and in cross direction.
    curves: Vec<[Estimate; 2]>,
}

/// How a curve follows from the flown ones.
#[derive(Clone, Debug)]
struct Estimate {
    /// What is added to the sum of the flown curves [m].
    constant: f32,
    weights: Vec<(u32, f32)>,
    /// The part of the variance that is not known.
    missing: f64,
}

impl FlownCurves {
    /// Fills in filaments.
    ///
    /// * `wanted` – where they are fed
    pub fn fill(&self, wanted: Vec<Place>, threads: usize) -> Filling<'_> {
        let covariances = Covariance::fit(self, threads);
        let curve = |i: usize| [0, 1].map(|d| self.estimate(d, &covariances[d], wanted[i]));
        let curves = each(threads, wanted.len(), curve);
        Filling { flown: self, places: wanted, curves }
    }

    fn estimate(&self, direction: usize, covariance: &Covariance, wanted: Place) -> Estimate {
        let places = self.places();
        let correlation = |from: Place, to: Place| covariance.correlation(self.apart(from, to));
        let mut near: Vec<(f64, usize)> =
            places.iter().map(|place| correlation(wanted, *place)).zip(0..).collect();
        if near.len() > NEAREST {
            near.select_nth_unstable_by(NEAREST, |a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            near.truncate(NEAREST);
        }
        sort_by_key(&mut near, |(correlation, _)| Reverse(*correlation));
        let row = |i: usize| {
            let at =
                |j: usize| correlation(places[near[i].1], places[near[j].1]) + if i == j { OWN } else { 0.0 };
            (0..near.len()).map(at).collect()
        };
        let known: Vec<f64> = near.iter().map(|(correlation, _)| *correlation).collect();
        // Without any variance there is nothing to estimate: the curve is the mean.
        let weights = solve_positive((0..near.len()).map(row).collect(), known.clone());
        let weights = weights.unwrap_or_else(|| vec![0.0; near.len()]);
        let missing = if covariance.variance() > 0.0 { 1.0 - dot(&weights, &known) } else { 0.0 };
        let of_flown =
            near.iter().zip(&weights).map(|((_, i), weight)| weight * self.mean(direction, places[*i].y));
        let constant = self.mean(direction, wanted.y) - of_flown.sum::<f64>();
        let weights = near.iter().zip(weights).map(|((_, i), weight)| (*i as u32, weight as f32)).collect();
        Estimate { constant: constant as f32, weights, missing }
    }
}

impl Filling<'_> {
    /// The part of the variance that the flown filaments do not tell, in machine and in cross direction: mean over all filaments.
    pub fn missing(&self) -> [f64; 2] {
        let count = self.curves.len().max(1) as f64;
        [0, 1].map(|d| self.curves.iter().map(|curve| curve[d].missing).sum::<f64>() / count)
    }

    /// As [`Filling::missing`], of one filament.
    pub fn missing_of(&self, filament: usize) -> [f64; 2] {
        self.curves[filament].each_ref().map(|estimate| estimate.missing)
    }

    /// Computes all curves, as if they had been flown.
    pub(super) fn compute(&self, threads: usize) -> Vec<[Vec<f32>; 2]> {
        each(threads, self.places.len(), |filament| {
            let mut curve = [0, 1].map(|_| vec![0.0; self.points()]);
            self.curve(filament, 0, curve.each_mut().map(Vec::as_mut_slice));
            curve
        })
    }
}

impl Curtain for Filling<'_> {
    fn places(&self) -> &[Place] {
        &self.places
    }

    fn points(&self) -> usize {
        self.flown.points()
    }

    fn spacing(&self) -> f64 {
        self.flown.spacing()
    }

    fn belt_ratio(&self) -> f64 {
        self.flown.belt_ratio()
    }

    fn curve(&self, filament: usize, first: usize, into: [&mut [f32]; 2]) {
        for (direction, (into, estimate)) in into.into_iter().zip(&self.curves[filament]).enumerate() {
            into.fill(estimate.constant);
            for (flown, weight) in &estimate.weights {
                add(into, *weight, &self.flown.deviations(*flown as usize, direction)[first..]);
            }
        }
    }

    fn reach(&self) -> [f64; 2] {
        self.flown.reach()
    }
}

/// Adds a multiple of some values.
pub(super) fn add(sums: &mut [f32], factor: f32, values: &[f32]) {
    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += factor * value);
}

#[cfg(test)]
mod tests {
    use super::super::synthetic::{Field, row, slot};
    use super::*;

    /// Mean square of the difference of two curtains in parts of the variance, by direction.
    fn error(filling: &Filling<'_>, truth: &FlownCurves, sigma: f64) -> [f64; 2] {
        let curves = filling.compute(2);
        [0, 1].map(|d| {
            let squares = curves.iter().enumerate().map(|(filament, curve)| {
                let pairs = curve[d].iter().zip(truth.deviations(filament, d));
                pairs.map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>() / curve[d].len() as f64
            });
            squares.sum::<f64>() / curves.len() as f64 / (sigma * sigma)
        })
    }

    /// Flown and wanted filaments of a field: those at even and at odd numbers.
    fn apart(field: &Field, places: &[Place]) -> [FlownCurves; 2] {
        let all = field.curves(places);
        [0, 1].map(|first| {
            let some = places.iter().copied().skip(first).step_by(2).collect();
            let curves: Vec<_> = all.iter().skip(first).step_by(2).cloned().collect();
            FlownCurves::new(some, Some(field.turn), (4e-3, 0.08), &curves).unwrap()
        })
    }

    #[test]
    fn stat_scratch() {
        for scale in [2e-3, 3e-3, 4e-3, 6e-3, 8e-3, 12e-3] {
            for seed in 1..4 {
                let field = Field {
                    turn: 0.128,
                    scales: [scale, f64::INFINITY],
                    points: 1500,
                    seed,
                    ..Field::default()
                };
                let [flown, truth] = apart(&field, &row(field.turn, 40));
                let covs = Covariance::fit(&flown, 2);
                let filling = flown.fill(truth.places().to_vec(), 2);
                let (missing, found) = (filling.missing(), error(&filling, &truth, field.sigma));
                println!("{scale} {seed}: {missing:?} {found:?}");
                println!("    {:?}", covs[0].parts());
            }
        }
        for seed in 1..4 {
            let field = Field { turn: 0.128, scales: [12e-3, 6e-3], points: 600, seed, ..Field::default() };
            let [flown, truth] = apart(&field, &slot(field.turn, 128, 20e-3));
            let filling = flown.fill(truth.places().to_vec(), 2);
            println!("slot {:?} {:?}", filling.missing(), error(&filling, &truth, field.sigma));
        }
    }
}
