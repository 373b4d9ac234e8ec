//! A flight: up to eight fibres side by side, advanced by its owner.
//!
//! ```text
//! charge   the electric field of charged fibres, and where their charge is
//! guard    which fibres are lost
//! common   what fibres of one flight must have in common
//! turbulence  what its turbulence is drawn from, which distinguishes it from that of another flight
//! start    flights at their start, straight and at rest
//! steps    the steps, and what is seen between them
//! set      keys of the case that change in flight
//! ```

mod charge;
mod guard;
mod set;
mod start;
mod steps;
mod turbulence;

use crate::case::Case;
use crate::chain::laying::Feed;
pub use crate::chain::laying::LaidPoint;
use crate::chain::work::WorkDone;
use crate::chain::{Chain, Scheme};
use crate::energy::Energy;
use spunlaid_air::{Atmosphere, Eddies, EddyField, Stream, StreamKey};
use spunlaid_ground::place::Inlet;
use spunlaid_ground::{Isa, Lanes, Register, Vec3, WIDTH, Wide};
pub use start::{Clock, FlightInvariants};
use std::sync::Arc;

/// One replicate of a case: the smallest piece of work.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// The case.
    pub case: &'a Case,
    /// Which replicate of it.
    pub replicate: u64,
    /// Where its root is.
    pub place: Inlet,
}

impl<'a> Job<'a> {
    /// A replicate whose root is in the middle.
    pub fn new(case: &'a Case, replicate: u64) -> Self {
        Self { case, replicate, place: Inlet::default() }
    }

    /// How its fibre is fed and laid; `None` for a fibre of fixed length. The first ends of successive
    /// replicates are off the axis in directions that spread evenly.
    pub(crate) fn fed(&self) -> Option<Feed> {
        const RATIOS: [f64; 2] = [0.618_033_988_749_894_9, 0.754_877_666_246_692_7];
        let (seed, fibre) = ((self.case.run.seed % 1_000_003) as f64, self.case.fibre);
        let turn = (self.replicate as f64 * RATIOS[0] + seed * RATIOS[1]).fract();
        Some(Feed { line: self.case.line?, fibre, turn })
    }

    /// The source of its turbulence, where that is the same everywhere across.
    ///
    /// * `eddies` – along a fibre of fixed length; a fed one has those of its stations
    pub fn stream(&self, eddies: &Eddies) -> Stream {
        let key = StreamKey { seed: self.case.run.seed, replicate: self.replicate };
        let eddies = match self.case.stations() {
            Some(stations) => self.case.air.turbulence_at(&stations),
            None => self.case.turbulence_along(eddies),
        };
        Stream { air: self.case.air.clone(), eddies, key }
    }
}

/// The run whose air a flight is in, where that is not its own.
#[derive(Clone, Copy, Debug)]
pub struct SurroundingRun<'a> {
    /// Its elements have the eddies: those of the flight, or finer.
    pub case: &'a Case,
    /// Time until which the air has to last [s]. Which stretches of a record a fibre gets depends on it.
    pub horizon: f64,
    /// A field of eddies that all fibres share and that another owner makes.
    pub field: Option<&'a Arc<EddyField>>,
}

impl<'a> SurroundingRun<'a> {
    /// The air of a run of the case itself.
    pub fn run(case: &'a Case) -> Self {
        Self { case, horizon: case.air_horizon(), field: None }
    }
}

/// Up to eight fibres in flight, side by side. A flight owns everything that it needs, and it may continue for
/// any time.
///
/// A fibre has the same bits alone and together with others.
#[derive(Clone, Debug)]
pub struct Flight {
    isa: Isa,
    /// What the fibres are; empty if the flight was assembled from parts.
    entries: Vec<Entry>,
    scheme: Scheme,
    damped: bool,
    h: f64,
    chain: Chain,
    start: Start,
    air: Atmosphere,
    work: WorkDone,
    steps_done: u64,
    clock: Clock,
    end_node: EndNodeStatistics,
    /// Sum over all steps of the strain of the element at the root [-].
    root_strain: Lanes,
}

/// What the fibre of a lane is: a [`Job`] of its own.
#[derive(Clone, Debug)]
struct Entry {
    case: Case,
    replicate: u64,
    place: Inlet,
}

