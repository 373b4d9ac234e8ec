//! The results of an ensemble.

use super::Trajectory;
use crate::observe::{FIBRE_ON_WAY, FORCE_ON_AIR, FibreMeasure};
use spunlaid_fibre::WayPlace;
use spunlaid_ground::statistics::median;
use spunlaid_ground::{Aggregate, Error, Estimate, Value};

/// Results of an ensemble. They are collected trajectory by trajectory, so that memory does not grow with the
/// replicates.
#[derive(Clone, Debug)]
pub struct Results {
    /// The measures that are numbers, in the order of their declarations.
    pub numbers: Vec<Number>,
    /// The measures that are curves, in the order of their declarations; empty if curves were not measured.
    pub curves: Vec<Curve>,
    /// The first trajectories, whole; see [`Results::collector`].
    pub trajectories: Vec<Trajectory>,
    /// The fibres that were lost. They are in no mean.
    pub lost: Vec<LostFibre>,
}

/// A fibre that was lost: its computation has diverged, or it does not come down.
#[derive(Clone, Debug, PartialEq)]
pub struct LostFibre {
    /// Number of the replicate in its case, from 0.
    pub replicate: u64,
    /// When it was lost [s].
    pub time: f64,
    /// Why, in a sentence that names the replicate, and what to do.
    pub reason: String,
}

impl LostFibre {
    /// * `error` – why it was lost
    pub(crate) fn new(replicate: u64, error: &Error) -> Self {
        let time = error.lost_fibre().map_or(f64::NAN, |(_, time)| time);
        Self { replicate, time, reason: error.to_string() }
    }
}

/// A measure that is a number, over the replicates.
#[derive(Clone, Debug)]
pub struct Number {
    /// Which measure.
    pub measure: &'static FibreMeasure,
    /// Mean and standard error over the replicates for which the measure is defined, and the values of all
    /// replicates in their order, NaN if not defined or if the fibre was lost. SI units.
    pub estimate: Estimate,
}

impl Number {
    /// The value that stands for all replicates: mean, median or largest, as the measure declares.
    pub fn value(&self) -> f64 {
        let values = &self.estimate.values;
        match self.measure.aggregate {
            Aggregate::Mean => self.estimate.mean,
            Aggregate::Median => median(values),
            Aggregate::Largest => values.iter().copied().fold(f64::NAN, f64::max),
        }
    }
}

/// A measure that is a curve, over the replicates.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Which measure.
    pub measure: &'static FibreMeasure,
    /// Its places along the fibre, times or frequencies, in their order.
    pub places: Vec<CurveValue>,
}

/// A point of a curve, in SI units; NaN if the measure is defined for no replicate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CurveValue {
    /// Distance from the root [m], time [s] or frequency [Hz].
    pub at: f64,
    /// Mean over the replicates.
    pub mean: f64,
    /// Standard error of the mean; `None` for a single replicate.
    pub standard_error: Option<f64>,
    /// The largest value of any replicate.
    pub largest: f64,
}

