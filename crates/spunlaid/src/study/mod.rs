//! Studies: many cases that differ in a few keys, each flown several times, and the statistics of the results.
//!
//! ```text
//! factors → design (rows of values) → points (a whole case each) → jobs (one replicate of one point)
//!   → pack (eight jobs to a flight, across points) → journal (a record per fibre) → statistics per point → effects
//! ```
//!
//! A study is data: it is read from a file (`input::read_study`) or made in code, [`Study::of_cases`].
//! [`run`] flies the fibres that the journal does not hold yet. The record of a fibre has the same bits for any
//! number of threads, any packing and any interruption, and equals the result of `ensemble::fly` for the same case.

mod design;
mod effects;
mod journal;
mod measures;
mod pack;
mod rounds;
mod run;
mod sobol;

pub use crate::observe::MEASURES;
pub use design::{Design, Factor, Levels, Spacing};
pub use effects::{Effect, Ranking, Rankings, Refusal, Term, rankings};
pub use journal::{Found, Header, Journal, foreign, in_use, other_format, unsynced};
pub use measures::{Landing, Measured, Record, measure, measured};
pub use pack::{Batch, Bundles, fly_batches};
pub use rounds::{PointResults, Rounds, results_of_point};
pub use run::{Progress, fly_bundle, run};

use crate::case::{Case, keys};
use crate::units::{Dimension, Expression};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A study: the points, and the number of replicates of each.
#[derive(Clone, Debug)]
pub struct Study {
    /// The keys that vary from point to point.
    pub factors: Vec<Factor>,
    /// The keys that follow from them.
    pub links: Vec<Link>,
    /// How the factors are combined.
    pub design: Design,
    /// Master seed.
    pub seed: u64,
    /// Whether the turbulence of all points has the same random phases.
    pub common_phases: bool,
    /// Number of replicates of each point.
    pub replicates: Replicates,
    /// The points.
    pub points: Vec<Point>,
}

/// A key that follows from other keys by a formula.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Full key, `air.cutoff_frequency`.
    pub key: &'static str,
    /// Physical dimension of its values.
    pub dimension: Dimension,
    /// The formula.
    pub expression: Expression,
}

/// A key of the case that differs between points: a factor, or the target of a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Input<'a> {
    /// Full key, `air.velocity`.
    pub key: &'static str,
    /// Physical dimension of its values.
    pub dimension: Dimension,
    /// The words of a key that takes words; its values are then indices into them. Empty for numbers.
    pub words: &'a [&'static str],
}

impl Input<'_> {
    /// The word that a value stands for; none for numbers.
    pub fn word(&self, value: f64) -> Option<&'static str> {
        self.words.get(value as usize).copied()
    }

    /// A value for people: a quantity with its unit, or a word.
    pub fn pretty(&self, value: f64) -> String {
        self.word(value).map_or_else(|| self.dimension.pretty(value), str::to_owned)
    }

    /// Name of its column in a table: the key and the SI unit of a quantity.
    pub fn column(&self) -> String {
        if self.words.is_empty() {
            format!("{}{}", self.key, self.dimension.suffix())
        } else {
            self.key.to_owned()
        }
    }
}

/// A point of a study: a complete case with its seed.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Values of the factors, then of the links: numbers in SI units, words as indices into those of the factor.
    pub values: Vec<f64>,
    /// The case, with the point's seed and the largest number of replicates that may be flown.
    pub case: Case,
}

/// How many replicates of a point are flown.
#[derive(Clone, Debug, PartialEq)]
pub struct Replicates {
    /// Smallest number.
    pub at_least: u64,
    /// Largest number.
    pub at_most: u64,
    /// Pairs of a result, as index into [`MEASURES`], and a fraction of its mean. More replicates are flown until
    /// the standard error of each result is below this fraction.
    pub until: Vec<(usize, f64)>,
}

impl Replicates {
    /// The same number for every point.
    pub const fn fixed(replicates: u64) -> Self {
        Self { at_least: replicates, at_most: replicates, until: Vec::new() }
    }
}

impl Study {
    /// A study of given cases. It keeps their seeds and replaces their replicates.
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

    /// The keys of the points' values, in the same order.
    pub fn inputs(&self) -> impl Iterator<Item = Input<'_>> {
        let linked = |link: &Link| Input { key: link.key, dimension: link.dimension, words: &[] };
        self.factors.iter().map(Factor::input).chain(self.links.iter().map(linked))
    }

    /// Largest number of fibres that may be flown.
    pub fn most_fibres(&self) -> u64 {
        (self.points.len() as u64).saturating_mul(self.replicates.at_most)
    }
}

/// The seed of a point without common phases. It depends on the study's seed and the point's index only, and is
/// below 2⁵³, so that programs which read it as a floating-point number read it exactly.
pub fn seed_of_point(seed: u64, point: u64) -> u64 {
    stream(seed, Use::PointSeed, point).next_u64() >> 11
}

/// What a random stream is used for; different uses have different numbers.
#[derive(Clone, Copy, Debug)]
enum Use {
    PointSeed = 1,
    LatinHypercube = 2,
}

fn stream(seed: u64, purpose: Use, index: u64) -> ChaCha8Rng {
    let mut key = [0; 32];
    // The turbulence counts velocity components in the last word, so its streams differ from these.
    for (bytes, word) in key.chunks_exact_mut(8).zip([seed, index, purpose as u64, u64::MAX]) {
        bytes.copy_from_slice(&word.to_le_bytes());
    }
    ChaCha8Rng::from_seed(key)
}

impl Study {
    /// A checksum over all that the records of a study depend on: the keys of every point's case, and the rule for more
    /// replicates. How many are flown at most is left out, so that a finished study can be given more.
    pub fn identity(&self) -> u32 {
        let mut sum = crc32fast::Hasher::new();
        if !self.replicates.until.is_empty() {
            sum.update(&self.replicates.at_least.to_le_bytes());
            for (measure, fraction) in &self.replicates.until {
                sum.update(&(*measure as u64).to_le_bytes());
                sum.update(&fraction.to_le_bytes());
            }
        }
        for point in &self.points {
            enter_keys(&mut sum, &point.case);
        }
        MEASURES.iter().for_each(|measure| sum.update(measure.column.as_bytes()));
        sum.finalize()
    }
}

/// Enters the name and the value of every key of a case but the number of replicates. A case that is written and read again
/// has the same values, to the last bit; of files, the contents count.
pub(crate) fn enter_keys(sum: &mut crc32fast::Hasher, case: &Case) {
    for key in keys::all().iter().filter(|key| key.name != "run.replicates") {
        if let Some(value) = key.get(case) {
            sum.update(key.name.as_bytes());
            // A number that the flow tells along the way is another than the same number everywhere.
            sum.update(&[u8::from(key.is_told(case))]);
            sum.update(&value.bytes());
        }
    }
}

#[cfg(test)]
pub(crate) mod tests;
