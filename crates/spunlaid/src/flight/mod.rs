//! Eight fibres flying side by side.

use crate::air::{Eddies, Surroundings, Turbulence, Wind};
use crate::chain::force_pass::Block;
use crate::chain::ledger::Work;
use crate::chain::schemes::Scheme;
use crate::chain::{Chain, Strand};
use crate::chain::{explicit, implicit};
use crate::energy::Energy;
use crate::lanes::{Isa, Lanes, Register, Task};
use crate::observe::EndNodeObserver;
use crate::vec3::Vec3;

/// A bundle of up to eight chains in flight.
#[derive(Clone, Debug)]
pub struct Flight<'a> {
    isa: Isa,
    scheme: Scheme,
    damped: bool,
    h: f64,
    chain: Chain,
    start: Start,
    eddies: &'a Eddies,
    wind: Wind<'a>,
    /// Where the air is not the same everywhere: what of it is around the fibres.
    surroundings: Option<Surroundings<'a>>,
    work: Work,
    steps_done: u64,
    /// Steps whose positions the end-node statistics leave out.
    spin_up: u64,
    end_node: EndNodeObserver,
}

/// Where the fibres started.
#[derive(Clone, Debug, Default)]
struct Start {
    position: Vec<Vec3<Lanes>>,
    velocity: Vec<Vec3<Lanes>>,
    energy: Energy,
}

/// Positions, velocities and energies of a bundle at one instant.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// Time since the start [s].
    pub time: f64,
    /// Of the `N+1` nodes [m].
    pub position: Vec<Vec3<Lanes>>,
    /// Of the `N+1` nodes, at the same instant [m/s].
    pub velocity: Vec<Vec3<Lanes>>,
    /// Energies and work done.
    pub energy: Energy,
}

impl<'a> Flight<'a> {
    /// Straight fibres at rest in a wind that is the same everywhere but for its eddies, to be advanced by
    /// steps of `h` [s].
    pub fn new(
        isa: Isa,
        strands: &[Strand],
        eddies: &'a Eddies,
        turbulence: &'a Turbulence,
        scheme: Scheme,
        h: f64,
        spin_up: u64,
    ) -> Self {
        Self::within(isa, strands, (eddies, turbulence, None), scheme, h, spin_up)
    }

    /// Straight fibres at rest in air that may differ from place to place, to be advanced by steps of `h` [s].
    ///
    /// * `air` – with `surroundings`, the turbulence has a mean of zero and a rms of one
    pub fn within(
        isa: Isa,
        strands: &[Strand],
        (eddies, turbulence, surroundings): (&'a Eddies, &'a Turbulence, Option<Surroundings<'a>>),
        scheme: Scheme,
        h: f64,
        spin_up: u64,
    ) -> Self {
        let chain = Chain::straight(strands, scheme);
        let mut bundle = Self {
            isa,
            scheme,
            damped: strands.iter().any(|s| s.damping != 0.0),
            h,
            start: Start::default(),
            chain,
            eddies,
            wind: Wind::new(turbulence),
            surroundings,
            work: Work::default(),
            steps_done: 0,
            spin_up,
            end_node: EndNodeObserver::default(),
        };
        bundle.begin();
        bundle
    }

    /// Puts the nodes elsewhere, with velocities, and starts the clock and all records again.
    ///
    /// * `position`, `velocity` – of the `N+1` nodes [m, m/s]
    pub fn restart_from(&mut self, position: Vec<Vec3<Lanes>>, velocity: Vec<Vec3<Lanes>>) {
        debug_assert_eq!(position.len(), self.chain.position.len());
        (self.chain.position, self.chain.velocity) = (position, velocity);
        self.steps_done = 0;
        self.work = Work::default();
        self.end_node = EndNodeObserver::default();
        self.begin();
    }

    /// Adds to the velocity of a node [m/s]: a push from outside the model.
    pub fn push(&mut self, node: usize, by: Vec3<Lanes>) {
        self.chain.velocity[node] += by;
        self.chain.earlier[node] += by;
    }

    /// Puts a node at rest at a place [m], as a hand would.
    pub fn hold(&mut self, node: usize, at: Vec3<Lanes>) {
        self.chain.position[node] = at;
        self.chain.velocity[node] = Vec3::ZERO;
        self.chain.earlier[node] = Vec3::ZERO;
    }

    /// The chains, positions and velocities as the scheme keeps them.
    pub fn chain(&self) -> &Chain {
        &self.chain
    }

    /// Time of the positions [s].
    pub fn time(&self) -> f64 {
        self.steps_done as f64 * self.h
    }

    /// Statistics of the end nodes so far.
    pub fn end_node(&self) -> &EndNodeObserver {
        &self.end_node
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
        Snapshot { time, position, velocity, energy }
    }

    /// Share of the time that the elements of a lane's fibre have spent outside of what the flow knows; none
    /// where the air is the same everywhere.
    pub fn outside(&self, lane: usize) -> Option<f64> {
        self.surroundings.as_ref().map(|surroundings| surroundings.outside(lane))
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
        self.end_node = EndNodeObserver::default();
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
                isa.run(Advance { bundle: self, steps, kick_and_drift, split });
            }
        }
    }
}

/// So many steps of a bundle in the wind of their time; a macro, for a closure would be called, not inlined.
macro_rules! in_wind {
    ($steps:expr, $b:ident, |$wind:ident, $eddy:ident| $step:block) => {
        for _ in 0..$steps {
            let gust = $b.wind.blow::<S>($b.steps_done as f64 * $b.h);
            let $eddy = $b.eddies.of_element();
            if let Some(surroundings) = &mut $b.surroundings {
                let $wind = surroundings.around::<S>($b.steps_done, &$b.chain.position, gust);
                $step
            } else {
                let $wind = gust;
                $step
            }
            $b.count_step::<S>();
        }
    };
}

/// Steps of a bundle; with `split` the ledger keeps apart what the velocities before each kick gave.
struct Advance<'b, 'a> {
    bundle: &'b mut Flight<'a>,
    steps: u64,
    kick_and_drift: (f64, f64),
    split: bool,
}

impl Task for Advance<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        match self.bundle.scheme {
            Scheme::SemiImplicitEuler => self.steps::<S, false>(),
            Scheme::Leapfrog => self.steps::<S, true>(),
            Scheme::ImplicitTension => self.implicit_steps::<S>(),
        }
    }
}

impl Advance<'_, '_> {
    #[inline(always)]
    fn steps<S: Register, const LEAPFROG: bool>(self) {
        let (b, by) = (self.bundle, self.kick_and_drift);
        let how = (b.damped, self.split);
        let mut block = Block::new();
        in_wind!(self.steps, b, |wind, eddy| {
            explicit::step::<S, LEAPFROG>(&mut b.chain, wind, eddy, by, how, &mut b.work, &mut block);
        });
    }

    #[inline(always)]
    fn implicit_steps<S: Register>(self) {
        let b = self.bundle;
        let how = (b.damped, self.split);
        let mut block = Block::new();
        in_wind!(self.steps, b, |wind, eddy| {
            implicit::step::<S>(&mut b.chain, wind, eddy, b.h, how, &mut b.work, &mut block);
        });
    }
}

impl Flight<'_> {
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
