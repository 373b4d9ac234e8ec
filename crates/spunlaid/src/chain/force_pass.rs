//! One pass along eight chains: all forces on every node.

use super::Constants;
use super::forces::{Element, internal};
use crate::air::AirAtElements;
use crate::drag::{DragLanes, Split};
use crate::lanes::{Register, Wide};
use crate::vec3::Vec3;

/// What a scheme brings to a force pass, and what it does with the forces.
pub(crate) trait Motion<S: Register> {
    /// Position of node `i` [m].
    fn position(&self, i: usize) -> Vec3<Wide<S>>;

    /// Velocity of node `i` that drag and damping see [m/s].
    fn drag_velocity(&self, i: usize) -> Vec3<Wide<S>>;

    /// Tension of element `j` [N], negative in compression.
    fn tension(&mut self, j: usize, element: &Element<S>) -> Wide<S>;

    /// Takes the force on node `i` of all but gravity and damping, and the part of it that is drag [N].
    /// The pass is done with the node.
    fn node(&mut self, i: usize, force: Vec3<Wide<S>>, drag: Vec3<Wide<S>>);
}

/// Passes over eight chains in a wind.
///
/// * `eddy` – index into the wind for each of the `N` elements
///
/// From the root down in blocks of elements: first how they lie and move in the air, then the powers of the
/// drag, then all forces and their sum on the nodes. A machine keeps only so many operations in flight:
/// with short loops these belong to several elements, in one long one they wait for each other. A block
/// stays in the nearest cache. The force on a node is complete, and handed over, when the element below it
/// is done.
#[inline(always)]
pub(crate) fn force_pass<S: Register, M: Motion<S>, B: AirAtElements<S>>(
    motion: &mut M,
    c: &Constants,
    wind: B,
    eddy: &[u32],
    block: &mut Block<S>,
) {
    let mut above = Element {
        tangent: Vec3::load(&c.root_direction),
        inverse_length: Wide::zero(),
        length: Wide::zero(),
    };
    // Forces so far on nodes j−1 and j: all, and of the air.
    let (mut force, mut force_above) = (Vec3::zero(), Vec3::zero());
    let (mut drag, mut drag_above) = (Vec3::zero(), Vec3::zero());
    for (start, eddy) in (0..).step_by(BLOCK).zip(eddy.chunks(BLOCK)) {
        let links = &mut block.0[..eddy.len()];
        kinematics(motion, start, links, wind, eddy);
        if c.half_drag.is_powers() {
            for link in &mut *links {
                c.half_drag.raise(&mut link.split);
            }
        } else {
            for (j, link) in (start..).zip(&mut *links) {
                c.half_drag.look_up(j, &mut link.split);
            }
        }
        for (j, link) in (start..).zip(&*links) {
            let stiffness = if j == 0 { &c.root_stiffness } else { &c.bending_stiffness };
            let tension = motion.tension(j, &link.element);
            let (a, pull) = internal(&above, &link.element, Wide::load(stiffness), tension);
            if j > 0 {
                motion.node(j - 1, force_above - a, drag_above);
            }
            let air = c.half_drag.force(&link.split, link.element.tangent);
            (force_above, force) = (force + (a + pull + air), air - pull);
            (drag_above, drag) = (drag + air, air);
            above = link.element;
        }
    }
    motion.node(eddy.len() - 1, force_above, drag_above);
    motion.node(eddy.len(), force, drag);
}

/// Elements in a block.
const BLOCK: usize = 8;

/// An element within a force pass.
#[derive(Clone, Copy)]
struct Link<S: Register> {
    element: Element<S>,
    /// On the way to half the element's drag.
    split: Split<S>,
}

/// Room for the elements of a block.
pub(crate) struct Block<S: Register>([Link<S>; BLOCK]);

impl<S: Register> Block<S> {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        let (vector, number) = (Vec3::zero(), Wide::zero());
        let element = Element { tangent: vector, inverse_length: number, length: number };
        Self([Link { element, split: Split::none() }; BLOCK])
    }
}

/// Geometry of the elements of a block from `start` on, and velocity of the air relative to them.
///
/// Root and quotient of one element take the divider as long as the products of the rest take the
/// multipliers.
#[inline(always)]
fn kinematics<S: Register>(
    motion: &impl Motion<S>,
    start: usize,
    block: &mut [Link<S>],
    wind: impl AirAtElements<S>,
    eddy: &[u32],
) {
    let mut upper = (motion.position(start), motion.drag_velocity(start));
    let (mut here, mut signal) = (eddy[0], wind.signal(eddy[0]));
    for (j, (link, &eddy)) in (start + 1..).zip(block.iter_mut().zip(eddy)) {
        let lower = (motion.position(j), motion.drag_velocity(j));
        link.element = Element::between(upper.0, lower.0);
        if eddy != here {
            (here, signal) = (eddy, wind.signal(eddy));
        }
        // Element `j−1` lies above node `j`.
        let air = wind.at(j - 1, signal);
        let relative = (upper.1 + lower.1).neg_mul_add(Wide::splat(0.5), air);
        link.split = DragLanes::split(relative, link.element.tangent);
        upper = lower;
    }
}
