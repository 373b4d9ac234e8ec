//! The settings that fibres in one flight must have in common.

use crate::air::FromFile;
use crate::case::Case;
use crate::drag::Curve;
use crate::error::FlightFault;

/// The settings that fibres in one flight must have in common. All others may differ from lane to lane.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Common {
    elements: usize,
    eddy_of_element: Vec<u32>,
    time_step: u64,
    steps: u64,
    spin_up_steps: u64,
    output_steps: u64,
    scheme: &'static str,
    damped: bool,
    drag_curves: [Option<Curve>; 2],
    cutoff_frequency: u64,
    harmonics: usize,
    records: Vec<u32>,
    steps_between_looks: u64,
    /// Steps to an element, bits of its length, and number of stations, of a fed fibre.
    feed: Option<(u64, u64, usize)>,
}

impl Common {
    pub(crate) fn of(case: &Case) -> Self {
        let Case { fibre, air, run, .. } = case;
        Self {
            elements: fibre.elements,
            eddy_of_element: if case.line.is_some() {
                Vec::new()
            } else {
                case.eddies().of_element().to_vec()
            },
            time_step: run.time_step.to_bits(),
            steps: run.steps,
            spin_up_steps: run.spin_up_steps,
            output_steps: run.output_steps,
            scheme: run.scheme.name(),
            damped: run.damping != 0.0,
            drag_curves: case.strand().drag.curves(),
            cutoff_frequency: air.cutoff_frequency.to_bits(),
            harmonics: air.harmonics,
            records: air.records.iter().map(FromFile::checksum).collect(),
            // A uniform flow is never looked up.
            feed: case.line.map(|line| {
                let stations = case.stations().map_or(0, |stations| stations.count);
                (line.steps_per_element, fibre.rest_length().to_bits(), stations)
            }),
            steps_between_looks: if case.line.is_none() && air.is_uniform() {
                0
            } else {
                case.steps_between_looks()
            },
        }
    }

    /// Refuses a fibre that differs from the first one in any of these settings.
    pub(super) fn check(&self, other: &Self, lane: usize) -> Result<(), FlightFault> {
        let same = [
            ("the number of elements (fibre.length, fibre.element_length)", self.elements == other.elements),
            (
                "which element lies in which eddy (air.length_scale, air.eddies)",
                self.eddy_of_element == other.eddy_of_element,
            ),
            ("run.time_step", self.time_step == other.time_step),
            ("run.duration", self.steps == other.steps),
            ("run.spin_up", self.spin_up_steps == other.spin_up_steps),
            ("run.output_interval", self.output_steps == other.output_steps),
            ("run.scheme", self.scheme == other.scheme),
            ("whether there is run.damping", self.damped == other.damped),
            ("the kind of drag.along or drag.across", self.drag_curves == other.drag_curves),
            ("air.cutoff_frequency", self.cutoff_frequency == other.cutoff_frequency),
            ("air.harmonics", self.harmonics == other.harmonics),
            ("air.record", self.records == other.records),
            (
                "how the fibre is fed (feed.speed, belt.distance, fibre.element_length, and the air's stations between inlet and belt)",
                self.feed == other.feed,
            ),
            (
                "how often the flow around the fibre is looked up (air.length_scale, air.velocity, or a flow that is not uniform)",
                self.steps_between_looks == other.steps_between_looks,
            ),
        ];
        FlightFault::unless_same(lane, &same)
    }
}