impl Entry {
    fn job(&self) -> Job<'_> {
        Job { case: &self.case, replicate: self.replicate, place: self.place }
    }
}

impl From<&Job<'_>> for Entry {
    fn from(job: &Job<'_>) -> Self {
        Self { case: job.case.clone(), replicate: job.replicate, place: job.place }
    }
}

/// State of the fibres at the start.
#[derive(Clone, Debug, Default)]
struct Start {
    position: Vec<Vec3<Lanes>>,
    velocity: Vec<Vec3<Lanes>>,
    energy: Energy,
}

/// Positions, velocities and energies of a flight at one instant.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// Time since the start [s].
    pub time: f64,
    /// Of the `N+1` nodes [m]. Of a fed fibre, the nodes after the first [`Snapshot::nodes`] have left it.
    pub position: Vec<Vec3<Lanes>>,
    /// Of the `N+1` nodes, at the same instant [m/s].
    pub velocity: Vec<Vec3<Lanes>>,
    /// Tension of the `N` elements, negative in compression [N].
    pub tension: Vec<Lanes>,
    /// Drag on the `N` elements [N]; empty with a scheme that does not give it.
    pub drag: Vec<Vec3<Lanes>>,
    /// Number of nodes of the fibre in each lane.
    pub nodes: [usize; WIDTH],
    /// Number of those between the root and the newest touch-down; all of a fibre of fixed length.
    pub in_air: [usize; WIDTH],
    /// Strain of the element at the root, integrated over time since the start [s]. The difference between two
    /// instants, divided by the time between them, is the mean strain, whatever happened between them.
    pub root_strain_integral: Lanes,
    /// Energies and work done.
    pub energy: Energy,
}

impl Flight {
    /// Adds to the velocity of a node [m/s], as a push from outside does.
    pub fn push(&mut self, node: usize, by: Vec3<Lanes>) {
        for velocities in [&mut self.chain.velocity, &mut self.chain.earlier] {
            if let Some(velocity) = velocities.get_mut(node) {
                *velocity += by;
            }
        }
    }

    /// Puts a node at rest at a given position [m].
    pub fn hold(&mut self, node: usize, at: Vec3<Lanes>) {
        if let Some(position) = self.chain.position.get_mut(node) {
            *position = at;
            self.chain.velocity[node] = Vec3::ZERO;
            self.chain.earlier[node] = Vec3::ZERO;
        }
    }

    /// Gives all fibres a field of eddies that has been made for the steps to come.
    pub fn give_field(&mut self, field: &Arc<EddyField>) {
        if let Atmosphere::Space(air) = &mut self.air {
            air.give(field);
        }
    }

    /// Takes back the field that was given. Another one is to be given before the next step.
    pub fn release_field(&mut self) {
        if let Atmosphere::Space(air) = &mut self.air {
            air.release();
        }
    }

    /// Points that the fibre in a lane has laid on the belt since the last call, in the order in which they were fed.
    pub fn take_laid(&mut self, lane: usize) -> Vec<LaidPoint> {
        self.chain.laying.as_mut().map_or_else(Vec::new, |laying| std::mem::take(&mut laying.laid[lane]))
    }

    /// Number of fibres. The lanes after them repeat the first fibre.
    pub fn fibres(&self) -> usize {
        if self.entries.is_empty() { WIDTH } else { self.entries.len() }
    }

    /// The present case of the fibre in a lane, with all changes made in flight. `None` for an unused lane, and
    /// if the flight was assembled from parts.
    pub fn case(&self, lane: usize) -> Option<&Case> {
        self.entries.get(lane).map(|entry| &entry.case)
    }
    /// The times of its cases.
    pub const fn clock(&self) -> &Clock {
        &self.clock
    }

    /// How it advances in time.
    pub const fn scheme(&self) -> Scheme {
        self.scheme
    }

    /// The instruction set that it is computed with.
    pub const fn isa(&self) -> Isa {
        self.isa
    }

    /// The chains, with positions and velocities as the scheme stores them.
    pub fn chain(&self) -> &Chain {
        &self.chain
    }

    /// Time of the positions [s].
    pub fn time(&self) -> f64 {
        self.steps_done as f64 * self.h
    }

