//! The feed: the start of a fed fibre, the births of its nodes, and its stiffness at the inlet.

use super::{Feed, LayingState};
use crate::chain::Chain;
use crate::chain::constants::Node;
use crate::chain::friction::Friction;
use crate::lanes::{Lanes, WIDTH};
use crate::vec3::Vec3;

/// Part of an element by which the root has passed the inlet when it is born. A node stands for half an element on both
/// of its sides; with this part alone inside, the root is sixteen times as stiff as other nodes.  theory.md (60)
const BORN: f64 = 1.0 / 16.0;

impl Chain {
    /// Makes a fibre of fixed length a fed one: its first elements move down from the inlet at the feed speed.
    ///
    /// The first end is a thousandth of an element off the axis, because a fibre that is exactly straight stays in the
    /// unstable balance of a column.
    ///
    /// * `lanes` – of each fibre
    /// * `steps_per_element` – of all of them
    pub(crate) fn feed(&mut self, lanes: &[Feed], steps_per_element: u64) {
        let c = &mut self.constants;
        let elements = self.position.len() - 1;
        let rest_length = c.element.rest_length;
        let mut laying = LayingState::new(lanes, steps_per_element, rest_length, elements);
        let above = c.root_direction * (rest_length * Lanes::splat(BORN - 0.5));
        self.position.iter_mut().for_each(|position| *position += above);
        let pick = |lane: usize| &lanes[if lane < lanes.len() { lane } else { 0 }];
        let end = &mut self.position[elements];
        for lane in 0..WIDTH {
            let off = 1e-3 * rest_length.0[lane];
            let angle = pick(lane).turn * std::f64::consts::TAU;
            end.y.0[lane] += off * libm::cos(angle);
            end.z.0[lane] += off * libm::sin(angle);
        }
        let velocity = c.root_direction * laying.feed_speed;
        self.velocity.iter_mut().chain(self.earlier.iter_mut()).for_each(|v| *v = velocity);
        laying.origin = self.position.clone();
        c.frame = laying.belt_speed;
        let contact = std::array::from_fn(|lane| pick(lane).line.contact);
        let diameter = Lanes::from_fn(|lane| pick(lane).fibre.diameter);
        c.friction = Friction::new(contact, &diameter, &rest_length);
        if c.friction.is_some() {
            self.tensions.rub();
        }
        // It becomes a node between two elements.
        let Node { mass, weight, .. } = c.between;
        (c.root.mass, c.root.weight) = (mass, weight);
        self.laying = Some(laying);
        self.clamp(0);
    }

    /// The root is let go and a new one is born above it, stretched like the element below.   theory.md (59)
    ///
    /// * `lifetime` – until the next birth [s]
    pub(super) fn give_birth(&mut self, lifetime: f64) {
        let c = &self.constants;
        let element = &c.element;
        let length = |lane: usize| (self.position[1].lane(lane) - self.position[0].lane(lane)).norm();
        let stretch = match self.tensions.tension.first() {
            Some(tension) => Lanes::from_fn(|i| tension.0[i] / element.axial_stiffness.0[i]),
            None => Lanes::from_fn(length) - element.rest_length,
        };
        let born = element.rest_length + stretch;
        let position = self.position[0] - c.root_direction * born;
        let velocity = c.root_direction * (born * Lanes::splat(1.0 / lifetime));
        let tension = element.axial_stiffness * stretch;
        self.position.push_root(position);
        self.velocity.push_root(velocity);
        self.earlier.push_root(velocity);
        self.tensions.push_root(tension);

        // The former root now bends like every other node.
        let c = &self.constants;
        let relative = Vec3::new(velocity.x, velocity.y - c.frame, velocity.z);
        let kinetic =
            (relative.x * relative.x + relative.y * relative.y + relative.z * relative.z) * c.root.mass;
        let axial = tension * stretch;
        let stiffness = self.constants.stiffness;
        let bending = self.bent(1, stiffness - self.constants.root_stiffness)
            + self.bent(2, stiffness - self.constants.second_stiffness);
        let half = Lanes::splat(0.5);
        (self.constants.root_stiffness, self.constants.second_stiffness) = (stiffness, stiffness);
        let Some(laying) = &mut self.laying else { return };
        laying.root_number += 1;
        laying.origin.push_root(position);
        let carried = &mut laying.carried;
        carried.kinetic = carried.kinetic + kinetic * half;
        carried.axial = carried.axial + axial * half;
        carried.bending = carried.bending + bending * half;
    }

    /// Stiffness of the root and of the node below it, after so many steps since the birth.   theory.md (60)
    pub(crate) fn clamp(&mut self, since_birth: u64) {
        let k = self.constants.stiffness;
        let Some(laying) = &self.laying else { return };
        let inside = BORN + since_birth as f64 / laying.steps_per_element as f64;
        let before = (self.constants.root_stiffness, self.constants.second_stiffness);
        let root = Lanes::from_fn(|i| if laying.clamped[i] { k.0[i] / inside } else { 0.0 });
        let second = Lanes::from_fn(|i| k.0[i] * if laying.clamped[i] { 1.0 } else { inside.min(1.0) });
        (self.constants.root_stiffness, self.constants.second_stiffness) = (root, second);
        // What the change adds or takes is the feed's.
        let half = Lanes::splat(0.5);
        let change = self.bent(0, root - before.0) + self.bent(1, second - before.1);
        if let Some(laying) = &mut self.laying {
            laying.carried.bending = laying.carried.bending + change * half;
        }
    }
}
