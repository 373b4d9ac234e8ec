//! What a study keeps of a trajectory.

use crate::ensemble::Trajectory;
use crate::observe::{MEASURES, NUMBERS};

/// The numbers measured of one fibre, in the order of [`MEASURES`]; NaN where one does not apply. SI units and
/// percent.
pub type Measured = [f64; NUMBERS];

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
#[derive(Clone, Copy, Debug)]
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

/// To the bit: a measure that does not apply is NaN, and like itself.
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
    /// What was measured, if anything.
    pub fn measured(&self) -> Option<&Measured> {
        match self {
            Self::Measured(measured) => Some(measured),
            Self::Lost { .. } => None,
        }
    }
}

/// The numbers of a trajectory.
pub fn measured(trajectory: &Trajectory) -> Measured {
    MEASURES.map(|measure| trajectory.number(measure.name))
}
