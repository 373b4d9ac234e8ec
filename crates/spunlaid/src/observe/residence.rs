//! The circle in which the free end stays.

use super::{Declaration, MILLIMETRES, Measure, Observation, Observer, Value, figure, fixed};
use crate::flight::Flight;
use crate::lanes::WIDTH;
use crate::statistics::{EvenSample, quantile};

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[Measure {
        name: "residence_radius",
        column: "residence_radius_m",
        label: "Circle of 90 % of the time",
        meaning: "radius of the circle around the free end’s mean position, seen along the flow, in which \
            the free end is at 90 % of the recorded instants",
        unit: MILLIMETRES,
        figure: &figure("residence", "Circle of 90 % of the time", "circle of 90 % of the time"),
        series: "radius",
        ..Measure::NUMBER
    }],
    applies: fixed,
    observer: |_| Box::new(Residence::default()),
};

/// Share of the time that the free end is in the circle.
const SHARE: f64 = 0.9;

/// y and z of the free ends at the recorded instants after the spin-up [m].
#[derive(Debug, Default)]
struct Residence([EvenSample<(f64, f64)>; WIDTH]);

impl Observer for Residence {
    fn see(&mut self, observation: &Observation<'_>) {
        if let (true, Some(end)) = (observation.settled, observation.snapshot.position.last()) {
            for (lane, places) in self.0.iter_mut().enumerate() {
                places.push((end.y.0[lane], end.z.0[lane]));
            }
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        vec![Value::Number(radius(self.0[lane].values()))]
    }
}

fn radius(places: &[(f64, f64)]) -> f64 {
    let n = places.len() as f64;
    let (y, z) = places.iter().fold((0.0, 0.0), |sum, place| (sum.0 + place.0 / n, sum.1 + place.1 / n));
    let distances: Vec<f64> =
        places.iter().map(|place| ((place.0 - y).powi(2) + (place.1 - z).powi(2)).sqrt()).collect();
    quantile(&distances, SHARE)
}

#[cfg(test)]
mod tests {
    use super::radius;

    #[test]
    fn analytic_circle_of_a_uniform_disc() {
        // In a disc of radius R, 90 % of the area is within R √0.9.
        let spiral = |i: u32| {
            let (r, angle) = ((f64::from(i) / 20_000.0).sqrt(), 2.399_963 * f64::from(i));
            (5.0 + r * angle.cos(), -2.0 + r * angle.sin())
        };
        let places: Vec<_> = (0..20_000).map(spiral).collect();
        assert!((radius(&places) - 0.9f64.sqrt()).abs() < 1e-3);
    }
}
