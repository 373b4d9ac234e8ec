//! The air around eight fibres in fields of eddies in space.
//!
//! ```text
//! EddyField → fluctuation of rms one at an element's place in space
//! MeanAlong, or Surroundings in a CFD field → mean velocity and rms there → the velocity
//! ```

use super::eddy_field::EddyFields;
use super::{Air, EddyField, Surroundings};
use crate::air::field::Hint;
use crate::ground::place::Place;
use crate::ground::{Lanes, Nodes, PerLane, Register, Task, Vec3, WIDTH, Wide};
use std::array::from_fn;
use std::sync::Arc;

/// Pieces of the way in each of which the mean flow is linear.
const PIECES: usize = 1024;

/// Air with a field of eddies in space, around up to eight fibres.
#[derive(Clone, Debug)]
pub struct AirInSpace {
    fields: PerLane<Field>,
    places: PerLane<Place>,
    means: PerLane<WayFlow>,
    elements: AirAtElements,
    /// The mean flow and the rms in a CFD field.
    surroundings: Option<Surroundings>,
}

/// The field of a fibre.
#[derive(Clone, Debug)]
struct Field {
    field: Arc<EddyField>,
    /// The first lane that has the same field.
    same_as: usize,
}

/// Mean flow and rms along the way.
#[derive(Clone, Debug)]
struct WayFlow {
    per_length: f64,
    /// At the ends of the pieces: velocity along x [m/s], change of the velocity along y with y [1/s], rms [m/s].
    ends: Arc<Vec<[f64; 3]>>,
}

impl WayFlow {
    /// * `distance` – to the end of the way [m]
    fn new(air: &Air, distance: f64) -> Self {
        let mut hint = Hint::default();
        let mut end = |i: usize| {
            let x = distance * i as f64 / PIECES as f64;
            let local = air.local(Vec3::new(x, 1.0, 0.0), &mut hint);
            [local.velocity.x, local.velocity.y, local.rms]
        };
        Self { per_length: PIECES as f64 / distance, ends: Arc::new((0..=PIECES).map(&mut end).collect()) }
    }

    #[inline(always)]
    fn at(&self, x: f64) -> [f64; 3] {
        let place = (x * self.per_length).clamp(0.0, PIECES as f64);
        let piece = (place as usize).min(PIECES - 1);
        let (start, end, share) = (&self.ends[piece], &self.ends[piece + 1], place - piece as f64);
        [0, 1, 2].map(|i| start[i] + share * (end[i] - start[i]))
    }
}

impl AirInSpace {
    /// * `lanes` – of each fibre: its air, its place, its field, and the distance to the end of its way [m]
    /// * `every` – steps from one look to the next
    pub(crate) fn new(
        lanes: &PerLane<(Air, Place, Arc<EddyField>, f64)>,
        elements: usize,
        every: u64,
    ) -> Self {
        let fields: Vec<&Arc<EddyField>> = lanes.iter().map(|(_, _, field, _)| field).collect();
        let (mut lane, mut last) = (0, None::<(Arc<EddyField>, WayFlow)>);
        let in_field = lanes.lane(0).0.flow.is_field();
        Self {
            fields: lanes.map(|(_, _, field, _)| {
                let same_as = fields.iter().position(|other| Arc::ptr_eq(other, field)).unwrap_or(lane);
                lane += 1;
                Field { field: Arc::clone(field), same_as }
            }),
            places: lanes.map(|(_, place, _, _)| *place),
            means: lanes.map(|(air, _, field, distance)| {
                let known =
                    last.take().filter(|(before, _)| before.has_air_of(field)).map(|(_, means)| means);
                let means = known.unwrap_or_else(|| WayFlow::new(air, *distance));
                last = Some((Arc::clone(field), means.clone()));
                means
            }),
            elements: AirAtElements::new(elements, every),
            surroundings: in_field.then(|| {
                let airs = lanes.map(|(air, place, _, _)| (air.clone(), *place));
                Surroundings::around_elements(airs, elements, every)
            }),
        }
    }

    /// Gives all fibres a field that has been made for the times to come.
    pub(crate) fn give(&mut self, field: &Arc<EddyField>) {
        self.fields = self.fields.map(|_| Field { field: Arc::clone(field), same_as: 0 });
    }

