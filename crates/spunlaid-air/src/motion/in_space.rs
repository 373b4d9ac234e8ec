//! The air around eight fibres in fields of eddies in space.
//!
//! ```text
//! EddyField → fluctuation of rms one at an element's place in space
//! MeanAlong, or Surroundings in a CFD field → mean velocity and rms there → the velocity
//! ```

use super::eddy_field::{EddyFields, Missing};
use super::{Air, EddyField, FibreAir, Surroundings};
use crate::field::Hint;
use spunlaid_ground::place::Inlet;
use spunlaid_ground::{Lanes, Nodes, PerLane, Register, Task, Vec3, WIDTH, Wide};
use std::array::from_fn;
use std::sync::Arc;

/// Pieces of the way in each of which the mean flow is linear.
const PIECES: usize = 1024;

/// Air with a field of eddies in space, around up to eight fibres.
#[derive(Clone, Debug)]
pub struct AirInSpace {
    fields: PerLane<Field>,
    places: PerLane<Inlet>,
    means: PerLane<WayFlow>,
    pub(super) elements: AirAtElements,
}

/// A fibre in a field of eddies.
#[derive(Clone, Debug)]
pub struct FibreInField {
    /// The mean flow, and the inlet.
    pub around: FibreAir,
    /// The eddies.
    pub field: Arc<EddyField>,
    /// Distance to the end of its way [m].
    pub distance: f64,
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
        let start = &self.ends[piece];
        let end = &self.ends[piece + 1];
        let share = place - piece as f64;
        [0, 1, 2].map(|i| start[i] + share * (end[i] - start[i]))
    }
}

impl AirInSpace {
    /// * `lanes` – of the fibres
    /// * `every` – steps from one look to the next
    pub fn new(lanes: &PerLane<FibreInField>, elements: usize, every: u64) -> Self {
        let fields: Vec<&Arc<EddyField>> = lanes.iter().map(|fibre| &fibre.field).collect();
        let (mut lane, mut last) = (0, None::<(Arc<EddyField>, WayFlow)>);
        let in_field = lanes.lane(0).around.air.flow.is_field();
        Self {
            fields: lanes.map(|FibreInField { field, .. }| {
                let same_as = fields.iter().position(|other| Arc::ptr_eq(other, field)).unwrap_or(lane);
                lane += 1;
                Field { field: Arc::clone(field), same_as }
            }),
            places: lanes.map(|fibre| fibre.around.inlet),
            means: lanes.map(|FibreInField { around, field, distance }| {
                let known =
                    last.take().filter(|(before, _)| before.has_air_of(field)).map(|(_, means)| means);
                let means = known.unwrap_or_else(|| WayFlow::new(&around.air, *distance));
                last = Some((Arc::clone(field), means.clone()));
                means
            }),
            elements: AirAtElements::new(
                in_field.then(|| lanes.map(|fibre| fibre.around.clone())),
                elements,
                every,
            ),
        }
    }

    /// Gives all fibres a field that has been made for the times to come.
    pub fn give(&mut self, field: &Arc<EddyField>) {
        self.fields = self.fields.map(|_| Field { field: Arc::clone(field), same_as: 0 });
    }

    /// Lets go of what has been made of the fields, so that their owners can forget it.
    pub fn release(&mut self) {
        let unmade = Arc::new(self.fields.lane(0).field.unmade());
        self.give(&unmade);
    }

    /// Replaces the air by another one. The values of the last look are kept until the next.
    pub(super) fn change(&mut self, by: Self) {
        let Self { fields, places, means, elements } = by;
        (self.fields, self.places, self.means) = (fields, places, means);
        self.elements.change(elements);
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
        let (each, field, per_step) = self.elements.look_up::<S>(position);
        let half = Wide::<S>::splat(0.5);
        let mut fields = looked_at(&self.fields);
        let means: [&WayFlow; WIDTH] = from_fn(|lane| self.means.lane(lane));
        let places =
            Vec3::new(Lanes::ZERO, self.places.lanes(|place| place.y), self.places.lanes(|place| place.z));
        for (j, (ends, element)) in position.windows(2).zip(each).enumerate() {
            let centre = ((Vec3::load(&ends[0]) + Vec3::load(&ends[1])) * half).store();
            let at = centre + places;
            let fluctuation = loop {
                match fields.fluctuations::<S>(t, &at) {
                    (fluctuation, None) => break fluctuation,
                    (_, Some(missing)) => {
                        self.fields = widened(&self.fields, &missing);
                        fields = looked_at(&self.fields);
                    }
                }
            };
            let (mut mean, mut rms) = (Vec3::ZERO, Lanes::ZERO);
            for (lane, means) in means.iter().enumerate() {
                let [speed, widening, strength] = means.at(at.x.0[lane]);
                (mean.x.0[lane], mean.y.0[lane], rms.0[lane]) = (speed, widening * at.y.0[lane], strength);
            }
            let (mut mean, mut rms) = (Vec3::<Wide<S>>::load(&mean), Wide::load(&rms));
            if let Some(field) = field {
                let [u, v, w, strength] = field.value(j);
                mean = Vec3::new(Wide::load(u), Wide::load(v), Wide::load(w));
                rms = Wide::load(strength);
            }
            element.keep(Vec3::load(&fluctuation).mul_add(rms, mean), per_step);
        }
    }
}

