//! The motion of the free end: amplitude, frequency and mean position from every step after the spin-up, its distance
//! from the axis of the flow, and the circle in which it stays.

use super::{Declaration, END_NODE, FibreMeasure, Observation, Observer, fixed};
use spunlaid_fibre::{Case, Flight, Run};
use spunlaid_ground::measure::figure;
use spunlaid_ground::statistics::quantile;
use spunlaid_ground::{
    EvenSample, Figure, HERTZ, MILLIMETRES, Measure, MeasureKind, SQUARE_MILLIMETRES_PER_HERTZ, Spectrum,
    Value, WIDTH, Welch, Window,
};

pub(super) const MOTION: Declaration = Declaration {
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

const NUMBER: FibreMeasure = Measure { group: END_NODE, ..Measure::NUMBER };

const AMPLITUDE: FibreMeasure = Measure {
    is_main: true,
    meaning: "standard deviation over time of the free end’s position",
    unit: MILLIMETRES,
    figure: &figure("amplitude", "Amplitude", "amplitude"),
    ..NUMBER
};

const FREQUENCY: FibreMeasure = Measure {
    is_main: true,
    meaning: "half the number of sign changes of its position in a second",
    unit: HERTZ,
    figure: &figure("frequency", "Frequency", "frequency"),
    ..NUMBER
};

const MEAN_X: FibreMeasure = Measure {
    name: "mean_x",
    is_main: true,
    column: "mean_x_m",
    label: "Mean position along the flow",
    meaning: "mean over time of the free end’s x; the smaller it is relative to the length of the fibre, \
         the more the fibre is bent",
    unit: MILLIMETRES,
    figure: &Figure { from_zero: false, ..figure("mean_x", "Mean position along the flow", "mean position") },
    series: "*x*",
    ..NUMBER
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

pub(super) const DEFLECTIONS: Declaration = Declaration {
    measures: &[
        DEFLECTION
            .observed("deflection_99", "deflection_99_m", "Deflection, 99 % of the time")
            .meaning(
                "distance from the axis through the root that is not exceeded at 99 % of the recorded \
                 instants",
            )
            .series("99 %"),
        DEFLECTION
            .observed("largest_deflection", "largest_deflection_m", "Largest deflection")
            .meaning("largest distance from the axis through the root; it grows with the duration")
            .series("largest"),
    ],
    applies: fixed,
    observer: |_| Box::new(Deflection::default()),
};

const DEFLECTION: FibreMeasure = Measure {
    unit: MILLIMETRES,
    figure: &figure("deflection", "Deflection of the free end", "deflection"),
    ..NUMBER
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

pub(super) const RESIDENCE: Declaration = Declaration {
    measures: &[Measure {
        name: "residence_radius",
        column: "residence_radius_m",
        label: "Radius with 90 % of the positions",
        meaning: "radius of the circle around its mean position, seen along the flow, in which it is at 90 % \
             of the recorded instants",
        unit: MILLIMETRES,
        figure: &figure(
            "residence",
            "Radius with 90 % of the positions",
            "radius with 90 % of the positions",
        ),
        series: "radius",
        ..NUMBER
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

pub(super) const SPECTRA: Declaration = Declaration {
    measures: &[
        SPECTRUM.observed("spectrum_y", "spectrum_y_m2_hz", "Spectrum of y").series("*y*"),
        SPECTRUM.observed("spectrum_z", "spectrum_z_m2_hz", "Spectrum of z").series("*z*"),
    ],
    applies: fixed,
    observer: |flight| Box::new(EndPositions::new(flight)),
};

const SPECTRUM: FibreMeasure = Measure {
    meaning: "one-sided power spectral density of its position (Welch’s method)",
    unit: SQUARE_MILLIMETRES_PER_HERTZ,
    kind: MeasureKind::Spectrum,
    figure: &Figure {
        logarithmic: true,
        from_zero: false,
        caption: "Power spectral density of the free end’s position, averaged over all replicates \
                  (Welch’s method). The area under a curve is the square of the amplitude.",
        ..figure("motion_spectrum", "Spectrum of the motion", "spectrum of the motion")
    },
    ..NUMBER
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
            let (frequency, density) = finished(record).points().unzip();
            Value::Curve(frequency, density)
        };
        self.0[lane].iter().map(density).collect()
    }
}

pub(super) const MEAN_FREQUENCY: Declaration = Declaration {
    measures: &[Measure {
        name: "mean_frequency",
        is_main: true,
        column: "mean_frequency_hz",
        label: "Mean frequency",
        meaning: "mean frequency of its spectra in y and z up to the cut-off of the turbulence, weighted by power. \
             Not defined in runs shorter than some periods of the cut-off, or recorded less than twice in such a \
             period",
        unit: HERTZ,
        figure: &figure("mean_frequency", "Mean frequency", "mean frequency"),
        series: "*y* and *z*",
        ..NUMBER
    }],
    applies: fixed,
    observer: |flight| {
        let cases = (0..WIDTH).filter_map(|lane| flight.case(lane));
        Box::new(MeanFrequency(cases.map(CoarseSpectra::new).collect()))
    },
};

/// Instants that are looked at in a period of the cut-off, and most instants in a segment: 64 periods. So the spectra
/// are as fine beside the turbulence in every run.
const IN_PERIOD: f64 = 4.0;
const COARSE_SEGMENT: usize = 256;

#[derive(Debug)]
struct MeanFrequency(Vec<CoarseSpectra>);

/// Spectra of y and z of a free end, of every so many recorded instants after the spin-up.
#[derive(Debug)]
struct CoarseSpectra {
    /// The highest frequency that counts; none without turbulence [Hz].
    cutoff: Option<f64>,
    every: u64,
    seen: u64,
    axes: [Welch; 2],
}

impl CoarseSpectra {
    fn new(case: &Case) -> Self {
        let run = &case.run;
        let interval = run.output_interval();
        let cutoff = Some(case.air.cutoff_frequency).filter(|_| case.air.rms() > 0.0);
        let every =
            cutoff.map_or(1.0, |cutoff| (1.0 / (IN_PERIOD * cutoff * interval) + 1e-9).floor().max(1.0));
        let instants = run.steps.saturating_sub(run.spin_up_steps) / run.output_steps.max(1);
        let samples = (instants / every as u64 + 1).clamp(2, COARSE_SEGMENT as u64);
        let welch = Welch::new(every * interval, 1 << samples.ilog2(), Window::Hann, 0.5);
        Self { cutoff, every: every as u64, seen: 0, axes: [welch.clone(), welch] }
    }
}

impl Observer for MeanFrequency {
    fn see(&mut self, observation: &Observation<'_>) {
        let Some(end) = observation.snapshot.position.last().filter(|_| observation.settled) else { return };
        for (lane, spectra) in self.0.iter_mut().enumerate() {
            if spectra.seen.is_multiple_of(spectra.every) {
                let [y, z] = &mut spectra.axes;
                y.push(end.y.0[lane], None);
                z.push(end.z.0[lane], None);
            }
            spectra.seen += 1;
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        let CoarseSpectra { cutoff, axes, .. } = &self.0[lane];
        vec![Value::Number(mean_frequency(axes.each_ref().map(finished), *cutoff))]
    }
}

/// The spectrum of a record that has come so far.
fn finished(welch: &Welch) -> Spectrum {
    let mut welch = welch.clone();
    welch.end_record(None);
    welch.finish()
}

/// The mean frequency of two spectra [Hz]; NaN where they end below the cut-off [Hz].
fn mean_frequency(spectra: [Spectrum; 2], cutoff: Option<f64>) -> f64 {
    let within = |point: &(f64, f64)| cutoff.is_none_or(|cutoff| point.0 <= cutoff);
    let add = |(sum, all): (f64, f64), (frequency, density)| (sum + frequency * density, all + density);
    let points = spectra.iter().flat_map(Spectrum::points);
    let (sum, all) = points.filter(within).fold((0.0, 0.0), add);
    if cutoff.is_some_and(|cutoff| cutoff > spectra[0].highest()) { f64::NAN } else { sum / all }
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

#[cfg(test)]
mod frequency_tests {
    use super::*;
    use std::f64::consts::PI;

    /// Sines of 8 and 32 Hz, the second of a third of the amplitude: a tenth of the square of the amplitude is its.
    #[test]
    fn analytic_mean_frequency_of_two_sines() {
        let spectrum = |cutoff: Option<f64>| {
            let sine = |i: usize, frequency: f64| (2.0 * PI * frequency * i as f64 / 256.0).sin();
            let welch = || {
                let mut welch = Welch::new(1.0 / 256.0, 512, Window::Hann, 0.5);
                (0..1024).for_each(|i| welch.push(sine(i, 8.0) + sine(i, 32.0) / 3.0, None));
                welch.end_record(None);
                welch.finish()
            };
            mean_frequency([welch(), welch()], cutoff)
        };
        // The lines are symmetric about their frequencies.
        assert!((spectrum(None) - (0.9 * 8.0 + 0.1 * 32.0)).abs() < 1e-9, "{}", spectrum(None));
        assert!((spectrum(Some(20.0)) - 8.0).abs() < 1e-6, "{}", spectrum(Some(20.0)));
        assert!(spectrum(Some(129.0)).is_nan());
    }
}

#[cfg(test)]
mod residence_tests {
    use super::radius;

    #[test]
    fn analytic_circle_of_a_uniform_disc() {
        // In a disc of radius R, 90 % of the area is within R √0.9.
        let spiral = |i: u32| {
            let r = (f64::from(i) / 20_000.0).sqrt();
            let angle = 2.399_963 * f64::from(i);
            (5.0 + r * angle.cos(), -2.0 + r * angle.sin())
        };
        let places: Vec<_> = (0..20_000).map(spiral).collect();
        assert!((radius(&places) - 0.9f64.sqrt()).abs() < 1e-3);
    }
}
