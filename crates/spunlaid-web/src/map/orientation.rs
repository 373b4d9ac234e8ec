//! The directions of the fibres in a web.

use super::plan::Plan;
use super::shared_error::{Part, SharedError};
use super::{Curves, Fibres, Web};
use spunlaid_ground::{Error, Estimate, RunContext, WIDTH};
use std::f64::consts::PI;

/// Directions of the pieces of some filaments on the belt, each piece with its mass: of curves that were simulated,
/// each of them once; of a surrogate, those of up to 64 filaments.
#[derive(Clone, Debug, PartialEq)]
pub struct Orientation {
    /// `⟨cos²⟩` of the angle to the machine direction of each filament: ½ without orientation. Its error counts
    /// eddies that move neighbours together.
    pub cos_squared: Estimate,
    /// Share of the mass by direction: entry i holds angles to the machine direction from 10i to 10(i+1)
    /// degrees, positive towards the cross direction, in the sense in which the fibre was fed.
    pub directions: [f64; Self::DIRECTIONS],
    /// Stiffness along MD over that along CD of straight fibres in these directions that follow the strain of the
    /// sheet, `⟨cos⁴⟩/⟨sin⁴⟩`, and its standard error; none if it is not known.      theory.md (105)
    ///
    /// Source: H. L. Cox, Br. J. Appl. Phys. 3 (1952) 72–79.
    pub stiffness_ratio: (f64, Option<f64>),
    /// Longest fed length of a piece [m]: what bends within it is not seen.
    pub piece: f64,
}

/// Filaments of a layer of a surrogate that are looked at.
const SAMPLE: usize = 8 * WIDTH;

/// Sums over pieces in a stretch of a filament.
#[derive(Clone, Copy, Debug, Default)]
struct DirectionSums {
    pieces: f64,
    squares: f64,
    fourths: f64,
}

impl DirectionSums {
    fn add(&mut self, cos_squared: f64) {
        self.pieces += 1.0;
        self.squares += cos_squared;
        self.fourths += cos_squared * cos_squared;
    }

    /// `Σ cos²`, `Σ cos⁴` and `Σ sin⁴`.
    fn moments(&self) -> [f64; 3] {
        [self.squares, self.fourths, self.pieces - 2.0 * self.squares + self.fourths]
    }
}

/// The filaments of a layer that are looked at.
struct Sample {
    /// Share of the mass of the web.
    weight: f64,
    /// Of each filament, by stretches of it: one unless filaments hang in shared turbulence.
    filaments: Vec<Vec<DirectionSums>>,
    /// The groups of neighbours of filaments in shared turbulence.
    groups: Option<Vec<usize>>,
    directions: [u64; Orientation::DIRECTIONS],
    /// Tangents of the angles between the classes in a quarter of a turn.
    tangents: [f64; Orientation::DIRECTIONS / 4 - 1],
}

impl Sample {
    fn new(weight: f64) -> Self {
        let edge = |i: usize| libm::tan(2.0 * PI * (i + 1) as f64 / Orientation::DIRECTIONS as f64);
        Self {
            weight,
            filaments: Vec::new(),
            groups: None,
            directions: [0; Orientation::DIRECTIONS],
            tangents: std::array::from_fn(edge),
        }
    }

    fn add(&mut self, filament: usize, stretch: usize, [md, cd]: [f64; 2]) {
        let squared = md * md + cd * cd;
        if squared > 0.0 {
            self.filaments[filament][stretch].add(md * md / squared);
            self.directions[self.class(md, cd)] += 1;
        }
    }

    /// The class of a direction, whatever its length.
    fn class(&self, md: f64, cd: f64) -> usize {
        // Turned back by quarters of a turn, until it lies in the first one.
        let (quarter, along, across) = if md > 0.0 && cd >= 0.0 {
            (0, md, cd)
        } else if cd > 0.0 {
            (1, cd, -md)
        } else if md < 0.0 {
            (2, -md, -cd)
        } else {
            (3, -cd, md)
        };
        let passed = self.tangents.iter().map(|tangent| usize::from(across >= tangent * along));
        quarter * Orientation::DIRECTIONS / 4 + passed.sum::<usize>()
    }

