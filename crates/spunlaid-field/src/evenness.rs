//! Along which axes the air of a field is the same.

use super::{Field, Hint, vector};
use spunlaid_ground::Vec3;

/// Pairs of points of the field that are compared.
const PAIRS: usize = 256;
/// Part by which consecutive partners of pairs are apart, of the list of points: all parts of it come equally often.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// A change along an axis below this share of the largest one is none: as much as a solver leaves.
const EVEN: f64 = 0.01;

impl Field {
    /// How much the velocity changes along x, y and z [m/s]: the rms change from a point of the field to the place at
    /// which one coordinate is that of another point. NaN if no such place lies in the field.
    ///
    /// Where the points of the field are dense, most is looked at.         Jansen 1999 (total effects)
    fn changes(&self) -> [f64; 3] {
        *self.changes.get_or_init(|| self.compare_points())
    }

    fn compare_points(&self) -> [f64; 3] {
        let points = self.some_points();
        let partner = |i: usize| points[(((i + 1) as f64 * GOLDEN).fract() * points.len() as f64) as usize];
        let mut hint = Hint::default();
        let mut squares = [0.0_f64; 3];
        let mut counts = [0.0; 3];
        for (i, at) in points.iter().enumerate() {
            let (here, other) = (self.sample(vector(*at), &mut hint), partner(i));
            for axis in 0..3 {
                let mut moved = *at;
                moved[axis] = other[axis];
                let there = self.sample(vector(moved), &mut hint);
                if there.inside {
                    let change = there.velocity - here.velocity;
                    (squares[axis], counts[axis]) = (squares[axis] + change.dot(change), counts[axis] + 1.0);
                }
            }
        }
        [0, 1, 2].map(|axis| (squares[axis] / counts[axis]).sqrt())
    }

    /// The only axis along which the air is the same, 0, 1, 2 for x, y, z: the one across a plane flow, or along which
    /// a flow in space does not change. None of a flow that changes along all of them, or along a single one.
    pub fn even_axis(&self) -> Option<usize> {
        self.plane_axis().or_else(|| {
            let mut even = (0..3).filter(|axis| self.is_even_along(*axis));
            even.next().filter(|_| even.next().is_none())
        })
    }

    /// Whether the air does not change along an axis, 0, 1, 2 for x, y, z, but does along another.
    pub fn is_even_along(&self, axis: usize) -> bool {
        self.changes()[axis] <= EVEN * self.changes().into_iter().fold(0.0, f64::max)
    }

    /// Points of the field, evenly from all of them.
    fn some_points(&self) -> Vec<[f64; 3]> {
        let (low, high) = self.support.bounds();
        let mut count = 0;
        self.support.points_in_box(low, high, |_, _| count += 1);
        let (mut number, mut points) = (0, Vec::with_capacity(PAIRS));
        self.support.points_in_box(low, high, |at, _| {
            if number * PAIRS / count >= points.len() && points.len() < PAIRS {
                points.push(at);
            }
            number += 1;
        });
        points
    }
}

/// Numbers over the points of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overview {
    /// Mean of the velocity [m/s].
    pub velocity: Vec3<f64>,
    /// Of its magnitude [m/s].
    pub speed: Spread,
    /// Of the turbulent kinetic energy `k` [m²/s²]; zero if the field has none.
    pub k: Spread,
    /// Of its dissipation rate `ε` [m²/s³]; zero if the field has none.
    pub epsilon: Spread,
}

/// How large a number is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The smallest value.
    pub least: f64,
    /// The mean over the points.
    pub mean: f64,
    /// The largest value.
    pub largest: f64,
}

impl Spread {
    const NOTHING: Self = Self { least: f64::INFINITY, mean: 0.0, largest: f64::NEG_INFINITY };

    /// Adds a value to the extremes and to the sum that becomes the mean.
    fn add(&mut self, value: f64) {
        self.least = self.least.min(value);
        self.largest = self.largest.max(value);
        self.mean += value;
    }
}

impl Field {
    /// The numbers over all points. In a mesh a point counts as often as it is looked at, so that small cells
    /// count more.
    pub fn overview(&self) -> Overview {
        let (low, high) = self.support.bounds();
        let mut count = 0.0;
        let (mut sum, mut spreads) = (Vec3::new(0.0, 0.0, 0.0), [Spread::NOTHING; 3]);
        self.support.points_in_box(low, high, |_, [u, v, w, k, epsilon]| {
            let velocity = Vec3::new(*u, *v, *w);
            sum += velocity;
            let values = [velocity.norm(), k.max(0.0), epsilon.max(0.0)];
            spreads.iter_mut().zip(values).for_each(|(spread, value)| spread.add(value));
            count += 1.0;
        });
        let [speed, k, epsilon] = spreads.map(|spread| Spread { mean: spread.mean / count, ..spread });
        Overview { velocity: sum * (1.0 / count), speed, k, epsilon }
    }
}
