//! A field of eddies in space, in which neighbouring fibres feel the same gusts.
//!
//! `u'(x, y, z, t) = u · G(c, y, z; a)`: air has the label `c`, the time at which it passed the inlet, and the age `a`, the
//! decay times that have gone by since. `G` is a sum of waves in `c`, `y` and `z` with von Kármán's structure across; its
//! phases walk as the age grows.                                                        theory.md (78) to (83)
//!
//! ```text
//! way        travel time and age along the way; where the generations are
//! lattice    the points across
//! brick      how samples lie in memory
//! plan       the shape of the turbulence in each generation
//! synthesis  random modes → two windows of a generation
//! transform  Fourier transforms of sixteen signals abreast
//! windows    how windows follow each other and are joined
//! tape       endless samples, made and forgotten block by block
//! look       the fluctuation at a time and eight places
//! ```

mod brick;
mod lattice;
mod look;
mod memory;
mod plan;
mod synthesis;
mod tape;
#[cfg(test)]
mod tests;
mod transform;
mod way;
mod windows;

pub use lattice::Extent;
pub(crate) use look::EddyFields;

use self::brick::{BEFORE, NEEDED};
use self::plan::Plan;
use self::synthesis::Synthesis;
use self::tape::Tape;
use self::way::EddyPath;
use super::{Air, StreamKey};
use crate::lanes::Isa;
use std::ops::Range;
use std::sync::Arc;

/// Looks in the shortest period that a fibre feels.
const LOOKS_IN_PERIOD: f64 = 8.0;

/// A field of eddies with the mean zero and the rms one, as far as it has been made. Clones share what has been made.
///
/// Equal airs, extents and keys give equal fields, bit for bit, in whatever order and with however many threads they are made.
#[derive(Clone)]
pub struct EddyField {
    plan: Arc<Plan>,
    synthesis: Arc<Synthesis>,
    key: StreamKey,
    /// Of each generation.
    tapes: Vec<Tape>,
    /// Times for which the field can be looked at [s].
    made: Range<f64>,
}

impl std::fmt::Debug for EddyField {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("EddyField").field("key", &self.key).field("made", &self.made).finish_non_exhaustive()
    }
}

impl EddyField {
    /// * `distance` – from the inlet, or the root, to the end of the way [m]
    /// * `extent` – after which the field repeats itself across
    /// * `cutoff` – largest wave number across, times the smallest length scale [-]; zero for the same fluctuation everywhere
    ///   across
    pub fn new(air: &Air, distance: f64, extent: Extent, cutoff: f64, key: StreamKey) -> Self {
        let plan = Plan::new(air, distance, extent, cutoff);
        let tapes = vec![Tape::default(); plan.generations.len()];
        Self {
            synthesis: Arc::new(Synthesis::new(&plan, Isa::detect())),
            plan: Arc::new(plan),
            key,
            tapes,
            made: 0.0..0.0,
        }
    }

    /// Whether both are fields of the same air.
    pub(crate) fn has_air_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.plan, &other.plan)
    }

    /// The same field, of which nothing has been made.
    #[must_use]
    pub(crate) fn unmade(&self) -> Self {
        self.with_key(self.key)
    }

    /// Another field of the same air, with a key of its own.
    #[must_use]
    pub fn with_key(&self, key: StreamKey) -> Self {
        let tapes = vec![Tape::default(); self.tapes.len()];
        Self { key, tapes, made: 0.0..0.0, ..self.clone() }
    }

    /// The most memory that so many fields take [bytes], if one after the other is made in blocks of time of [`EddyField::block`].
    /// What clones look at lives as long as they do.
    ///
    /// * as of [`EddyField::new`]
    pub fn memory(fields: u64, air: &Air, distance: f64, extent: Extent, cutoff: f64) -> f64 {
        memory::memory(fields, air, distance, extent, cutoff)
    }

    /// Longest time between two looks at the air around a fibre that is fed [s]: an eighth of the shortest period that it feels, and no
    /// longer than fibre and air take to pass a length scale. With seven looks in that period the fibres of a web spread 0.3 % more than
    /// with twenty, with ten 0.1 %; CV stays the same.
    ///
    /// * `distance` – as of [`EddyField::new`]
    /// * `feed_speed` – [m/s]
    pub(crate) fn time_between_looks(air: &Air, distance: f64, feed_speed: f64) -> f64 {
        let way = EddyPath::new(air, distance);
        let passing = air.length_scale / air.velocity.abs().max(feed_speed);
        passing.min(1.0 / (LOOKS_IN_PERIOD * way.highest_frequency_at(feed_speed)))
    }

    /// A good length of the blocks of time for which the field is made [s].
    pub fn block(&self) -> f64 {
        self.plan.block()
    }

    /// Whether the field can be looked at now.
    #[inline(always)]
    pub(crate) fn is_made_for(&self, time: f64) -> bool {
        self.made.start <= time && time < self.made.end
    }

    /// Makes what is looked at between two times [s], and forgets what lies before them.
    pub fn make(&mut self, times: Range<f64>, threads: usize) {
        let Self { plan, synthesis, key, .. } = self;
        for (j, tape) in self.tapes.iter_mut().enumerate() {
            let (spacing, margin) = (plan.spacing(j), NEEDED as f64);
            let [youngest, oldest] = plan.way.travels(j);
            let first = ((times.start - oldest) / spacing - margin).floor() as i64 - BEFORE;
            let end = ((times.end - youngest) / spacing + margin).ceil() as i64 + 1;
            tape.extend((&**plan, &**synthesis, *key), j, first..end, threads);
        }
        self.made = times;
    }
}