    /// Lets go of what has been made of the fields, so that their owners can forget it.
    pub(crate) fn release(&mut self) {
        let unmade = Arc::new(self.fields.lane(0).field.unmade());
        self.give(&unmade);
    }

    /// Velocity of the air at element `j` in the last step [m/s].
    pub(super) fn velocity(&self, j: usize, step: u64) -> Option<Vec3<Lanes>> {
        self.elements.velocity(j, step)
    }

    /// Share of the time that the elements of a lane's fibre have spent outside of a CFD field's data.
    pub(super) fn outside(&self, lane: usize) -> Option<f64> {
        self.surroundings.as_ref().map(|surroundings| surroundings.outside(lane))
    }

    pub(super) fn forget(&mut self) {
        self.elements.forget();
        if let Some(surroundings) = &mut self.surroundings {
            surroundings.forget();
        }
    }

    pub(super) fn follow(&mut self, elements: usize, born: bool) {
        self.elements.follow(elements, born);
        if let Some(surroundings) = &mut self.surroundings {
            surroundings.follow(elements, born);
        }
    }

    /// Replaces the air by another one. The values of the last look are kept until the next.
    pub(super) fn change(&mut self, by: Self) {
        let Self { fields, places, means, elements, surroundings } = by;
        (self.fields, self.places, self.means) = (fields, places, means);
        self.elements.every = elements.every;
        if let (Some(own), Some(new)) = (&mut self.surroundings, surroundings) {
            own.change(new);
        }
    }

    /// Looks at the air at the elements before a step at the time `t` [s].
    #[inline(always)]
    pub(super) fn look<S: Register>(
        &mut self,
        step: u64,
        t: f64,
        position: &[Vec3<Lanes>],
    ) -> InstantStations<'_, S> {
        if self.elements.is_look_due(step) {
            self.make_for(t);
            S::ISA.run(Look { air: self, t, position });
        }
        self.elements.now(step)
    }

    /// Makes the fields for a time, unless their owner has made them.
    #[inline(never)]
    fn make_for(&mut self, t: f64) {
        if !self.fields.any(|Field { field, .. }| !field.is_made_for(t)) {
            return;
        }
        let mut made: Vec<Arc<EddyField>> = Vec::new();
        self.fields = self.fields.map(|Field { field, same_as }| {
            let mut field = Arc::clone(made.get(*same_as).unwrap_or(field));
            if !field.is_made_for(t) {
                let block = field.block();
                Arc::make_mut(&mut field).make(t..t + block, 1);
            }
            made.push(Arc::clone(&field));
            Field { field, same_as: *same_as }
        });
    }

    /// Looks up the air at the elements at the time `t` [s].
    #[inline(always)]
    fn look_up<S: Register>(&mut self, t: f64, position: &[Vec3<Lanes>]) {
        if let Some(surroundings) = &mut self.surroundings {
            surroundings.look_up::<S>(position);
        }
        let per_step = self.elements.per_step();
        let half = Wide::<S>::splat(0.5);
        let fields = EddyFields::new(from_fn(|lane| &*self.fields.lane(lane).field));
        let means: [&WayFlow; WIDTH] = from_fn(|lane| self.means.lane(lane));
        let places =
            Vec3::new(Lanes::ZERO, self.places.lanes(|place| place.y), self.places.lanes(|place| place.z));
        for (j, (ends, element)) in position.windows(2).zip(self.elements.each()).enumerate() {
            let centre = ((Vec3::load(&ends[0]) + Vec3::load(&ends[1])) * half).store();
            let at = centre + places;
            let fluctuation = fields.fluctuations::<S>(t, &at);
            let (mut mean, mut rms) = (Vec3::ZERO, Lanes::ZERO);
            for (lane, means) in means.iter().enumerate() {
                let [speed, widening, strength] = means.at(at.x.0[lane]);
                (mean.x.0[lane], mean.y.0[lane], rms.0[lane]) = (speed, widening * at.y.0[lane], strength);
            }
            let (mut mean, mut rms) = (Vec3::<Wide<S>>::load(&mean), Wide::load(&rms));
            if let Some(surroundings) = &self.surroundings {
                let [u, v, w, strength] = surroundings.value(j);
                mean = Vec3::new(Wide::load(u), Wide::load(v), Wide::load(w));
                rms = Wide::load(strength);
            }
            element.keep(Vec3::load(&fluctuation).mul_add(rms, mean), per_step);
        }
        self.elements.finish_look();
    }
}

