//! The velocity of the air at the elements of eight fibres: looked up every few steps, linear in time in between.

use crate::lanes::{Lanes, Register, Wide};
use crate::nodes::Nodes;
use crate::vec3::Vec3;

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