    /// All curves that were simulated, each once.
    fn of_curves(weight: f64, curves: &Curves, advance: f64) -> Self {
        let stretches = (curves.length() / curves.one_air.memory).max(1.0) as usize;
        let mut sample = Self { groups: Some(curves.one_air.groups.clone()), ..Self::new(weight) };
        for (number, curve) in curves.curves().iter().enumerate() {
            sample.filaments.push(vec![DirectionSums::default(); stretches]);
            let pieces = curve.len() - 1;
            for (i, pair) in curve.windows(2).enumerate() {
                let step = [pair[1][0] - pair[0][0] - advance, pair[1][1] - pair[0][1]];
                sample.add(number, i * stretches / pieces, step);
            }
        }
        sample
    }

    /// Filaments of a surrogate, spread over the width.
    fn of_surrogate(weight: f64, plan: &Plan<'_>, web: &Web, by: RunContext<'_>) -> Result<Self, Error> {
        let groups = plan.places.len().div_ceil(WIDTH);
        let advance = plan.layer.belt_ratio() * plan.piece;
        let mut sample = Self::new(weight);
        for group in (0..groups).step_by(groups.div_ceil(SAMPLE / WIDTH).max(1)) {
            let first = group * WIDTH;
            let count = WIDTH.min(plan.places.len() - group * WIDTH);
            let before = sample.filaments.len();
            sample.filaments.resize(before + count, vec![DirectionSums::default()]);
            plan.walk(web, &[(first, count)], by, |_, points| {
                for pair in points.windows(2) {
                    for lane in 0..count {
                        let [md, cd] = [0, 1].map(|axis| pair[1][axis].0[lane] - pair[0][axis].0[lane]);
                        sample.add(before + lane, 0, [md - advance, cd]);
                    }
                }
            })?;
        }
        Ok(sample)
    }

    /// The means of `cos²`, `cos⁴` and `sin⁴` of a filament.
    fn of_filament(stretches: &[DirectionSums]) -> Option<[f64; 3]> {
        let whole = stretches.iter().fold(DirectionSums::default(), |sum, of| DirectionSums {
            pieces: sum.pieces + of.pieces,
            squares: sum.squares + of.squares,
            fourths: sum.fourths + of.fourths,
        });
        (whole.pieces > 0.0).then(|| whole.moments().map(|moment| moment / whole.pieces))
    }

    fn filaments(&self) -> Vec<[f64; 3]> {
        self.filaments.iter().filter_map(|stretches| Self::of_filament(stretches)).collect()
    }

    /// Standard error of the mean over filaments of a sum of the three moments; None if it is not known.
    fn error(&self, factors: [f64; 3]) -> Option<f64> {
        let sum =
            |moments: [f64; 3]| moments.iter().zip(factors).map(|(of, factor)| of * factor).sum::<f64>();
        let Some(groups) = &self.groups else {
            let values = self.filaments().into_iter().map(sum).collect();
            return Estimate::new(values).standard_error;
        };
        let of_filament = |stretches: &Vec<DirectionSums>| {
            let whole: f64 = stretches.iter().map(|of| of.pieces).sum();
            let part =
                |of: &DirectionSums| Part { value: sum(of.moments()) / whole, length: of.pieces / whole };
            stretches.iter().map(part).collect()
        };
        let parts: Vec<Vec<Part>> = self.filaments.iter().map(of_filament).collect();
        SharedError::of(&parts, groups).map(|error| error.standard_error)
    }
}

impl Orientation {
    /// Number of classes of direction.
    pub(crate) const DIRECTIONS: usize = 36;

