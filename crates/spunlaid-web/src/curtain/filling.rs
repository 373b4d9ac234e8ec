//! The curves of all filaments of a curtain, from those that were simulated.

use super::covariance::Covariance;
use super::{Curtain, FlownCurves};
use spunlaid_ground::place::Inlet;
use spunlaid_ground::statistics::solve_positive;
use spunlaid_ground::threads::par_map;

/// Flown filaments from which a curve follows.
const NEAREST: usize = 16;
/// Variance that a simulated filament has for itself, in parts of its variance: keeps the equations solvable
/// where filaments are simulated at nearly one place.
const OWN: f64 = 0.002;

/// Shortest scales of the covariance by which the curves are filled in, and of that which reports what they
/// miss. A filling with the smoother one misses no more, is nearer to the web as it would be simulated, and includes
/// less of what it misses.
const SMOOTH: [f64; 2] = [1.0, 0.5];
const ROUGH: [f64; 2] = [0.4, 1.0 / 3.0];
/// Filaments, evenly spread, that give what is missing.
const REPORTED: usize = 512;

/// How the deviations of filaments vary together, in machine and in cross direction.
#[derive(Clone, Debug)]
pub struct Covariances {
    /// By which filaments are filled in.
    pub smooth: [Covariance; 2],
    /// Which reports what they miss.
    pub rough: [Covariance; 2],
}

impl Covariances {
    /// As simulated filaments give them.
    pub fn fit(simulated: &FlownCurves, threads: usize) -> Self {
        let [smooth, rough] = [SMOOTH, ROUGH].map(|shortest| Covariance::fit(simulated, shortest, threads));
        Self { smooth, rough }
    }
}

/// Filaments at any places, each the best linear estimate from the simulated ones near it (simple kriging).
///                                                                                            theory.md (83f)
#[derive(Clone, Debug)]
pub struct Filling<'a> {
    simulated: &'a FlownCurves,
    places: Vec<Inlet>,
    /// Of each filament, in machine and in cross direction.
    curves: Vec<[Estimate; 2]>,
    missing: [f64; 2],
}

/// How a curve follows from the simulated ones.
#[derive(Clone, Debug)]
struct Estimate {
    /// What is added to the sum of the simulated curves [m].
    constant: f32,
    /// Of simulated filaments.
    weights: Vec<(u32, f32)>,
}

impl FlownCurves {
    /// Fills in filaments.
    ///
    /// * `wanted` – where they are fed
    pub fn fill(&self, wanted: Vec<Inlet>, threads: usize) -> Filling<'_> {
        self.fill_by(&Covariances::fit(self, threads), wanted, threads)
    }

    /// As [`FlownCurves::fill`], with known covariances.
    pub fn fill_by(&self, by: &Covariances, wanted: Vec<Inlet>, threads: usize) -> Filling<'_> {
        let curve = |i: usize| [0, 1].map(|d| self.estimate(d, &by.smooth[d], wanted[i]));
        let curves = par_map(threads, wanted.len(), curve);
        let step = wanted.len().div_ceil(REPORTED).max(1);
        let some: Vec<usize> = (0..wanted.len()).step_by(step).collect();
        let missing = par_map(threads, some.len(), |i| {
            [0, 1].map(|d| self.missing(&by.rough[d], wanted[some[i]], &curves[some[i]][d]))
        });
        let missing = [0, 1].map(|d| missing.iter().map(|of| of[d]).sum::<f64>() / some.len().max(1) as f64);
        Filling { simulated: self, places: wanted, curves, missing }
    }

    fn estimate(&self, direction: usize, covariance: &Covariance, wanted: Inlet) -> Estimate {
        let places = self.places();
        let correlation = |from: Inlet, to: Inlet| covariance.correlation(self.apart(from, to));
        let mut near: Vec<(f64, usize)> =
            places.iter().map(|place| correlation(wanted, *place)).zip(0..).collect();
        if near.len() > NEAREST {
            near.select_nth_unstable_by(NEAREST, |a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            near.truncate(NEAREST);
        }
        near.sort_by_key(|(_, filament)| *filament);
        // Only the half below the diagonal is looked at.
        let row = |i: usize| {
            let here = places[near[i].1];
            let others = near[..i].iter().map(|(_, other)| correlation(here, places[*other]));
            others.chain([1.0 + OWN]).collect()
        };
        let known: Vec<f64> = near.iter().map(|(correlation, _)| *correlation).collect();
        let weights = solve_positive((0..near.len()).map(row).collect(), known);
        let weights = weights.unwrap_or_else(|| vec![0.0; near.len()]);
        let of_flown =
            near.iter().zip(&weights).map(|((_, i), weight)| weight * self.mean(direction, places[*i].y));
        let constant = self.mean(direction, wanted.y) - of_flown.sum::<f64>();
        let weights = near.iter().zip(weights).map(|((_, i), weight)| (*i as u32, weight as f32)).collect();
        Estimate { constant: constant as f32, weights }
    }

    /// The part of the variance that is not in the curve of a filament, `1 − 2 w·k + w·(K + ε) w`.
    fn missing(&self, covariance: &Covariance, wanted: Inlet, estimate: &Estimate) -> f64 {
        if covariance.variance() <= 0.0 {
            return 0.0;
        }
        let correlation = |from: Inlet, to: Inlet| covariance.correlation(self.apart(from, to));
        let weights =
            || estimate.weights.iter().map(|(i, weight)| (self.places()[*i as usize], f64::from(*weight)));
        let known: f64 = weights().map(|(place, weight)| weight * correlation(wanted, place)).sum();
        let both = |(one, a): (Inlet, f64)| {
            weights().map(move |(other, b)| a * b * correlation(one, other)).sum::<f64>()
        };
        let own: f64 = weights().map(|(_, weight)| OWN * weight * weight).sum();
        1.0 - 2.0 * known + weights().map(both).sum::<f64>() + own
    }
}

