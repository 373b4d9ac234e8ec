//! A flight: up to eight fibres side by side, advanced by its owner.
//!
//! ```
//! use spunlaid::flight::{Flight, Job};
//! use spunlaid::input::{parse_case, starter_case};
//! use spunlaid::lanes::Isa;
//!
//! # fn main() -> Result<(), spunlaid::error::Error> {
//! let (case, _notes) = parse_case(starter_case(), "starter.toml", &[])?;
//! let jobs = [0, 1, 2].map(|replicate| Job { case: &case, replicate });
//! let mut flight = Flight::new(&jobs, Isa::detect())?;
//! flight.step_to(0.01)?;
//! let end = flight.snapshot().position.last().map(|end| end.lane(2));
//! # assert!(end.is_some_and(|end| end.norm().is_finite()));
//! # Ok(())
//! # }
//! ```

mod common;
mod end_node;
mod set;

pub(crate) use common::Common;
pub use end_node::{EndNodeMotion, EndNodeStatistics};

use crate::air::{Eddies, Stream, StreamKey, Surroundings, Wind};
use crate::case::Case;
use crate::chain::force_pass::ElementBlock;
use crate::chain::schemes::Scheme;
use crate::chain::work::WorkDone;
use crate::chain::{Chain, Strand};
use crate::chain::{explicit, implicit};
use crate::energy::Energy;
use crate::error::{Error, FlightFault};
use crate::fibre::Root;
use crate::lanes::{Isa, Lanes, Register, Task, WIDTH};
use crate::vec3::Vec3;

/// One replicate of a case: the smallest piece of work.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// The case.
    pub case: &'a Case,
    /// Which replicate of it.
    pub replicate: u64,
}

impl Job<'_> {
    /// The source of its turbulence.
    pub(crate) fn stream(&self, eddies: &Eddies) -> Stream {
        let key = StreamKey { seed: self.case.run.seed, replicate: self.replicate };
        Stream { air: self.case.air.clone(), eddies: self.case.turbulence_along(eddies), key }
    }
}

/// Up to eight fibres in flight, side by side. A flight owns everything that it needs, and it may continue for
/// any time.
///
/// A fibre has the same bits alone and together with others.
#[derive(Clone, Debug)]
pub struct Flight {
    isa: Isa,
    /// The fibres' cases and replicates; empty if the flight was assembled from parts.
    cases: Vec<(Case, u64)>,
    scheme: Scheme,
    damped: bool,
    h: f64,
    chain: Chain,
    start: Start,
    eddies: Eddies,
    wind: Wind,
    /// The flow around the fibres, if it is not uniform.
    surroundings: Option<Surroundings>,
    work: WorkDone,
    steps_done: u64,
    /// Number of steps at the start that the end-node statistics leave out.
    spin_up: u64,
    end_node: EndNodeStatistics,
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
    /// Of the `N+1` nodes [m].
    pub position: Vec<Vec3<Lanes>>,
    /// Of the `N+1` nodes, at the same instant [m/s].
    pub velocity: Vec<Vec3<Lanes>>,
    /// Tension of the `N` elements, negative in compression [N].
    pub tension: Vec<Lanes>,
    /// Energies and work done.
    pub energy: Energy,
}

/// The air of a flight that is assembled from parts, see [`Flight::assembled`].
#[derive(Clone, Debug)]
pub struct Surrounded {
    /// Which element lies in which eddy.
    pub eddies: Eddies,
    /// The wind in each eddy; with surroundings, its mean is zero and its rms is one.
    pub wind: Wind,
    /// The flow around the fibres, if it is not uniform.
    pub surroundings: Option<Surroundings>,
}

impl From<(&Eddies, &Wind)> for Surrounded {
    fn from((eddies, wind): (&Eddies, &Wind)) -> Self {
        Self { eddies: eddies.clone(), wind: wind.clone(), surroundings: None }
    }
}

/// Number of steps between two checks that all positions are finite.
const STEPS_UNSEEN: u64 = 256;

