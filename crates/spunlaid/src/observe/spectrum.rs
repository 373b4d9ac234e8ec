//! Power spectrum of the free end's motion.

use super::{Declaration, Figure, Kind, Measure, Observer, SQUARE_MILLIMETRES_PER_HERTZ, Seen, Value, fixed};
use crate::case::Case;
use crate::flight::Flight;
use crate::lanes::WIDTH;
use crate::statistics::{Welch, Window};

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[
        Measure {
            name: "spectrum_y",
            column: "spectrum_y_m2_hz",
            label: "Spectrum of y",
            series: "*y*",
            ..SPECTRUM
        },
        Measure {
            name: "spectrum_z",
            column: "spectrum_z_m2_hz",
            label: "Spectrum of z",
            series: "*z*",
            ..SPECTRUM
        },
    ],
    applies: fixed,
    observer: |case| Box::new(EndPositions::of(case)),
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

/// y and z of the free ends at the recorded instants after the spin-up [m].
#[derive(Debug)]
struct EndPositions {
    /// The method, before any record: made once for all fibres.
    welch: Welch,
    end: [[Vec<f64>; 2]; WIDTH],
}

impl EndPositions {
    fn of(case: &Case) -> Self {
        let run = &case.run;
        let samples = (run.steps.saturating_sub(run.spin_up_steps) / run.output_steps.max(1)) as usize + 1;
        let segment = Welch::segment_length(samples);
        let welch = Welch::new(run.output_interval(), segment, Window::Hann, 0.5);
        Self { welch, end: Default::default() }
    }
}

impl Observer for EndPositions {
    fn see(&mut self, seen: &Seen<'_>) {
        if let (true, Some(end)) = (seen.settled, seen.snapshot.position.last()) {
            for (lane, [y, z]) in self.end.iter_mut().enumerate() {
                y.push(end.y.0[lane]);
                z.push(end.z.0[lane]);
            }
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        let density = |record: &Vec<f64>| {
            let mut welch = self.welch.clone();
            welch.add(record, None);
            let (frequency, density) = welch.finish().points().unzip();
            Value::Curve(frequency, density)
        };
        self.end[lane].iter().map(density).collect()
    }
}