    /// Mass along the machine direction over mass along the cross direction, `⟨cos²⟩/⟨sin²⟩`, and its standard
    /// error.
    pub fn md_cd_ratio(&self) -> (f64, Option<f64>) {
        let sin_squared = 1.0 - self.cos_squared.mean;
        let error = self.cos_squared.standard_error.map(|error| error / (sin_squared * sin_squared));
        (self.cos_squared.mean / sin_squared, error)
    }

    /// What the filaments of all layers say together; their airs are independent of each other.
    fn of(samples: &[Sample], piece: f64) -> Self {
        let whole: f64 = samples.iter().map(|of| of.weight).sum();
        let filaments: Vec<Vec<[f64; 3]>> = samples.iter().map(Sample::filaments).collect();
        let mut means = [0.0; 3];
        let mut directions = [0.0; Self::DIRECTIONS];
        for (sample, filaments) in samples.iter().zip(&filaments) {
            let share = sample.weight / whole;
            for (axis, mean) in means.iter_mut().enumerate() {
                let sum: f64 = filaments.iter().map(|moments| moments[axis]).sum();
                *mean += share * sum / filaments.len() as f64;
            }
            let total: u64 = sample.directions.iter().sum();
            for (direction, count) in directions.iter_mut().zip(sample.directions) {
                *direction += sample.weight * count as f64 / total.max(1) as f64;
            }
        }
        let error = |factors: [f64; 3]| {
            let squares = samples.iter().map(|of| Some((of.weight / whole * of.error(factors)?).powi(2)));
            squares.sum::<Option<f64>>().map(f64::sqrt).filter(|error| error.is_finite())
        };
        // Each value stands for its layer's share of the mass.
        let count = filaments.iter().map(Vec::len).min().unwrap_or(0);
        let layers = || samples.iter().zip(&filaments);
        let mixed =
            |i: usize| layers().map(|(of, filaments)| of.weight / whole * filaments[i][0]).sum::<f64>();
        let [cos_squared, md, cd] = means;
        let ratio = md / cd;
        Self {
            cos_squared: Estimate {
                mean: cos_squared,
                standard_error: error([1.0, 0.0, 0.0]),
                values: (0..count).map(mixed).collect(),
            },
            directions,
            stiffness_ratio: (ratio, error([0.0, 1.0 / cd, -ratio / cd])),
            piece,
        }
    }
}

