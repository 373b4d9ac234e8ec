//! Eight fibres flying side by side.

use crate::air::{Eddies, Turbulence, Wind};
use crate::chain::schemes::{Block, Scheme, step};
use crate::chain::{Chain, Strand};
use crate::energy::{Energy, Work};
use crate::lanes::{Isa, Lanes, Register, Task};
use crate::observe::EndNodeObserver;
use crate::vec3::Vec3;

/// A bundle of up to eight chains in flight.
#[derive(Clone, Debug)]
pub struct Bundle<'a> {
    isa: Isa,
    scheme: Scheme,
    damped: bool,
    h: f64,
    chain: Chain,
    start: Vec<Vec3<Lanes>>,
    eddies: &'a Eddies,
    wind: Wind<'a>,
    work: Work,
    steps_done: u64,
    /// Steps whose positions the end-node statistics leave out.
    spin_up: u64,
    end_node: EndNodeObserver,
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

impl<'a> Bundle<'a> {
    /// Straight fibres at rest in a wind, to be advanced by steps of `h` [s].
    pub fn new(
        isa: Isa,
        strands: &[Strand],
        eddies: &'a Eddies,
        turbulence: &'a Turbulence,
        scheme: Scheme,
        h: f64,
        spin_up: u64,
    ) -> Self {
        let chain = Chain::straight(strands);
        let mut bundle = Self {
            isa,
            scheme,
            damped: strands.iter().any(|s| s.damping != 0.0),
            h,
            start: chain.position.clone(),
            chain,
            eddies,
            wind: Wind::new(turbulence),
            work: Work::default(),
            steps_done: 0,
            spin_up,
            end_node: EndNodeObserver::default(),
        };
        bundle.start_leapfrog();
        bundle
    }

    /// Puts the nodes elsewhere, with velocities, and starts the clock and all records again.
    ///
    /// * `position`, `velocity` – of the `N+1` nodes [m, m/s]
    pub fn restart_from(&mut self, position: Vec<Vec3<Lanes>>, velocity: Vec<Vec3<Lanes>>) {
        debug_assert_eq!(position.len(), self.chain.position.len());
        self.start.clone_from(&position);
        (self.chain.position, self.chain.velocity) = (position, velocity);
        self.steps_done = 0;
        self.work = Work::default();
        self.end_node = EndNodeObserver::default();
        self.start_leapfrog();
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
        let before = self.work;
        self.run(1, (self.h, self.h), true);
        if self.scheme == Scheme::Leapfrog {
            for (v, after) in velocity.iter_mut().zip(&self.chain.velocity) {
                *v = (*v + *after) * Lanes::splat(0.5);
            }
        }
        let ledgers = (&before, &self.work);
        let energy = Energy::of(&self.chain, &position, &velocity, &self.start, ledgers, self.h);
        Snapshot { time, position, velocity, energy }
    }

    /// Takes the velocities from time 0 to half a step before, and makes the first extrapolation of the
    /// drag's velocity give those at time 0.
    fn start_leapfrog(&mut self) {
        if self.scheme != Scheme::Leapfrog {
            return;
        }
        let at_rest = self.chain.velocity.clone();
        self.chain.earlier.clone_from(&at_rest);
        self.run(1, (-0.5 * self.h, 0.0), false);
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
        let first = steps.min(u64::from(self.steps_done == 0));
        if split || first == 1 {
            isa.run(Advance::<true> { bundle: self, steps: if split { steps } else { first }, kick_and_drift });
        }
        if !split {
            isa.run(Advance::<false> { bundle: self, steps: steps - first, kick_and_drift });
        }
    }
}

/// Steps of a bundle; with `SPLIT` the ledger keeps apart what the velocities before each kick gave.
struct Advance<'b, 'a, const SPLIT: bool> {
    bundle: &'b mut Bundle<'a>,
    steps: u64,
    kick_and_drift: (f64, f64),
}

impl<const SPLIT: bool> Task for Advance<'_, '_, SPLIT> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        match (self.bundle.scheme, self.bundle.damped) {
            (Scheme::SemiImplicitEuler, false) => self.steps::<S, false, false>(),
            (Scheme::SemiImplicitEuler, true) => self.steps::<S, false, true>(),
            (Scheme::Leapfrog, false) => self.steps::<S, true, false>(),
            (Scheme::Leapfrog, true) => self.steps::<S, true, true>(),
        }
    }
}

impl<const SPLIT: bool> Advance<'_, '_, SPLIT> {
    #[inline(always)]
    fn steps<S: Register, const LEAPFROG: bool, const DAMPED: bool>(self) {
        let b = self.bundle;
        let end = b.chain.elements();
        let mut block = Block::new();
        for _ in 0..self.steps {
            let wind = b.wind.blow::<S>(b.steps_done as f64 * b.h);
            let eddy = b.eddies.of_element();
            step::<S, LEAPFROG, DAMPED, SPLIT>(&mut b.chain, wind, eddy, self.kick_and_drift, &mut b.work, &mut block);
            if b.steps_done == 0 {
                b.work.begin();
            }
            b.steps_done += 1;
            if b.steps_done > b.spin_up {
                b.end_node.see::<S>(&b.chain.position[end]);
            }
        }
    }
}
