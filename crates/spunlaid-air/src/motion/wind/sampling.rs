//! What the winds of one flight have in common: when samples are made, and what they are made of.

use super::super::{Air, EddyTurbulence, FileContent, Measured};
use rand_chacha::ChaCha8Rng;
use spunlaid_ground::random::stream;
use spunlaid_ground::{Bits, Error, Fault, PerLane};
use std::cmp::Ordering;
use std::fmt;
use std::ops::Deref;

shared! {
    /// When the samples of a wind are made, of how many harmonics or of which records.
    pub struct Sampling {
        eddies: usize = "the number of eddies along the fibre",
        cutoff_frequency: Bits = "air.cutoff_frequency",
        harmonics: usize = "air.harmonics",
        records: Vec<Recording> = "air.record",
    }
}

impl Sampling {
    /// No wind is sampled in a field of eddies.
    pub fn none() -> Self {
        Self { eddies: 0, cutoff_frequency: Bits::from(0.0), harmonics: 0, records: Vec::new() }
    }

    /// * `eddies` – number of eddies along the fibre
    pub fn new(air: &Air, eddies: usize) -> Self {
        let records: Vec<_> = air.records.iter().cloned().map(Recording).collect();
        match records.is_empty() {
            true => Self {
                eddies,
                cutoff_frequency: air.cutoff_frequency.into(),
                harmonics: air.harmonics,
                records,
            },
            // No harmonics are drawn.
            false => Self { eddies, records, ..Self::none() },
        }
    }

    /// The same for another number of eddies.
    pub fn with_eddies(self, eddies: usize) -> Self {
        Self { eddies, ..self }
    }

    /// That of the fibres of a flight.
    pub(super) fn from_streams(streams: Vec<Stream>) -> Result<(Self, PerLane<Stream>), Error> {
        let streams = PerLane::new(streams)?;
        let sampling = streams.shared(|stream| Self::new(&stream.air, stream.eddies.len()))?;
        if sampling.eddies == 0 {
            return Err(Error::Flight(Fault::plain("turbulence needs at least one eddy")));
        }
        let makes_turbulence = (1..=1 << 30).contains(&sampling.harmonics) && sampling.repeat_time() > 0.0;
        if sampling.records.is_empty() && !makes_turbulence {
            return Err(Error::Flight(Fault::plain(
                "turbulence cannot be made: air.harmonics must be from 1 to 2^30 and air.cutoff_frequency above zero",
            )));
        }
        Ok((sampling, streams))
    }

    /// The time after which one sum of cosines repeats with the opposite sign [s].
    pub(super) fn repeat_time(&self) -> f64 {
        self.harmonics as f64 / self.cutoff_frequency.number()
    }
}

/// A record; two are equal if they are the same file, read in the same way.
#[derive(Clone)]
pub(crate) struct Recording(FileContent<Measured>);

impl Recording {
    fn identity(&self) -> impl Ord + fmt::Debug {
        let Measured { interval, integral_time, components, layout, says: _ } = &*self.0;
        let read = (layout.skip, layout.columns.clone(), layout.velocity_unit.clone());
        (self.0.checksum(), Bits::from(*interval), Bits::from(*integral_time), components.len(), read)
    }
}

impl fmt::Debug for Recording {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.identity().fmt(f)
    }
}

impl Deref for Recording {
    type Target = Measured;

    fn deref(&self) -> &Measured {
        &self.0
    }
}

impl Ord for Recording {
    fn cmp(&self, other: &Self) -> Ordering {
        self.identity().cmp(&other.identity())
    }
}

impl PartialOrd for Recording {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Recording {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Recording {}

/// The key of the random phases of a fibre. Equal keys give equal turbulence, bit for bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StreamKey {
    /// Master seed of the run.
    pub seed: u64,
    /// Index of the replicate.
    pub replicate: u64,
}

impl StreamKey {
    /// Random numbers of one velocity component of one eddy in one window of time.
    pub(super) fn stream(self, window: u64, eddy: u64, component: usize) -> ChaCha8Rng {
        stream([self.seed, self.replicate, eddy, component as u64 | window << 2])
    }
}

/// The source of the turbulence of one fibre.
#[derive(Clone, Debug)]
pub struct Stream {
    /// The air.
    pub air: Air,
    /// The turbulence of each eddy, see [`Air::turbulence_along`].
    pub eddies: Vec<EddyTurbulence>,
    /// The key of its random phases.
    pub key: StreamKey,
}

impl Stream {
    /// The streams of a uniform flow, whose eddies are all alike and independent.
    pub fn uniform(lanes: &[(Air, StreamKey)], eddies: usize) -> Vec<Self> {
        let stream = |(air, key): &(Air, StreamKey)| Self {
            air: air.clone(),
            eddies: vec![air.turbulence_of_an_eddy(); eddies],
            key: *key,
        };
        lanes.iter().map(stream).collect()
    }
}
