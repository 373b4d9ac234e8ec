//! Energy of the chain, and the two checks of the work done on it.

use crate::chain::Scheme;
use crate::chain::constants::Constants;
use crate::chain::forces::Element;
use crate::chain::laying::CarriedEnergy;
use crate::chain::work::WorkDone;
use spunlaid_ground::lanes::bend_ratio;
use spunlaid_ground::{Isa, Lanes, Register, Task, Vec3, Wide};

/// Energies [J] of eight chains at one instant, and the work done on them since the start.
#[derive(Clone, Copy, Debug, Default)]
pub struct Energy {
    /// `Σ ½ m v²`.
    pub kinetic: Lanes,
    /// `Σ ½ k_a (ℓ−l)²`.
    pub axial: Lanes,
    /// `Σ ½ k_θ θ²`.
    pub bending: Lanes,
    /// Work of all forces by the trapezoidal rule.
    pub work: Lanes,
    /// Work of gravity.
    pub gravity_work: Lanes,
    /// Work of the drag.
    pub drag_work: Lanes,
    /// Work of damping and bending viscosity, negative.
    pub damping_work: Lanes,
    /// Work of the electric field of charged fibres.
    pub field_work: Lanes,
    /// Work of what drives the root of a fed fibre.
    pub feed_work: Lanes,
    /// Work of the belt, negative: it stops what lands.
    pub belt_work: Lanes,
    /// Energy that came with fed fibre, minus the energy that left with laid fibre.
    pub carried: Lanes,
    /// Energy that the implicit tension has taken out of the motion and that the elements do not store.
    pub tension_dissipation: Lanes,
    /// Kinetic and potential energy at the start.
    pub initial: Lanes,
    /// Largest absolute strain of an element at this instant [-].
    pub strain: Lanes,
}

impl Energy {
    /// Kinetic, axial and bending energy of a chain, work of gravity, and largest strain.
    ///
    /// * `position`, `velocity` – of the `N+1` nodes at the same instant [m, m/s]
    /// * `start` – positions at time 0, where the work of gravity is zero [m]
    pub(crate) fn stored_energy(
        isa: Isa,
        constants: &Constants,
        position: &[Vec3<Lanes>],
        velocity: &[Vec3<Lanes>],
        start: &[Vec3<Lanes>],
    ) -> Self {
        isa.run(StateEnergy { constants, position, velocity, start })
    }

    /// Adds the work done since the start, at which the chain had the energy `initial`.
    ///
    /// * `before`, `after` – the sums of work before and after the step that starts at this instant
    pub(crate) fn enter_work(
        &mut self,
        initial: &Self,
        before: &WorkDone,
        after: &WorkDone,
        carried: &CarriedEnergy,
        scheme: Scheme,
        h: f64,
    ) {
        self.work = after.total.work(&before.total, h);
        self.drag_work = after.drag.work(&before.drag, h);
        self.damping_work = after.damping.work(&before.damping, h) - before.viscous;
        self.field_work = after.field.work(&before.field, h);
        self.initial = initial.kinetic + initial.axial + initial.bending;
        self.gravity_work = self.gravity_work + carried.gravity_work;
        self.feed_work = after.feed.work(&before.feed, h);
        // The belt has no work between two steps.
        self.belt_work = before.belt.both * Lanes::splat(0.5 * h) + carried.impacts;
        self.carried = carried.kinetic + carried.axial + carried.bending;
        if scheme == Scheme::ImplicitTension {
            let given_back = after.tension.work(&before.tension, h);
            self.tension_dissipation = initial.axial + carried.axial - self.axial - given_back;
        }
    }

    /// Potential and kinetic energy plus the dissipation of the implicit tension, minus the work of gravity,
    /// drag, damping, electric field, feed and belt and the energy carried in with the fibre [J]. It differs from
    /// zero by the error of the time integration only. theory.md (36)
    pub fn imbalance(&self) -> Lanes {
        let stored = self.kinetic + self.axial + self.bending + self.tension_dissipation;
        let supplied = self.initial + self.carried + self.feed_work + self.belt_work;
        stored - supplied - self.gravity_work - self.drag_work - self.damping_work - self.field_work
    }
}

/// Computes the energies that depend on positions and velocities.
struct StateEnergy<'a> {
    constants: &'a Constants,
    position: &'a [Vec3<Lanes>],
    velocity: &'a [Vec3<Lanes>],
    start: &'a [Vec3<Lanes>],
}

impl Task for StateEnergy<'_> {
    type Output = Energy;

    #[inline(always)]
    fn call<S: Register>(self) -> Energy {
        let c = self.constants;
        let nodes = self.position.len();
        let frame = Wide::<S>::load(&c.frame);
        let (mut kinetic, mut gravity_work) = (Wide::<S>::zero(), Wide::<S>::zero());
        for (i, ((position, velocity), start)) in
            self.position.iter().zip(self.velocity).zip(self.start).enumerate()
        {
            let node = c.node(i, nodes);
            let v = Vec3::load(velocity).less_y(frame);
            kinetic = Wide::load(&node.mass).mul_add(v.dot(v), kinetic);
            let fallen = Wide::load(&position.x) - Wide::load(&start.x);
            gravity_work = Wide::load(&node.weight).mul_add(fallen, gravity_work);
        }
        let mut axial = Wide::zero();
        let mut bending = Wide::zero();
        let mut strain = Wide::zero();
        let mut above = Vec3::load(&c.root_direction);
        for (j, pair) in self.position.windows(2).enumerate() {
            let element = Element::<S>::between(Vec3::load(&pair[0]), Vec3::load(&pair[1]));
            let properties = &c.element;
            let rest_length = Wide::load(&properties.rest_length);
            let mut stiffness = Wide::load(c.bending_stiffness(j));
            let mut stretch = element.length - rest_length;
            if j > 0 && c.may_be_held(j, nodes) {
                // Nodes that have left the chain have no mass, and their elements do not count.
                let (zero, mass) = (Wide::zero(), Wide::load(&c.node(j, nodes).mass));
                stretch = Wide::select_less(zero, mass, stretch, zero);
                stiffness = Wide::select_less(zero, mass, stiffness, zero);
            }
            axial = (Wide::load(&properties.axial_stiffness) * stretch).mul_add(stretch, axial);
            strain = stretch.over(rest_length).abs().max(strain);
            bending = stiffness.mul_add(angle_squared(above, element.tangent), bending);
            above = element.tangent;
        }
        let half = Wide::splat(0.5);
        Energy {
            kinetic: (kinetic * half).store(),
            axial: (axial * half).store(),
            bending: (bending * half).store(),
            gravity_work: gravity_work.store(),
            strain: strain.store(),
            ..Energy::default()
        }
    }
}

/// `θ²` of two unit vectors: `θ = (θ/sin θ) 2 √(x(1−x))` with `x = sin²(θ/2)`.
#[inline(always)]
fn angle_squared<S: Register>(a: Vec3<Wide<S>>, b: Vec3<Wide<S>>) -> Wide<S> {
    let turn = b - a;
    let turn_squared = turn.dot(turn);
    let ratio = bend_ratio(turn_squared);
    let cosine_squared = turn_squared.neg_mul_add(Wide::splat(0.25), Wide::splat(1.0));
    ratio * ratio * turn_squared * cosine_squared
}
