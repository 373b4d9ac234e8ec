//! A field of eddies in space, in which neighbouring fibres feel the same eddies.
//!
//! `u'(x, y, z, t) = u · G(c, y, z; a)`: air has the label `c`, the time at which it passed the inlet, and
//! the age `a`, the decay times that have gone by since. `G` is a sum of waves in `c`, `y` and `z` with von
//! Kármán's structure across; its phases walk as the age grows.                        theory.md (78) to (83)
//!
//! ```text
//! way        travel time and age along the way; where the generations are
//! lattice    the points across, and how samples lie in memory
//! plan       the shape of the turbulence in each generation
//! synthesis  random modes → two windows of a generation
//! transform  Fourier transforms of sixteen signals abreast
//! windows    how windows follow each other and are joined
//! tape       endless samples, made and forgotten block by block
//! look       the fluctuation at a time and eight places
//! ```

mod lattice;
mod look;
mod plan;
mod synthesis;
mod tape;
#[cfg(test)]
mod tests;
mod transform;
mod way;
mod windows;

use self::plan::Plan;
use self::synthesis::Synthesis;
use self::tape::Tape;
use self::way::{EddyPath, GenerationSteps};
use super::{Air, SpectrumShape, StreamKey};
pub use lattice::Extent;
use lattice::{BEFORE, Lattice, NEEDED, Part, samples};
pub(crate) use look::{EddyFields, Missing};
use plan::{BLOCKS, sizes};
use spunlaid_ground::Isa;
use std::ops::Range;
use std::sync::Arc;

/// Looks in the shortest period that a fibre feels.
const LOOKS_IN_PERIOD: f64 = 8.0;

/// How many times as far apart as usual generations are in a [`Room`]: what the pattern of one of its airs
/// remembers too long, that of another one does too.
const COARSER: f64 = 2.0;

/// Memory of the way and of the random phases, which all fields of an air share [bytes].
const TABLES: f64 = 48e3;

/// A field of eddies with the mean zero and the rms one, as far as it has been made. Clones share what has been made.
///
/// Equal airs, extents and keys give equal fields, bit for bit, in whatever order and with however many
/// threads they are made.
#[derive(Clone)]
pub struct EddyField {
    plan: Arc<Plan>,
    synthesis: Arc<Synthesis>,
    key: StreamKey,
    /// Of each generation.
    tapes: Vec<Tape>,
    /// Times for which the field can be looked at, from the start on [s].
    made: Range<f64>,
    /// Time of the pattern at the start [s].
    start: f64,
}

impl std::fmt::Debug for EddyField {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("EddyField").field("key", &self.key).field("made", &self.made).finish_non_exhaustive()
    }
}

/// A room in which airs that differ in their speed or their turbulence have the same pattern as far as they
/// can: it is as long and as wide as the largest of their ways needs, and has as many generations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// How far it goes along and across the way.
    pub extent: Extent,
    /// Length of the way [m].
    pub distance: f64,
    /// Steps from one generation to the next.
    steps: GenerationSteps,
    /// Largest wave number across, times the smallest length scale, of the waves that fields of any larger cut-off
    /// have in common.
    in_common: f64,
    /// How far from the middle a fibre goes that is alone in it, in distances from the inlet [-]: what lies farther is
    /// made when it comes there. None if all is made, and for many fibres.
    swing: Option<f64>,
}

impl Room {
    /// The room of some airs, each with the length of its way and the distances after which it repeats itself.
    pub fn of(airs: &[(&Air, f64, Extent)]) -> Self {
        let largest = |size: fn(&(&Air, f64, Extent)) -> f64| airs.iter().map(size).fold(0.0, f64::max);
        let extent = Extent { y: largest(|(.., extent)| extent.y), z: largest(|(.., extent)| extent.z) };
        let room = Self {
            extent,
            distance: largest(|(_, distance, _)| *distance),
            steps: GenerationSteps { least: 0, longer: COARSER },
            in_common: f64::INFINITY,
            swing: None,
        };
        let steps = airs.iter().map(|(air, ..)| room.way(air).stages.len() - 1);
        Self { steps: GenerationSteps { least: steps.max().unwrap_or(0), longer: COARSER }, ..room }
    }

