//! Statistics of the fibres while they fly, since the last change.

use super::fibres::Instant;
use super::laid::{LaidStatistics, ShownNumber};
use serde::Serialize;
use spunlaid::fibre::{Case, EndNodeMotion, Flight};
use spunlaid::ground::{Value, WIDTH, Welch, Window};
use spunlaid::simulation::observe::Sample;
use spunlaid::simulation::{DECLARED, Observation, Observer};
use std::array::from_fn;

/// Time after a change that the statistics of a fibre of fixed length leave out, if the case has no longer spin-up [s].
const SETTLING: f64 = 0.5;
/// Samples in a segment of the spectrum.
const SEGMENT: usize = 512;

/// Statistics since the last change.
#[derive(Debug)]
pub(super) struct Statistics {
    /// From this time of the flight on [s].
    from: f64,
    /// Time over which they are taken so far [s].
    duration: f64,
    /// Whether they have begun.
    begun: bool,
    motion: Motion,
}

#[derive(Debug)]
enum Motion {
    Fixed(Box<FixedFibreMeasures>),
    Fed(Box<LaidStatistics>),
}

/// Of fibres of fixed length.
#[derive(Debug)]
struct FixedFibreMeasures {
    along: Option<Box<dyn Observer>>,
    /// The last positions of each free end in y and z [m], one segment at most.
    recent: [[Vec<f64>; 2]; WIDTH],
    spectrum: [Welch; 2],
}

/// The statistics as a page gets them.
#[derive(Debug, Serialize)]
#[serde(tag = "is", rename = "measured")]
pub(super) struct StatisticsMessage {
    pub(super) generation: u32,
    /// Time over which they were taken [s].
    duration: f64,
    /// Time that is still left out [s].
    settling: f64,
    numbers: Vec<ShownNumber>,
    curves: Option<Curves>,
    footprint: Option<super::laid::Map>,
}

/// Curves, averaged over the fibres.
#[derive(Debug, Serialize)]
struct Curves {
    /// Distance from the root [mm]; amplitudes in y and z there [mm].
    along: [Vec<f64>; 3],
    /// Frequency [Hz]; spectra of y and z [mm²/Hz].
    spectrum: [Vec<f64>; 3],
}

impl Statistics {
    /// Statistics of a case from now on, as soon as what was before is forgotten.
    ///
    /// * `flight` – of that case
    pub(super) fn new(case: &Case, flight: &Flight) -> Self {
        let spin_up = case.run.spin_up();
        let settling = match case.line {
            Some(line) => spin_up.max(4.0 * line.distance / line.feed_speed),
            None => spin_up.max(SETTLING),
        };
        let motion = match LaidStatistics::new(case) {
            Some(statistics) => Motion::Fed(Box::new(statistics)),
            None => Motion::Fixed(Box::new(FixedFibreMeasures::new(case, flight))),
        };
        Self { from: flight.time() + settling, duration: 0.0, begun: false, motion }
    }

    /// Sees a recorded instant.
    pub(super) fn see(&mut self, instant: Instant<'_>) {
        let now = instant.snapshot.time;
        if now < self.from {
            return;
        }
        if !self.begun {
            self.begun = true;
            // The flight is one step further.
            instant.flight.forget_statistics();
            return;
        }
        self.duration = now - self.from;
        match &mut self.motion {
            Motion::Fed(statistics) => statistics.see(&instant),
            Motion::Fixed(swinging) => swinging.see(&instant),
        }
    }

    /// What has been found so far.
    pub(super) fn message(&mut self, generation: u32, flight: &Flight) -> StatisticsMessage {
        let settling = (self.from - flight.time()).max(0.0);
        let mut message = StatisticsMessage {
            generation,
            duration: self.duration,
            settling,
            numbers: Vec::new(),
            curves: None,
            footprint: None,
        };
        match &mut self.motion {
            Motion::Fed(statistics) => {
                message.numbers = statistics.numbers();
                message.footprint = statistics.map();
            }
            Motion::Fixed(swinging) => {
                // The flight is beyond the last recorded instant.
                let duration = if self.begun { flight.time() - self.from } else { 0.0 };
                message.numbers = numbers(flight, duration);
                message.curves = (self.duration > 0.0).then(|| swinging.curves(flight));
            }
        }
        message
    }
}

impl FixedFibreMeasures {
    fn new(case: &Case, flight: &Flight) -> Self {
        let observer =
            DECLARED.iter().find(|d| d.measures.iter().any(|m| m.name == "amplitude_y_along_fibre"));
        let welch = Welch::new(case.run.output_interval(), SEGMENT, Window::Hann, 0.5);
        Self {
            along: observer.map(|found| (found.observer)(flight)),
            recent: from_fn(|_| Default::default()),
            spectrum: [welch.clone(), welch],
        }
    }

    fn see(&mut self, instant: &Instant<'_>) {
        let samples = [Sample::default(); WIDTH];
        let observation =
            Observation { snapshot: instant.snapshot, samples: &samples, settled: true, laid: instant.laid };
        if let Some(along) = &mut self.along {
            along.see(&observation);
        }
        let Some(end) = instant.snapshot.position.last() else {
            return;
        };
        for (lane, recent) in self.recent.iter_mut().enumerate() {
            for ((values, x), welch) in recent.iter_mut().zip([end.y, end.z]).zip(&mut self.spectrum) {
                values.push(x.0[lane]);
                if values.len() == SEGMENT {
                    welch.add(values, None);
                    values.drain(..SEGMENT / 2);
                }
            }
        }
    }

