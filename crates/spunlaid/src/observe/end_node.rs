//! Amplitude, frequency and mean position of the free end, from every step after the spin-up.

use super::{Declaration, Figure, HERTZ, MILLIMETRES, Measure, Observation, Observer, Value, figure, fixed};
use crate::flight::Flight;

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[
        AMPLITUDE.observed("amplitude_y", "amplitude_y_m", "Amplitude in y").series("*y*"),
        AMPLITUDE.observed("amplitude_z", "amplitude_z_m", "Amplitude in z").series("*z*"),
        FREQUENCY.observed("frequency_y", "frequency_y_hz", "Frequency in y").series("*y*"),
        FREQUENCY.observed("frequency_z", "frequency_z_hz", "Frequency in z").series("*z*"),
        MEAN_X,
    ],
    applies: fixed,
    observer: |_| Box::new(EndNode),
};

const AMPLITUDE: Measure = Measure {
    is_main: true,
    meaning: "standard deviation over time of the free end’s position",
    unit: MILLIMETRES,
    figure: &figure("amplitude", "Amplitude", "amplitude"),
    ..Measure::NUMBER
};

const FREQUENCY: Measure = Measure {
    is_main: true,
    meaning: "half the number of sign changes per second of the free end’s position",
    unit: HERTZ,
    figure: &figure("frequency", "Frequency", "frequency"),
    ..Measure::NUMBER
};

const MEAN_X: Measure = Measure {
    name: "mean_x",
    is_main: true,
    column: "mean_x_m",
    label: "Mean position along the flow",
    meaning: "mean over time of the free end’s x; the smaller it is against the fibre’s length, the more the \
        fibre is bent",
    unit: MILLIMETRES,
    figure: &Figure { from_zero: false, ..figure("mean_x", "Mean position along the flow", "mean position") },
    series: "*x*",
    ..Measure::NUMBER
};

/// The flight itself takes the statistics of the free ends at every step.
#[derive(Debug)]
struct EndNode;

impl Observer for EndNode {
    fn see(&mut self, _: &Observation<'_>) {}

    fn finish(&self, lane: usize, flight: &Flight) -> Vec<Value> {
        // Time over which the statistics are taken [s].
        let observed = flight.case(lane).map_or(f64::NAN, |case| case.run.duration() - case.run.spin_up());
        let motion = flight.end_node().motion(lane, observed);
        [motion.amplitude_y, motion.amplitude_z, motion.frequency_y, motion.frequency_z, motion.mean.x]
            .map(Value::Number)
            .to_vec()
    }
}
