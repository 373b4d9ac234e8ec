//! Distance of the free end from the axis of the flow.

use super::{Declaration, MILLIMETRES, Measure, Observation, Observer, Value, figure, fixed};
use crate::flight::Flight;
use crate::lanes::WIDTH;
use crate::statistics::{EvenSample, quantile};

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[
        DEFLECTION
            .observed("deflection_99", "deflection_99_m", "Deflection, 99 % of the time")
            .meaning(
                "distance from the axis through the root that the free end does not exceed at 99 % of \
                the recorded instants",
            )
            .series("99 %"),
        DEFLECTION
            .observed("largest_deflection", "largest_deflection_m", "Largest deflection")
            .meaning(
                "largest distance of the free end from the axis through the root at the recorded \
                instants; it grows with the duration",
            )
            .series("largest"),
    ],
    applies: fixed,
    observer: |_| Box::new(Deflection::default()),
};

const DEFLECTION: Measure = Measure {
    unit: MILLIMETRES,
    figure: &figure("deflection", "Deflection of the free end", "deflection"),
    ..Measure::NUMBER
};

/// Distances of the free ends from the axis at the recorded instants after the spin-up, and the largest ones [m].
#[derive(Debug)]
struct Deflection {
    distances: [EvenSample<f64>; WIDTH],
    largest: [f64; WIDTH],
}

impl Default for Deflection {
    fn default() -> Self {
        Self { distances: Default::default(), largest: [f64::NAN; WIDTH] }
    }
}

impl Deflection {
    fn add(&mut self, lane: usize, distance: f64) {
        self.distances[lane].push(distance);
        self.largest[lane] = self.largest[lane].max(distance);
    }

    /// The distance that is not exceeded at 99 % of the instants, and the largest one [m].
    fn known(&self, lane: usize) -> [f64; 2] {
        [quantile(self.distances[lane].values(), 0.99), self.largest[lane]]
    }
}

impl Observer for Deflection {
    fn see(&mut self, observation: &Observation<'_>) {
        if let (true, Some(end)) = (observation.settled, observation.snapshot.position.last()) {
            for lane in 0..WIDTH {
                let (y, z) = (end.y.0[lane], end.z.0[lane]);
                self.add(lane, (y * y + z * z).sqrt());
            }
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        self.known(lane).map(Value::Number).to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_quantile_and_largest_of_known_distances() {
        let mut observer = Deflection::default();
        assert_eq!(observer.known(2).map(f64::is_nan), [true; 2]);
        (0..=1000).for_each(|i| observer.add(2, f64::from(i) * 1e-3));
        let [most_of_the_time, largest] = observer.known(2);
        assert!((most_of_the_time - 0.99).abs() < 1e-12);
        assert_eq!(largest, 1.0);
    }
}
