//! The results of a trajectory that a study keeps.

use crate::ensemble::Trajectory;
use crate::observe::{MEASURES, Measure, NUMBERS};

/// The numbers measured on one fibre, in the order of [`MEASURES`], in SI units and percent. NaN means that a
/// measure does not apply to the case.
pub type Measured = [f64; NUMBERS];

/// The outcome of one replicate of one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// Index of the point.
    pub point: u64,
    /// Index of the replicate.
    pub replicate: u64,
    /// The outcome.
    pub landing: Landing,
}

/// How a flight ended.
#[derive(Clone, Copy, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "nearly all flights are measured, and records are copied as they are"
)]
pub enum Landing {
    /// The flight was completed and measured.
    Measured(Measured),
    /// The positions became infinite or NaN.
    Lost {
        /// Node, counted from 1 at the root.
        node: u64,
        /// Time [s].
        time: f64,
    },
}

/// Compares bits, so that NaN equals NaN.
impl PartialEq for Landing {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Measured(a), Self::Measured(b)) => {
                a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
            }
            (Self::Lost { node: a, time: t }, Self::Lost { node: b, time: u }) => {
                a == b && t.to_bits() == u.to_bits()
            }
            _ => false,
        }
    }
}

impl Landing {
    /// The results of a completed flight.
    pub fn measured(&self) -> Option<&Measured> {
        match self {
            Self::Measured(measured) => Some(measured),
            Self::Lost { .. } => None,
        }
    }
}

/// A measure with its index into the [`MEASURES`]. None without a measure of this name.
pub fn measure(name: &str) -> Option<(usize, &'static Measure)> {
    MEASURES.into_iter().enumerate().find(|(_, measure)| measure.name == name)
}

/// The numbers of a trajectory.
pub fn measured(trajectory: &Trajectory) -> Measured {
    MEASURES.map(|measure| trajectory.number(measure.name))
}