impl Filling<'_> {
    /// The part of the variance that the simulated filaments do not give, in machine and in cross direction: mean
    /// over the filaments.
    pub fn missing(&self) -> [f64; 2] {
        self.missing
    }

    /// Computes all curves, as if they had been simulated.
    pub(super) fn compute(&self, threads: usize) -> Vec<[Vec<f32>; 2]> {
        par_map(threads, self.places.len(), |filament| {
            let mut curve = [0, 1].map(|_| vec![0.0; self.points()]);
            self.curve(filament, 0, curve.each_mut().map(Vec::as_mut_slice));
            curve
        })
    }
}

impl Curtain for Filling<'_> {
    fn places(&self) -> &[Inlet] {
        &self.places
    }

    fn points(&self) -> usize {
        self.simulated.points()
    }

    fn spacing(&self) -> f64 {
        self.simulated.spacing()
    }

    fn belt_ratio(&self) -> f64 {
        self.simulated.belt_ratio()
    }

    fn curve(&self, filament: usize, first: usize, into: [&mut [f32]; 2]) {
        for (direction, (into, estimate)) in into.into_iter().zip(&self.curves[filament]).enumerate() {
            into.fill(estimate.constant);
            for (simulated, weight) in &estimate.weights {
                add(into, *weight, &self.simulated.deviations(*simulated as usize, direction)[first..]);
            }
        }
    }

    fn reach(&self) -> [f64; 2] {
        self.simulated.reach()
    }

    fn farthest(&self) -> f64 {
        let of_flown = self.simulated.farthest();
        let farthest = |[md, _]: &[Estimate; 2]| {
            let weights: f64 = md.weights.iter().map(|(_, weight)| f64::from(weight.abs())).sum();
            f64::from(md.constant.abs()) + weights * of_flown
        };
        self.curves.iter().map(farthest).fold(0.0, f64::max)
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

    /// Flown and wanted filaments of a field: those of even and of odd numbers.
    fn parts(field: &Field, places: &[Inlet]) -> [FlownCurves; 2] {
        let all = field.curves(places);
        [0, 1].map(|first| {
            let some = places.iter().copied().skip(first).step_by(2).collect();
            let curves: Vec<_> = all.iter().skip(first).step_by(2).cloned().collect();
            field.flown_of(some, &curves)
        })
    }

    /// Mean square of what a filling is off, in parts of the variance.
    fn error(filling: &Filling<'_>, truth: &FlownCurves, sigma: f64) -> f64 {
        let curves = filling.compute(2);
        let values = |filament: usize| {
            [0, 1].map(|d| {
                let pairs = curves[filament][d].iter().zip(truth.deviations(filament, d));
                pairs.map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>() / curves[filament][d].len() as f64
            })
        };
        let all: f64 = (0..curves.len()).flat_map(values).sum();
        all / (2 * curves.len()) as f64 / (sigma * sigma)
    }

    fn known(field: &Field) -> Covariances {
        let covariance = || Covariance::normal(field.sigma.powi(2), field.scales, Some(field.turn));
        let [smooth, rough] = [0, 1].map(|_| [covariance(), covariance()]);
        Covariances { smooth, rough }
    }

    fn mean(missing: [f64; 2]) -> f64 {
        0.5 * (missing[0] + missing[1])
    }

    /// Rows whose pitch is 2.1 and 1.6 scales, and a slot.
    fn fields() -> [(Field, Vec<Inlet>); 3] {
        let row_of = |scale: f64| Field { scales: [scale, f64::INFINITY], points: 1500, ..Field::default() };
        let in_slot = Field { scales: [12e-3, 6e-3], points: 600, ..Field::default() };
        let turn = in_slot.turn;
        [(row_of(3e-3), row(turn, 40)), (row_of(4e-3), row(turn, 40)), (in_slot, slot(turn, 128, 20e-3))]
    }

    /// The error of the best linear estimate is known: `1 − k·K⁻¹k`.                          theory.md (83f)
    #[test]
    fn analytic_the_error_of_a_normal_field_of_known_covariance() {
        for (field, places) in fields() {
            let [simulated, truth] = parts(&field, &places);
            let simulated = field.with_noise(&simulated, OWN);
            let filling = simulated.fill_by(&known(&field), truth.places().to_vec(), 2);
            let estimated = mean(filling.missing());
            let found = error(&filling, &truth, field.sigma);
            assert!((found / estimated - 1.0).abs() < 0.03, "{field:?}: {found} {estimated}");
        }
    }

    /// With the covariance from the simulated curves alone, hardly more is missed.
    #[test]
    fn stat_a_fitted_covariance_fills_nearly_as_well_as_the_known_one() {
        for (field, places) in &fields()[1..] {
            let [simulated, truth] = parts(field, places);
            let best = simulated.fill_by(&known(field), truth.places().to_vec(), 2);
            let filling = simulated.fill(truth.places().to_vec(), 2);
            let [best, found] = [&best, &filling].map(|filling| error(filling, &truth, field.sigma));
            let estimated = mean(filling.missing());
            assert!(found < 1.1 * best, "{found} {best}");
            assert!(estimated > 0.8 * found && estimated < 1.8 * found, "{estimated} {found}");
        }
    }

    #[test]
    fn analytic_a_flown_filament_is_filled_in_as_it_was_flown() {
        for (field, places) in fields() {
            let simulated = field.simulated(places);
            let filling = simulated.fill(simulated.places().to_vec(), 2);
            let found = error(&filling, &simulated, field.sigma);
            assert!(found < 1e-4 && mean(filling.missing()) < 0.004, "{found} {:?}", filling.missing());
        }
    }

    /// In one air that is the same everywhere.
    #[test]
    fn limit_filaments_between_equal_ones_are_equal_too() {
        let field = Field { points: 300, ..Field::default() };
        let one = field.curves(&row(field.turn, 1)).remove(0);
        let simulated = field.flown_of(row(field.turn, 24), &vec![one; 24]);
        let filling = simulated.fill(row(field.turn, 7), 2);
        let missing = mean(filling.missing());
        assert!(missing < 1e-3, "{missing}");
        for curve in filling.compute(1) {
            for (d, values) in curve.iter().enumerate() {
                let off = values.iter().zip(simulated.deviations(0, d)).map(|(a, b)| (a - b).abs());
                assert!(off.fold(0.0, f32::max) < 1e-3 * field.sigma as f32);
            }
        }
    }

    /// In independent turbulence, nothing is known of a filament but the mean.
    #[test]
    fn limit_nothing_is_known_between_independent_filaments() {
        let field = Field { points: 2000, ..Field::default() };
        let curve = |seed: u64| Field { seed, ..field }.curves(&row(field.turn, 1)).remove(0);
        let curves: Vec<_> = (1..=32).map(curve).collect();
        let simulated = field.flown_of(row(field.turn, 32), &curves);
        // In the middle between two simulated ones.
        let between =
            simulated.places().iter().map(|place| Inlet { z: place.z + field.turn / 64.0, ..*place });
        let filling = simulated.fill(between.collect(), 2);
        assert!(mean(filling.missing()) > 0.95, "{:?}", filling.missing());
        let squares = filling.compute(2).concat().concat().iter().map(|x| f64::from(*x).powi(2)).sum::<f64>();
        let variance = squares / (2 * 32 * 2000) as f64 / field.sigma.powi(2);
        assert!(variance < 0.05, "{variance}");
    }

    /// A flow that widens lays filaments farther apart than they are fed.
    #[test]
    fn analytic_a_mean_that_is_linear_in_the_depth_is_kept() {
        let field = Field { points: 400, ..Field::default() };
        let places = slot(field.turn, 48, 20e-3);
        let mut curves = field.curves(&vec![Inlet::default(); 48]);
        for (curve, place) in curves.iter_mut().zip(&places) {
            curve.iter_mut().for_each(|point| point[0] += 0.01 + 1.5 * place.y);
        }
        let simulated = field.flown_of(places, &curves);
        let wanted = slot(field.turn, 9, 18e-3);
        for (curve, place) in simulated.fill(wanted.clone(), 2).compute(2).iter().zip(&wanted) {
            for (value, first) in curve[0].iter().zip(&curves[0]) {
                let expected = first[0] + 1.5 * (place.y - simulated.places()[0].y);
                assert!((f64::from(*value) - expected).abs() < 1e-4, "{value} {expected}");
            }
        }
    }

    #[test]
    fn identical_bits_for_any_number_of_threads() {
        let field = Field { points: 200, memory: 0.9, ..Field::default() };
        let simulated = field.simulated(slot(field.turn, 40, 20e-3));
        let filled = |threads: usize| {
            let filling = simulated.fill(slot(field.turn, 100, 20e-3), threads);
            (filling.missing(), filling.compute(threads))
        };
        let one = filled(1);
        for threads in [2, 5] {
            assert!(filled(threads) == one);
        }
    }
}
