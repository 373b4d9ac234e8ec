//! One pass along eight chains that computes all forces on every node.

use super::Constants;
use super::forces::{Element, internal};
use crate::air::AirAtElements;
use crate::drag::{DragLanes, Split};
use crate::lanes::{Register, Wide};
use crate::vec3::Vec3;

/// What a time-integration scheme gives to a force pass, and what it does with the forces.
pub(crate) trait Integrator<S: Register> {
    /// Position of node `i` [m].
    fn position(&self, i: usize) -> Vec3<Wide<S>>;

    /// Velocity of node `i` from which drag and damping are computed [m/s].
    fn drag_velocity(&self, i: usize) -> Vec3<Wide<S>>;

    /// Tension of element `j` [N], negative in compression.
    fn tension(&mut self, j: usize, element: &Element<S>) -> Wide<S>;

    /// Takes the force on node `i` without gravity and damping, and the part of it that is drag [N].
    /// The pass does not need the node any more.
    fn node(&mut self, i: usize, force: Vec3<Wide<S>>, drag: Vec3<Wide<S>>);
}

/// Computes the forces on eight chains in a wind.
///
/// * `eddy` – index into the wind for each of the `N` elements
///
/// The pass goes from the root to the free end in blocks of elements. For each block it computes first the
/// geometry and the relative velocities, then the powers of the drag law, then all forces and their sums on
/// the nodes. Three short loops are faster than one long loop, because the processor then works on several
/// elements at once instead of waiting for one result after the other. A block fits in the first-level
/// cache. The force on a node is complete when the element below it is done.
#[inline(always)]
pub(crate) fn force_pass<S: Register, M: Integrator<S>, B: AirAtElements<S>>(
    integrator: &mut M,
    c: &Constants,
    wind: B,
    eddy: &[u32],
    block: &mut ElementBlock<S>,
) {
    let mut above = Element {
        tangent: Vec3::load(&c.root_direction),
        inverse_length: Wide::zero(),
        length: Wide::zero(),
    };
    // Sums so far on nodes j−1 and j: of all forces, and of the drag alone.
    let (mut force, mut force_above) = (Vec3::zero(), Vec3::zero());
    let (mut drag, mut drag_above) = (Vec3::zero(), Vec3::zero());
    for (start, eddy) in (0..).step_by(BLOCK).zip(eddy.chunks(BLOCK)) {
        let elements = &mut block.0[..eddy.len()];
        kinematics(integrator, start, elements, wind, eddy);
        if c.half_drag.is_powers() {
            for item in &mut *elements {
                c.half_drag.raise(&mut item.split);
            }
        } else {
            for (j, item) in (start..).zip(&mut *elements) {
                c.half_drag.look_up(j, &mut item.split);
            }
        }
        for (j, item) in (start..).zip(&*elements) {
            let stiffness = if j == 0 { &c.root_stiffness } else { &c.bending_stiffness };
            let tension = integrator.tension(j, &item.element);
            let (a, pull) = internal(&above, &item.element, Wide::load(stiffness), tension);
            if j > 0 {
                integrator.node(j - 1, force_above - a, drag_above);
            }
            let air = c.half_drag.force(&item.split, item.element.tangent);
            (force_above, force) = (force + (a + pull + air), air - pull);
            (drag_above, drag) = (drag + air, air);
            above = item.element;
        }
    }
    integrator.node(eddy.len() - 1, force_above, drag_above);
    integrator.node(eddy.len(), force, drag);
}

/// Number of elements in a block.
const BLOCK: usize = 8;

/// An element during a force pass.
#[derive(Clone, Copy)]
struct BlockElement<S: Register> {
    element: Element<S>,
    /// Intermediate values for half the element's drag.
    split: Split<S>,
}

/// Memory for the elements of a block.
pub(crate) struct ElementBlock<S: Register>([BlockElement<S>; BLOCK]);

impl<S: Register> ElementBlock<S> {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        let (vector, number) = (Vec3::zero(), Wide::zero());
        let element = Element { tangent: vector, inverse_length: number, length: number };
        Self([BlockElement { element, split: Split::none() }; BLOCK])
    }
}

/// Geometry of the elements of a block that begins at element `start`, and their relative velocities.
#[inline(always)]
fn kinematics<S: Register>(
    integrator: &impl Integrator<S>,
    start: usize,
    block: &mut [BlockElement<S>],
    wind: impl AirAtElements<S>,
    eddy: &[u32],
) {
    let mut upper = (integrator.position(start), integrator.drag_velocity(start));
    let (mut here, mut signal) = (eddy[0], wind.signal(eddy[0]));
    for (j, (item, &eddy)) in (start + 1..).zip(block.iter_mut().zip(eddy)) {
        let lower = (integrator.position(j), integrator.drag_velocity(j));
        item.element = Element::between(upper.0, lower.0);
        if eddy != here {
            (here, signal) = (eddy, wind.signal(eddy));
        }
        // Element `j−1` is above node `j`.
        let air = wind.at(j - 1, signal);
        let relative = (upper.1 + lower.1).neg_mul_add(Wide::splat(0.5), air);
        item.split = DragLanes::split(relative, item.element.tangent);
        upper = lower;
    }
}
