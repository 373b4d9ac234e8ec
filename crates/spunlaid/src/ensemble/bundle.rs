//! Eight fibres flying side by side.

use crate::air::{Eddies, Turbulence, Wind};
use crate::chain::schemes::{Scheme, step};
use crate::chain::{Chain, Strand};
use crate::energy::{Energy, Work};
use crate::lanes::isa::Task;
use crate::lanes::{Isa, Lanes};
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
        self.run(steps, self.h, self.h);
    }

    /// Positions, velocities and energies now; looks one step ahead without taking it.
    pub fn snapshot(&self) -> Snapshot {
        let mut ahead = self.clone();
        ahead.advance(1);
        let position = self.chain.position.clone();
        let velocity = match self.scheme {
            Scheme::SemiImplicitEuler => self.chain.velocity.clone(),
            Scheme::Leapfrog => {
                let both = self.chain.velocity.iter().zip(&ahead.chain.velocity);
                both.map(|(&a, &b)| (a + b) * Lanes::splat(0.5)).collect()
            }
        };
        let ledgers = (&self.work, &ahead.work);
        let energy = Energy::of(&self.chain, &position, &velocity, &self.start, ledgers, self.h);
        Snapshot { time: self.time(), position, velocity, energy }
    }

    /// Takes the velocities from time 0 to half a step before, and makes the first extrapolation of the
    /// drag's velocity give those at time 0.
    fn start_leapfrog(&mut self) {
        if self.scheme != Scheme::Leapfrog {
            return;
        }
        let at_rest = self.chain.velocity.clone();
        self.chain.earlier.clone_from(&at_rest);
        self.run(1, -0.5 * self.h, 0.0);
        self.steps_done = 0;
        self.work = Work::default();
        self.end_node = EndNodeObserver::default();
        for (i, &v0) in at_rest.iter().enumerate() {
            let v = self.chain.velocity[i];
            self.chain.earlier[i] = v + (v - v0) * Lanes::splat(2.0);
        }
    }

    fn run(&mut self, steps: u64, kick: f64, drift: f64) {
        self.isa.run(Advance { bundle: self, steps, kick, drift });
    }
}

struct Advance<'b, 'a> {
    bundle: &'b mut Bundle<'a>,
    steps: u64,
    kick: f64,
    drift: f64,
}

impl Task for Advance<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        match (self.bundle.scheme, self.bundle.damped) {
            (Scheme::SemiImplicitEuler, false) => self.steps::<false, false>(),
            (Scheme::SemiImplicitEuler, true) => self.steps::<false, true>(),
            (Scheme::Leapfrog, false) => self.steps::<true, false>(),
            (Scheme::Leapfrog, true) => self.steps::<true, true>(),
        }
    }
}

impl Advance<'_, '_> {
    #[inline(always)]
    fn steps<const LEAPFROG: bool, const DAMPED: bool>(self) {
        let b = self.bundle;
        let (kick, drift) = (Lanes::splat(self.kick), Lanes::splat(self.drift));
        let end = b.chain.elements();
        for _ in 0..self.steps {
            let wind = b.wind.at(b.steps_done as f64 * b.h);
            step::<LEAPFROG, DAMPED>(&mut b.chain, wind, b.eddies.of_element(), kick, drift, &mut b.work);
            if b.steps_done == 0 {
                b.work.begin();
            }
            b.steps_done += 1;
            if b.steps_done > b.spin_up {
                b.end_node.see(b.chain.position[end]);
            }
        }
    }
}
