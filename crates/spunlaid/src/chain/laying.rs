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

use super::{Chain, Constants, Friction, Node};
use crate::fibre::{Fibre, Root};
use crate::lanes::{Lanes, Register, WIDTH, Wide};
use crate::line::{Contact, Line};
use crate::nodes::Nodes;
use crate::vec3::Vec3;

/// Part of an element by which the root has passed the inlet when it is born. A node stands for half an element on both
/// of its sides; with this part alone inside, the root is sixteen times as stiff as other nodes.  theory.md (60)
pub(crate) const BORN: f64 = 1.0 / 16.0;

/// Nodes that stay in the chain after they have left it in every lane, because they hold the bending of the last one.
const HOLDING: usize = 2;
/// Nodes that leave the arrays together.
const TOGETHER: usize = 4;

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

/// Feed and belt of eight fibres, and what has been fed and laid so far.
#[derive(Clone, Debug)]
pub(crate) struct Laying {
    clamped: [bool; WIDTH],
    feed_speed: Lanes,
    height: Lanes,
    belt_speed: Lanes,
    steps_per_element: u64,
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
    /// Nodes that land in this step, with the share of the step that they still fly; NaN in lanes where they do not land.
    landing: Vec<(usize, Lanes)>,
    /// Where the nodes were born [m].
    pub(crate) origin: Nodes<Vec3<Lanes>>,
    /// Points that have left the chain and have not been taken yet.
    pub(crate) laid: [Vec<LaidPoint>; WIDTH],
    /// Energy that came with fed fibre minus the energy that left with laid fibre [J], in parts.
    pub(crate) carried: Carried,
}

/// Energy carried into the chain by fed fibre, minus what laid fibre carried out of it [J].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Carried {
    pub(crate) kinetic: Lanes,
    pub(crate) axial: Lanes,
    pub(crate) bending: Lanes,
    /// Work of gravity on nodes that have left.
    pub(crate) gravity_work: Lanes,
    /// Work of the belt at the touch-downs.
    pub(crate) impacts: Lanes,
}