impl Flight {
    /// Fibres at the start of their cases: straight and at rest, in moving air.
    ///
    /// # Errors
    /// There is no job or there are more than eight, a case cannot be run ([`Case::check`]), or the cases cannot
    /// fly together. Cases that fly together have the same number of elements, eddy of each element, times,
    /// scheme, kinds of drag laws, cut-off frequency, number of harmonics and records; and either all or none of
    /// them are damped.
    pub fn new(jobs: &[Job<'_>], isa: Isa) -> Result<Self, Error> {
        let first = jobs.first().ok_or(FlightFault::Empty)?;
        for (lane, job) in jobs.iter().enumerate() {
            // Replicates of one case usually share one reference.
            if lane > 0 && std::ptr::eq(job.case, jobs[lane - 1].case) {
                continue;
            }
            job.case.check().map_err(Error::Rejected)?;
            if lane > 0 {
                Common::of(first.case).check(&Common::of(job.case), lane)?;
            }
        }
        let run = &first.case.run;
        let strands: Vec<Strand> = jobs.iter().map(|job| job.case.strand()).collect();
        let cases = jobs.iter().map(|job| (job.case.clone(), job.replicate)).collect::<Vec<_>>();
        let air = surrounded(&cases, isa)?;
        let mut flight = Self::assembled(isa, &strands, air, run.scheme, run.time_step)?;
        (flight.cases, flight.spin_up) = (cases, run.spin_up_steps);
        Ok(flight)
    }

    /// Straight fibres at rest in given air, to be advanced by steps of `h` [s].
    ///
    /// # Errors
    /// There is no strand or there are more than eight, the strands have different numbers of elements or
    /// different kinds of drag laws, the eddies or surroundings have another number of elements, the wind has
    /// another number of eddies, or the step is not positive.
    pub fn assembled(
        isa: Isa,
        strands: &[Strand],
        air: impl Into<Surrounded>,
        scheme: Scheme,
        h: f64,
    ) -> Result<Self, FlightFault> {
        let Surrounded { eddies, wind, surroundings } = air.into();
        check_strands(strands)?;
        if !(h > 0.0 && h.is_finite()) {
            return Err(FlightFault::Step { step: h });
        }
        let elements = strands[0].fibre.elements;
        let around = surroundings.as_ref().map_or(elements, Surroundings::elements);
        for (what, of, found, wanted) in [
            ("air", "elements", eddies.of_element().len(), elements),
            ("wind", "eddies", wind.eddies(), eddies.count()),
            ("surrounding flow", "elements", around, elements),
        ] {
            if found != wanted {
                return Err(FlightFault::Size { what, of, found, wanted });
            }
        }
        let mut flight = Self {
            isa,
            cases: Vec::new(),
            scheme,
            damped: strands.iter().any(|s| s.damping != 0.0),
            h,
            start: Start::default(),
            chain: Chain::straight(strands, scheme),
            eddies,
            wind,
            surroundings,
            work: WorkDone::default(),
            steps_done: 0,
            spin_up: 0,
            end_node: EndNodeStatistics::default(),
        };
        // Clones made later share the first samples.
        flight.wind.prepare();
        flight.begin();
        Ok(flight)
    }

    /// Sets positions and velocities of all nodes, and starts the clock and all statistics again.
    ///
    /// * `position`, `velocity` – of the `N+1` nodes [m, m/s]
    ///
    /// # Errors
    /// The number of positions or velocities is not the number of nodes.
    pub fn restart_from(
        &mut self,
        position: Vec<Vec3<Lanes>>,
        velocity: Vec<Vec3<Lanes>>,
    ) -> Result<(), FlightFault> {
        let wanted = self.chain.position.len();
        for found in [position.len(), velocity.len()] {
            if found != wanted {
                return Err(FlightFault::Size { what: "start", of: "nodes", found, wanted });
            }
        }
        (self.chain.position, self.chain.velocity) = (position, velocity);
        self.steps_done = 0;
        self.work = WorkDone::default();
        self.end_node = EndNodeStatistics::default();
        self.begin();
        Ok(())
    }

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

    /// Number of fibres. The lanes after them repeat the first fibre.
    pub fn fibres(&self) -> usize {
        if self.cases.is_empty() { WIDTH } else { self.cases.len() }
    }

    /// The present case of the fibre in a lane, with all changes made in flight. `None` for an unused lane, and
    /// if the flight was assembled from parts.
    pub fn case(&self, lane: usize) -> Option<&Case> {
        self.cases.get(lane).map(|(case, _)| case)
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

    /// Begins the statistics of the end nodes anew.
    pub fn forget_statistics(&mut self) {
        self.end_node = EndNodeStatistics::default();
    }

    /// Advances all fibres to a time [s], to the nearest whole step. There is no last time: the wind is made as
    /// the time goes on.
    ///
    /// # Errors
    /// A time that has passed, and a fibre that stops being finite; the flight is of no further use then.
    pub fn step_to(&mut self, time: f64) -> Result<(), Error> {
        let steps = (time / self.h).round();
        // Beyond 2^53 steps a number of steps is no whole number any more.
        if !(steps >= self.steps_done as f64 && steps < 9e15) {
            return Err(FlightFault::TimePast { time, now: self.time() }.into());
        }
        let mut left = steps as u64 - self.steps_done;
        while left > 0 {
            let now = left.min(STEPS_UNSEEN);
            self.advance(now);
            left -= now;
            if let Some(lost) = self.lost() {
                return Err(lost);
            }
        }
        Ok(())
    }

    /// Advances all fibres by a number of steps.
    pub fn advance(&mut self, steps: u64) {
        self.run(steps, (self.h, self.h), false);
    }

    /// Positions, velocities and energies now.
    pub fn snapshot(&self) -> Snapshot {
        self.clone().observe()
    }

    /// Positions, velocities and energies now. The flight advances by one step.
    pub fn observe(&mut self) -> Snapshot {
        let time = self.time();
        let position = self.chain.position.clone();
        let mut velocity = self.chain.velocity.clone();
        let tension = self.chain.tension();
        let (before, first) = (self.work, self.steps_done == 0);
        self.run(1, (self.h, self.h), true);
        if first {
            velocity.clone_from(&self.start.velocity);
        } else if self.scheme.is_staggered() {
            for (v, after) in velocity.iter_mut().zip(&self.chain.velocity) {
                *v = (*v + *after) * Lanes::splat(0.5);
            }
        }
        let mut energy = Energy::held(self.isa, &self.chain, &position, &velocity, &self.start.position);
        energy.enter_work(&self.start.energy, (&before, &self.work), self.scheme, self.h);
        Snapshot { time, position, velocity, tension, energy }
    }

    /// Share of the time that the elements of the fibre in a lane have spent outside the given flow. `None` in
    /// uniform air.
    pub fn outside(&self, lane: usize) -> Option<f64> {
        self.surroundings.as_ref().map(|surroundings| surroundings.outside(lane))
    }

    /// The first fibre and node whose position is not finite, if there is one.
    pub(crate) fn lost(&self) -> Option<Error> {
        let position = &self.chain.position;
        let lost = |lane: usize| position.iter().position(|p| !p.lane(lane).norm().is_finite());
        let (lane, node) = (0..self.fibres()).find_map(|lane| Some((lane, lost(lane)?)))?;
        let case = self.cases.get(lane);
        // A held root becomes NaN only through the first element.
        let held = case.is_some_and(|(case, _)| case.fibre.root != Root::Free);
        Some(Error::NotFinite {
            replicate: case.map_or(lane as u64, |(_, replicate)| *replicate) + 1,
            node: node.max(usize::from(held)) + 1,
            time: self.time(),
            cause: case.map_or_else(
                || "lower the time step".to_owned(),
                |(case, _)| case.likely_cause_of_divergence(),
            ),
        })
    }

    /// Stores the start, and takes the first half kick of the staggered schemes.
    fn begin(&mut self) {
        let (position, velocity) = (self.chain.position.clone(), self.chain.velocity.clone());
        let energy = Energy::held(self.isa, &self.chain, &position, &velocity, &position);
        self.start = Start { position, velocity, energy };
        self.start_staggered();
        if let Some(surroundings) = &mut self.surroundings {
            surroundings.forget();
        }
    }

    /// Moves the velocities from time 0 to half a step before it, and chooses the earlier velocities so that the
    /// first extrapolation gives the velocities at time 0.
    fn start_staggered(&mut self) {
        if !self.scheme.is_staggered() {
            return;
        }
        let scheme = std::mem::replace(&mut self.scheme, Scheme::Leapfrog);
        self.chain.settle_tensions();
        let at_rest = self.chain.velocity.clone();
        self.chain.earlier.clone_from(&at_rest);
        self.run(1, (-0.5 * self.h, 0.0), false);
        self.scheme = scheme;
        self.steps_done = 0;
        self.work = WorkDone::default();
        self.end_node = EndNodeStatistics::default();
        for (i, &v0) in at_rest.iter().enumerate() {
            let v = self.chain.velocity[i];
            self.chain.earlier[i] = v + (v - v0) * Lanes::splat(2.0);
        }
    }

    fn run(&mut self, steps: u64, kick_and_drift: (f64, f64), split: bool) {
        let isa = self.isa;
        // The very first step always stores the work separately, because the sums begin with it.
        let first = steps.min(u64::from(self.steps_done == 0));
        for (steps, split) in [(first, true), (steps - first, split)] {
            if steps > 0 {
                isa.run(Advance { flight: self, steps, kick_and_drift, split });
            }
        }
    }
}

/// Advances a flight by a number of steps in its wind. This is a macro because a closure would not be inlined.
macro_rules! in_wind {
    ($steps:expr, $b:ident, |$wind:ident, $eddy:ident| $step:block) => {
        for _ in 0..$steps {
            let now = $b.wind.blow::<S>($b.steps_done as f64 * $b.h);
            let $eddy = $b.eddies.of_element();
            if let Some(surroundings) = &mut $b.surroundings {
                let $wind = surroundings.around::<S>($b.steps_done, &$b.chain.position, now);
                $step
            } else {
                let $wind = now;
                $step
            }
            $b.count_step::<S>();
        }
    };
}

/// Steps of a flight. With `split`, the work of the velocities before each kick is stored separately.
struct Advance<'a> {
    flight: &'a mut Flight,
    steps: u64,
    kick_and_drift: (f64, f64),
    split: bool,
}

impl Task for Advance<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        match self.flight.scheme {
            Scheme::SemiImplicitEuler => self.steps::<S, false>(),
            Scheme::Leapfrog => self.steps::<S, true>(),
            Scheme::ImplicitTension => self.implicit_steps::<S>(),
        }
    }
}

