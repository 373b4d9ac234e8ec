//! What is recorded of fibres while they fly, so that no flight has to keep it.

use super::Shapes;
use crate::error::Error;
use crate::flight::LaidPoint;
use crate::observe::Sample;
use crate::threads::lock;
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard};

/// Takes what is recorded of the fibres of a case, some instants at a time.
///
/// Flights on several threads call it at the same time; the calls for one fibre come in the order of time.
pub trait Recorder: std::fmt::Debug + Sync {
    /// A fibre begins to fly. What was recorded of it before has to be forgotten: it flew beside a fibre that
    /// was lost, and flies again without it.
    fn begin(&self, replicate: u64);

    /// Receives the next recorded instants of a fibre, the start included.
    ///
    /// # Errors
    /// An error ends the flight.
    fn samples(&self, replicate: u64, samples: &[Sample]) -> Result<(), Error>;

    /// Receives the next points that a fed fibre has laid on the belt, in the order in which they were fed.
    ///
    /// # Errors
    /// An error ends the flight.
    fn lay(&self, replicate: u64, points: &[LaidPoint]) -> Result<(), Error>;

    /// Says where the shapes of a fibre are kept that begins to fly: in memory, or in a file.
    ///
    /// # Errors
    /// There is no such file.
    fn shapes(&self, replicate: u64) -> Result<Shapes, Error> {
        let _ = replicate;
        Ok(Shapes::default())
    }
}

/// Keeps in memory what the fed fibres of a case lay, for those who want it there.
#[derive(Debug, Default)]
pub struct LaidCurves(Mutex<BTreeMap<u64, Vec<LaidPoint>>>);

impl LaidCurves {
    /// Hands over the points of a replicate, in the order of feed; none if it has laid nothing.
    pub fn take(&self, replicate: u64) -> Vec<LaidPoint> {
        self.curves().remove(&replicate).unwrap_or_default()
    }

    fn curves(&self) -> MutexGuard<'_, BTreeMap<u64, Vec<LaidPoint>>> {
        lock(&self.0)
    }
}

impl Recorder for LaidCurves {
    fn begin(&self, replicate: u64) {
        self.curves().remove(&replicate);
    }

    fn samples(&self, _: u64, _: &[Sample]) -> Result<(), Error> {
        Ok(())
    }

    fn lay(&self, replicate: u64, points: &[LaidPoint]) -> Result<(), Error> {
        self.curves().entry(replicate).or_default().extend_from_slice(points);
        Ok(())
    }
}