impl Laying {
    /// * `lanes` – of up to eight fibres
    /// * `rest_length` – of an element [m]
    fn new(lanes: &[Fed], rest_length: &Lanes, elements: usize) -> Self {
        let pick = |i: usize| &lanes[if i < lanes.len() { i } else { 0 }];
        let kept = |i: usize| (pick(i).line.kept_length / rest_length.0[i]).ceil().clamp(1.0, 1e9) as u64;
        Self {
            clamped: std::array::from_fn(|i| pick(i).fibre.root == Root::Clamped),
            feed_speed: Lanes::from_fn(|i| pick(i).line.feed_speed),
            height: Lanes::from_fn(|i| pick(i).line.distance),
            belt_speed: Lanes::from_fn(|i| pick(i).line.belt_speed),
            steps_per_element: lanes[0].line.steps_per_element,
            kept: std::array::from_fn(kept),
            root_number: elements as u64,
            touched: [0; WIDTH],
            left: [0; WIDTH],
            landed_at: vec![Lanes::splat(f64::NAN)],
            landing: Vec::new(),
            origin: Nodes::default(),
            laid: Default::default(),
            carried: Carried::default(),
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

    /// Whether a node passes the belt within a step, in any lane.
    #[inline(always)]
    pub(crate) fn reached<S: Register>(&self, x: Wide<S>, vx: Wide<S>, h: Wide<S>) -> bool {
        (vx.mul_add(h, x) - Wide::load(&self.height)).any_above(0.0)
    }

    /// Lets a node land: changes its velocity of this step so that it ends on the belt, and returns 0 in the lanes where
    /// it does, 1 in the others. It keeps its own velocity until it touches down, then it has that of the belt.
    #[cold]
    #[inline(never)]
    pub(crate) fn land(&mut self, node: usize, position: &Vec3<Lanes>, v: &mut Vec3<Lanes>, h: f64) -> Lanes {
        let mut shares = Lanes::splat(f64::NAN);
        for lane in 0..WIDTH {
            let left = self.height.0[lane] - position.x.0[lane];
            if v.x.0[lane].mul_add(h, -left) > 0.0 {
                let share = (left / (h * v.x.0[lane])).clamp(0.0, 1.0);
                let belt = self.belt_speed.0[lane];
                v.x.0[lane] = left / h;
                v.y.0[lane] = share * v.y.0[lane] + (1.0 - share) * belt;
                v.z.0[lane] *= share;
                shares.0[lane] = share;
            }
        }
        self.landing.push((node, shares));
        Lanes::from_fn(|lane| if shares.0[lane].is_nan() { 1.0 } else { 0.0 })
    }
}

impl Node {
    /// Holds the node in a lane.
    fn hold(&mut self, lane: usize) {
        (self.inverse_mass.0[lane], self.inverse_mass_x.0[lane]) = (0.0, 0.0);
    }
}

/// Friction of up to eight fibres; none if all of them stick.
fn friction(lanes: &[Fed], rest_length: &Lanes) -> Option<Friction> {
    let pick = |i: usize| &lanes[if i < lanes.len() { i } else { 0 }];
    let of = |i: usize| match pick(i).line.contact {
        // What sticks would have to be pulled with an infinite force.
        Contact::Stick => (f64::INFINITY, 0.0),
        Contact::Friction { coefficient, suction } => {
            (coefficient, suction * pick(i).fibre.diameter * rest_length.0[i])
        }
    };
    let slides = (0..WIDTH).any(|i| pick(i).line.contact != Contact::Stick);
    slides.then(|| Friction { coefficient: Lanes::from_fn(|i| of(i).0), press: Lanes::from_fn(|i| of(i).1) })
}

/// How a fibre is fed and laid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fed {
    /// Feed and belt.
    pub(crate) line: Line,
    /// The fibre.
    pub(crate) fibre: Fibre,
    /// Direction around the axis in which the first end is a little off it [turns].
    pub(crate) turn: f64,
}

impl Chain {
    /// Nodes on the belt begin to slide where the belt would have to hold them with more than the friction, and stick
    /// again where the friction stops them.                                       theory.md (61)
    #[inline(always)]
    pub(crate) fn slide(&mut self, h: f64) {
        if self.constants.friction.is_some() && self.laying.is_some() {
            self.begin_and_end_sliding(h);
        }
    }

    #[inline(never)]
    fn begin_and_end_sliding(&mut self, h: f64) {
        let nodes = self.position.len();
        let Self { velocity, earlier, constants: c, tensions, laying: Some(laying), .. } = self else {
            return;
        };
        let Some(friction) = c.friction else { return };
        for (from_end, node) in c.tail.iter_mut().enumerate() {
            let i = nodes - 1 - from_end;
            for lane in 0..WIDTH {
                let landed = !laying.landed_at[from_end].0[lane].is_nan() && node.mass.0[lane] > 0.0;
                if !landed {
                    continue;
                }
                let (mass, force) = (node.mass.0[lane], tensions.belt_force[i].lane(lane));
                let with_belt = Vec3::new(0.0, laying.belt_speed.0[lane], 0.0);
                let normal = (friction.press.0[lane] - force.x).max(0.0);
                let most = friction.coefficient.0[lane] * normal;
                if node.inverse_mass.0[lane] == 0.0 {
                    if force.y.hypot(force.z) > most {
                        node.inverse_mass.0[lane] = 1.0 / mass;
                    }
                    continue;
                }
                // The slip that there would be without friction: what friction can stop sticks.
                let (after, rate) = (velocity[i].lane(lane) - with_belt, h / mass);
                if (after.y - rate * force.y).hypot(after.z - rate * force.z) <= rate * most {
                    let slip = velocity[i].lane(lane) - with_belt;
                    laying.carried.impacts.0[lane] -= 0.5 * mass * slip.dot(slip);
                    velocity[i].set_lane(lane, with_belt);
                    earlier[i].set_lane(lane, with_belt);
                    node.hold(lane);
                }
            }
        }
    }

