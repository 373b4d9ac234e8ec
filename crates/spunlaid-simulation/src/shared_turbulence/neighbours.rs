//! The correlation of neighbours: how two filaments at a distance across come down together, at equal fed length.
//!
//! ```text
//! points of a block → deviations from the straight trace → sums over each pair and stretch of fed length → correlation
//!                    its error: the scatter of the stretches, and what stays with a pair from stretch to stretch ┘
//! ```
//!
//! Nothing but the sums is kept, so the memory does not grow with the points.

use super::Beam;
use spunlaid_ground::place::{Inlet, rows};
use spunlaid_web::{Correlation, Edges, NeighbourCorrelation, Sheet};

/// Farthest neighbours, in parts of the distance after which the air repeats itself at least, which is ten
/// length scales.
const FARTHEST: f64 = 0.5;
/// Least length of a stretch, in ways from inlet to belt: eddies that were near the belt at its start are
/// forgotten at its end, unless the air itself changes more slowly.
const STRETCH: f64 = 2.0;
/// Most stretches, about.
const STRETCHES: f64 = 32.0;
/// In a metre.
const NANOMETRES: f64 = 1e9;
/// Fewest stretches whose scatter is reported as an error.
const FEWEST: usize = 4;

/// The pairs of a beam and their sums.
#[derive(Debug)]
pub(super) struct Neighbours {
    distances: Vec<Distance>,
    /// Deviations of each filament that the others have not reached yet, in machine and in cross direction [m].
    waiting: Vec<Vec<[f64; 2]>>,
    lost: Vec<bool>,
    stretches: Vec<StretchSums>,
    /// Points of each filament in a stretch.
    points: u64,
}

/// Pairs at one distance.
#[derive(Debug)]
struct Distance {
    /// [m]
    distance: f64,
    pairs: Vec<[usize; 2]>,
}

/// Sums over the points of a stretch of fed length, for both directions.
#[derive(Debug)]
struct StretchSums {
    points: u64,
    /// Of the deviations and their squares, for each filament.
    filaments: Vec<[[f64; 2]; 2]>,
    /// Of the products, for each pair of each distance.
    products: Vec<Vec<[f64; 2]>>,
}

/// Mean deviation of each filament, in machine and in cross direction [m].
type Means = Vec<[f64; 2]>;

/// Sums of a pair over some points.
#[derive(Clone, Copy, Debug, Default)]
struct PairSums {
    points: f64,
    /// Of the products of both.
    product: f64,
    /// Of the deviations and of their squares, for each of the two.
    sums: [[f64; 2]; 2],
}

impl PairSums {
    fn with(self, other: Self, sign: f64) -> Self {
        let sums = [0, 1].map(|i| [0, 1].map(|power| self.sums[i][power] + sign * other.sums[i][power]));
        let [points, product] = [(self.points, other.points), (self.product, other.product)]
            .map(|(one, other)| one + sign * other);
        Self { points, product, sums }
    }

    /// The moments about other means than zero.
    fn about(self, means: [f64; 2]) -> Moments {
        let Self { points, product, sums: [a, b] } = self;
        let square = |mean: f64, [sum, square]: [f64; 2]| square - 2.0 * mean * sum + points * mean * mean;
        Moments {
            product: product - means[0] * b[0] - means[1] * a[0] + points * means[0] * means[1],
            squares: [square(means[0], a), square(means[1], b)],
        }
    }
}

/// Sums over pairs of products and squares of deviations from the mean of each filament.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    product: f64,
    squares: [f64; 2],
}

impl Neighbours {
    pub(super) fn new(beam: &Beam<'_>, sheet: &Sheet) -> Self {
        let (case, count) = (beam.case, beam.places.len());
        let spacing = case.fibre.rest_length();
        let (way, feed_speed) = case.line.map_or((0.0, 0.0), |line| (line.distance, line.feed_speed));
        let time = beam.steps(sheet) as f64 / count.max(1) as f64 * case.run.time_step;
        let longest_memory = (STRETCH * way).max(feed_speed * case.air.memory());
        let stretch = longest_memory.max(feed_speed * time / STRETCHES);
        let farthest = FARTHEST * case.extent_of_air().z;
        Self {
            distances: distances(beam.places, farthest, sheet),
            waiting: vec![Vec::new(); count],
            lost: vec![false; count],
            stretches: Vec::new(),
            points: (stretch / spacing).ceil().max(1.0) as u64,
        }
    }

    /// Takes what a filament has laid since the last time.
    pub(super) fn lay(&mut self, filament: usize, deviations: &mut Vec<[f64; 2]>) {
        self.waiting[filament].append(deviations);
    }

    /// Leaves a filament out, with all that it has laid: the last of it may be wrong.
    pub(super) fn lose(&mut self, filament: usize) {
        self.lost[filament] = true;
        self.waiting[filament].clear();
    }

