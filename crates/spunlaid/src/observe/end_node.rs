//! Amplitude, frequency and mean position of the free end, from every step after the spin-up.

use super::{
    Declaration, END_NODE, Figure, HERTZ, Kind, MILLIMETRES, Measure, Observer, Over, Seen, Unit, Value,
    always,
};
use crate::case::Case;
use crate::flight::Flight;

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[
        across("amplitude_y", "amplitude_y_m", "Amplitude in y", DEVIATION, &AMPLITUDE, MILLIMETRES, "*y*"),
        across("amplitude_z", "amplitude_z_m", "Amplitude in z", DEVIATION, &AMPLITUDE, MILLIMETRES, "*z*"),
        across("frequency_y", "frequency_y_hz", "Frequency in y", CROSSINGS, &FREQUENCY, HERTZ, "*y*"),
        across("frequency_z", "frequency_z_hz", "Frequency in z", CROSSINGS, &FREQUENCY, HERTZ, "*z*"),
        across("mean_x", "mean_x_m", "Mean position along the flow", MEAN_X, &POSITION, MILLIMETRES, "*x*"),
    ],
    applies: always,
    observer: |case| Box::new(EndNode::of(case)),
};

const DEVIATION: &str = "standard deviation over time of the free end’s position";
const CROSSINGS: &str = "half the number of sign changes per second of the free end’s position";
const MEAN_X: &str = "mean over time of the free end’s x; the smaller it is against the fibre’s length, the more the fibre is bent";

const AMPLITUDE: Figure = figure("amplitude", "Amplitude", "amplitude", true);
const FREQUENCY: Figure = figure("frequency", "Frequency", "frequency", true);
const POSITION: Figure = figure("mean_x", "Mean position along the flow", "mean position", false);

const fn figure(name: &'static str, title: &'static str, words: &'static str, from_zero: bool) -> Figure {
    Figure { name, title, words, logarithmic: false, from_zero, caption: "" }
}

const fn across(
    name: &'static str,
    column: &'static str,
    label: &'static str,
    meaning: &'static str,
    figure: &'static Figure,
    unit: Unit,
    series: &'static str,
) -> Measure {
    let (kind, group, over_replicates) = (Kind::Number, END_NODE, Over::Mean);
    Measure { name, column, label, meaning, unit, kind, group, over_replicates, figure, series }
}

/// The flight itself takes the statistics of the free ends at every step.
#[derive(Debug)]
struct EndNode {
    /// Time over which the statistics are taken [s].
    observed: f64,
}

impl EndNode {
    fn of(case: &Case) -> Self {
        Self { observed: case.run.duration() - case.run.spin_up() }
    }
}

impl Observer for EndNode {
    fn see(&mut self, _: &Seen<'_>) {}

    fn finish(&self, lane: usize, flight: &Flight) -> Vec<Value> {
        let motion = flight.end_node().motion(lane, self.observed);
        [motion.amplitude_y, motion.amplitude_z, motion.frequency_y, motion.frequency_z, motion.mean.x]
            .map(Value::Number)
            .to_vec()
    }
}