/// Collects the trajectories of an ensemble in order; [`Collector::finish`] returns the [`Results`].
#[derive(Clone, Debug, Default)]
pub struct Collector {
    keep: usize,
    /// The values of the numbers, and the places and sums of the curves.
    numbers: Vec<(&'static FibreMeasure, Vec<f64>)>,
    curves: Vec<(&'static FibreMeasure, Vec<f64>, Vec<RunningMoments>)>,
    trajectories: Vec<Trajectory>,
    lost: Vec<LostFibre>,
}

/// Running mean and sum of squares over the replicates (Welford), and the largest.
#[derive(Clone, Copy, Debug)]
struct RunningMoments {
    count: f64,
    mean: f64,
    squares: f64,
    largest: f64,
}

impl RunningMoments {
    const NONE: Self = Self { count: 0.0, mean: 0.0, squares: 0.0, largest: f64::NAN };

    fn add(&mut self, value: f64) {
        if !value.is_finite() {
            return;
        }
        self.count += 1.0;
        let off = value - self.mean;
        self.mean += off / self.count;
        self.squares += off * (value - self.mean);
        self.largest = self.largest.max(value);
    }

    fn at(self, place: f64) -> CurveValue {
        let Self { count, mean, squares, largest } = self;
        CurveValue {
            at: place,
            mean: if count > 0.0 { mean } else { f64::NAN },
            standard_error: (count > 1.0).then(|| (squares / (count - 1.0) / count).sqrt()),
            largest,
        }
    }
}

impl Results {
    /// A collector for the trajectories of one case.
    ///
    /// * `keep` – number of trajectories, from the first on, to store whole
    pub fn collector(keep: usize) -> Collector {
        Collector { keep, ..Collector::default() }
    }

    /// Number of replicates that were collected; fibres that were lost do not count.
    pub fn replicates(&self) -> usize {
        self.numbers.first().map_or(0, |number| number.estimate.values.len() - self.lost.len())
    }

    /// A number by its measure's name; `None` if it does not apply to the case.
    pub fn number(&self, name: &str) -> Option<&Number> {
        self.numbers.iter().find(|number| number.measure.name == name)
    }

    /// Mean and standard error of a number by its measure's name; NaN if there is none.
    pub fn estimate(&self, name: &str) -> Estimate {
        let nothing = || Estimate { mean: f64::NAN, standard_error: None, values: Vec::new() };
        self.number(name).map_or_else(nothing, |number| number.estimate.clone())
    }

    /// What a fed fibre does on its way, for the load on its air; empty if that was not measured.
    pub fn way(&self) -> Vec<WayPlace> {
        let places = self.curve(FORCE_ON_AIR).iter().zip(self.curve(FIBRE_ON_WAY));
        let place = |(force, fibre): (&CurveValue, &CurveValue)| WayPlace {
            distance: force.at,
            force: force.mean,
            standard_error: force.standard_error,
            fibre: fibre.mean,
        };
        places.map(place).collect()
    }

    /// A curve by its measure's name; empty if there is none.
    pub fn curve(&self, name: &str) -> &[CurveValue] {
        self.curves.iter().find(|curve| curve.measure.name == name).map_or(&[], |curve| &curve.places)
    }
}

impl Collector {
    /// Adds one more trajectory.
    pub fn take(&mut self, trajectory: Trajectory) {
        if self.numbers.is_empty() && self.curves.is_empty() {
            for (measure, value) in &trajectory.values {
                match value {
                    Value::Curve(places, _) => {
                        self.curves.push((measure, places.clone(), vec![RunningMoments::NONE; places.len()]));
                    }
                    _ => self.numbers.push((measure, Vec::new())),
                }
            }
        }
        let mut numbers = self.numbers.iter_mut();
        let mut curves = self.curves.iter_mut();
        for (_, value) in &trajectory.values {
            match value {
                Value::Curve(_, values) => curves.next().into_iter().for_each(|(.., sums)| {
                    sums.iter_mut().zip(values).for_each(|(sums, value)| sums.add(*value));
                }),
                number => numbers.next().into_iter().for_each(|(_, all)| all.push(number.number())),
            }
        }
        if self.trajectories.len() < self.keep {
            self.trajectories.push(trajectory);
        }
    }

    /// Adds a fibre that was lost, in its turn.
    pub fn lose(&mut self, fibre: LostFibre) {
        self.lost.push(fibre);
    }

    /// The results of all trajectories.
    pub fn finish(self) -> Results {
        let lost = self.lost;
        let with_gaps = |mut values: Vec<f64>| {
            lost.iter()
                .for_each(|fibre| values.insert((fibre.replicate as usize).min(values.len()), f64::NAN));
            values
        };
        let numbers = self.numbers.into_iter();
        let curves = self.curves.into_iter().map(|(measure, places, sums)| {
            let places = places.into_iter().zip(sums).map(|(place, sums)| sums.at(place)).collect();
            Curve { measure, places }
        });
        Results {
            numbers: numbers
                .map(|(measure, values)| Number { measure, estimate: estimate_finite(with_gaps(values)) })
                .collect(),
            curves: curves.collect(),
            trajectories: self.trajectories,
            lost,
        }
    }
}

/// Mean and standard error of the finite values, together with all values.
fn estimate_finite(values: Vec<f64>) -> Estimate {
    let defined = values.iter().copied().filter(|value| value.is_finite()).collect();
    Estimate { values, ..Estimate::new(defined) }
}
