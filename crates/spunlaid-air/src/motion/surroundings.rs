//! The air around eight fibres in a flow that is not uniform.

use super::Air;
use crate::field::{AirAround, Hint};
use spunlaid_ground::place::Inlet;
use spunlaid_ground::{Error, Lanes, Nodes, PerLane, Register, Task, Vec3, WIDTH, Wide};

/// Mean velocity and rms where an element is, of eight fibres.
///
/// Looked up every few steps and extrapolated linearly from the last two looks in between: the error is of second
/// order in the time between them.
#[derive(Clone, Copy, Debug, Default)]
struct FlowAtElement {
    /// Velocity x, y, z and rms at the last look [m/s].
    value: [Lanes; 4],
    /// Their rise in a step [m/s].
    rise: [Lanes; 4],
}

/// The air around an element of eight fibres, linear in space. It is used until the element has moved too far.
#[derive(Clone, Copy, Debug)]
struct LinearAir {
    /// Where the element was [m].
    at: Vec3<Lanes>,
    /// How far it may move along each axis [m].
    reach: Lanes,
    /// Velocity x, y, z and rms there [m/s].
    value: [Lanes; 4],
    /// Their change along x, y and z [1/s].
    gradients: [[Lanes; 4]; 3],
    /// One if the place lies outside the flow's data, zero otherwise.
    outside: Lanes,
}

/// Nothing is known of the air yet.
const UNKNOWN: LinearAir = LinearAir {
    at: Vec3::new(Lanes::ZERO, Lanes::ZERO, Lanes::ZERO),
    reach: Lanes::splat(-1.0),
    value: [Lanes::ZERO; 4],
    gradients: [[Lanes::ZERO; 4]; 3],
    outside: Lanes::ZERO,
};

/// The air of a fibre, and where in it the fibre begins.
#[derive(Clone, Debug)]
pub struct FibreAir {
    /// The air.
    pub air: Air,
    /// The fibre's inlet.
    pub inlet: Inlet,
}

/// The air around the elements of eight fibres.
#[derive(Clone, Debug)]
pub struct Surroundings {
    airs: PerLane<FibreAir>,
    places: Nodes<FlowAtElement>,
    nearby: Nodes<LinearAir>,
    /// Where each fibre's element was found last.
    hints: Nodes<[Hint; WIDTH]>,
    /// Steps from one look to the next.
    every: u64,
    looked: bool,
    /// Number of each fibre's looks at elements outside of the flow's data, and number of all looks.
    outside: Lanes,
    looks: u64,
}

impl Surroundings {
    /// * `airs` – of up to eight fibres; lanes left over repeat the first
    /// * `every` – steps from one look at the flow to the next
    ///
    /// # Errors
    /// No air or more than eight.
    pub fn new(airs: Vec<Air>, elements: usize, every: u64) -> Result<Self, Error> {
        let middle = |air| FibreAir { air, inlet: Inlet::default() };
        Ok(Self::around_elements(PerLane::new(airs.into_iter().map(middle).collect())?, elements, every))
    }

    /// The same for airs with their own inlets.
    pub fn around_elements(airs: PerLane<FibreAir>, elements: usize, every: u64) -> Self {
        let every = every.max(1);
        let places = vec![FlowAtElement::default(); elements].into();
        let nearby = vec![UNKNOWN; elements].into();
        let hints = vec![[Hint::default(); WIDTH]; elements].into();
        Self { airs, places, nearby, hints, every, looked: false, outside: Lanes::ZERO, looks: 0 }
    }

    /// Share of the time that the elements of a lane's fibre have spent outside of the flow's data.
    pub(crate) fn outside(&self, lane: usize) -> f64 {
        if self.looks == 0 { 0.0 } else { self.outside.0[lane] / self.looks as f64 }
    }

    /// Replaces the air by another one of the same flow. The values of the last look are kept until the next.
    pub(crate) fn change(&mut self, by: Self) {
        (self.airs, self.every) = (by.airs, by.every);
        self.nearby.fill(UNKNOWN);
    }

    /// Forgets the looks so far.
    pub(crate) fn forget(&mut self) {
        *self = Self::around_elements(self.airs.clone(), self.places.len(), self.every);
    }

    /// Mean velocity x, y, z and rms at an element at the last look [m/s].
    #[inline(always)]
    pub(super) fn value(&self, element: usize) -> &[Lanes; 4] {
        &self.places[element].value
    }

    /// Follows a chain that has grown at its root and become shorter at its end to so many elements.
    pub(super) fn follow(&mut self, elements: usize, born: bool) {
        if born {
            self.places.push_root(self.places[0]);
            self.nearby.push_root(self.nearby[0]);
            self.hints.push_root(self.hints[0]);
        }
        self.places.truncate(elements);
        self.nearby.truncate(elements);
        self.hints.truncate(elements);
    }