    /// Adds the points that all filaments have reached to the sums.
    pub(super) fn add(&mut self) {
        let alive = || self.waiting.iter().zip(&self.lost).filter(|(_, lost)| !**lost);
        let common = alive().map(|(waiting, _)| waiting.len()).min().unwrap_or(0);
        if common == 0 {
            return;
        }
        if self.stretches.last().is_none_or(|sums| sums.points >= self.points) {
            self.stretches.push(StretchSums::new(self.waiting.len(), &self.distances));
        }
        let Some(sums) = self.stretches.last_mut() else { return };
        sums.points += common as u64;
        for (sums, waiting) in sums.filaments.iter_mut().zip(&self.waiting) {
            for (direction, [sum, squares]) in sums.iter_mut().enumerate() {
                for point in waiting.iter().take(common) {
                    *sum += point[direction];
                    *squares += point[direction] * point[direction];
                }
            }
        }
        for (sums, Distance { pairs, .. }) in sums.products.iter_mut().zip(&self.distances) {
            for (sums, pair) in sums.iter_mut().zip(pairs) {
                let [a, b] = pair.map(|filament| self.waiting[filament].iter().take(common));
                for (a, b) in a.zip(b) {
                    sums[0] += a[0] * b[0];
                    sums[1] += a[1] * b[1];
                }
            }
        }
        for waiting in &mut self.waiting {
            waiting.drain(..common.min(waiting.len()));
        }
    }

    /// The correlations, from the nearest neighbours on.
    pub(super) fn correlations(&self) -> Vec<NeighbourCorrelation> {
        let (means, all) = (self.means(None), 0..self.stretches.len());
        // The mean of a filament is reported by the same stretches, and so is left out with them.
        let means_without: Vec<Means> = all.map(|left_out| self.means(Some(left_out))).collect();
        let correlation = |(number, distance): (usize, &Distance)| NeighbourCorrelation {
            distance: distance.distance,
            md: self.correlation(number, 0, &means, &means_without),
            cd: self.correlation(number, 1, &means, &means_without),
        };
        let all = self.distances.iter().enumerate().map(correlation);
        all.filter(|neighbour| neighbour.md.value.is_finite() && neighbour.cd.value.is_finite()).collect()
    }

    /// The mean deviation of each filament, without one of the stretches.
    fn means(&self, left_out: Option<usize>) -> Means {
        let kept = || self.stretches.iter().enumerate().filter(|(number, _)| Some(*number) != left_out);
        let points = kept().map(|(_, sums)| sums.points).sum::<u64>() as f64;
        let mean = |filament: usize| {
            [0, 1].map(|direction| {
                kept().map(|(_, sums)| sums.filaments[filament][direction][0]).sum::<f64>() / points
            })
        };
        (0..self.waiting.len()).map(mean).collect()
    }

    /// Over all pairs at a distance. Its error is that by the jackknife over the stretches, and what the
    /// places of the pairs add, which stay as they are in all stretches.                      theory.md (83b)
    fn correlation(
        &self,
        distance: usize,
        direction: usize,
        means: &Means,
        without: &[Means],
    ) -> Correlation {
        let pairs = self.distances[distance].pairs.iter().enumerate();
        let pairs: Vec<(usize, [usize; 2])> = pairs
            .filter(|(_, pair)| pair.iter().all(|i| !self.lost[*i]))
            .map(|(number, pair)| (number, *pair))
            .collect();
        let of_stretch = |sums: &StretchSums, (number, pair): &(usize, [usize; 2])| PairSums {
            points: sums.points as f64,
            product: sums.products[distance][*number][direction],
            sums: pair.map(|i| sums.filaments[i][direction]),
        };
        let of_all = |pair: &(usize, [usize; 2])| {
            let all = self.stretches.iter().map(|sums| of_stretch(sums, pair));
            all.fold(PairSums::default(), |all, one| all.with(one, 1.0))
        };
        let whole: Vec<PairSums> = pairs.iter().map(of_all).collect();
        let about = |means: &Means, pair: &(usize, [usize; 2])| pair.1.map(|i| means[i][direction]);
        let sum = |moments: &mut dyn Iterator<Item = Moments>| {
            moments.fold(Moments::default(), |all, one| all.with(one))
        };
        let all = sum(&mut pairs.iter().zip(&whole).map(|(pair, of)| of.about(about(means, pair))));
        let value = all.correlation();
        if self.stretches.len() < FEWEST {
            return Correlation { value, standard_error: None, degrees: f64::NAN };
        }
        let correlation_without = |(stretch, means): (&StretchSums, &Means)| {
            let left = |(pair, of): (&(usize, [usize; 2]), &PairSums)| {
                of.with(of_stretch(stretch, pair), -1.0).about(about(means, pair))
            };
            sum(&mut pairs.iter().zip(&whole).map(left)).correlation()
        };
        let count = self.stretches.len() as f64;
        let all_without = self.stretches.iter().zip(without).map(correlation_without);
        let squares = all_without.map(|found| (found - value).powi(2)).sum::<f64>();
        let by_chance = (count - 1.0) / count * squares;
        let parts = |pair: &(usize, [usize; 2])| -> Vec<f64> {
            let of = |sums| of_stretch(sums, pair).about(about(means, pair)).part_of(all);
            self.stretches.iter().map(of).collect()
        };
        let all_parts: Vec<Vec<f64>> = pairs.iter().map(parts).collect();
        let by_places = self.variance_by_places(&pairs, &all_parts);
        let variance = by_chance + by_places;
        let shares = by_chance * by_chance / (count - 1.0)
            + by_places * by_places / (pairs.len() as f64 - 1.0).max(1.0);
        Correlation {
            value,
            standard_error: Some(variance.sqrt()),
            degrees: if shares > 0.0 { variance * variance / shares } else { count - 1.0 },
        }
    }

