//! Power spectrum of the free end's motion.

use super::{
    Declaration, Figure, Kind, Measure, Observation, Observer, SQUARE_MILLIMETRES_PER_HERTZ, Value, fixed,
};
use crate::case::Run;
use crate::flight::Flight;
use crate::lanes::WIDTH;
use crate::statistics::{Welch, Window};

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[
        SPECTRUM.observed("spectrum_y", "spectrum_y_m2_hz", "Spectrum of y").series("*y*"),
        SPECTRUM.observed("spectrum_z", "spectrum_z_m2_hz", "Spectrum of z").series("*z*"),
    ],
    applies: fixed,
    observer: |flight| Box::new(EndPositions::new(flight)),
};

const SPECTRUM: Measure = Measure {
    meaning: "one-sided power spectral density of the free end’s position at the recorded instants (Welch’s method)",
    unit: SQUARE_MILLIMETRES_PER_HERTZ,
    kind: Kind::Spectrum,
    figure: &Figure {
        name: "motion_spectrum",
        title: "Spectrum of the motion",
        words: "spectrum of the motion",
        logarithmic: true,
        from_zero: false,
        caption: "Power spectral density of the free end’s position, averaged over all replicates \
                  (Welch’s method). The area under a curve is the square of the amplitude.",
    },
    ..Measure::NUMBER
};

/// Most instants in a segment. A longer run has more segments, so that its spectrum is smoother.
const SEGMENT: usize = 1 << 12;

/// Spectra of y and z of the free ends at the recorded instants after the spin-up, of each fibre.
#[derive(Debug)]
struct EndPositions(Vec<[Welch; 2]>);

impl EndPositions {
    fn new(flight: &Flight) -> Self {
        let cases = (0..WIDTH).filter_map(|lane| flight.case(lane));
        // The fibres of a flight have one clock, and its window and factors take long to compute.
        let welch = flight.case(0).map(|case| welch(&case.run));
        Self(welch.iter().cycle().zip(cases).map(|(welch, _)| [welch.clone(), welch.clone()]).collect())
    }
}

/// Welch's method for a run, before any record.
fn welch(run: &Run) -> Welch {
    let samples = (run.steps.saturating_sub(run.spin_up_steps) / run.output_steps.max(1)) as usize + 1;
    let segment = Welch::segment_length(samples).min(SEGMENT);
    Welch::new(run.output_interval(), segment, Window::Hann, 0.5)
}

impl Observer for EndPositions {
    fn see(&mut self, observation: &Observation<'_>) {
        if let (true, Some(end)) = (observation.settled, observation.snapshot.position.last()) {
            for (lane, [y, z]) in self.0.iter_mut().enumerate() {
                y.push(end.y.0[lane], None);
                z.push(end.z.0[lane], None);
            }
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        let density = |record: &Welch| {
            let mut welch = record.clone();
            welch.end_record(None);
            let (frequency, density) = welch.finish().points().unzip();
            Value::Curve(frequency, density)
        };
        self.0[lane].iter().map(density).collect()
    }
}
