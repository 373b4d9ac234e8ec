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
    /// How much the velocity changes along x, y and z: the rms change from a point of the field to the place at which
    /// one coordinate is that of another point, over √2 times the rms speed. NaN if no such place lies in the field.
    ///
    /// Where the points of the field are dense, most is looked at.         Jansen 1999 (total effects)
    fn changes(&self) -> [f64; 3] {
        *self.changes.get_or_init(|| self.compare_points())
    }

    fn compare_points(&self) -> [f64; 3] {
        let points = self.some_points();
        let partner = |i: usize| points[(((i + 1) as f64 * GOLDEN).fract() * points.len() as f64) as usize];
        let (mut hint, mut squares, mut speeds, mut counts) = (Hint::default(), [0.0; 3], 0.0, [0.0; 3]);
        for (i, at) in points.iter().enumerate() {
            let (here, other) = (self.sample(vector(*at), &mut hint), partner(i));
            speeds += here.velocity.dot(here.velocity) / points.len() as f64;
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
        [0, 1, 2].map(|axis| (0.5 * squares[axis] / counts[axis] / speeds).sqrt())
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Values;
    use spunlaid_ground::Vec3;

    /// A lattice of the unit cube with a velocity.
    fn cube(velocity: impl Fn(f64, f64, f64) -> Vec3<f64>) -> Field {
        let row: Vec<f64> = (0..9).map(|i| f64::from(i) / 8.0).collect();
        let mut values = Values::default();
        for (z, y) in row.iter().flat_map(|z| row.iter().map(move |y| (*z, *y))) {
            values.velocity.extend(row.iter().map(|x| velocity(*x, y, z)));
        }
        Field::lattice([row.clone(), row.clone(), row], &values).unwrap()
    }

    /// Of two independent even numbers from 0 to 1 in steps of 1/8 the half mean square difference is their variance,
    /// (9² − 1)/12/64 = 0.1042, of 10 m/s.
    #[test]
    fn analytic_a_linear_change_is_the_standard_deviation_of_its_coordinate() {
        let field = cube(|x, y, _| Vec3::new(10.0 + x, 2.0 * y, 0.0));
        let speed = (10.5_f64.powi(2) + 0.1042 + 4.0 * (0.25 + 0.1042)).sqrt();
        let [x, y, z] = field.changes();
        assert!((x * speed / 0.1042_f64.sqrt() - 1.0).abs() < 0.1, "{x}");
        assert!((y * speed / 2.0 / 0.1042_f64.sqrt() - 1.0).abs() < 0.1, "{y}");
        assert_eq!((z, field.even_axis()), (0.0, Some(2)));
    }

    #[test]
    fn the_even_axis_is_the_only_one_and_bears_what_a_solver_leaves() {
        let noise = |x: f64, y: f64, z: f64| 1e-3 * (977.0 * x + 631.0 * y + 1409.0 * z).sin();
        let flow = |x: f64, y: f64| Vec3::new(10.0 - 3.0 * x, y * y, 0.0);
        let noisy = cube(|x, y, z| flow(x, z) + Vec3::new(noise(x, y, z), 0.0, 0.0));
        assert_eq!(noisy.even_axis(), Some(1));
        // In all directions, along one only, nowhere, and as between walls that are far apart.
        for field in [
            cube(|x, y, z| flow(x, y) * (1.0 + z)),
            cube(|x, _, _| flow(x, 0.0)),
            cube(|_, _, _| flow(0.0, 0.0)),
            cube(|x, y, z| flow(x, y) * if z == 0.0 || z == 1.0 { 0.0 } else { 1.0 }),
        ] {
            assert_eq!(field.even_axis(), None);
        }
    }
}

#[cfg(test)]
mod overview_tests {
    use super::*;

    /// Each point counts once on a lattice: u is 0, 1, 2 along x, and v is 3 everywhere.
    #[test]
    fn analytic_an_overview_has_the_extremes_and_the_means_of_the_points() {
        let table = "x_m,y_m,u_m_s,v_m_s,k_m2_s2,epsilon_m2_s3\n\
                     0,0,0,3,1,5\n1,0,1,3,2,5\n2,0,2,3,3,5\n0,1,0,3,1,5\n1,1,1,3,2,5\n2,1,2,3,3,5\n";
        let (field, _) = Field::parse(table.as_bytes(), "lattice.csv").unwrap();
        let Overview { velocity, speed, k, epsilon } = field.overview();
        assert_eq!([velocity.x, velocity.y, velocity.z], [1.0, 3.0, 0.0]);
        assert_eq!((speed.least, speed.largest), (3.0, 13f64.sqrt()));
        assert!((speed.mean - (3.0 + 10f64.sqrt() + 13f64.sqrt()) / 3.0).abs() < 1e-15);
        assert_eq!(k, Spread { least: 1.0, mean: 2.0, largest: 3.0 });
        assert_eq!(epsilon, Spread { least: 5.0, mean: 5.0, largest: 5.0 });
    }
}