    /// What the places of the filaments add to the variance of a sum over pairs: what pairs with a filament
    /// in common have in common in different stretches.
    fn variance_by_places(&self, pairs: &[(usize, [usize; 2])], parts: &[Vec<f64>]) -> f64 {
        let apart = |parts: &[f64]| {
            let (sum, squares) =
                parts.iter().fold((0.0, 0.0), |(sum, squares), x| (sum + x, squares + x * x));
            sum * sum - squares
        };
        let mut of_filaments = vec![vec![0.0; self.stretches.len()]; self.waiting.len()];
        for ((_, pair), parts) in pairs.iter().zip(parts) {
            for filament in pair {
                of_filaments[*filament].iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
            }
        }
        // A pair has two filaments, and is counted with both.
        let twice: f64 = of_filaments.iter().map(|parts| apart(parts)).sum();
        (twice - parts.iter().map(|parts| apart(parts)).sum::<f64>()).max(0.0)
    }
}

impl StretchSums {
    fn new(filaments: usize, distances: &[Distance]) -> Self {
        let products = distances.iter().map(|distance| vec![[0.0; 2]; distance.pairs.len()]).collect();
        Self { points: 0, filaments: vec![[[0.0; 2]; 2]; filaments], products }
    }
}

impl Moments {
    fn with(self, other: Self) -> Self {
        let squares = [0, 1].map(|i| self.squares[i] + other.squares[i]);
        Self { product: self.product + other.product, squares }
    }

    /// What a part adds to the correlation of the whole, to the first order.
    fn part_of(self, whole: Self) -> f64 {
        let squares = [0, 1].map(|i| self.squares[i] / whole.squares[i]);
        whole.correlation() * (self.product / whole.product - 0.5 * (squares[0] + squares[1]))
    }

    fn correlation(self) -> f64 {
        self.product / (self.squares[0] * self.squares[1]).sqrt()
    }
}

/// The pairs at some distances: once, twice, five, ten, twenty, forty … times the pitch.
///
/// * `farthest` – largest distance [m]
fn distances(places: &[Inlet], farthest: f64, sheet: &Sheet) -> Vec<Distance> {
    let rows = rows(places);
    let turn = (sheet.edges == Edges::Periodic).then_some(sheet.width);
    let width = rows.iter().filter_map(|row| Some(places[*row.last()?].z - places[*row.first()?].z));
    let width = width.fold(0.0, f64::max);
    let gaps = rows.iter().map(Vec::len).max().unwrap_or(0);
    let pitch = width / gaps.saturating_sub(1).max(1) as f64;
    let farthest = farthest.min(turn.map_or(width, |turn| 0.5 * turn)) + 0.5 * pitch;
    let multiples = [1.0, 2.0].into_iter().chain((0..).map(|doubled| 5.0 * f64::from(doubled).exp2()));
    let wanted = multiples.map(|multiple| multiple * pitch);
    // Filaments at one place have no pitch.
    let wanted = wanted.take_while(|distance| pitch > 0.0 && *distance < farthest);
    let found = wanted.filter_map(|wanted| {
        let mut pairs = Vec::new();
        for row in &rows {
            let z: Vec<f64> = row.iter().map(|filament| places[*filament].z).collect();
            let partner = |filament: usize| nearest(&z, z[filament] + wanted, turn);
            let of_row = (0..row.len()).filter_map(|i| Some((i, partner(i)?)));
            let near = of_row.filter(|(_, (_, off))| off.abs() < 0.5 * pitch);
            pairs.extend(near.map(|(i, (other, off))| ([row[i], row[other]], wanted + off)));
        }
        let distance = pairs.iter().map(|(_, distance)| distance).sum::<f64>() / pairs.len() as f64;
        // Without the rounding of sums.
        let distance = (distance * NANOMETRES).round() / NANOMETRES;
        let pairs: Vec<_> = pairs.into_iter().map(|(pair, _)| pair).collect();
        (!pairs.is_empty()).then_some(Distance { distance, pairs })
    });
    found.collect()
}

/// Which of some places in order is nearest to a place, and how far beyond it that one is.
///
/// * `turn` – distance after which the places repeat themselves [m]
fn nearest(places: &[f64], place: f64, turn: Option<f64>) -> Option<(usize, f64)> {
    let first = *places.first()?;
    let turns = turn.map_or(0.0, |turn| turn * ((place - first) / turn).floor());
    let place = place - turns;
    let after = places.partition_point(|other| *other < place);
    let around = [after.checked_sub(1), (after < places.len()).then_some(after)].into_iter().flatten();
    let around = around.map(|i| (i, places[i] - place));
    let again = turn.map(|turn| (0, first + turn - place));
    around.chain(again).min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
}