    fn curves(&self, flight: &Flight) -> Curves {
        let mut along = [Vec::new(), Vec::new(), Vec::new()];
        for lane in 0..WIDTH {
            let values = self.along.as_ref().map(|along| along.finish(lane, flight)).unwrap_or_default();
            for (axis, value) in values.into_iter().enumerate() {
                if let Value::Curve(distance, values) = value {
                    along[0] = distance;
                    let mean = &mut along[axis + 1];
                    mean.resize(values.len(), 0.0);
                    mean.iter_mut().zip(values).for_each(|(sum, value)| *sum += value / WIDTH as f64);
                }
            }
        }
        for curve in &mut along {
            curve.iter_mut().for_each(|x| *x *= 1e3);
        }
        let [y, z] = self.spectrum.each_ref().map(|welch| welch.clone().finish());
        let frequency = y.points().map(|(frequency, _)| frequency).collect();
        let density =
            |spectrum: &spunlaid::ground::Spectrum| spectrum.density.iter().map(|p| p * 1e6).collect();
        Curves { along, spectrum: [frequency, density(&y), density(&z)] }
    }
}

/// Amplitude and frequency of the free ends over a time, as a run of these eight fibres has them.
fn numbers(flight: &Flight, duration: f64) -> Vec<ShownNumber> {
    let motions: [_; WIDTH] = from_fn(|lane| flight.end_node().motion(lane, duration));
    let of_all = |name, of: fn(&EndNodeMotion) -> f64| {
        let known = if duration > 0.0 { motions.iter().map(of).collect() } else { Vec::new() };
        ShownNumber::of_fibres(name, known)
    };
    let all = [
        of_all("amplitude_y", |motion| motion.amplitude_y),
        of_all("amplitude_z", |motion| motion.amplitude_z),
        of_all("frequency_y", |motion| motion.frequency_y),
        of_all("frequency_z", |motion| motion.frequency_z),
    ];
    all.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::super::fibres::Fibres;
    use super::super::laid::measure;
    use super::*;
    use spunlaid::input::{read_case, starter_case};

    #[test]
    fn stat_amplitude_and_curves_agree_with_those_of_a_run() {
        use spunlaid::ground::{Error, Isa, RunContext};
        use spunlaid::simulation::ensemble::fly;
        use spunlaid::simulation::{Recorded, Results};
        use std::sync::atomic::{AtomicBool, AtomicU64};
        // The same flight over the same time: 0.5 s of settling, two seconds of statistics.
        let values = [
            ("fibre.element_length", "50 mm"),
            ("run.time_step", "200 µs"),
            ("run.duration", "2.5 s"),
            ("run.spin_up", "0.5 s"),
            ("run.replicates", "8"),
        ];
        let values = values.map(|(k, v)| (k.to_owned(), v.to_owned()));
        let (case, _) = read_case((starter_case(), "starter.toml"), &values).unwrap();
        let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
        let computing = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &steps };
        let mut results = Results::collector(0);
        fly::<Error>(&case, Recorded::NUMBERS, computing, |simulated| {
            results.take(simulated);
            Ok(())
        })
        .unwrap();
        let results = results.finish();

        let mut fibres = Fibres::new(case.clone()).unwrap();
        let mut measured = Statistics::new(&case, fibres.flight());
        fibres.fly(case.run.steps + 1, |instant| measured.see(instant)).unwrap();
        let message = measured.message(1, fibres.flight());
        assert!((message.duration - 2.0).abs() < 1e-9 && message.settling == 0.0);
        for number in &message.numbers {
            let run = results.estimate(number.name).mean * measure(number.name).unwrap().unit.per_si;
            // They begin a step later than those of the run, and end a step later.
            let tolerance = if number.name.starts_with("amplitude") { 1e-3 } else { 0.01 };
            assert!((number.value.unwrap() / run - 1.0).abs() < tolerance, "{number:?}: {run}");
            assert!(number.error.is_some_and(|e| e > 0.0 && e < 0.3 * run), "{number:?}");
        }
        let curves = message.curves.unwrap();
        let amplitude = message.numbers[0].value.unwrap();
        // The end of the curve is taken at recorded instants, the amplitude at all steps.
        assert!((curves.along[1].last().unwrap() / amplitude - 1.0).abs() < 0.01);
        let variance: f64 = curves.spectrum[1].iter().sum::<f64>() * curves.spectrum[0][0];
        // Each segment of 0.5 s has its own mean taken out, and weighs its middle most.
        assert!((variance.sqrt() / amplitude - 1.0).abs() < 0.2, "{} {amplitude}", variance.sqrt());
    }

    #[test]
    fn nothing_is_reported_before_the_fibres_have_settled() {
        let (case, _) = read_case((starter_case(), "starter.toml"), &[]).unwrap();
        let fibres = Fibres::new(case.clone()).unwrap();
        let message = Statistics::new(&case, fibres.flight()).message(1, fibres.flight());
        assert!(message.settling > 0.4 && message.curves.is_none() && message.numbers[0].value.is_none());
    }
}