    /// Looks at the flow at the elements before a step.
    #[inline(always)]
    pub(super) fn look<S: Register>(&mut self, step: u64, position: &[Vec3<Lanes>]) -> InstantFlow<'_, S> {
        let since = step % self.every;
        if since == 0 {
            S::ISA.run(Look { surroundings: self, position });
        }
        InstantFlow { places: &self.places, steps: Wide::splat(since as f64) }
    }

    /// Looks up the flow at the elements.
    #[inline(always)]
    pub(super) fn look_up<S: Register>(&mut self, position: &[Vec3<Lanes>]) {
        let half = Wide::<S>::splat(0.5);
        // The first look has none before it to extrapolate from.
        let per_step = Wide::splat(if self.looked { 1.0 / self.every as f64 } else { 0.0 });
        let mut outside = Wide::<S>::load(&self.outside);
        for (j, ends) in position.windows(2).enumerate() {
            let centre = (Vec3::load(&ends[0]) + Vec3::load(&ends[1])) * half;
            let nearby = &self.nearby[j];
            let mut moved = centre - Vec3::load(&nearby.at);
            let farthest = moved.x.abs().max(moved.y.abs()).max(moved.z.abs());
            let beyond = farthest - Wide::load(&nearby.reach);
            if beyond.any_above(0.0) {
                self.renew(j, &centre.store(), &beyond.store());
                moved = centre - Vec3::load(&self.nearby[j].at);
            }
            let (nearby, place) = (&self.nearby[j], &mut self.places[j]);
            outside += Wide::load(&nearby.outside);
            for i in 0..4 {
                let [x, y, z] = &nearby.gradients;
                let value = Wide::load(&x[i]).mul_add(moved.x, Wide::load(&nearby.value[i]));
                let value = Wide::load(&y[i]).mul_add(moved.y, value);
                let value = Wide::load(&z[i]).mul_add(moved.z, value);
                let rise = (value - Wide::load(&place.value[i])) * per_step;
                (place.value[i], place.rise[i]) = (value.store(), rise.store());
            }
        }
        self.outside = outside.store();
        self.looks += self.places.len() as u64;
        self.looked = true;
    }

    /// Looks up the air around an element of those fibres whose `beyond` is above zero.
    #[inline(never)]
    fn renew(&mut self, element: usize, centre: &Vec3<Lanes>, beyond: &Lanes) {
        let (nearby, hints) = (&mut self.nearby[element], &mut self.hints[element]);
        for (lane, hint) in hints.iter_mut().enumerate().filter(|(lane, _)| beyond.0[*lane] > 0.0) {
            let at = centre.lane(lane);
            let FibreAir { air, inlet } = self.airs.lane(lane);
            let in_slot = Vec3::new(at.x, at.y + inlet.y, at.z);
            let AirAround { value, gradients, reach, inside } = air.around(in_slot, hint);
            nearby.at.set_lane(lane, at);
            nearby.reach.0[lane] = reach;
            nearby.outside.0[lane] = if inside { 0.0 } else { 1.0 };
            for i in 0..4 {
                nearby.value[i].0[lane] = value[i];
                (0..3).for_each(|axis| nearby.gradients[axis][i].0[lane] = gradients[axis][i]);
            }
        }
    }
}

/// [`Surroundings::look_up`].
struct Look<'a> {
    surroundings: &'a mut Surroundings,
    position: &'a [Vec3<Lanes>],
}

impl Task for Look<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        self.surroundings.look_up::<S>(self.position);
    }
}

/// The flow at the elements at one instant.
pub struct InstantFlow<'a, S: Register> {
    places: &'a [FlowAtElement],
    /// Steps since the last look.
    steps: Wide<S>,
}

impl<S: Register> InstantFlow<'_, S> {
    /// Velocity of the air at element `j` [m/s], where the flow carries an eddy with this signal of mean zero
    /// and rms one.
    #[inline(always)]
    pub(super) fn carried(&self, j: usize, signal: Vec3<Wide<S>>) -> Vec3<Wide<S>> {
        let FlowAtElement { value, rise } = &self.places[j];
        // No closures here, because the compiler does not inline them.
        let rms = Wide::load(&rise[3]).mul_add(self.steps, Wide::load(&value[3]));
        let x = Wide::load(&rise[0]).mul_add(self.steps, Wide::load(&value[0]));
        let y = Wide::load(&rise[1]).mul_add(self.steps, Wide::load(&value[1]));
        let z = Wide::load(&rise[2]).mul_add(self.steps, Wide::load(&value[2]));
        signal.mul_add(rms, Vec3::new(x, y, z))
    }
}
