//! What the scheme stores, and its room for fibres that grow.

use crate::lanes::{Lanes, WIDTH};
use crate::nodes::Nodes;
use crate::vec3::Vec3;

/// What the scheme stores besides positions and velocities.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tensions {
    /// Of each element: tension `λ` [N].
    pub(crate) tension: Nodes<Lanes>,
    /// For each node: what a step knows of it and of the element below.
    pub(super) links: Vec<Link>,
    /// For each node on the belt, if there is friction: the belt's force on it [N].
    pub(crate) belt_force: Vec<Vec3<Lanes>>,
    rubs: bool,
    /// The largest error of an element's length after all iterations of a step, in parts of its rest length
    /// [-], and the element; so far, of each lane.
    pub(crate) worst: [(f64, usize); WIDTH],
}

/// What a step knows of a node and of the element below it. It lies together, because each pass along the
/// chain needs most of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    /// The element's direction at the start of the step, and its predicted direction at the end.
    pub(super) tangent: Vec3<Lanes>,
    pub(super) direction: Vec3<Lanes>,
    /// Force with the tensions of the last step, and the drag in it [N].
    pub(super) force: Vec3<Lanes>,
    pub(super) drag: Vec3<Lanes>,
    /// Acceleration [m/s²] minus `slope` times that of the next node; later the predicted velocity.
    pub(super) acceleration: Vec3<Lanes>,
    pub(super) slope: Lanes,
    /// Correction of the element's tension [N] minus `.1` times that of the element above.
    pub(super) correction: (Lanes, Lanes),
}

impl Link {
    const NONE: Self = Self {
        tangent: Vec3::ZERO,
        direction: Vec3::ZERO,
        force: Vec3::ZERO,
        drag: Vec3::ZERO,
        acceleration: Vec3::ZERO,
        slope: Lanes::ZERO,
        correction: (Lanes::ZERO, Lanes::ZERO),
    };
}

impl Tensions {
    pub(crate) fn new(elements: usize) -> Self {
        let mut tensions = Self { tension: vec![Lanes::ZERO; elements].into(), ..Self::default() };
        if elements > 0 {
            tensions.make_room(elements + 1);
        }
        tensions
    }

    /// Drag on a node at the start of the last step [N], by the number that the node had then.
    pub(crate) fn drag(&self, node: usize) -> Vec3<Lanes> {
        self.links[node].drag
    }

    /// Keeps the belt's force on each node.
    pub(crate) fn rub(&mut self) {
        self.rubs = true;
        self.belt_force = vec![Vec3::ZERO; self.links.len()];
    }

    /// Makes room for a number of nodes.
    fn make_room(&mut self, room: usize) {
        if self.links.len() < room {
            if self.rubs {
                self.belt_force.resize(room, Vec3::ZERO);
            }
            self.links.resize(room, Link::NONE);
        }
    }

    /// Adds an element at the root, unless the scheme does without tensions.
    pub(crate) fn push_root(&mut self, tension: Lanes) {
        if !self.tension.is_empty() {
            self.tension.push_root(tension);
            let nodes = self.tension.len() + 1;
            if self.links.len() < nodes {
                // For some more, because the next element is born soon.
                self.make_room(nodes + nodes / 4);
            }
        }
    }

    /// Keeps so many elements from the root on.
    pub(crate) fn truncate(&mut self, elements: usize) {
        if !self.tension.is_empty() {
            self.tension.truncate(elements);
        }
    }
}