#[inline(always)]
fn looked_at(fields: &PerLane<Field>) -> EddyFields<'_> {
    EddyFields::new(from_fn(|lane| &*fields.lane(lane).field))
}

/// The fields, of which one is made around a place that a fibre has come to.
#[cold]
#[inline(never)]
fn widened(fields: &PerLane<Field>, missing: &Missing) -> PerLane<Field> {
    let Field { field, same_as } = fields.lane(missing.lane);
    let wider = Arc::new(field.widened(missing));
    fields.map(|known| match known.same_as == *same_as {
        true => Field { field: Arc::clone(&wider), same_as: *same_as },
        false => known.clone(),
    })
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
    every: u64,
    looked: bool,
    /// The mean flow and the rms in a CFD field.
    field: Option<Surroundings>,
}

impl ElementAir {
    /// Keeps the velocity at a look.
    ///
    /// * `per_step` – of [`AirAtElements::look_up`]
    #[inline(always)]
    pub(super) fn keep<S: Register>(&mut self, value: Vec3<Wide<S>>, per_step: Wide<S>) {
        self.rise = ((value - Vec3::load(&self.value)) * per_step).store();
        self.value = value.store();
    }
}

impl AirAtElements {
    /// * `in_field` – air and place of each fibre in a CFD field
    /// * `every` – steps from one look to the next
    pub(super) fn new(in_field: Option<PerLane<FibreAir>>, elements: usize, every: u64) -> Self {
        let nothing = ElementAir { value: Vec3::ZERO, rise: Vec3::ZERO };
        let field = in_field.map(|airs| Surroundings::around_elements(airs, elements, every));
        Self { elements: vec![nothing; elements].into(), every: every.max(1), looked: false, field }
    }

    /// Share of the time that the elements of a lane's fibre have spent outside of a field's data.
    pub(super) fn outside(&self, lane: usize) -> Option<f64> {
        self.field.as_ref().map(|field| field.outside(lane))
    }

    /// Forgets the looks so far.
    pub(super) fn forget(&mut self) {
        self.looked = false;
        self.field.iter_mut().for_each(Surroundings::forget);
    }

    /// Replaces the air by another one. The values of the last look are kept until the next.
    pub(super) fn change(&mut self, by: Self) {
        self.every = by.every;
        if let (Some(field), Some(new)) = (&mut self.field, by.field) {
            field.change(new);
        }
    }

    /// Follows chains that have grown at their roots and become shorter at their ends to so many elements.
    pub(super) fn follow(&mut self, elements: usize, born: bool) {
        if born {
            self.elements.push_root(self.elements[0]);
        }
        self.elements.truncate(elements);
        self.field.iter_mut().for_each(|field| field.follow(elements, born));
    }

    #[inline(always)]
    pub(super) fn is_look_due(&self, step: u64) -> bool {
        step.is_multiple_of(self.every)
    }

    /// Looks up the field. Returns the elements, to keep the velocity at each, the field, and the factor from the
    /// change since the last look to that in a step.
    #[inline(always)]
    pub(super) fn look_up<S: Register>(
        &mut self,
        position: &[Vec3<Lanes>],
    ) -> (std::slice::IterMut<'_, ElementAir>, Option<&Surroundings>, Wide<S>) {
        if let Some(field) = &mut self.field {
            field.look_up::<S>(position);
        }
        // The first look has none before it to extrapolate from.
        let per_step = Wide::splat(if self.looked { 1.0 / self.every as f64 } else { 0.0 });
        self.looked = true;
        (self.elements.iter_mut(), self.field.as_ref(), per_step)
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
pub struct InstantStations<'a, S: Register> {
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
