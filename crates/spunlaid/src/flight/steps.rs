//! Steps of a flight, and what is seen of it between them.

use super::{Flight, Snapshot};
use crate::air::{AirAtElements, InEddies};
use crate::chain::Chain;
use crate::chain::force_pass::ElementBlock;
use crate::chain::schemes::Scheme;
use crate::chain::work::WorkDone;
use crate::chain::{explicit, implicit};
use crate::energy::Energy;
use crate::error::Error;
use crate::lanes::{Lanes, Register, Task, WIDTH, Wide};
use crate::vec3::Vec3;

/// Number of steps between two checks that no fibre is lost.
const STEPS_UNSEEN: u64 = 256;

impl Flight {
    /// Advances all fibres to a time [s], to the nearest whole step. There is no last time: the wind is made as
    /// the time goes on.
    ///
    /// # Errors
    /// A time that has passed, and a fibre that stops being finite; the flight is of no further use then.
    pub fn step_to(&mut self, time: f64) -> Result<(), Error> {
        let steps = (time / self.h).round();
        // Beyond 2^53 steps a number of steps is no whole number any more.
        if !(steps >= self.steps_done as f64 && steps < 9e15) {
            let now = self.time();
            return Err(Error::flight(
                format!("the flight is at {now:e} s and cannot step to {time:e} s"),
                "name a later time",
            ));
        }
        let mut left = steps as u64 - self.steps_done;
        while left > 0 {
            let now = left.min(STEPS_UNSEEN);
            self.advance(now);
            left -= now;
            if let Some((_, lost)) = self.lost() {
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
        let chain = &self.chain;
        let (position, mut velocity) = (chain.position.to_vec(), chain.velocity.to_vec());
        let tension = chain.tension();
        // The step may add nodes and take others away.
        let (constants, origin) = (chain.constants.clone(), chain.origin(&self.start.position).to_vec());
        let (nodes, in_air, fed) = (chain.nodes(), chain.in_air(), chain.fed());
        let carried = chain.laying.as_ref().map(|laying| laying.carried).unwrap_or_default();
        let root_strain_integral = self.root_strain * Lanes::splat(self.h);
        let (before, first) = (self.work, self.steps_done == 0);
        self.run(1, (self.h, self.h), true);
        if first {
            velocity.clone_from(&self.start.velocity);
        } else if self.scheme.is_staggered() {
            let born = (self.chain.fed() - fed) as usize;
            let after = self.chain.velocity.get(born..).unwrap_or_default();
            let laid = self.chain.laying.is_some();
            for (i, (v, after)) in velocity.iter_mut().zip(after).enumerate() {
                let mean = (*v + *after) * Lanes::splat(0.5);
                // A node that lands in the step does not know of it yet.
                let landed = |lane: usize| laid && i > 0 && self.chain.is_held(i + born, lane);
                if (0..WIDTH).any(landed) {
                    (0..WIDTH)
                        .filter(|&lane| !landed(lane))
                        .for_each(|lane| v.set_lane(lane, mean.lane(lane)));
                } else {
                    *v = mean;
                }
            }
        }
        let mut energy = Energy::held(self.isa, &constants, &position, &velocity, &origin);
        let works = (&before, &self.work);
        energy.enter_work(&self.start.energy, works, &carried, self.scheme, self.h);
        Snapshot { time, position, velocity, tension, nodes, in_air, root_strain_integral, energy }
    }

    pub(super) fn run(&mut self, steps: u64, kick_and_drift: (f64, f64), split: bool) {
        // The very first step always stores the work separately, because the sums begin with it.
        let first = steps.min(u64::from(self.steps_done == 0));
        for (steps, split) in [(first, true), (steps - first, split)] {
            let how = How { steps, kick_and_drift, split };
            match self.scheme {
                _ if steps == 0 => {}
                Scheme::SemiImplicitEuler => self.run_in_air::<{ Scheme::SemiImplicitEuler as u8 }>(how),
                Scheme::Leapfrog => self.run_in_air::<{ Scheme::Leapfrog as u8 }>(how),
                Scheme::ImplicitTension => self.run_in_air::<{ Scheme::ImplicitTension as u8 }>(how),
            }
        }
    }

    fn run_in_air<const SCHEME: u8>(&mut self, how: How) {
        let isa = self.isa;
        match (&self.stations, &self.surroundings) {
            (Some(_), _) => isa.run(Advance::<SCHEME, ALONG_THE_WAY> { flight: self, how }),
            (None, Some(_)) => isa.run(Advance::<SCHEME, IN_FLOW> { flight: self, how }),
            (None, None) => isa.run(Advance::<SCHEME, UNIFORM> { flight: self, how }),
        }
    }

    /// What a step changes besides the motion: fibre is fed and laid down.
    #[inline(never)]
    fn feed_and_lay(&mut self) {
        if let Some(stations) = &mut self.stations {
            let fed = self.chain.fed();
            self.chain.slide(self.h);
            self.chain.feed_and_lay(self.steps_done, self.h);
            stations.follow(self.chain.elements(), self.chain.fed() > fed);
        }
    }

    #[inline(always)]
    fn count_step<S: Register>(&mut self) {
        if self.steps_done == 0 {
            self.work.begin();
        }
        self.steps_done += 1;
        if self.steps_done > self.clock.spin_up_steps && self.stations.is_none() {
            self.end_node.see::<S>(&self.chain.position[self.chain.elements()]);
        }
        let element = Vec3::load(&self.chain.position[1]) - Vec3::load(&self.chain.position[0]);
        let strain = element.dot(element).sqrt().over(Wide::<S>::load(&self.chain.constants.rest_length))
            - Wide::splat(1.0);
        self.root_strain = (Wide::load(&self.root_strain) + strain).store();
    }
}

/// The kinds of air: that of fed fibres, a flow that differs from place to place, and the same everywhere but for eddies.
const ALONG_THE_WAY: u8 = 0;
const IN_FLOW: u8 = 1;
const UNIFORM: u8 = 2;

/// How a flight is advanced.
#[derive(Clone, Copy)]
struct How {
    steps: u64,
    kick_and_drift: (f64, f64),
    /// Whether the work of the velocities before each kick is stored separately.
    split: bool,
}

/// Steps of a flight with one scheme in one kind of air. Each is compiled by itself: compilers take far longer for one
/// large function than for many small ones.
struct Advance<'a, const SCHEME: u8, const AIR: u8> {
    flight: &'a mut Flight,
    how: How,
}

impl<const SCHEME: u8, const AIR: u8> Task for Advance<'_, SCHEME, AIR> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        let Self { flight, how } = self;
        let mut block = ElementBlock::<S>::new();
        for _ in 0..how.steps {
            let (step, time) = (flight.steps_done, flight.steps_done as f64 * flight.h);
            let Flight { stations, surroundings, wind, eddies, chain, work, h, damped, .. } = flight;
            let moved = Moved { chain, work, block: &mut block, h: *h, damped: *damped, how };
            match (stations, surroundings) {
                (Some(stations), _) if AIR == ALONG_THE_WAY => {
                    let air = stations.around::<S>(step, time, wind, &moved.chain.position);
                    moved.step::<SCHEME, true>(air);
                }
                (_, Some(flow)) if AIR == IN_FLOW => {
                    let eddies = InEddies { now: wind.blow::<S>(time), of_element: eddies.of_element() };
                    let air = flow.around::<S>(step, &moved.chain.position, eddies);
                    moved.step::<SCHEME, false>(air);
                }
                _ => {
                    let eddies = InEddies { now: wind.blow::<S>(time), of_element: eddies.of_element() };
                    moved.step::<SCHEME, false>(eddies);
                }
            }
            flight.count_step::<S>();
            let moves = SCHEME == Scheme::ImplicitTension as u8 || how.kick_and_drift.1 != 0.0;
            if AIR == ALONG_THE_WAY && moves {
                flight.feed_and_lay();
            }
        }
    }
}

/// What a step changes.
struct Moved<'a, S: Register> {
    chain: &'a mut Chain,
    work: &'a mut WorkDone,
    block: &'a mut ElementBlock<S>,
    h: f64,
    damped: bool,
    how: How,
}

impl<S: Register> Moved<'_, S> {
    #[inline(always)]
    fn step<const SCHEME: u8, const FED: bool>(self, air: impl AirAtElements<S>) {
        let Self { chain, work, block, h, damped, how: How { kick_and_drift, split, .. } } = self;
        let how = (damped, split);
        if SCHEME == Scheme::ImplicitTension as u8 {
            implicit::step::<S, FED>(chain, air, h, how, work, block);
        } else if SCHEME == Scheme::Leapfrog as u8 {
            explicit::step::<S, true, FED>(chain, air, kick_and_drift, how, work, block);
        } else {
            explicit::step::<S, false, FED>(chain, air, kick_and_drift, how, work, block);
        }
    }
}