    /// Holds the nodes that land in this step.
    #[inline(always)]
    pub(crate) fn hold_landing(&mut self) {
        if self.laying.as_ref().is_some_and(|laying| !laying.landing.is_empty()) {
            self.lengthen_tail();
        }
    }

    #[cold]
    #[inline(never)]
    fn lengthen_tail(&mut self) {
        let nodes = self.position.len();
        let Self { constants: c, laying: Some(laying), .. } = self else { return };
        for (node, shares) in &laying.landing {
            let from_end = nodes - 1 - node;
            while c.tail.len() <= from_end {
                c.tail.push(c.node);
                laying.landed_at.push(Lanes::splat(f64::NAN));
            }
            for lane in (0..WIDTH).filter(|&lane| !shares.0[lane].is_nan()) {
                c.tail[from_end].hold(lane);
            }
        }
    }

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

    /// Stiffness of the root and of the node below it, after so many steps since the birth.   theory.md (60)
    pub(crate) fn clamp(&mut self, since_birth: u64) {
        let k = self.constants.bending_stiffness;
        let Some(laying) = &self.laying else { return };
        let inside = BORN + since_birth as f64 / laying.steps_per_element as f64;
        let before = (self.constants.root_stiffness, self.constants.second_stiffness);
        let root = Lanes::from_fn(|i| if laying.clamped[i] { k.0[i] / inside } else { 0.0 });
        let second = Lanes::from_fn(|i| k.0[i] * if laying.clamped[i] { 1.0 } else { inside.min(1.0) });
        (self.constants.root_stiffness, self.constants.second_stiffness) = (root, second);
        // What the change adds or takes is the feed's.
        let bends: [Lanes; 2] = [0, 1]
            .map(|node| if node + 1 < self.position.len() { self.bend_squared(node) } else { Lanes::ZERO });
        let half = Lanes::splat(0.5);
        let change = (root - before.0) * bends[0] + (second - before.1) * bends[1];
        if let Some(laying) = &mut self.laying {
            laying.carried.bending = laying.carried.bending + change * half;
        }
    }

    #[cold]
    #[inline(never)]
    fn touch_down(&mut self, step: u64, h: f64) {
        let nodes = self.position.len();
        let time = step as f64 * h;
        self.lengthen_tail();
        let Self { position, velocity, earlier, constants: c, laying: Some(laying), .. } = self else {
            return;
        };
        let mut changed = [false; WIDTH];
        for (node, shares) in laying.landing.drain(..) {
            let from_end = nodes - 1 - node;
            let number = laying.root_number - node as u64;
            for lane in (0..WIDTH).filter(|&lane| !shares.0[lane].is_nan()) {
                let (v, belt) = (velocity[node].lane(lane), laying.belt_speed.0[lane]);
                let with_belt = Vec3::new(0.0, belt, 0.0);
                let fall = v - with_belt;
                laying.carried.impacts.0[lane] -= 0.5 * c.tail[from_end].mass.0[lane] * fall.dot(fall);
                position[node].x.0[lane] = laying.height.0[lane];
                velocity[node].set_lane(lane, with_belt);
                earlier[node].set_lane(lane, with_belt);
                laying.landed_at[from_end].0[lane] = time - (1.0 - shares.0[lane]) * h;
                laying.touched[lane] = laying.touched[lane].max(number + 1);
                changed[lane] = true;
            }
        }
        for lane in (0..WIDTH).filter(|&lane| changed[lane]) {
            self.leave(lane, time);
        }
        self.shorten();
    }