/// [`AirInSpace::look_up`].
struct Look<'a> {
    air: &'a mut AirInSpace,
    t: f64,
    position: &'a [Vec3<Lanes>],
}

impl Task for Look<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        self.air.look_up::<S>(self.t, self.position);
    }
}

/// The air at an element of eight fibres.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElementAir {
    /// Velocity at the last look [m/s].
    value: Vec3<Lanes>,
    /// Its rise in a step [m/s].
    rise: Vec3<Lanes>,
}

/// The air at the elements of eight fibres.
#[derive(Clone, Debug)]
pub(super) struct AirAtElements {
    elements: Nodes<ElementAir>,
    /// Steps from one look to the next.
    pub(super) every: u64,
    looked: bool,
}

impl ElementAir {
    /// Keeps the velocity at a look.
    ///
    /// * `per_step` – of [`AirAtElements::per_step`]
    #[inline(always)]
    pub(super) fn keep<S: Register>(&mut self, value: Vec3<Wide<S>>, per_step: Wide<S>) {
        self.rise = ((value - Vec3::load(&self.value)) * per_step).store();
        self.value = value.store();
    }
}

impl AirAtElements {
    pub(super) fn new(elements: usize, every: u64) -> Self {
        let nothing = ElementAir { value: Vec3::ZERO, rise: Vec3::ZERO };
        Self { elements: vec![nothing; elements].into(), every: every.max(1), looked: false }
    }

    /// Forgets the looks so far.
    pub(super) fn forget(&mut self) {
        self.looked = false;
    }

    /// Follows chains that have grown at their roots and become shorter at their ends to so many elements.
    pub(super) fn follow(&mut self, elements: usize, born: bool) {
        if born {
            self.elements.push_root(self.elements[0]);
        }
        self.elements.truncate(elements);
    }

    #[inline(always)]
    pub(super) fn is_look_due(&self, step: u64) -> bool {
        step.is_multiple_of(self.every)
    }

    /// Factor from the change since the last look to that in a step. The first look has none before it to
    /// extrapolate from.
    #[inline(always)]
    pub(super) fn per_step<S: Register>(&self) -> Wide<S> {
        Wide::splat(if self.looked { 1.0 / self.every as f64 } else { 0.0 })
    }

    /// The elements, to keep the velocity at each.
    pub(super) fn each(&mut self) -> std::slice::IterMut<'_, ElementAir> {
        self.elements.iter_mut()
    }

    /// Ends a look at all elements.
    pub(super) fn finish_look(&mut self) {
        self.looked = true;
    }

    /// Velocity of the air at element `j` in a step since the last look [m/s]; None beyond the last element.
    pub(super) fn velocity(&self, j: usize, step: u64) -> Option<Vec3<Lanes>> {
        let ElementAir { value, rise } = self.elements.get(j)?;
        Some(*value + *rise * Lanes::splat((step % self.every) as f64))
    }

    /// The air before a step.
    #[inline(always)]
    pub(super) fn now<S: Register>(&self, step: u64) -> InstantStations<'_, S> {
        InstantStations { elements: &self.elements, steps: Wide::splat((step % self.every) as f64) }
    }
}

/// The air at the elements at one instant.
pub(crate) struct InstantStations<'a, S: Register> {
    elements: &'a [ElementAir],
    /// Steps since the last look.
    steps: Wide<S>,
}

impl<S: Register> InstantStations<'_, S> {
    /// Velocity of the air at element `j` [m/s].
    #[inline(always)]
    pub(super) fn at(&self, j: usize) -> Vec3<Wide<S>> {
        let ElementAir { value, rise } = &self.elements[j];
        Vec3::load(rise).mul_add(self.steps, Vec3::load(value))
    }
}
