//! How large a case may be.

use super::Case;
use spunlaid_air::{EddyField, EddyModel, Wind};
use spunlaid_ground::WIDTH;

/// Largest number of steps of a run.
pub const MOST_STEPS: u64 = 1_000_000_000_000;
/// Largest number of shapes of a fibre that are kept.
pub const MOST_SHAPES: u64 = 20_000;
/// Largest number of replicates. Each takes half a kilobyte of memory for its values in the summary.
pub const MOST_REPLICATES: u64 = 10_000_000;
/// Largest number of recorded instants over all replicates. They are written to disk during the run, so they take
/// no memory. Each takes 150 bytes in the tables of a run, which makes 150 GB in all.
pub const MOST_INSTANTS: f64 = 1e9;

/// How many times `part` fits into `whole`, rounded to a whole number, and whether it fits exactly (apart from
/// floating-point rounding).
pub fn whole_parts(whole: f64, part: f64) -> (u64, bool) {
    let ratio = whole / part;
    let nearest = ratio.round();
    (nearest as u64, (ratio - nearest).abs() <= 8.0 * f64::EPSILON * ratio)
}

/// Most memory a flight of eight fibres may take [bytes].
pub const FLIGHT_MEMORY_LIMIT: f64 = 8.0 * (1u64 << 30) as f64;

/// Vectors of eight fibres that the chain, its copies for a look ahead and its start keep per node.
const VECTORS_PER_NODE: f64 = 12.0;
/// Bytes of such a vector.
const VECTOR: f64 = 192.0;
/// Bytes that observers of eight fibres keep of a recorded instant, and of how many instants at most: what
/// quantiles are found in, and what waits to be transformed into spectra.
const QUANTILES: (f64, f64) = (400.0, (1 << 14) as f64);
const SPECTRA: (f64, f64) = (200.0, (17 << 11) as f64);
/// Bytes of the air around an element of eight fibres in a flow that is not uniform.
const SURROUNDINGS: f64 = 2000.0;
/// Bytes of scratch space that the synthesis of turbulence takes per harmonic.
const SYNTHESIS: f64 = 1200.0;

/// Memory of a flight of eight fibres of a case [bytes].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightMemory {
    /// The chain.
    pub chain: f64,
    /// The samples of the turbulence that are kept.
    pub turbulence: f64,
    /// What making the turbulence takes besides.
    pub synthesis: f64,
    /// The fields of eddies in space: one for each replicate.
    pub field: f64,
    /// What observers keep of the recorded instants.
    pub instants: f64,
}

impl FlightMemory {
    /// All together [bytes].
    pub fn total(&self) -> f64 {
        self.chain + self.turbulence + self.synthesis + self.field + self.instants
    }
}

impl Case {
    /// Estimate of the memory of a flight of eight fibres [bytes].
    pub fn flight_memory(&self) -> FlightMemory {
        // A fed fibre swings and folds on its way, and some of it lies on the belt.
        let slack = if self.line.is_some() { 2.0 } else { 1.0 };
        let (air, elements) = (&self.air, self.fibre.elements as f64 * slack);
        let eddies = self.number_of_eddies();
        let harmonics = air.harmonics as f64;
        let synthesis = if air.records.is_empty() { SYNTHESIS * 2.0 * harmonics } else { 0.0 };
        let turbulence = if synthesis <= FLIGHT_MEMORY_LIMIT {
            Wind::memory(air, 1, self.run.duration()) * eddies
        } else {
            0.0
        };
        let (turbulence, synthesis, field) = match air.field_cutoff() {
            None => (turbulence, synthesis, 0.0),
            Some(cutoff) => {
                let fields = self.run.replicates.min(WIDTH as u64);
                (0.0, 0.0, EddyField::memory_in_room(fields, air, &self.room_of_air(), cutoff))
            }
        };
        let number_of_instants = (self.run.steps / self.run.output_steps.max(1) + 1) as f64;
        let surroundings = if air.is_uniform() { 0.0 } else { elements * SURROUNDINGS };
        let chain = (elements + 1.0) * VECTORS_PER_NODE * VECTOR + surroundings;
        let kept = |(bytes, most): (f64, f64)| bytes * number_of_instants.min(most);
        let instants = kept(QUANTILES) + kept(SPECTRA);
        FlightMemory { chain, turbulence, synthesis, field, instants }
    }

    /// Pairs of windows of a field of eddies in space that a run makes one after the other, in those of its first
    /// step; zero without such a field.
    pub fn windows_of_eddies(&self) -> f64 {
        let pairs = |cutoff| EddyField::pairs(&self.air, &self.room_of_air(), cutoff, self.air_horizon());
        self.air.field_cutoff().map_or(0.0, pairs)
    }

    /// Number of eddies, or stations of the air, for which a flight makes turbulence; at most one for each
    /// element where their size varies along the fibre.
    fn number_of_eddies(&self) -> f64 {
        let elements = self.fibre.elements as f64;
        match self.air.eddies {
            _ if self.line.is_some() => self.stations().map_or(0.0, |stations| stations.count as f64),
            EddyModel::Convected { .. } => elements,
            EddyModel::Independent if self.air.from_flow.length_scale => elements,
            EddyModel::Independent => (self.fibre.length / self.air.length_scale).ceil().max(1.0),
        }
    }

    /// Computing time that a flight takes to make its turbulence from harmonics until a time [s], in steps of
    /// elements with the explicit schemes. Each window is made whole, and the first one however short the
    /// flight is. Zero where the turbulence comes from records or from a field of eddies in space, which
    /// takes its time in other ways.
    pub fn cost_of_air(&self, time: f64) -> f64 {
        match self.air.field_cutoff() {
            None => Wind::cost(&self.air, time) * self.number_of_eddies(),
            Some(_) => 0.0,
        }
    }
}