    /// Nodes far behind the newest touch-down leave the chain. Those that hang in the air as an arch stay where they are
    /// from now on.
    fn leave(&mut self, lane: usize, time: f64) {
        loop {
            let Self { position, velocity, earlier, constants: c, laying: Some(laying), .. } = self else {
                return;
            };
            let number = laying.left[lane];
            if number + laying.kept[lane] >= laying.touched[lane] {
                return;
            }
            let node = (laying.root_number - number) as usize;
            let from_end = position.len() - 1 - node;
            let with_belt = Vec3::new(0.0, laying.belt_speed.0[lane], 0.0);
            if c.tail[from_end].inverse_mass.0[lane] != 0.0 {
                let fall = velocity[node].lane(lane) - with_belt;
                laying.carried.impacts.0[lane] -= 0.5 * c.tail[from_end].mass.0[lane] * fall.dot(fall);
                c.tail[from_end].hold(lane);
                velocity[node].set_lane(lane, with_belt);
                earlier[node].set_lane(lane, with_belt);
                if laying.landed_at[from_end].0[lane].is_nan() {
                    laying.landed_at[from_end].0[lane] = time;
                }
            }
            let at = position[node].lane(lane);
            let fed = number as f64 * c.rest_length.0[lane];
            let touch_down = laying.landed_at[from_end].0[lane];
            let md = at.y - laying.belt_speed.0[lane] * time;
            laying.laid[lane].push(LaidPoint { fed, time: touch_down, md, cd: at.z });
            laying.left[lane] += 1;

            // Without mass it counts no longer: its element towards the end, its bending and its weight neither.
            let fallen = at.x - laying.origin[node].x.0[lane];
            laying.carried.gravity_work.0[lane] += c.tail[from_end].weight.0[lane] * fallen;
            c.tail[from_end].weight.0[lane] = 0.0;
            c.tail[from_end].mass.0[lane] = 0.0;
            let (axial, bending) = self.held_by(node, lane);
            if let Some(laying) = &mut self.laying {
                laying.carried.axial.0[lane] -= axial;
                laying.carried.bending.0[lane] -= bending;
            }
        }
    }

    /// Energy of the element below a node, and of the bending at the node [J].
    fn held_by(&self, node: usize, lane: usize) -> (f64, f64) {
        let c = &self.constants;
        let Some(below) = self.position.get(node + 1) else { return (0.0, 0.0) };
        let edge = below.lane(lane) - self.position[node].lane(lane);
        let stretch = edge.norm() - c.rest_length.0[lane];
        let bending =
            if node == 0 { 0.0 } else { c.bending_stiffness.0[lane] * self.bend_squared_in(node, lane) };
        (0.5 * c.axial_stiffness.0[lane] * stretch * stretch, 0.5 * bending)
    }

    /// Square of the angle at a node.
    fn bend_squared(&self, node: usize) -> Lanes {
        Lanes::from_fn(|lane| self.bend_squared_in(node, lane))
    }

    fn bend_squared_in(&self, node: usize, lane: usize) -> f64 {
        let at = |i: usize| self.position[i].lane(lane);
        let above =
            if node == 0 { self.constants.root_direction.lane(lane) } else { at(node) - at(node - 1) };
        let below = at(node + 1) - at(node);
        let angle = libm::atan2(above.cross(below).norm(), above.dot(below));
        angle * angle
    }

    /// Takes the nodes off the arrays that have left in all lanes.
    fn shorten(&mut self) {
        let Some(laying) = &mut self.laying else { return };
        let nodes = self.position.len();
        let needed = (0..WIDTH).map(|lane| laying.nodes(lane)).max().unwrap_or(nodes) + HOLDING;
        if needed + TOGETHER > nodes {
            return;
        }
        laying.origin.truncate(needed);
        laying.landed_at.drain(..nodes - needed);
        self.constants.tail.drain(..nodes - needed);
        self.position.truncate(needed);
        self.velocity.truncate(needed);
        self.earlier.truncate(needed);
        self.tensions.truncate(needed - 1);
    }

