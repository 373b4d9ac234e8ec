//! Fibres in flight: up to eight side by side, advanced by whoever owns them.
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
use crate::chain::force_pass::Block;
use crate::chain::ledger::Work;
use crate::chain::schemes::Scheme;
use crate::chain::{Chain, Strand};
use crate::chain::{explicit, implicit};
use crate::energy::Energy;
use crate::error::{Error, FlightFault};
use crate::fibre::Root;
use crate::lanes::{Isa, Lanes, Register, Task, WIDTH};
use crate::vec3::Vec3;

/// One replicate of a case: the unit of work, fully described by data.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// The case.
    pub case: &'a Case,
    /// Which replicate of it.
    pub replicate: u64,
}

impl Job<'_> {
    /// Where its turbulence comes from.
    pub(crate) fn stream(&self, eddies: &Eddies) -> Stream {
        let key = StreamKey { seed: self.case.run.seed, replicate: self.replicate };
        Stream { air: self.case.air.clone(), eddies: self.case.turbulence_along(eddies), key }
    }
}

/// Up to eight fibres in flight, side by side. It owns all that it needs and goes on for as long as it is
/// stepped.
///
/// Fibres that fly together have the same bits as fibres that fly alone.
#[derive(Clone, Debug)]
pub struct Flight {
    isa: Isa,
    /// The fibres' cases and replicates; none where the flight was put together from parts.
    cases: Vec<(Case, u64)>,
    scheme: Scheme,
    damped: bool,
    h: f64,
    chain: Chain,
    start: Start,
    eddies: Eddies,
    wind: Wind,
    /// Where the air is not the same everywhere: what of it is around the fibres.
    surroundings: Option<Surroundings>,
    work: Work,
    steps_done: u64,
    /// Steps whose positions the end-node statistics leave out.
    spin_up: u64,
    end_node: EndNodeStatistics,
}

/// Where the fibres started.
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

/// What a flight is put together from, see [`Flight::assembled`].
#[derive(Clone, Debug)]
pub struct Surrounded {
    /// Which element lies in which eddy.
    pub eddies: Eddies,
    /// The wind in each of these; with surroundings, of mean zero and rms one.
    pub wind: Wind,
    /// What is around the fibres where the flow is not uniform.
    pub surroundings: Option<Surroundings>,
}

impl From<(&Eddies, &Wind)> for Surrounded {
    fn from((eddies, wind): (&Eddies, &Wind)) -> Self {
        Self { eddies: eddies.clone(), wind: wind.clone(), surroundings: None }
    }
}

/// Steps between two looks for numbers that are lost.
const STEPS_UNSEEN: u64 = 256;

impl Flight {
    /// Fibres at the start of their cases: straight, at rest, the wind blowing.
    ///
    /// # Errors
    /// No job or more than eight, a case that cannot be run ([`Case::check`]), and cases that cannot fly
    /// together. They must agree in the number of elements, the eddy of each element, the times, the scheme, the
    /// kinds of the drag laws, the cut-off frequency, the number of harmonics, the records, and in whether they
    /// are damped.
    pub fn new(jobs: &[Job<'_>], isa: Isa) -> Result<Self, Error> {
        let first = jobs.first().ok_or(FlightFault::Empty)?;
        for (lane, job) in jobs.iter().enumerate() {
            // Replicates of one case are most often given as the same reference.
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

    /// Straight fibres at rest in air that is made already, to be advanced by steps of `h` [s].
    ///
    /// # Errors
    /// No strand or more than eight, strands of unequal numbers of elements or of drag laws of several kinds,
    /// eddies or surroundings for another number of elements, a wind for another number of eddies, and a step
    /// that is not positive.
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
            work: Work::default(),
            steps_done: 0,
            spin_up: 0,
            end_node: EndNodeStatistics::default(),
        };
        // Clones then share the first samples.
        flight.wind.prepare();
        flight.begin();
        Ok(flight)
    }

    /// Puts the nodes elsewhere, with velocities, and starts the clock and all records again.
    ///
    /// * `position`, `velocity` – of the `N+1` nodes [m, m/s]
    ///
    /// # Errors
    /// As many positions and velocities as there are nodes are needed.
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
        self.work = Work::default();
        self.end_node = EndNodeStatistics::default();
        self.begin();
        Ok(())
    }

