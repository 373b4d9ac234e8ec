//! Steps of a flight, and what is seen of it between them.

use super::{Flight, Snapshot};
use crate::air::InEddies;
use crate::chain::force_pass::ElementBlock;
use crate::chain::schemes::Scheme;
use crate::chain::{explicit, implicit};
use crate::energy::Energy;
use crate::error::{Error, FlightFault};
use crate::fibre::Root;
use crate::lanes::{Lanes, Register, Task, WIDTH, Wide};
use crate::line::Line;
use crate::vec3::Vec3;

/// Length of fibre in the air, in distances to the belt, above which it does not reach the belt.
const MOST_IN_AIR: f64 = 10.0;

/// Number of steps between two checks that all positions are finite.
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
            return Err(FlightFault::TimePast { time, now: self.time() }.into());
        }
        let mut left = steps as u64 - self.steps_done;
        while left > 0 {
            let now = left.min(STEPS_UNSEEN);
            self.advance(now);
            left -= now;
            if let Some(lost) = self.lost().or_else(|| self.adrift()) {
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
            for (i, (v, after)) in velocity.iter_mut().zip(after).enumerate() {
                let mean = (*v + *after) * Lanes::splat(0.5);
                // A node that lands in the step does not know of it yet.
                let landed = |lane: usize| i > 0 && self.chain.is_held(i + born, lane);
                (0..WIDTH).filter(|&lane| !landed(lane)).for_each(|lane| v.set_lane(lane, mean.lane(lane)));
            }
        }
        let mut energy = Energy::held(self.isa, &constants, &position, &velocity, &origin);
        let works = (&before, &self.work);
        energy.enter_work(&self.start.energy, works, &carried, self.scheme, self.h);
        Snapshot { time, position, velocity, tension, nodes, in_air, root_strain_integral, energy }
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

    /// The first fibre that does not reach the belt, if there is one: ten times the way has been fed and has not landed.
    pub(crate) fn adrift(&self) -> Option<Error> {
        let in_air = self.chain.in_air();
        let length = |lane: usize, line: &Line| {
            in_air[lane] as f64 * self.chain.constants.rest_length.0[lane] / line.distance
        };
        self.cases.iter().enumerate().find_map(|(lane, (case, replicate))| {
            let line = case.line.as_ref()?;
            (length(lane, line) > MOST_IN_AIR).then(|| Error::NotLanding {
                replicate: replicate + 1,
                times: MOST_IN_AIR,
                time: self.time(),
                reached: self.chain.position.iter().map(|p| p.x.0[lane]).fold(f64::NEG_INFINITY, f64::max),
                distance: line.distance,
            })
        })
    }

    pub(super) fn run(&mut self, steps: u64, kick_and_drift: (f64, f64), split: bool) {
        let isa = self.isa;
        // The very first step always stores the work separately, because the sums begin with it.
        let first = steps.min(u64::from(self.steps_done == 0));
        for (steps, split) in [(first, true), (steps - first, split)] {
            if steps > 0 {
                isa.run(Advance { flight: self, steps, kick_and_drift, split });
            }
        }
    }

    /// What a step changes besides the motion: fibre is fed and laid down.
    #[inline(always)]
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
        if self.steps_done > self.spin_up && self.stations.is_none() {
            self.end_node.see::<S>(&self.chain.position[self.chain.elements()]);
        }
        let element = Vec3::load(&self.chain.position[1]) - Vec3::load(&self.chain.position[0]);
        let strain = element.dot(element).sqrt().over(Wide::<S>::load(&self.chain.constants.rest_length))
            - Wide::splat(1.0);
        self.root_strain = (Wide::load(&self.root_strain) + strain).store();
    }
}

/// Advances a flight by a number of steps in its wind. This is a macro because a closure would not be inlined.
macro_rules! in_wind {
    ($steps:expr, $b:ident, $moves:expr, |$wind:ident, $fed:ident| $step:block) => {
        for _ in 0..$steps {
            let time = $b.steps_done as f64 * $b.h;
            if let Some(stations) = &mut $b.stations {
                const $fed: bool = true;
                let $wind = stations.around::<S>($b.steps_done, time, &mut $b.wind, &$b.chain.position);
                $step
            } else {
                const $fed: bool = false;
                let eddies = InEddies { now: $b.wind.blow::<S>(time), of_element: $b.eddies.of_element() };
                if let Some(surroundings) = &mut $b.surroundings {
                    let $wind = surroundings.around::<S>($b.steps_done, &$b.chain.position, eddies);
                    $step
                } else {
                    let $wind = eddies;
                    $step
                }
            }
            $b.count_step::<S>();
            if $moves {
                $b.feed_and_lay();
            }
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
        in_wind!(self.steps, b, by.1 != 0.0, |wind, FED| {
            explicit::step::<S, LEAPFROG, FED>(&mut b.chain, wind, by, how, &mut b.work, &mut block);
        });
    }

    #[inline(always)]
    fn implicit_steps<S: Register>(self) {
        let b = self.flight;
        let how = (b.damped, self.split);
        let mut block = ElementBlock::new();
        in_wind!(self.steps, b, true, |wind, FED| {
            implicit::step::<S, FED>(&mut b.chain, wind, b.h, how, &mut b.work, &mut block);
        });
    }
}