    /// The root is let go and a new one is born above it, stretched like the element below.   theory.md (59)
    ///
    /// * `lifetime` – until the next birth [s]
    fn give_birth(&mut self, lifetime: f64) {
        let c = &self.constants;
        let length = |lane: usize| (self.position[1].lane(lane) - self.position[0].lane(lane)).norm();
        let stretch = match self.tensions.tension.first() {
            Some(tension) => Lanes::from_fn(|i| tension.0[i] / c.axial_stiffness.0[i]),
            None => Lanes::from_fn(length) - c.rest_length,
        };
        let born = c.rest_length + stretch;
        let position = self.position[0] - c.root_direction * born;
        let velocity = c.root_direction * (born * Lanes::splat(1.0 / lifetime));
        let tension = c.axial_stiffness * stretch;
        self.position.push_root(position);
        self.velocity.push_root(velocity);
        self.earlier.push_root(velocity);
        self.tensions.push_root(tension);

        // The former root now bends like every other node.
        let seen = Vec3::new(velocity.x, velocity.y - c.frame, velocity.z);
        let kinetic = (seen.x * seen.x + seen.y * seen.y + seen.z * seen.z) * c.root.mass;
        let axial = tension * stretch;
        let bend = self.bend_squared(1);
        let second = self.bend_squared(2);
        let (k, root) = (self.constants.bending_stiffness, self.constants.root_stiffness);
        let former = self.constants.second_stiffness;
        let bending = (k - root) * bend + (k - former) * second;
        let half = Lanes::splat(0.5);
        (self.constants.root_stiffness, self.constants.second_stiffness) = (k, k);
        let Some(laying) = &mut self.laying else { return };
        laying.root_number += 1;
        laying.origin.push_root(position);
        let carried = &mut laying.carried;
        carried.kinetic = carried.kinetic + kinetic * half;
        carried.axial = carried.axial + axial * half;
        carried.bending = carried.bending + bending * half;
    }

    /// Carries over to new constants what is fed, and what is held by the belt.
    pub(super) fn keep_held(&mut self, former: &Constants) {
        if self.laying.is_none() {
            return;
        }
        let c = &mut self.constants;
        (c.frame, c.friction) = (former.frame, former.friction);
        (c.root.mass, c.root.weight) = (c.node.mass, c.node.weight);
        let (root, second) = (former.root_stiffness, former.second_stiffness);
        let scale = |of: Lanes| {
            Lanes::from_fn(|i| of.0[i] / former.bending_stiffness.0[i] * c.bending_stiffness.0[i])
        };
        (c.root_stiffness, c.second_stiffness) = (scale(root), scale(second));
        let node = c.node;
        let kept = |new: Lanes, old: Lanes| Lanes::from_fn(|i| if old.0[i] == 0.0 { 0.0 } else { new.0[i] });
        c.tail = former
            .tail
            .iter()
            .map(|old| Node {
                mass: kept(node.mass, old.mass),
                inverse_mass: kept(node.inverse_mass, old.inverse_mass),
                inverse_mass_x: kept(node.inverse_mass_x, old.inverse_mass_x),
                weight: kept(node.weight, old.weight),
            })
            .collect();
    }

    /// Makes a fibre of fixed length a fed one: its first elements move down from the inlet at the feed speed.
    ///
    /// The first end is a thousandth of an element off the axis, because a fibre that is exactly straight stays in the
    /// unstable balance of a column.
    ///
    /// * `lanes` – of each fibre
    pub(crate) fn feed(&mut self, lanes: &[Fed]) {
        let c = &mut self.constants;
        let elements = self.position.len() - 1;
        let mut laying = Laying::new(lanes, &c.rest_length, elements);
        let above = c.root_direction * (c.rest_length * Lanes::splat(BORN - 0.5));
        self.position.iter_mut().for_each(|position| *position += above);
        let pick =
            |lane: usize| lanes[if lane < lanes.len() { lane } else { 0 }].turn * std::f64::consts::TAU;
        let end = &mut self.position[elements];
        for lane in 0..WIDTH {
            let off = 1e-3 * c.rest_length.0[lane];
            end.y.0[lane] += off * libm::cos(pick(lane));
            end.z.0[lane] += off * libm::sin(pick(lane));
        }
        let velocity = c.root_direction * laying.feed_speed;
        self.velocity.iter_mut().chain(self.earlier.iter_mut()).for_each(|v| *v = velocity);
        laying.origin = self.position.clone();
        c.frame = laying.belt_speed;
        c.friction = friction(lanes, &c.rest_length);
        if c.friction.is_some() {
            self.tensions.rub();
        }
        // It becomes a node between two elements.
        let Node { mass, weight, .. } = c.node;
        (c.root.mass, c.root.weight) = (mass, weight);
        self.laying = Some(laying);
        self.clamp(0);
    }
}