    /// The time step [s].
    pub const fn time_step(&self) -> f64 {
        self.h
    }

    /// Statistics of the end nodes so far, without the spin-up.
    pub fn end_node(&self) -> &EndNodeStatistics {
        &self.end_node
    }

    /// Begins the statistics of the end nodes again.
    pub fn forget_statistics(&mut self) {
        self.end_node = EndNodeStatistics::default();
    }

    /// Velocity of the air at an element, as a step has felt it [m/s]; known after the step, of fed fibres.
    ///
    /// * `step` – number of the last step, from 0
    pub fn air_felt(&self, element: usize, step: u64) -> Option<Vec3<Lanes>> {
        self.air.felt(element, step)
    }

    /// Drag on each element in the last step [N]; none with a scheme that does not give it.
    ///
    /// * `count` – number of elements
    fn drag_of_elements(&self, count: usize) -> Vec<Vec3<Lanes>> {
        if self.scheme != Scheme::ImplicitTension {
            return Vec::new();
        }
        // A node has half of the drag of each element beside it, and the root that of the first one.
        let mut half = Vec3::ZERO;
        let of_element = |node| {
            half = self.chain.tensions.drag(node) - half;
            half + half
        };
        (0..count).map(of_element).collect()
    }

    /// Share of the time that the elements of the fibre in a lane have spent outside the given flow. `None` in
    /// uniform air.
    pub fn outside(&self, lane: usize) -> Option<f64> {
        self.air.outside(lane)
    }
}

/// Running statistics of the end nodes of eight fibres, taken every step.
#[derive(Clone, Copy, Debug, Default)]
pub struct EndNodeStatistics {
    count: f64,
    mean: Vec3<Lanes>,
    /// Sums of squared deviations from the mean, of y and z.
    squares: [Lanes; 2],
    crossings: [Lanes; 2],
    /// Last side of the x-z plane and of the x-y plane: −1, +1, or 0 before the node left the plane.
    side: [Lanes; 2],
}

/// Motion of one fibre's end node over the observed time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EndNodeMotion {
    /// Standard deviation of y over time [m].
    pub amplitude_y: f64,
    /// Standard deviation of z over time [m].
    pub amplitude_z: f64,
    /// Half the number of sign changes of y, divided by the observed time [Hz].
    pub frequency_y: f64,
    /// Half the number of sign changes of z, divided by the observed time [Hz].
    pub frequency_z: f64,
    /// Mean position [m].
    pub mean: Vec3<f64>,
}

impl EndNodeStatistics {
    /// Adds one more position (Welford's running mean and variance).
    #[inline(always)]
    pub(crate) fn see<S: Register>(&mut self, position: &Vec3<Lanes>) {
        self.count += 1.0;
        let share = Wide::<S>::splat(1.0 / self.count);
        let position = Vec3::load(position);
        let off = position - Vec3::load(&self.mean);
        let mean = off.mul_add(share, Vec3::load(&self.mean));
        self.mean = mean.store();
        let rest = position - mean;
        let (zero, one) = (Wide::zero(), Wide::splat(1.0));
        for (i, (y, off, rest)) in
            [(position.y, off.y, rest.y), (position.z, off.z, rest.z)].into_iter().enumerate()
        {
            self.squares[i] = off.mul_add(rest, Wide::load(&self.squares[i])).store();
            let last = Wide::load(&self.side[i]);
            let side = Wide::select_less(zero, y, one, Wide::select_less(y, zero, -one, last));
            let crossing = Wide::select_less(side * last, zero, one, zero);
            self.crossings[i] = (Wide::load(&self.crossings[i]) + crossing).store();
            self.side[i] = side.store();
        }
    }

    /// The motion in one lane, observed over `time` [s].
    pub fn motion(&self, lane: usize, time: f64) -> EndNodeMotion {
        let deviation = |squares: Lanes| (squares.0[lane] / self.count).sqrt();
        let frequency = |crossings: Lanes| crossings.0[lane] / 2.0 / time;
        EndNodeMotion {
            amplitude_y: deviation(self.squares[0]),
            amplitude_z: deviation(self.squares[1]),
            frequency_y: frequency(self.crossings[0]),
            frequency_z: frequency(self.crossings[1]),
            mean: self.mean.lane(lane),
        }
    }
}