/// Directions of the fibres of a web.
///
/// # Errors
/// As [`lay`](super::lay).
pub fn orientation(web: &Web, by: RunContext<'_>) -> Result<Orientation, Error> {
    let (mut samples, mut piece) = (Vec::new(), 0.0_f64);
    for (number, layer) in web.layers.iter().enumerate() {
        let weight = layer.basis_weight(&web.sheet) / web.basis_weight();
        samples.push(match &layer.fibres {
            Fibres::Flown(simulated) => {
                let curves = &simulated.curves;
                piece = piece.max(curves.spacing());
                Sample::of_curves(weight, curves, layer.belt_ratio() * curves.spacing())
            }
            Fibres::Surrogate(_) => {
                let plan = Plan::new(web, number, layer)?;
                piece = piece.max(plan.piece);
                Sample::of_surrogate(weight, &plan, web, by)?
            }
        });
    }
    Ok(Orientation::of(&samples, piece))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::map::{Filaments, FlownFibres, Layer, OneAir, Row, Sheet};
    use crate::surrogate::Surrogate;
    use rand_xoshiro::SplitMix64;
    use rand_xoshiro::rand_core::{Rng, SeedableRng};
    use spunlaid_ground::Isa;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, AtomicU64};

    /// Directions of filaments of which ten beside each other are in the same eddy: over many seeds the errors
    /// that are reported are as large as the scatter, and those of independent filaments a half of it or less.
    #[test]
    fn stat_the_errors_of_filaments_in_one_air_are_their_scatter() {
        const FILAMENTS: usize = 60;
        const STRETCHES: usize = 6;
        const PIECES: usize = 24;
        const GUST: usize = 10;
        const SEEDS: usize = 400;
        let mut random = SplitMix64::seed_from_u64(5);
        let mut uniform = || (random.next_u64() >> 11) as f64 / 9_007_199_254_740_992.0;
        let (mut found, mut estimated) = (Vec::new(), [0.0; 3]);
        for _ in 0..SEEDS {
            let mut sample = Sample::new(1.0);
            sample.filaments = vec![vec![DirectionSums::default(); STRETCHES]; FILAMENTS];
            sample.groups = Some((0..FILAMENTS).map(|filament| filament / (2 * GUST)).collect());
            for stretch in 0..STRETCHES {
                let gusts: Vec<f64> = (0..FILAMENTS / GUST).map(|_| uniform()).collect();
                for (filament, _) in
                    (0..FILAMENTS).flat_map(|filament| (0..PIECES).map(move |i| (filament, i)))
                {
                    // A eddy draws filaments out along the machine direction by more or less.
                    let angle = PI * uniform();
                    let drawn = 1.0 + gusts[filament / GUST];
                    sample.add(filament, stretch, [drawn * libm::cos(angle), libm::sin(angle)]);
                }
            }
            let alone = Estimate::new(sample.filaments().iter().map(|moments| moments[0]).collect());
            let of = Orientation::of(&[sample], 1e-3);
            let errors = [of.cos_squared.standard_error, of.stiffness_ratio.1, alone.standard_error];
            estimated
                .iter_mut()
                .zip(errors)
                .for_each(|(sum, error)| *sum += error.unwrap().powi(2) / SEEDS as f64);
            found.push([of.cos_squared.mean, of.stiffness_ratio.0]);
        }
        let scatter = |of: usize| {
            let values = Estimate::new(found.iter().map(|values| values[of]).collect());
            values.standard_error.unwrap() * (SEEDS as f64).sqrt()
        };
        for (of, estimated) in estimated.iter().enumerate().take(2) {
            let ratio = estimated.sqrt() / scatter(of);
            assert!((0.85..1.18).contains(&ratio), "{of}: {ratio}");
        }
        assert!(estimated[2].sqrt() < 0.7 * scatter(0), "{} {}", estimated[2].sqrt(), scatter(0));
    }

    #[test]
    fn analytic_the_class_of_a_direction_is_that_of_its_angle() {
        let sample = Sample::new(1.0);
        for tenths in 0..3600 {
            // Half a tenth of a degree away from the angles between classes; then at multiples of 90°, which are exact.
            let angle = (f64::from(tenths) + 0.5) / 1800.0 * PI;
            let [md, cd] = [0.3 * libm::cos(angle), 0.3 * libm::sin(angle)];
            assert_eq!(sample.class(md, cd), tenths as usize / 100, "{tenths} tenths of a degree");
        }
        for (direction, class) in [([2.0, 0.0], 0), ([0.0, 2.0], 9), ([-2.0, -0.0], 18), ([0.0, -2.0], 27)] {
            assert_eq!(sample.class(direction[0], direction[1]), class, "{direction:?}");
        }
    }

    #[test]
    fn analytic_the_ratio_of_stiffness_of_directions_with_a_cosine() {
        const PIECES: usize = 200_000;
        for (share, expected) in [(0.0, 1.0), (0.4, 1.727_272_7), (0.8, 3.285_714_3)] {
            // Angles of equal mass: the inverse of the distribution by bisection.
            let below = |angle: f64| (angle + 0.5 * share * libm::sin(2.0 * angle)) / (2.0 * PI);
            let mut sample = Sample::new(1.0);
            sample.filaments = vec![vec![DirectionSums::default()]; 2];
            for i in 0..PIECES {
                let wanted = (i as f64 + 0.5) / PIECES as f64;
                let (mut low, mut high) = (0.0, 2.0 * PI);
                for _ in 0..40 {
                    let middle = 0.5 * (low + high);
                    if below(middle) < wanted { low = middle } else { high = middle }
                }
                sample.add(i % 2, 0, [libm::cos(low), libm::sin(low)]);
            }
            let found = Orientation::of(&[sample], 1e-3);
            assert!((found.stiffness_ratio.0 / expected - 1.0).abs() < 1e-6, "{share}: {found:?}");
            assert!((found.cos_squared.mean - 0.5 - 0.25 * share).abs() < 1e-6, "{share}: {found:?}");
        }
    }

    /// Two layers of two filaments each, all of them straight.
    #[test]
    fn analytic_layers_count_by_their_mass_and_their_errors_are_independent() {
        let angles = [[5.0, 65.0], [-35.0, 95.0]].map(|layer| layer.map(|angle: f64| angle.to_radians()));
        let weights = [0.75, 0.25];
        let samples: Vec<Sample> = angles
            .iter()
            .zip(weights)
            .map(|(angles, weight)| {
                let mut sample = Sample::new(2.0 * weight);
                // A filament without pieces counts for nothing; it comes behind the others.
                sample.filaments = vec![Vec::new(); 3];
                for (number, angle) in angles.iter().enumerate() {
                    sample.filaments[number] = vec![DirectionSums::default()];
                    // A piece without length has no direction.
                    sample.add(number, 0, [0.0, 0.0]);
                    sample.add(number, 0, [3.0 * libm::cos(*angle), 3.0 * libm::sin(*angle)]);
                }
                sample
            })
            .collect();
        let found = Orientation::of(&samples, 1e-3);
        // The mean over all of a function of the angle, and its error: of two values half of their difference.
        let over_all = |of: &dyn Fn(f64) -> f64| {
            let layer = |angles: &[f64; 2]| angles.map(of);
            let layers = || angles.iter().map(layer).zip(weights);
            let mean: f64 = layers().map(|([a, b], weight)| weight * 0.5 * (a + b)).sum();
            let squares: f64 = layers().map(|([a, b], weight)| (weight * 0.5 * (a - b)).powi(2)).sum();
            (mean, squares.sqrt())
        };
        let is_near = |found: f64, wanted: f64| (found / wanted - 1.0).abs() < 1e-12;
        let (cos_squared, error) = over_all(&|angle| libm::cos(angle).powi(2));
        assert!(is_near(found.cos_squared.mean, cos_squared));
        assert!(is_near(found.cos_squared.standard_error.unwrap(), error), "{:?}", found.cos_squared);
        let [first, second] = [0, 1].map(|i| {
            weights[0] * libm::cos(angles[0][i]).powi(2) + weights[1] * libm::cos(angles[1][i]).powi(2)
        });
        assert!(is_near(found.cos_squared.values[0], first) && is_near(found.cos_squared.values[1], second));
        let (ratio, of_ratio) = found.md_cd_ratio();
        assert!(is_near(ratio, cos_squared / (1.0 - cos_squared)));
        assert!(is_near(of_ratio.unwrap(), error / (1.0 - cos_squared).powi(2)));
        let [md, cd] =
            [libm::cos as fn(f64) -> f64, libm::sin].map(|of| over_all(&|angle| of(angle).powi(4)).0);
        let difference = |angle: f64| (libm::cos(angle).powi(4) - md / cd * libm::sin(angle).powi(4)) / cd;
        let (stiffness, of_stiffness) = found.stiffness_ratio;
        assert!(is_near(stiffness, md / cd) && is_near(of_stiffness.unwrap(), over_all(&difference).1));
        // Shares of the mass of 2, in classes of ten degrees.
        let shares = [(0, 0.75), (6, 0.75), (32, 0.25), (9, 0.25)];
        for (class, found) in found.directions.iter().enumerate() {
            let wanted = shares.iter().find(|(number, _)| *number == class).map_or(0.0, |(_, share)| *share);
            assert!((found - wanted).abs() < 1e-12, "{class}: {found}");
        }
    }

    fn layer(filaments: Filaments, fibres: Fibres) -> Layer {
        let (linear_density, defects) = (2e-7, Vec::new());
        Layer { linear_density, feed_speed: 50.0, belt_speed: 25.0, filaments, defects, fibres }
    }

    fn orientation_of(layers: Vec<Layer>) -> Orientation {
        let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
        let by = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &done };
        orientation(&Web { sheet: Sheet::new(0.1, 2.0, 1e-3), layers, seed: 2 }, by).unwrap()
    }

    /// Curves of 16 pieces of 2 mm that lie half of their way along and half of it across the web, others by quarters.
    #[test]
    fn analytic_directions_of_curves_that_were_simulated() {
        let groups = vec![0, 1, 2, 3, 4, 5, 6, 7];
        let along = |number: usize, i: usize| i < 8 || number.is_multiple_of(4) && i < 12;
        let curve = |number: usize| {
            let mut at = [0.0, 0.0];
            let mut points = vec![at];
            for i in 0..16 {
                let axis = usize::from(!along(number, i));
                at[axis] -= [1e-3, 0.5e-3][axis];
                points.push(at);
            }
            points
        };
        // Eddies are forgotten after half of a curve.
        let one_air = OneAir { groups: groups.clone(), memory: 15e-3 };
        let curves = Curves::new(2e-3, 0.5, (0..8).map(curve).collect(), one_air).unwrap();
        let estimate = |mean: f64| Estimate { mean, ..Estimate::default() };
        let numbers = [estimate(9e-3), estimate(8e-3), estimate(15.0)];
        let simulated = FlownFibres { curves, numbers, residual: None, way: Vec::new() };
        let row = || Filaments::Rows(vec![Row::new(0.0, 1e-3, 100)]);
        let found = orientation_of(vec![layer(row(), Fibres::Flown(Arc::new(simulated)))]);
        let close =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        let cos_squared = |number: usize| if number.is_multiple_of(4) { 0.75 } else { 0.5 };
        assert_eq!(found.cos_squared.values, (0..8).map(cos_squared).collect::<Vec<f64>>());
        close(found.cos_squared.mean, 0.5625);
        // Against the sense of the machine direction, 180 degrees, and of the cross direction, 270 degrees.
        close(found.directions[17] + found.directions[18], 0.5625);
        close(found.directions[26] + found.directions[27], 0.4375);
        let part = |number: usize, stretch: usize| {
            let pieces = (8 * stretch..8 * stretch + 8).filter(|i| along(number, *i)).count();
            Part { value: pieces as f64 / 16.0, length: 0.5 }
        };
        let parts: Vec<Vec<Part>> = (0..8).map(|number| vec![part(number, 0), part(number, 1)]).collect();
        let error = SharedError::of(&parts, &groups).unwrap().standard_error;
        close(found.cos_squared.standard_error.unwrap(), error);
        assert_eq!(found.piece, 2e-3);
    }

    /// The belt runs off with half of the speed of the feed: of directions α at random, (cos α − ½, sin α) lies
    /// against the machine direction in two of three.
    #[test]
    fn analytic_fibre_lies_against_a_belt_that_runs_off() {
        let surrogate = Fibres::Surrogate(Surrogate { sigma_md: 9e-3, sigma_cd: 8e-3, noise: 15.0 });
        for (count, looked_at) in [(100, 52), (64, 64), (3, 3)] {
            let rows = Filaments::Rows(vec![Row::new(0.0, 0.5e-3, count)]);
            let found = orientation_of(vec![layer(rows, surrogate.clone())]);
            // Thirteen sets of eight, of which every second one is looked at; the last one has four.
            let mut values = found.cos_squared.values.clone();
            values.sort_by(f64::total_cmp);
            values.dedup();
            assert_eq!(values.len(), looked_at);
            let against: f64 = found.directions[9..27].iter().sum();
            assert!((against - 2.0 / 3.0).abs() < 0.05 * (3.0 / count as f64).sqrt(), "{count}: {against}");
            assert!((1e-4..2e-3).contains(&found.piece), "{}", found.piece);
        }
    }
}