    /// Adds to the velocity of a node [m/s]: a push from outside the model.
    pub fn push(&mut self, node: usize, by: Vec3<Lanes>) {
        for velocities in [&mut self.chain.velocity, &mut self.chain.earlier] {
            if let Some(velocity) = velocities.get_mut(node) {
                *velocity += by;
            }
        }
    }

    /// Puts a node at rest at a place [m], as a hand would.
    pub fn hold(&mut self, node: usize, at: Vec3<Lanes>) {
        if let Some(position) = self.chain.position.get_mut(node) {
            *position = at;
            self.chain.velocity[node] = Vec3::ZERO;
            self.chain.earlier[node] = Vec3::ZERO;
        }
    }

    /// Number of fibres: lanes from here on repeat the first.
    pub fn fibres(&self) -> usize {
        if self.cases.is_empty() { WIDTH } else { self.cases.len() }
    }

    /// The case that the fibre of a lane flies now, with all that was set in flight; none of lanes left over and
    /// where the flight was put together from parts.
    pub fn case(&self, lane: usize) -> Option<&Case> {
        self.cases.get(lane).map(|(case, _)| case)
    }

    /// The chains, positions and velocities as the scheme keeps them.
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

    /// Statistics of the end nodes so far, spin-up left out.
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

    /// Positions, velocities and energies now, taken while advancing by one step.
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

    /// Share of the time that the elements of a lane's fibre have spent outside of what the flow knows; none
    /// where the air is the same everywhere.
    pub fn outside(&self, lane: usize) -> Option<f64> {
        self.surroundings.as_ref().map(|surroundings| surroundings.outside(lane))
    }

    /// The first fibre and node whose position is no number, if any is.
    pub(crate) fn lost(&self) -> Option<Error> {
        let position = &self.chain.position;
        let lost = |lane: usize| position.iter().position(|p| !p.lane(lane).norm().is_finite());
        let (lane, node) = (0..self.fibres()).find_map(|lane| Some((lane, lost(lane)?)))?;
        let case = self.cases.get(lane);
        // A held root that is no number is so by what the first element did to it.
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

    /// Remembers the start, and takes the first half kick where the scheme wants it.
    fn begin(&mut self) {
        let (position, velocity) = (self.chain.position.clone(), self.chain.velocity.clone());
        let energy = Energy::held(self.isa, &self.chain, &position, &velocity, &position);
        self.start = Start { position, velocity, energy };
        self.start_staggered();
        if let Some(surroundings) = &mut self.surroundings {
            surroundings.forget();
        }
    }

    /// Takes the velocities from time 0 to half a step before, and makes the first extrapolation of the
    /// drag's velocity give those at time 0.
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
        self.work = Work::default();
        self.end_node = EndNodeStatistics::default();
        for (i, &v0) in at_rest.iter().enumerate() {
            let v = self.chain.velocity[i];
            self.chain.earlier[i] = v + (v - v0) * Lanes::splat(2.0);
        }
    }

    fn run(&mut self, steps: u64, kick_and_drift: (f64, f64), split: bool) {
        let isa = self.isa;
        // The very first step always: the ledger begins with it.
        let first = steps.min(u64::from(self.steps_done == 0));
        for (steps, split) in [(first, true), (steps - first, split)] {
            if steps > 0 {
                isa.run(Advance { flight: self, steps, kick_and_drift, split });
            }
        }
    }
}

/// So many steps of a flight in the wind of their time; a macro, for a closure would be called, not inlined.
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

/// Steps of a flight; with `split` the ledger keeps apart what the velocities before each kick gave.
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
        let mut block = Block::new();
        in_wind!(self.steps, b, |wind, eddy| {
            explicit::step::<S, LEAPFROG>(&mut b.chain, wind, eddy, by, how, &mut b.work, &mut block);
        });
    }

    #[inline(always)]
    fn implicit_steps<S: Register>(self) {
        let b = self.flight;
        let how = (b.damped, self.split);
        let mut block = Block::new();
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
    // One step more than the run: the last instant's energies look one step ahead.
    let wind = Wind::along(isa, streams, case.run.duration() + case.run.time_step)?;
    let surroundings = case.surroundings(cases.iter().map(|(case, _)| case.air.clone()))?;
    Ok(Surrounded { eddies, wind, surroundings })
}

/// What strands that fly together must have in common.
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
