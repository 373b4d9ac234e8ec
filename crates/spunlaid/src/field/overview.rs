//! What a field holds, to see whether it was read as it was meant.

use super::Field;
use crate::vec3::Vec3;

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