    /// The room of one air alone.
    pub const fn alone(distance: f64, extent: Extent) -> Self {
        Self { extent, distance, steps: GenerationSteps::USUAL, in_common: f64::INFINITY, swing: None }
    }

    /// The same room, in which a field of any larger cut-off than this one has the waves of a field of this one, and
    /// smaller ones.
    pub const fn with_waves_in_common(self, cutoff: f64) -> Self {
        Self { in_common: cutoff, ..self }
    }

    /// The same room for one fibre.
    pub const fn for_fibre(self, swing: f64) -> Self {
        Self { swing: Some(swing), ..self }
    }

    /// The points that are made of each generation at first.
    fn parts(&self, way: &EddyPath, lattice: &Lattice) -> Vec<Part> {
        let within = |generation: usize| Some(self.swing? * way.farthest(generation));
        (0..way.stages.len()).map(|generation| lattice.part(within(generation))).collect()
    }

    fn way(&self, air: &Air) -> EddyPath {
        EddyPath::with_steps(air, self.distance, self.steps)
    }
}

impl EddyField {
    /// * `distance` – from the inlet, or the root, to the end of the way [m]
    /// * `extent` – after which the field repeats itself across
    /// * `cutoff` – largest wave number across, times the smallest length scale [-]; zero for the same
    ///   fluctuation everywhere across
    pub fn new(air: &Air, distance: f64, extent: Extent, cutoff: f64, key: StreamKey) -> Self {
        Self::in_room(air, &Room::alone(distance, extent), cutoff, key)
    }

    /// What the pattern of a field follows from beside spectrum, cut-off and key, as a text.
    ///
    /// * as of [`EddyField::new`]
    pub fn pattern(air: &Air, distance: f64, extent: Extent) -> String {
        format!("{:?} {extent:?}", EddyPath::new(air, distance))
    }

    /// A field that is as long and as wide as a room, and has as many generations.
    ///
    /// * `cutoff`, `key` – as of [`EddyField::new`]
    pub fn in_room(air: &Air, room: &Room, cutoff: f64, key: StreamKey) -> Self {
        let plan = Plan::new(air, room.way(air), room.extent, [cutoff, room.in_common.min(cutoff)]);
        let tapes = room.parts(&plan.way, &plan.lattice).into_iter().map(Tape::unmade).collect();
        Self {
            synthesis: Arc::new(Synthesis::new(&plan, Isa::detect())),
            start: room.swing.map_or(0.0, |_| plan.start_of_fibre()),
            plan: Arc::new(plan),
            key,
            tapes,
            made: 0.0..0.0,
        }
    }

    /// The field of another air in the same room, if that has the pattern of this one and lets it pass faster
    /// or slower, with its pace: how many times as fast it passes. What has been made is shared.
    ///
    /// * `airs` – the one of this field, and the other one
    pub fn at_pace_of(&self, airs: [&Air; 2], room: &Room) -> Option<(Self, f64)> {
        let [own, other] = airs.map(|air| &air.spectrum);
        // A measured spectrum stays as it is measured, however fast the air is.
        if own != other || matches!(own, SpectrumShape::Measured(_)) {
            return None;
        }
        let plan = self.plan.on_way(room.way(airs[1]))?;
        let pace = self.plan.repeat_time / plan.repeat_time;
        Some((Self { plan: Arc::new(plan), ..self.clone() }, pace))
    }

    /// This field as far as another one has been made, of which it has the pattern.
    ///
    /// * `pace` – how many times as fast it passes in this one
    #[must_use]
    pub fn made_as(&self, other: &Self, pace: f64) -> Self {
        let made = other.made.start / pace..other.made.end / pace;
        Self { tapes: other.tapes.clone(), made, ..self.clone() }
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
        let tapes = self.tapes.iter().map(|tape| Tape::unmade(tape.part)).collect();
        Self { key, tapes, made: 0.0..0.0, ..self.clone() }
    }

