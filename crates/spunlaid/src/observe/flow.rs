//! Share of the time that the fibres spend outside the given flow.

use super::{Declaration, FIBRE, Measure, Observation, Observer, PERCENT, Value, figure};
use crate::air::Flow;
use crate::flight::Flight;

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[Measure {
        name: "share_outside_flow",
        column: "share_outside_flow",
        label: "Time outside the flow",
        meaning: "share of the time that the elements spend outside the profile or the field, the spin-up \
            included; the simulation uses the air at the nearest point there",
        unit: PERCENT,
        group: FIBRE,
        figure: &figure("share_outside_flow", "Time outside the flow", "time outside the flow"),
        series: "share",
        ..Measure::NUMBER
    }],
    // A profile reaches from the inlet to the belt as far as it was measured; a fed fibre does not leave it sideways.
    applies: |case| match case.air.flow {
        Flow::Uniform => false,
        Flow::Profile(_) => case.line.is_none(),
        Flow::Field(_) => true,
    },
    observer: |_| Box::new(Outside),
};

/// The flight itself counts how often it looks up the flow outside.
#[derive(Debug)]
struct Outside;

impl Observer for Outside {
    fn see(&mut self, _: &Observation<'_>) {}

    fn finish(&self, lane: usize, flight: &Flight) -> Vec<Value> {
        vec![Value::Number(flight.outside(lane).unwrap_or(f64::NAN))]
    }
}
