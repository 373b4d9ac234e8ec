//! Studies: many experiments that differ in a few keys, each repeated several times, and the statistics of
//! the results. An experiment is a case whose fibres are simulated, a web that is laid, or a spinline that is
//! solved.
//!
//! ```text
//! factors → design (rows of values) → points (a whole experiment each) → jobs (one replicate of one point)
//!   → pack (eight fibres to a flight, across points) webs (one after another) or spinlines
//!   → journal (a record per replicate) → statistics per point → effects
//! ```
//!
//! A study is data: it is read from a file (`input::read_study`) or made in code, [`Study::of_cases`].
//! [`run`] makes the replicates that the journal does not hold yet. The record of a replicate has the same bits for any
//! number of threads, any packing and any interruption, and equals the result of `ensemble::fly` or `web::find`.

mod batch;
mod claims;
mod design;
mod effects;
mod experiment;
mod journal;
mod keys;
mod made;
mod measures;
mod rounds;
mod run;

pub use batch::{Batch, Bundles, fly_batches};
pub use claims::{Statement, StudyClaim, Trend, judge};
pub use design::{Design, Factor, Levels, Spacing};
pub use effects::{Contrast, Ranking, Rankings, Refusal, Term, rankings};
pub use experiment::Experiment;
pub use journal::{Header, Journal, JournalState, foreign, in_use, unsynced};
pub use keys::STUDY;
pub use keys::{MOST_POINTS, MOST_REPLICATES, RANGE};
pub(crate) use made::seed_of_web;
pub use measures::{Quantity, Record, ReplicateOutcome, measured};
pub use rounds::{PointResults, Rounds, results_of_point};
pub use run::{Progress, fly_bundle, run};

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;
use spunlaid_fibre::Case;
use spunlaid_fibre::case::keys::VariedKey;
use spunlaid_ground::Expression;
use spunlaid_simulation::WebSpec;

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
    /// The numbers that are kept of each replicate.
    pub quantities: Vec<Quantity>,
    /// What is claimed of its results.
    pub claims: Vec<StudyClaim>,
}

/// A key that follows from other keys by a formula.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// The key.
    pub key: VariedKey,
    /// The formula.
    pub expression: Expression,
}

/// A point of a study: a complete experiment.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Values of the factors, then of the links: numbers in SI units, words as indices into those of the factor.
    pub values: Vec<f64>,
    /// What is repeated.
    pub experiment: Experiment,
}

/// How many replicates of a point are simulated.
#[derive(Clone, Debug, PartialEq)]
pub struct Replicates {
    /// Smallest number.
    pub at_least: u64,
    /// Largest number.
    pub at_most: u64,
    /// Pairs of a result, as index into [`Study::quantities`], and a fraction of its mean. More replicates
    /// are simulated until the standard error of each result is below this fraction.
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
    pub fn from_cases(cases: impl IntoIterator<Item = Case>, replicates: Replicates) -> Self {
        let mut cases: Vec<Case> = cases.into_iter().collect();
        cases.iter_mut().for_each(|case| case.run.replicates = replicates.at_most);
        let seed = cases.first().map_or(0, |case| case.run.seed);
        let common_phases = cases.iter().all(|case| case.run.seed == seed);
        let point = |case| Point { values: Vec::new(), experiment: Experiment::from(case) };
        Self {
            factors: Vec::new(),
            links: Vec::new(),
            design: Design::Paired,
            seed,
            common_phases,
            replicates,
            points: cases.into_iter().map(point).collect(),
            quantities: measures::quantities_of_fibres(),
            claims: Vec::new(),
        }
    }

    /// The quantities that are kept of these points.
    pub fn quantities_of(points: &[Point]) -> Vec<Quantity> {
        match points.first().map(|point| &point.experiment) {
            Some(Experiment::Web(_)) => measures::quantities_of_webs(webs(points)),
            Some(Experiment::Spinline(_)) => measures::quantities_of_spinlines(),
            _ => measures::quantities_of_fibres(),
        }
    }

    /// The sides of the patches over which the webs of all points are measured [m]; none for fibres.
    pub fn patch_sides(&self) -> Vec<f64> {
        measures::sides(webs(&self.points))
    }

    /// The index of a quantity by its name; None without one of this name.
    pub fn quantity(&self, name: &str) -> Option<usize> {
        self.quantities.iter().position(|quantity| quantity.name == name)
    }

    /// What a replicate is called, `fibre`, `web` or `spinline`.
    pub fn noun(&self) -> &'static str {
        self.points.first().map_or("fibre", |point| point.experiment.noun())
    }

    /// The keys of the points' values, in the same order.
    pub fn inputs(&self) -> impl Iterator<Item = &VariedKey> {
        let linked = self.links.iter().map(|link| &link.key);
        self.factors.iter().map(|factor| &factor.key).chain(linked)
    }

    /// Largest number of replicates of all points.
    pub fn most_fibres(&self) -> u64 {
        (self.points.len() as u64).saturating_mul(self.replicates.at_most)
    }
}

/// The seed of a point without common phases. It depends on the study's seed and the point's index only, and is
/// below 2⁵³, so that programs which read it as a floating-point number read it exactly.
pub fn seed_of_point(seed: u64, point: u64) -> u64 {
    stream(seed, RandomUse::PointSeed, point).next_u64() >> 11
}

/// What a random stream is used for; different uses have different numbers.
#[derive(Clone, Copy, Debug)]
enum RandomUse {
    PointSeed = 1,
    LatinHypercube = 2,
}

fn stream(seed: u64, purpose: RandomUse, index: u64) -> ChaCha8Rng {
    spunlaid_ground::random::stream([seed, index, purpose as u64, u64::MAX])
}

impl Study {
    /// A checksum over all that the records of a study depend on: the keys of every point's experiment, and
    /// the rule for more replicates. How many are simulated at most is left out, so that a finished study can be
    /// given more.
    pub fn identity(&self) -> u32 {
        let mut sum = crc32fast::Hasher::new();
        if !self.replicates.until.is_empty() {
            sum.update(&self.replicates.at_least.to_le_bytes());
            for (measure, fraction) in &self.replicates.until {
                sum.update(&(*measure as u64).to_le_bytes());
                sum.update(&fraction.to_le_bytes());
            }
        }
        self.points.iter().for_each(|point| point.experiment.enter(&mut sum));
        self.quantities.iter().for_each(|quantity| sum.update(quantity.column.as_bytes()));
        sum.finalize()
    }
}

/// The webs of points.
fn webs(points: &[Point]) -> impl Iterator<Item = &WebSpec> {
    points.iter().filter_map(|point| point.experiment.web())
}

#[cfg(test)]
pub(crate) mod tests;
