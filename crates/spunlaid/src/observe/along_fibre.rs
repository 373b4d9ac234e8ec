//! Amplitude of each node of the fibre.

use super::{
    Declaration, FIBRE, Figure, Kind, MILLIMETRES, Measure, Observation, Observer, Value, figure, fixed,
    number_of_each,
};
use crate::flight::Flight;
use crate::lanes::{Lanes, WIDTH};
use crate::vec3::Vec3;

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[
        AMPLITUDE
            .observed(
                "amplitude_y_along_fibre",
                "amplitude_y_along_fibre_m",
                "Amplitude in y along the fibre",
            )
            .series("*y*"),
        AMPLITUDE
            .observed(
                "amplitude_z_along_fibre",
                "amplitude_z_along_fibre_m",
                "Amplitude in z along the fibre",
            )
            .series("*z*"),
    ],
    applies: fixed,
    observer: |flight| Box::new(Spread::new(flight)),
};

const AMPLITUDE: Measure = Measure {
    meaning: "standard deviation over time of each node’s position, at the recorded instants",
    unit: MILLIMETRES,
    kind: Kind::Profile,
    group: FIBRE,
    figure: &Figure {
        caption: "Amplitude of each node: the standard deviation of its y and z over time.",
        ..figure("amplitude_along_fibre", "Amplitude along the fibre", "amplitude along the fibre")
    },
    ..Measure::NUMBER
};

/// Running mean and variance of every node at the recorded instants (Welford).
#[derive(Debug)]
struct Spread {
    rest_length: [f64; WIDTH],
    count: f64,
    /// Mean of y and z, and the sums of the squared deviations from it.
    nodes: Vec<([Lanes; 2], [Lanes; 2])>,
}

impl Spread {
    fn new(flight: &Flight) -> Self {
        let nodes = vec![Default::default(); flight.chain().elements() + 1];
        Self { rest_length: number_of_each(flight, |case| case.fibre.rest_length()), count: 0.0, nodes }
    }
}

impl Observer for Spread {
    fn see(&mut self, observation: &Observation<'_>) {
        if !observation.settled {
            return;
        }
        self.count += 1.0;
        let share = Lanes::splat(1.0 / self.count);
        for ((mean, squares), &Vec3 { y, z, .. }) in self.nodes.iter_mut().zip(&observation.snapshot.position)
        {
            for ((mean, squares), p) in mean.iter_mut().zip(squares).zip([y, z]) {
                let off = p - *mean;
                *mean = *mean + off * share;
                *squares = *squares + off * (p - *mean);
            }
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        let distance: Vec<f64> = (0..self.nodes.len()).map(|i| i as f64 * self.rest_length[lane]).collect();
        let deviation = |squares: &Lanes| (squares.0[lane] / self.count).sqrt();
        let deviations =
            |axis: usize| self.nodes.iter().map(|(_, squares)| deviation(&squares[axis])).collect();
        vec![Value::Curve(distance.clone(), deviations(0)), Value::Curve(distance, deviations(1))]
    }
}
