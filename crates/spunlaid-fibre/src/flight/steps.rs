//! Steps of a flight, and what is seen of it between them.

use super::{Flight, Snapshot};
use crate::chain::forces::ElementBlock;
use crate::chain::{Scheme, Stride, explicit, implicit};
use crate::energy::Energy;
use spunlaid_air::Instant;
use spunlaid_ground::{Error, Lanes, Register, Task, Vec3, WIDTH, Wide};

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
        self.run(steps, self.h, self.h, false);
    }

    /// Positions, velocities and energies now.
    pub fn snapshot(&self) -> Snapshot {
        self.clone().observe()
    }

    /// Positions, velocities and energies now. The flight advances by one step.
    pub fn observe(&mut self) -> Snapshot {
        let time = self.time();
        let chain = &self.chain;
        let position = chain.position.to_vec();
        let mut velocity = chain.velocity.to_vec();
        let tension = chain.tension();
        // The step may add nodes to a fed fibre and take others away.
        let fed_before =
            chain.laying.as_ref().map(|laying| (chain.constants.clone(), laying.origin.to_vec()));
        let nodes = chain.nodes();
        let in_air = chain.in_air();
        let fed = chain.fed();
        let carried = chain.laying.as_ref().map(|laying| laying.carried).unwrap_or_default();
        let root_strain_integral = self.root_strain * Lanes::splat(self.h);
        let (before, first) = (self.work, self.steps_done == 0);
        self.run(1, self.h, self.h, true);
        let drag = self.drag_of_elements(tension.len());
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
        let (constants, origin) = fed_before
            .as_ref()
            .map_or((&self.chain.constants, &self.start.position), |(c, origin)| (c, origin));
        let mut energy = Energy::stored_energy(self.isa, constants, &position, &velocity, origin);
        energy.enter_work(&self.start.energy, &before, &self.work, &carried, self.scheme, self.h);
        Snapshot { time, position, velocity, tension, drag, nodes, in_air, root_strain_integral, energy }
    }

    pub(super) fn run(&mut self, steps: u64, kick: f64, drift: f64, split: bool) {
        // The very first step always stores the work separately, because the sums begin with it.
        let first = steps.min(u64::from(self.steps_done == 0));
        for (steps, split) in [(first, true), (steps - first, split)] {
            let stride = Stride { kick, drift, damped: self.damped, split };
            match self.scheme {
                _ if steps == 0 => {}
                Scheme::SemiImplicitEuler => {
                    self.run_scheme::<{ Scheme::SemiImplicitEuler as u8 }>(steps, stride)
                }
                Scheme::Leapfrog => self.run_scheme::<{ Scheme::Leapfrog as u8 }>(steps, stride),
                Scheme::ImplicitTension => {
                    self.run_scheme::<{ Scheme::ImplicitTension as u8 }>(steps, stride)
                }
            }
        }
    }

    fn run_scheme<const SCHEME: u8>(&mut self, steps: u64, stride: Stride) {
        let isa = self.isa;
        match self.chain.laying {
            Some(_) => isa.run(Advance::<SCHEME, true> { flight: self, steps, stride }),
            None => isa.run(Advance::<SCHEME, false> { flight: self, steps, stride }),
        }
    }

    /// What a step changes besides the motion: fibre is fed and laid down.
    #[inline(never)]
    fn feed_and_lay(&mut self) {
        let fed = self.chain.fed();
        self.chain.slide(self.h);
        self.chain.feed_and_lay(self.steps_done, self.h);
        self.air.follow(self.chain.elements(), self.chain.fed() > fed);
    }

    #[inline(always)]
    fn count_step<S: Register>(&mut self) {
        if self.steps_done == 0 {
            self.work.begin();
        }
        self.steps_done += 1;
        if self.steps_done > self.clock.spin_up_steps && self.chain.laying.is_none() {
            self.end_node.see::<S>(&self.chain.position[self.chain.elements()]);
        }
        let element = Vec3::load(&self.chain.position[1]) - Vec3::load(&self.chain.position[0]);
        let strain =
            element.dot(element).sqrt().over(Wide::<S>::load(&self.chain.constants.element.rest_length))
                - Wide::splat(1.0);
        self.root_strain = (Wide::load(&self.root_strain) + strain).store();
    }
}

/// Steps of a flight with one scheme, of fibres that are fed or not. Each is compiled by itself: compilers
/// take far longer for one large function than for many small ones.
struct Advance<'a, const SCHEME: u8, const FED: bool> {
    flight: &'a mut Flight,
    steps: u64,
    stride: Stride,
}

impl<const SCHEME: u8, const FED: bool> Task for Advance<'_, SCHEME, FED> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        let Self { flight, steps, stride } = self;
        let mut block = ElementBlock::<S>::new();
        for _ in 0..steps {
            let now = Instant { step: flight.steps_done, time: flight.time() };
            let Flight { chain, air, work, .. } = flight;
            let air = air.look::<S>(now, &chain.position);
            if chain.charged.is_some() {
                chain.feel_field(work);
            }
            if SCHEME == Scheme::ImplicitTension as u8 {
                implicit::step::<S, FED>(chain, &air, stride, work, &mut block);
            } else if SCHEME == Scheme::Leapfrog as u8 {
                explicit::step::<S, true, FED>(chain, &air, stride, work, &mut block);
            } else {
                explicit::step::<S, false, FED>(chain, &air, stride, work, &mut block);
            }
            if chain.charged.is_some() {
                chain.enter_field(work);
            }
            flight.count_step::<S>();
            // The half kick of a start moves nothing.
            if FED && stride.drift != 0.0 {
                flight.feed_and_lay();
            }
        }
    }
}
