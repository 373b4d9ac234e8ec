//! The forces on the nodes of charged fibres: those of an electric field, and their work.

use super::Chain;
use super::work::WorkDone;
use crate::charge::SheetField;
use crate::lanes::{Lanes, Register, Wide};
use crate::vec3::Vec3;
use std::sync::Arc;

/// The charge of eight fibres in a field along the machine direction.
#[derive(Clone, Debug)]
pub(crate) struct Charged {
    /// The field.
    pub(crate) field: Arc<SheetField>,
    /// Charge per mass [C/kg].
    pub(crate) per_mass: f64,
    /// Where the inlets of the fibres are in the field, in machine direction [m].
    pub(crate) inlets: Lanes,
    /// Force on each node along the machine direction, in the step that is made [N].
    force: Vec<Lanes>,
}

impl Charged {
    pub(crate) fn new(field: Arc<SheetField>, per_mass: f64, inlets: Lanes) -> Self {
        Self { field, per_mass, inlets, force: Vec::new() }
    }

    /// Adds the force on a node in the step that is made.
    #[inline(always)]
    pub(super) fn push<S: Register>(&self, node: usize, force: &mut Vec3<Wide<S>>) {
        force.y += Wide::load(&self.force[node]);
    }
}

impl Chain {
    /// Finds the force of the field on all nodes where they are now, and enters its work with their velocities
    /// before the step.
    #[inline(never)]
    pub(crate) fn feel_field(&mut self, work: &mut WorkDone) {
        let Self { position, constants: c, charged: Some(charged), .. } = self else { return };
        let nodes = position.len();
        let Charged { field, per_mass, inlets, force } = charged;
        force.clear();
        force.extend(position.iter().enumerate().map(|(i, at)| {
            let mass = &c.node(i, nodes).mass;
            let on_lane = |lane: usize| {
                let strength = field.at(at.x.0[lane], at.y.0[lane] + inlets.0[lane]);
                *per_mass * mass.0[lane] * strength
            };
            Lanes::from_fn(on_lane)
        }));
        work.field.before = self.power_of_field();
        work.field.both = work.field.both + work.field.before;
    }

    /// Enters the work of the field with the velocities after the step.
    #[inline(never)]
    pub(crate) fn enter_field(&self, work: &mut WorkDone) {
        work.field.both = work.field.both + self.power_of_field();
    }

    /// `Σ F·v` of the field, with the velocities as they are, seen from the belt [W].
    fn power_of_field(&self) -> Lanes {
        let Self { velocity, constants: c, charged: Some(Charged { force, .. }), .. } = self else {
            return Lanes::ZERO;
        };
        Lanes::from_fn(|lane| {
            let speed = |v: &Vec3<Lanes>| v.y.0[lane] - c.frame.0[lane];
            force.iter().zip(velocity.iter()).map(|(force, v)| force.0[lane] * speed(v)).sum()
        })
    }
}
