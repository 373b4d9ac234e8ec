//! The source of the turbulence of a fibre.

use super::super::{Air, EddyTurbulence};
use crate::random::stream;
use rand_chacha::ChaCha8Rng;

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
