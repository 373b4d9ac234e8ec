//! Energy of the chain and the two ledgers kept against it.

use crate::chain::Chain;
use crate::chain::forces::Element;
use crate::lanes::Lanes;
use crate::vec3::Vec3;

/// Running sums of `F·v` over nodes and steps, with the velocities before and after each kick.
///
/// With `r_{k+1} − r_k = h v_after`, the trapezoidal rule of theory.md (33) up to time `t_K` is
/// `½h (Σ_{k≤K} F_k·v_before + Σ_{k<K} F_k·v_after)`, the very first `F₀·v_before` left out.
#[derive(Clone, Copy, Debug, Default)]
pub struct Power {
    before: Lanes,
    after: Lanes,
}

impl Power {
    #[inline(always)]
    pub(crate) fn add(&mut self, force: Vec3<Lanes>, before: Vec3<Lanes>, after: Vec3<Lanes>) {
        self.before = add_dot(force, before, self.before);
        self.after = add_dot(force, after, self.after);
    }

    /// Work [J] up to the positions of the last step's start: `earlier` is the ledger before that step.
    fn work(&self, earlier: &Self, h: f64) -> Lanes {
        (self.before + earlier.after) * (0.5 * h)
    }
}

#[inline(always)]
fn add_dot(a: Vec3<Lanes>, b: Vec3<Lanes>, sum: Lanes) -> Lanes {
    a.x.mul_add(b.x, a.y.mul_add(b.y, a.z.mul_add(b.z, sum)))
}

/// Work done on the nodes: of all forces together, and of those that no potential accounts for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Work {
    /// All forces (theory.md (33), Eq 35 of the paper).
    pub total: Power,
    /// The drag of the air.
    pub drag: Power,
    /// The mass-proportional damping.
    pub damping: Power,
}

impl Work {
    /// Drops what the first step added for the time before it; called once, after that step.
    pub(crate) fn begin(&mut self) {
        for power in [&mut self.total, &mut self.drag, &mut self.damping] {
            power.before = Lanes::ZERO;
        }
    }
}

/// Energies [J] of eight chains at one instant, work done on them since the start.
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
    /// Work of the damping, negative.
    pub damping_work: Lanes,
    /// Largest strain of an element at this instant, by size [-].
    pub strain: Lanes,
}

impl Energy {
    /// Takes stock of a chain.
    ///
    /// * `position`, `velocity` – of the `N+1` nodes at the same instant [m, m/s]
    /// * `start` – positions at time 0, from where gravity's work counts [m]
    /// * `before`, `after` – the ledger before and after the step that starts at this instant
    pub fn of(
        chain: &Chain,
        position: &[Vec3<Lanes>],
        velocity: &[Vec3<Lanes>],
        start: &[Vec3<Lanes>],
        (before, after): (&Work, &Work),
        h: f64,
    ) -> Self {
        let c = &chain.constants;
        let n = chain.elements();
        let half = Lanes::splat(0.5);
        let mut e = Self {
            work: after.total.work(&before.total, h),
            drag_work: after.drag.work(&before.drag, h),
            damping_work: after.damping.work(&before.damping, h),
            ..Self::default()
        };
        for i in 0..=n {
            let mass = if i == 0 || i == n { c.mass * half } else { c.mass };
            e.kinetic += half * mass * velocity[i].dot(velocity[i]);
            e.gravity_work += mass * c.gravity * (position[i].x - start[i].x);
        }
        let mut above = c.root_direction;
        let mut stiffness = c.root_stiffness;
        for j in 0..n {
            let element = Element::between(position[j], position[j + 1]);
            let stretch = element.length - c.rest_length;
            e.axial += half * c.axial_stiffness * stretch * stretch;
            e.strain = e.strain.max((stretch / c.rest_length).abs());
            let angle = angle_between(above, element.tangent);
            e.bending += half * stiffness * angle * angle;
            above = element.tangent;
            stiffness = c.bending_stiffness;
        }
        e
    }

    /// Potential and kinetic energy less the work of gravity, drag and damping [J]: zero but for the
    /// error of the time integration.                                        theory.md (36)
    pub fn imbalance(&self) -> Lanes {
        self.kinetic + self.axial + self.bending - self.gravity_work - self.drag_work - self.damping_work
    }
}

/// Angle between unit vectors, accurate from 0 to π.
fn angle_between(a: Vec3<Lanes>, b: Vec3<Lanes>) -> Lanes {
    Lanes::from_fn(|i| {
        let (a, b) = (a.lane(i), b.lane(i));
        let (difference, sum) = ((b - a).norm(), (b + a).norm());
        2.0 * libm::atan2(difference, sum)
    })
}
