//! Distance of the free end from the axis of the flow.

use super::{Declaration, Figure, MILLIMETRES, Measure, Observer, Seen, Value, fixed};
use crate::flight::Flight;
use crate::lanes::WIDTH;
use crate::statistics::quantile;

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[
        Measure {
            name: "deflection_99",
            column: "deflection_99_m",
            label: "Deflection, 99 % of the time",
            meaning: "distance from the axis through the root that the free end does not exceed at 99 % of the recorded instants",
            series: "99 %",
            ..DEFLECTION
        },
        Measure {
            name: "largest_deflection",
            column: "largest_deflection_m",
            label: "Largest deflection",
            meaning: "largest distance of the free end from the axis through the root at the recorded instants; it grows with the \
                      duration",
            series: "largest",
            ..DEFLECTION
        },
    ],
    applies: fixed,
    observer: |_| Box::new(Deflection::default()),
};

const DEFLECTION: Measure = Measure {
    unit: MILLIMETRES,
    figure: &Figure {
        name: "deflection",
        title: "Deflection of the free end",
        words: "deflection",
        logarithmic: false,
        from_zero: true,
        caption: "",
    },
    ..Measure::NUMBER
};

/// Distances of the free ends from the axis at the recorded instants after the spin-up [m].
#[derive(Debug, Default)]
struct Deflection([Vec<f64>; WIDTH]);

impl Observer for Deflection {
    fn see(&mut self, seen: &Seen<'_>) {
        if let (true, Some(end)) = (seen.settled, seen.snapshot.position.last()) {
            for (lane, distances) in self.0.iter_mut().enumerate() {
                let (y, z) = (end.y.0[lane], end.z.0[lane]);
                distances.push((y * y + z * z).sqrt());
            }
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        known(&self.0[lane]).map(Value::Number).to_vec()
    }
}

/// The distance that is not exceeded at 99 % of the instants, and the largest one [m].
fn known(distances: &[f64]) -> [f64; 2] {
    [quantile(distances, 0.99), distances.iter().copied().fold(f64::NAN, f64::max)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_quantile_and_largest_of_known_distances() {
        let distances: Vec<f64> = (0..=1000).map(|i| f64::from(i) * 1e-3).collect();
        let [most_of_the_time, largest] = known(&distances);
        assert!((most_of_the_time - 0.99).abs() < 1e-12);
        assert_eq!(largest, 1.0);
        assert!(known(&[]).iter().all(|distance| distance.is_nan()));
    }
}
