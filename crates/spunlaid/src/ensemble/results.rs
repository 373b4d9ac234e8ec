//! What an ensemble amounts to.

use super::Trajectory;
use crate::case::Case;
use crate::observe::NodeSpread;
use crate::statistics::{Estimate, Welch, Window, median};

/// Results of an ensemble, taken in flight by flight: memory does not grow with the flights' records.
#[derive(Clone, Debug)]
pub struct Results {
    /// Motion of the end node.
    pub end_node: EndNodeResults,
    /// The paper's work check [%].                                            theory.md (35)
    pub work_error_percent: LedgerError,
    /// The full energy balance, relative to the work of the air [%].          theory.md (36)
    pub balance_error_percent: LedgerError,
    /// What the implicit tension has dissipated, relative to the work of the air [%]; zero with the
    /// explicit schemes.
    pub tension_dissipation_percent: LedgerError,
    /// Largest strain of any element at any recorded instant [-].
    pub max_strain: f64,
    /// Share of the time that the fibres' elements have spent outside of what the flow knows, mean over the
    /// replicates [-]; none where the air is the same everywhere.
    pub outside: Option<f64>,
    /// Motion of the `N+1` nodes.
    pub nodes: Vec<NodeResults>,
    /// Both energy errors at the recorded instants.
    pub errors: Vec<ErrorOverTime>,
    /// Power spectral densities of the end node's y and z [m²/Hz] at frequencies [Hz], after the spin-up.
    pub motion_spectrum: Vec<(f64, f64, f64)>,
    /// The first flights, whole; see [`Results::collector`].
    pub flights: Vec<Trajectory>,
}

/// Motion of the end node over the replicates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EndNodeResults {
    /// Standard deviation over time of y [m].
    pub amplitude_y: Estimate,
    /// Standard deviation over time of z [m].
    pub amplitude_z: Estimate,
    /// Crossing frequency of y [Hz].
    pub frequency_y: Estimate,
    /// Crossing frequency of z [Hz].
    pub frequency_z: Estimate,
    /// Mean over time of x [m].
    pub mean_x: Estimate,
}

/// An energy error of an ensemble [%].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LedgerError {
    /// At the end, mean over the replicates.
    pub final_mean: f64,
    /// Median over time of each replicate, median of those.
    pub time_median: f64,
}

/// Motion of a node, mean and standard error over the replicates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NodeResults {
    /// Distance from the root along the fibre [m].
    pub distance: f64,
    /// Mean and standard error of the standard deviation of y [m]; no error from a single replicate.
    pub amplitude_y: (f64, Option<f64>),
    /// Mean and standard error of the standard deviation of z [m].
    pub amplitude_z: (f64, Option<f64>),
}

/// Energy errors over the replicates at one instant [%]; NaN while undefined.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ErrorOverTime {
    /// Time [s].
    pub time: f64,
    /// Mean and largest of the work check.
    pub work: (f64, f64),
    /// Mean and largest of the energy balance.
    pub balance: (f64, f64),
}

/// An energy error over the replicates at one instant: how many defined, their sum, the largest.
type ErrorSums = (f64, f64, f64);

/// Takes in the flights of an ensemble in order; [`Collector::finish`] gives the [`Results`].
#[derive(Clone, Debug)]
pub struct Collector {
    keep: usize,
    spin_up: f64,
    rest_length: f64,
    /// Per replicate: amplitude y, z, frequency y, z, mean x.
    end_node: [Vec<f64>; 5],
    /// Per replicate, work check, balance and dissipation: final value and median over time.
    finals: [Vec<f64>; 3],
    medians: [Vec<f64>; 3],
    max_strain: f64,
    outside: Option<f64>,
    /// Per node, y and z: running mean and sum of squares over the replicates.
    nodes: Vec<[(f64, f64); 2]>,
    /// Per instant: time, and of both errors count, sum and largest.
    errors: Vec<(f64, [ErrorSums; 2])>,
    spectra: [Welch; 2],
    flights: Vec<Trajectory>,
}

impl Results {
    /// Ready to take in the flights of a case.
    ///
    /// * `keep` – how many of the first flights to keep whole
    pub fn collector(case: &Case, keep: usize) -> Collector {
        let run = &case.run;
        let samples = ((run.steps - run.spin_up_steps) / run.output_steps) as usize + 1;
        let segment = Welch::segment_length(samples);
        let spectrum = Welch::new(run.output_interval(), segment, Window::Hann, 0.5);
        Collector {
            keep,
            spin_up: run.spin_up(),
            rest_length: case.fibre.rest_length(),
            end_node: Default::default(),
            finals: Default::default(),
            medians: Default::default(),
            max_strain: 0.0,
            outside: None,
            nodes: vec![Default::default(); case.fibre.elements + 1],
            errors: Vec::new(),
            spectra: [spectrum.clone(), spectrum],
            flights: Vec::new(),
        }
    }
}

