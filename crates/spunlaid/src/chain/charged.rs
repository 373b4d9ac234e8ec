//! The forces on the nodes of charged fibres: those of an electric field and of neighbours, and their work.

use super::Chain;
use super::work::WorkDone;
use crate::charge::SheetField;
use crate::lanes::{Lanes, Register, WIDTH, Wide};
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
    /// What neighbours do, if they are known.
    pub(crate) neighbours: Option<HeldForces>,
    /// Force on each node along the machine direction, in the step that is made [N].
    force: Vec<Lanes>,
    /// Force across; empty without neighbours [N].
    across: Vec<Lanes>,
}

/// Forces that stay with the nodes for some time.
#[derive(Clone, Debug)]
pub(crate) struct HeldForces {
    /// Number of elements that had been fed when they were found: later nodes feel none yet.
    fed: u64,
    /// On each node, in machine and in cross direction [N].
    forces: Vec<[Lanes; 2]>,
}

impl Charged {
    pub(crate) fn new(field: Arc<SheetField>, per_mass: f64, inlets: Lanes) -> Self {
        Self { field, per_mass, inlets, neighbours: None, force: Vec::new(), across: Vec::new() }
    }

    /// Adds the force on a node in the step that is made.
    #[inline(always)]
    pub(super) fn push<S: Register>(&self, node: usize, force: &mut Vec3<Wide<S>>) {
        force.y += Wide::load(&self.force[node]);
        if let Some(across) = self.across.get(node) {
            force.z += Wide::load(across);
        }
    }
}

impl Chain {
    /// Holds forces of neighbours on the nodes that there are now, until others are known.
    ///
    /// * `forces` – on the nodes of each fibre, in machine and in cross direction [N]
    pub(crate) fn hold_neighbours(&mut self, forces: [&[[f64; 2]]; WIDTH]) {
        let (fed, nodes) = (self.fed(), self.position.len());
        let Some(charged) = &mut self.charged else { return };
        let of_node = |node: usize, axis: usize| {
            Lanes::from_fn(|lane| forces[lane].get(node).map_or(0.0, |force| force[axis]))
        };
        let forces = (0..nodes).map(|node| [0, 1].map(|axis| of_node(node, axis))).collect();
        charged.neighbours = Some(HeldForces { fed, forces });
    }

    /// Finds the force of the field on all nodes where they are now, and enters its work with their velocities
    /// before the step.
    #[inline(never)]
    pub(crate) fn feel_field(&mut self, work: &mut WorkDone) {
        let fed = self.fed();
        let Self { position, constants: c, charged: Some(charged), .. } = self else { return };
        let nodes = position.len();
        let Charged { field, per_mass, inlets, neighbours, force, across } = charged;
        force.clear();
        force.extend(position.iter().enumerate().map(|(i, at)| {
            let mass = &c.node(i, nodes).mass;
            let on_lane = |lane: usize| {
                let strength = field.at(at.x.0[lane], at.y.0[lane] + inlets.0[lane]);
                *per_mass * mass.0[lane] * strength
            };
            Lanes::from_fn(on_lane)
        }));
        if let Some(held) = neighbours {
            across.clear();
            across.extend(force.iter_mut().zip(position.iter()).enumerate().map(|(i, (force, at))| {
                // A node has moved on by one place for each that was born after it.
                let before = i.checked_sub((fed - held.fed) as usize).and_then(|i| held.forces.get(i));
                let Some([along, across]) = before else { return Lanes::ZERO };
                let above = |of: &Lanes, lane: usize| match field.is_above_belt(at.x.0[lane]) {
                    true => of.0[lane],
                    false => 0.0,
                };
                *force = *force + Lanes::from_fn(|lane| above(along, lane));
                Lanes::from_fn(|lane| above(across, lane))
            }));
        }
        work.field.before = self.power_of_field();
        work.field.both = work.field.both + work.field.before;
    }

    /// Enters the work of the field with the velocities after the step.
    #[inline(never)]
    pub(crate) fn enter_field(&self, work: &mut WorkDone) {
        work.field.both = work.field.both + self.power_of_field();
    }

    /// `Σ F·v` of the field and of neighbours, with the velocities as they are, seen from the belt [W].
    fn power_of_field(&self) -> Lanes {
        let Self { velocity, constants: c, charged: Some(Charged { force, across, .. }), .. } = self else {
            return Lanes::ZERO;
        };
        Lanes::from_fn(|lane| {
            let speed = |v: &Vec3<Lanes>| v.y.0[lane] - c.frame.0[lane];
            let along: f64 =
                force.iter().zip(velocity.iter()).map(|(force, v)| force.0[lane] * speed(v)).sum();
            let across = across.iter().zip(velocity.iter()).map(|(force, v)| force.0[lane] * v.z.0[lane]);
            across.fold(along, |sum, power| sum + power)
        })
    }
}