impl Advance<'_> {
    #[inline(always)]
    fn steps<S: Register, const LEAPFROG: bool>(self) {
        let (b, by) = (self.flight, self.kick_and_drift);
        let how = (b.damped, self.split);
        let mut block = ElementBlock::new();
        in_wind!(self.steps, b, |wind, eddy| {
            explicit::step::<S, LEAPFROG>(&mut b.chain, wind, eddy, by, how, &mut b.work, &mut block);
        });
    }

    #[inline(always)]
    fn implicit_steps<S: Register>(self) {
        let b = self.flight;
        let how = (b.damped, self.split);
        let mut block = ElementBlock::new();
        in_wind!(self.steps, b, |wind, eddy| {
            implicit::step::<S>(&mut b.chain, wind, eddy, b.h, how, &mut b.work, &mut block);
        });
    }
}

impl Flight {
    #[inline(always)]
    fn count_step<S: Register>(&mut self) {
        if self.steps_done == 0 {
            self.work.begin();
        }
        self.steps_done += 1;
        if self.steps_done > self.spin_up {
            self.end_node.see::<S>(&self.chain.position[self.chain.elements()]);
        }
    }
}

/// The air of cases that can fly together.
fn surrounded(cases: &[(Case, u64)], isa: Isa) -> Result<Surrounded, FlightFault> {
    let case = &cases[0].0;
    let eddies = case.eddies();
    let streams =
        cases.iter().map(|(case, replicate)| Job { case, replicate: *replicate }.stream(&eddies)).collect();
    // One step more than the run, because the energies at the last instant need one more step.
    let wind = Wind::along(isa, streams, case.run.duration() + case.run.time_step)?;
    let surroundings = case.surroundings(cases.iter().map(|(case, _)| case.air.clone()))?;
    Ok(Surrounded { eddies, wind, surroundings })
}

/// Refuses strands that cannot fly together.
fn check_strands(strands: &[Strand]) -> Result<(), FlightFault> {
    let Some(first) = strands.first() else {
        return Err(FlightFault::Empty);
    };
    if strands.len() > WIDTH {
        return Err(FlightFault::TooMany { fibres: strands.len(), most: WIDTH });
    }
    if first.fibre.elements == 0 {
        return Err(FlightFault::Size { what: "fibre", of: "elements", found: 0, wanted: 1 });
    }
    for (lane, strand) in strands.iter().enumerate() {
        let same = [
            ("the number of elements", strand.fibre.elements == first.fibre.elements),
            ("the kind of their drag laws", strand.drag.curves() == first.drag.curves()),
        ];
        if let Some((what, _)) = same.into_iter().find(|(_, same)| !same) {
            return Err(FlightFault::Differ { what, lane });
        }
    }
    Ok(())
}