    /// The most memory that so many fields take [bytes], if one after the other is made in blocks of time of
    /// [`EddyField::block`]. What clones look at lives as long as they do.
    ///
    /// * as of [`EddyField::new`]
    pub fn memory(fields: u64, air: &Air, distance: f64, extent: Extent, cutoff: f64) -> f64 {
        Self::memory_in_room(fields, air, &Room::alone(distance, extent), cutoff)
    }

    /// [`EddyField::memory`] of fields in a room.
    pub fn memory_in_room(fields: u64, air: &Air, room: &Room, cutoff: f64) -> f64 {
        memory(fields, &room.way(air), room, cutoff)
    }

    /// How many pairs of windows are made for a fibre until a time [s], in those that are made at its start.
    ///
    /// * as of [`EddyField::in_room`]
    pub fn pairs(air: &Air, room: &Room, cutoff: f64, until: f64) -> f64 {
        let plan = Plan::new(air, room.way(air), room.extent, [cutoff; 2]);
        let pairs = |time: f64| (time / plan.pair()).ceil();
        let first = plan.start_of_fibre() + plan.block();
        pairs(first + until) / pairs(first)
    }

    /// Longest time between two looks at the air around a fibre that is fed [s]: an eighth of the shortest
    /// period that it feels, and no longer than fibre and air take to pass a length scale. With seven looks
    /// in that period the fibres of a web spread 0.3 % more than with twenty, with ten 0.1 %; CV stays the
    /// same.
    ///
    /// * `distance` – as of [`EddyField::new`]
    /// * `feed_speed` – [m/s]
    pub fn time_between_looks(air: &Air, distance: f64, feed_speed: f64) -> f64 {
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
        self.made = times;
        (0..self.tapes.len()).for_each(|generation| self.make_generation(generation, threads));
    }

    fn make_generation(&mut self, j: usize, threads: usize) {
        let Self { plan, synthesis, key, .. } = self;
        let made = self.start + self.made.start..self.start + self.made.end;
        let (spacing, margin) = (plan.spacing(j), NEEDED as f64);
        let [youngest, oldest] = plan.way.travels(j);
        let first = ((made.start - oldest) / spacing - margin).floor() as i64 - BEFORE;
        let end = ((made.end - youngest) / spacing + margin).ceil() as i64 + 1;
        self.tapes[j].extend(plan, synthesis, *key, j, first..end, threads);
    }

    /// The same field, as far as it has been made and around a place that was missing, with the same bits.
    #[must_use]
    pub(crate) fn widened(&self, missing: &Missing) -> Self {
        let (j, mut field) = (missing.generation, self.clone());
        field.tapes[j] = Tape::unmade(field.tapes[j].part.widened(missing.first));
        field.make_generation(j, 1);
        field
    }
}

/// The most memory that so many fields take, of which one at a time is made in such blocks [bytes].
fn memory(fields: u64, way: &EddyPath, room: &Room, cutoff: f64) -> f64 {
    let (lattice, harmonics) = sizes(way, room.extent, cutoff);
    let highest = way.stages.iter().map(|stage| stage.cutoff_frequency).fold(0.0, f64::max);
    let (mut kept, mut making) = (0.0, 0.0_f64);
    for (j, (stage, part)) in way.stages.iter().zip(room.parts(way, &lattice)).enumerate() {
        let of_stage = harmonics as f64 * stage.cutoff_frequency / highest;
        let points = part.counts();
        let samples = samples(of_stage.ceil() as usize);
        let [youngest, oldest] = way.travels(j);
        let looked_at = samples as f64 * (1.0 / BLOCKS + (oldest - youngest) * highest / harmonics as f64);
        kept += tape::memory(points, samples, looked_at) + of_stage * amplitudes_memory(&lattice);
        making =
            making.max(synthesis::memory(points, of_stage) + tape::memory_while_joining(points, samples));
    }
    kept * fields as f64 + making + TABLES
}

/// Memory of the amplitudes of a harmonic [bytes].
fn amplitudes_memory(lattice: &Lattice) -> f64 {
    let [y, z] = lattice.most_waves().map(|most| (most + 1) as f64);
    y * z * size_of::<f32>() as f64
}
