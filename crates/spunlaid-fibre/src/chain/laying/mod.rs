//! Feed and belt: how a chain grows at its root and is laid down at its end.
//!
//! ```text
//! inlet   ● root, driven at the feed speed; every few steps it is let go and a new one is born above it
//!         ●
//!         ●   nodes in the air, all alike
//!         ●
//! belt ●●●●   a node that reaches the belt moves with it; well behind the newest touch-down it leaves the chain
//! ```
//!
//! Landing and leaving depend on the fibre's own lane alone, so a fibre has the same bits whatever flies beside it.
//!                                                                         theory.md (59) to (62)

mod landing;
#[cfg(test)]
pub(super) mod tests;

use super::Chain;
use super::constants::{Constants, Friction, Node};
use crate::body::{Fibre, Root};
use crate::line::Line;
use spunlaid_ground::{Lanes, Nodes, Vec3, WIDTH};

/// A point of a fibre that has been laid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LaidPoint {
    /// Length of fibre fed before it [m].
    pub fed: f64,
    /// Time of the touch-down [s].
    pub time: f64,
    /// Place on the belt in machine direction, `y − v_b t` [m].
    pub md: f64,
    /// Place on the belt in cross direction, `z` [m].
    pub cd: f64,
}

/// How a fibre is fed and laid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Feed {
    /// Feed and belt.
    pub(crate) line: Line,
    /// The fibre.
    pub(crate) fibre: Fibre,
    /// Direction around the axis in which the first end is a little off it [turns].
    pub(crate) turn: f64,
}

/// Feed and belt of eight fibres, and what has been fed and laid so far.
#[derive(Clone, Debug)]
pub(crate) struct LayingState {
    clamped: [bool; WIDTH],
    feed_speed: Lanes,
    height: Lanes,
    belt_speed: Lanes,
    steps_per_element: u64,
    /// Rest length of an element [m].
    element_length: Lanes,
    /// Nodes behind the newest touch-down that stay in the chain.
    kept: [u64; WIDTH],
    /// Number of the root in the order of feed. The first end of the fibre has the number 0.
    root_number: u64,
    /// Number of the node that touched down last in the order of feed, plus one; 0 before the first.
    touched: [u64; WIDTH],
    /// Nodes with lower numbers have left the chain.
    left: [u64; WIDTH],
    /// Times of the touch-downs of the nodes in the tail [s].
    landed_at: Vec<Lanes>,
    /// Nodes that land in this step, with the share of the step that they still fly; NaN in lanes where they
    /// do not land.
    landing: Vec<(usize, Lanes)>,
    /// Where the nodes were born [m].
    pub(crate) origin: Nodes<Vec3<Lanes>>,
    /// Points that have left the chain and have not been taken yet.
    pub(crate) laid: [Vec<LaidPoint>; WIDTH],
    /// Energy that came with fed fibre minus the energy that left with laid fibre [J], in parts.
    pub(crate) carried: CarriedEnergy,
}

impl LayingState {
    /// * `lanes` – of up to eight fibres
    /// * `steps_per_element` – of all of them
    /// * `rest_length` – of an element [m]
    fn new(lanes: &[Feed], steps_per_element: u64, rest_length: Lanes, elements: usize) -> Self {
        let pick = |i: usize| &lanes[if i < lanes.len() { i } else { 0 }];
        let kept = |i: usize| (pick(i).line.kept_length / rest_length.0[i]).ceil().clamp(1.0, 1e9) as u64;
        Self {
            clamped: std::array::from_fn(|i| pick(i).fibre.root == Root::Clamped),
            feed_speed: Lanes::from_fn(|i| pick(i).line.feed_speed),
            height: Lanes::from_fn(|i| pick(i).line.distance),
            belt_speed: Lanes::from_fn(|i| pick(i).line.belt_speed),
            steps_per_element,
            element_length: rest_length,
            kept: std::array::from_fn(kept),
            root_number: elements as u64,
            touched: [0; WIDTH],
            left: [0; WIDTH],
            landed_at: vec![Lanes::splat(f64::NAN)],
            landing: Vec::new(),
            origin: Nodes::default(),
            laid: Default::default(),
            carried: CarriedEnergy::default(),
        }
    }

    /// Number of nodes between the root and the newest touch-down, for a lane.
    pub(crate) fn in_air(&self, lane: usize) -> u64 {
        self.root_number + 1 - self.touched[lane].min(self.root_number + 1)
    }

    /// Nodes from the root on that have not left the chain, for a lane.
    pub(crate) fn nodes(&self, lane: usize) -> usize {
        (self.root_number + 1 - self.left[lane]) as usize
    }

    /// Number of elements fed so far.
    pub(crate) fn fed(&self) -> u64 {
        self.root_number
    }
}

impl Node {
    /// Holds the node in a lane.
    fn hold(&mut self, lane: usize) {
        (self.inverse_mass.0[lane], self.inverse_mass_x.0[lane]) = (0.0, 0.0);
    }
}

