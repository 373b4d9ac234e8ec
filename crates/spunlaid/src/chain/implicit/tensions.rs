//! What the scheme stores, and its room for fibres that grow.

use crate::lanes::Lanes;
use crate::nodes::Nodes;
use crate::vec3::Vec3;

/// What the scheme stores besides positions and velocities.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tensions {
    /// Of each element: tension `λ` [N].
    pub(crate) tension: Nodes<Lanes>,
    /// For each element: its direction at the start of the step, and its predicted direction at the end.
    pub(super) tangent: Vec<Vec3<Lanes>>,
    pub(super) direction: Vec<Vec3<Lanes>>,
    /// For each node: force with the tensions of the last step, and the drag in it [N].
    pub(super) force: Vec<Vec3<Lanes>>,
    pub(super) drag: Vec<Vec3<Lanes>>,
    /// For each node: acceleration [m/s²] minus `slope` times that of the next node; later the predicted velocity.
    pub(super) acceleration: Vec<Vec3<Lanes>>,
    pub(super) slope: Vec<Lanes>,
    /// For each node on the belt, if there is friction: the belt's force on it [N].
    pub(crate) belt_force: Vec<Vec3<Lanes>>,
    rubs: bool,
    /// For each element: correction of the tension [N] minus `.1` times that of the element above.
    pub(super) correction: Vec<(Lanes, Lanes)>,
}

impl Tensions {
    pub(crate) fn new(elements: usize) -> Self {
        let mut tensions = Self { tension: vec![Lanes::ZERO; elements].into(), ..Self::default() };
        if elements > 0 {
            tensions.make_room(elements + 1);
        }
        tensions
    }

    /// Keeps the belt's force on each node.
    pub(crate) fn rub(&mut self) {
        self.rubs = true;
        self.belt_force = vec![Vec3::ZERO; self.force.len()];
    }

    /// Makes room for a number of nodes.
    fn make_room(&mut self, room: usize) {
        if self.force.len() < room {
            if self.rubs {
                self.belt_force.resize(room, Vec3::ZERO);
            }
            self.tangent.resize(room, Vec3::ZERO);
            self.direction.resize(room, Vec3::ZERO);
            self.force.resize(room, Vec3::ZERO);
            self.drag.resize(room, Vec3::ZERO);
            self.acceleration.resize(room, Vec3::ZERO);
            self.slope.resize(room, Lanes::ZERO);
            self.correction.resize(room, Default::default());
        }
    }

    /// Adds an element at the root, unless the scheme does without tensions.
    pub(crate) fn push_root(&mut self, tension: Lanes) {
        if !self.tension.is_empty() {
            self.tension.push_root(tension);
            let nodes = self.tension.len() + 1;
            if self.force.len() < nodes {
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