impl Collector {
    /// Takes in one more flight.
    pub fn take(&mut self, flight: &Trajectory) {
        let motion = &flight.end_node;
        let values =
            [motion.amplitude_y, motion.amplitude_z, motion.frequency_y, motion.frequency_z, motion.mean.x];
        for (all, value) in self.end_node.iter_mut().zip(values) {
            all.push(value);
        }
        self.max_strain = self.max_strain.max(flight.max_strain);
        if let Some(outside) = flight.outside {
            *self.outside.get_or_insert(0.0) += outside;
        }
        self.take_nodes(&flight.nodes);
        self.take_errors(flight);
        let flown = |axis: fn(&super::Sample) -> f64| -> Vec<f64> {
            flight.samples.iter().filter(|s| s.time >= self.spin_up).map(axis).collect()
        };
        let (y, z) = (flown(|s| s.end.y), flown(|s| s.end.z));
        self.spectra[0].add(&y, None);
        self.spectra[1].add(&z, None);
        if self.flights.len() < self.keep {
            self.flights.push(flight.clone());
        }
    }

    fn take_nodes(&mut self, nodes: &[NodeSpread]) {
        let count = self.end_node[0].len() as f64;
        for (sums, node) in self.nodes.iter_mut().zip(nodes) {
            for ((mean, squares), value) in sums.iter_mut().zip([node.amplitude_y, node.amplitude_z]) {
                let off = value - *mean;
                *mean += off / count;
                *squares += off * (value - *mean);
            }
        }
    }

    fn take_errors(&mut self, flight: &Trajectory) {
        self.errors.resize(flight.samples.len(), Default::default());
        let mut over_time = [Vec::new(), Vec::new(), Vec::new()];
        for ((time, sums), sample) in self.errors.iter_mut().zip(&flight.samples) {
            *time = sample.time;
            let errors = [sample.work_error_percent(), sample.balance_error_percent()];
            over_time[2].push(sample.tension_dissipation_percent());
            for ((error, over_time), (count, sum, largest)) in
                errors.into_iter().zip(&mut over_time).zip(sums)
            {
                over_time.push(error);
                if error.is_finite() {
                    *count += 1.0;
                    *sum += error;
                    *largest = largest.max(error);
                }
            }
        }
        for ((errors, finals), medians) in over_time.iter().zip(&mut self.finals).zip(&mut self.medians) {
            finals.push(errors.last().copied().unwrap_or(f64::NAN));
            medians.push(median(errors));
        }
    }

    /// The results over all flights taken in.
    pub fn finish(self) -> Results {
        let n = self.end_node[0].len() as f64;
        let [amplitude_y, amplitude_z, frequency_y, frequency_z, mean_x] = self.end_node.map(Estimate::of);
        let ledger = |i: usize| LedgerError {
            final_mean: mean_of_finite(&self.finals[i]),
            time_median: median(&self.medians[i]),
        };
        let estimate =
            |(mean, squares): (f64, f64)| (mean, (n > 1.0).then(|| (squares / (n - 1.0) / n).sqrt()));
        let nodes = self.nodes.iter().enumerate().map(|(i, &[y, z])| NodeResults {
            distance: i as f64 * self.rest_length,
            amplitude_y: estimate(y),
            amplitude_z: estimate(z),
        });
        let errors = self.errors.iter().map(|&(time, [work, balance])| {
            let of = |(count, sum, largest): ErrorSums| {
                if count > 0.0 { (sum / count, largest) } else { (f64::NAN, f64::NAN) }
            };
            ErrorOverTime { time, work: of(work), balance: of(balance) }
        });
        let [y, z] = self.spectra.map(Welch::finish);
        Results {
            end_node: EndNodeResults { amplitude_y, amplitude_z, frequency_y, frequency_z, mean_x },
            work_error_percent: ledger(0),
            balance_error_percent: ledger(1),
            tension_dissipation_percent: ledger(2),
            max_strain: self.max_strain,
            outside: self.outside.map(|sum| sum / n),
            nodes: nodes.collect(),
            errors: errors.collect(),
            motion_spectrum: y.points().zip(z.density).map(|((f, py), pz)| (f, py, pz)).collect(),
            flights: self.flights,
        }
    }
}

fn mean_of_finite(values: &[f64]) -> f64 {
    let finite: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    finite.iter().sum::<f64>() / finite.len() as f64
}
