//! Studies: many cases that differ in what varies, each flown several times, and what follows from it.
//!
//! ```text
//! factors → design (rows of values) → points (a whole case each) → jobs (one replicate of one point)
//!   → pack (eight jobs to a bundle, across points) → journal (a record per fibre) → statistics per point → effects
//! ```
//!
//! A study is data: it may be read from a file (`input::read_study`) or made in code, [`Study::of_cases`].
//! [`run`] flies what its journal does not hold yet. Whatever the threads, the packing and the interruptions,
//! the records of a fibre are the same to the bit, and those of `ensemble::fly` for the same case.

mod design;
mod effects;
mod journal;
mod measures;
mod pack;
mod run;
mod sobol;

pub use crate::observe::MEASURES;
pub use design::{Design, Factor, Levels, Spacing};
pub use effects::{Effect, Ranking, rankings};
pub use journal::{Found, Header, Journal};
pub use measures::{Landing, Measured, Record, measured};
pub use pack::{Batch, fly_batches};
pub use run::{PointResults, Progress, results_of_point, run};

use crate::case::Case;
use crate::units::{Dimension, Expression};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A study: the points and how often each is flown.
#[derive(Clone, Debug)]
pub struct Study {
    /// What varies from point to point.
    pub factors: Vec<Factor>,
    /// What follows from it.
    pub links: Vec<Link>,
    /// How the factors are combined.
    pub design: Design,
    /// Master seed.
    pub seed: u64,
    /// Whether all points fly in turbulence of the same random phases.
    pub common_phases: bool,
    /// How often each point is flown.
    pub replicates: Replicates,
    /// The points.
    pub points: Vec<Point>,
}

/// A key that follows from others.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Full key, `air.cutoff_frequency`.
    pub key: &'static str,
    /// What it measures.
    pub dimension: Dimension,
    /// How it follows.
    pub expression: Expression,
}

/// A point of a study: a case with its own seed, fully described by data.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Values of the factors, then of the links, in SI units.
    pub values: Vec<f64>,
    /// The case; its seed is the point's own, its replicates the most that may be flown.
    pub case: Case,
}

/// How often a point is flown.
#[derive(Clone, Debug, PartialEq)]
pub struct Replicates {
    /// Times every point is flown.
    pub at_least: u64,
    /// Times no point is flown more often than.
    pub at_most: u64,
    /// Results, as indices into [`MEASURES`], and the fraction of its mean that the standard error of each
    /// must fall to, or else the point is flown more often.
    pub until: Vec<(usize, f64)>,
}

impl Replicates {
    /// As many for every point.
    pub const fn fixed(replicates: u64) -> Self {
        Self { at_least: replicates, at_most: replicates, until: Vec::new() }
    }
}

impl Study {
    /// A study of cases that have been made already. Their seeds are kept, their replicates replaced.
    pub fn of_cases(cases: impl IntoIterator<Item = Case>, replicates: Replicates) -> Self {
        let mut points: Vec<Point> =
            cases.into_iter().map(|case| Point { values: Vec::new(), case }).collect();
        for point in &mut points {
            point.case.run.replicates = replicates.at_most;
        }
        let seed = points.first().map_or(0, |point| point.case.run.seed);
        let common_phases = points.iter().all(|point| point.case.run.seed == seed);
        Self {
            factors: Vec::new(),
            links: Vec::new(),
            design: Design::Paired,
            seed,
            common_phases,
            replicates,
            points,
        }
    }

    /// Keys and dimensions of the points' values, in their order.
    pub fn inputs(&self) -> impl Iterator<Item = (&'static str, Dimension)> {
        let factors = self.factors.iter().map(|factor| (factor.key, factor.dimension));
        factors.chain(self.links.iter().map(|link| (link.key, link.dimension)))
    }

    /// Most fibres that are flown.
    pub fn most_fibres(&self) -> u64 {
        (self.points.len() as u64).saturating_mul(self.replicates.at_most)
    }
}

/// The seed of a point whose random phases are its own: drawn from a stream keyed by the study's seed and
/// the point's index, so that it depends on nothing else. Below 2⁵³, which every program reads exactly.
pub fn seed_of_point(seed: u64, point: u64) -> u64 {
    stream(seed, Use::PointSeed, point).next_u64() >> 11
}

/// What a random stream is for; no two uses share numbers.
#[derive(Clone, Copy, Debug)]
enum Use {
    PointSeed = 1,
    LatinHypercube = 2,
}

fn stream(seed: u64, purpose: Use, index: u64) -> ChaCha8Rng {
    let mut key = [0; 32];
    // The last word keeps these streams apart from those of the turbulence, which count components there.
    for (bytes, word) in key.chunks_exact_mut(8).zip([seed, index, purpose as u64, u64::MAX]) {
        bytes.copy_from_slice(&word.to_le_bytes());
    }
    ChaCha8Rng::from_seed(key)
}

impl Study {
    /// A checksum over all that the records of a study depend on: every point's whole case, and how often each
    /// is flown.
    pub fn identity(&self) -> u32 {
        let mut sum = crc32fast::Hasher::new();
        // As text, which holds every number to the last bit.
        let Self { factors, links, design, seed, common_phases, replicates, points } = self;
        sum.update(format!("{factors:?}{links:?}{design:?}{seed}{common_phases}{replicates:?}").as_bytes());
        points.iter().for_each(|point| sum.update(format!("{point:?}").as_bytes()));
        MEASURES.iter().for_each(|measure| sum.update(measure.column.as_bytes()));
        sum.finalize()
    }
}

#[cfg(test)]
pub(crate) mod tests;