impl Chain {
    /// After a step: nodes that have landed move with the belt, nodes far behind leave, and a new root is born if it is
    /// due.
    ///
    /// * `step` – number of steps done
    /// * `h` – the time step [s]
    #[inline(always)]
    pub(crate) fn feed_and_lay(&mut self, step: u64, h: f64) {
        let Some(laying) = &self.laying else { return };
        if !laying.landing.is_empty() {
            self.touch_down(step, h);
        }
        let per_element = self.laying.as_ref().map_or(1, |laying| laying.steps_per_element);
        if step.is_multiple_of(per_element) {
            self.give_birth(h * per_element as f64);
        }
        self.clamp(step % per_element);
    }

    /// Carries over to new constants what is fed, and what is held by the belt.
    pub(super) fn keep_held(&mut self, former: &Constants) {
        if self.laying.is_none() {
            return;
        }
        let c = &mut self.constants;
        (c.frame, c.friction) = (former.frame, former.friction);
        (c.root.mass, c.root.weight) = (c.between.mass, c.between.weight);
        let scale = |stiffness: Lanes| {
            Lanes::from_fn(|lane| stiffness.0[lane] / former.stiffness.0[lane] * c.stiffness.0[lane])
        };
        let root = scale(former.root_stiffness);
        let second = scale(former.second_stiffness);
        let kept = |new: Lanes, old: Lanes| Lanes::from_fn(|i| if old.0[i] == 0.0 { 0.0 } else { new.0[i] });
        let tail = former.tail.iter().map(|old| {
            let node = c.between;
            Node {
                mass: kept(node.mass, old.mass),
                inverse_mass: kept(node.inverse_mass, old.inverse_mass),
                inverse_mass_x: kept(node.inverse_mass_x, old.inverse_mass_x),
                weight: kept(node.weight, old.weight),
            }
        });
        let tail = tail.collect();
        (c.root_stiffness, c.second_stiffness, c.tail) = (root, second, tail);
    }
}

/// `arcsin² x` in `x²`, below [`ALMOST_STRAIGHT`] to 1e-17 of it.
const ARCSINE_SQUARED: [f64; 5] = [1.0, 1.0 / 3.0, 8.0 / 45.0, 4.0 / 35.0, 128.0 / 1575.0];
/// Square of the sine of an angle up to which the series holds.
const ALMOST_STRAIGHT: f64 = 1e-3;

/// Energy carried into the chain by fed fibre, minus what laid fibre carried out of it [J].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CarriedEnergy {
    pub(crate) kinetic: Lanes,
    pub(crate) axial: Lanes,
    pub(crate) bending: Lanes,
    /// Work of gravity on nodes that have left.
    pub(crate) gravity_work: Lanes,
    /// Work of the belt at the touch-downs.
    pub(crate) impacts: Lanes,
}

impl Chain {
    /// Energy of the element below a node, and of the bending at the node [J].
    fn element_energy(&self, node: usize, lane: usize) -> (f64, f64) {
        let c = &self.constants;
        let Some(below) = self.position.get(node + 1) else { return (0.0, 0.0) };
        let edge = below.lane(lane) - self.position[node].lane(lane);
        let element = &c.element;
        let stretch = edge.norm() - element.rest_length.0[lane];
        let stiffness = c.stiffness.0[lane];
        let bending = if node == 0 { 0.0 } else { stiffness * self.bend_squared_in(node, lane) };
        (0.5 * element.axial_stiffness.0[lane] * stretch * stretch, 0.5 * bending)
    }

    /// Twice the bending energy at a node with springs of this stiffness [J].
    fn bent(&self, node: usize, stiffness: Lanes) -> Lanes {
        let bends = node + 1 < self.position.len();
        let energy = |lane: usize, stiffness: f64| {
            if bends && stiffness != 0.0 { stiffness * self.bend_squared_in(node, lane) } else { 0.0 }
        };
        Lanes::from_fn(|lane| energy(lane, stiffness.0[lane]))
    }

    /// Square of the angle at a node.
    fn bend_squared_in(&self, node: usize, lane: usize) -> f64 {
        let at = |i: usize| self.position[i].lane(lane);
        let above =
            if node == 0 { self.constants.root_direction.lane(lane) } else { at(node) - at(node - 1) };
        let below = at(node + 1) - at(node);
        let (cross, dot) = (above.cross(below), above.dot(below));
        let sine_squared = cross.dot(cross) / (above.dot(above) * below.dot(below));
        if dot > 0.0 && sine_squared < ALMOST_STRAIGHT {
            return ARCSINE_SQUARED.iter().rev().fold(0.0, |sum, c| (sum + c) * sine_squared);
        }
        let angle = libm::atan2(cross.norm(), dot);
        angle * angle
    }
}

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
    fn give_birth(&mut self, lifetime: f64) {
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
