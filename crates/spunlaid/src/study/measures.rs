//! What a study keeps of a flight.

use crate::ensemble::{Sample, Trajectory};
use crate::statistics::median;

/// Something measured of every fibre.
#[derive(Clone, Copy, Debug)]
pub struct Measure {
    /// Name in a study file, `amplitude_y`.
    pub name: &'static str,
    /// Name in tables, with its unit: `amplitude_y_m`.
    pub column: &'static str,
    /// What it is.
    pub meaning: &'static str,
    of: fn(&Trajectory) -> f64,
}

const fn measure(
    name: &'static str,
    column: &'static str,
    meaning: &'static str,
    of: fn(&Trajectory) -> f64,
) -> Measure {
    Measure { name, column, meaning, of }
}

/// Number of measures.
const COUNT: usize = 8;

/// All of them, in the order of the tables.
pub const MEASURES: [Measure; COUNT] = [
    measure("amplitude_y", "amplitude_y_m", "standard deviation over time of the free end’s y", |f| {
        f.end_node.amplitude_y
    }),
    measure("amplitude_z", "amplitude_z_m", "standard deviation over time of the free end’s z", |f| {
        f.end_node.amplitude_z
    }),
    measure("frequency_y", "frequency_y_hz", "half the sign changes of the free end’s y per second", |f| {
        f.end_node.frequency_y
    }),
    measure("frequency_z", "frequency_z_hz", "half the sign changes of the free end’s z per second", |f| {
        f.end_node.frequency_z
    }),
    measure("mean_x", "mean_x_m", "mean over time of the free end’s x", |f| f.end_node.mean.x),
    measure("work_error", "work_error_percent", "the paper’s work check, median over time", |f| {
        over_time(f, Sample::work_error_percent)
    }),
    measure("balance_error", "balance_error_percent", "the full energy balance, median over time", |f| {
        over_time(f, Sample::balance_error_percent)
    }),
    measure("max_strain", "max_strain", "largest strain of an element at the recorded instants", |f| {
        f.max_strain
    }),
];

fn over_time(flight: &Trajectory, of: fn(&Sample) -> f64) -> f64 {
    median(&flight.samples.iter().map(of).collect::<Vec<_>>())
}

/// The [`MEASURES`] of one fibre, SI units and percent.
pub type Measured = [f64; COUNT];

/// What became of one replicate of one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// Index of the point.
    pub point: u64,
    /// Index of the replicate.
    pub replicate: u64,
    /// What became of it.
    pub landing: Landing,
}

/// How a flight ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Landing {
    /// With results.
    Measured(Measured),
    /// Its positions were no longer numbers.
    Lost {
        /// Node, counted from 1 at the root.
        node: u64,
        /// Time [s].
        time: f64,
    },
}

impl Landing {
    /// What was measured, if anything.
    pub fn measured(&self) -> Option<&Measured> {
        match self {
            Self::Measured(measured) => Some(measured),
            Self::Lost { .. } => None,
        }
    }
}

impl Measure {
    /// All measures of a flight.
    pub fn all(flight: &Trajectory) -> Measured {
        MEASURES.map(|measure| (measure.of)(flight))
    }
}
