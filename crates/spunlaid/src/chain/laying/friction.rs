//! Friction on the belt: when a node slides and when it sticks.

use super::Feed;
use crate::chain::Chain;
use crate::chain::node::Node;
use crate::lanes::{Lanes, WIDTH};
use crate::line::Contact;
use crate::vec3::Vec3;

/// Friction of eight fibres on their belts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Friction {
    /// Coefficient of friction `μ` [-]. What sticks would have to be pulled with an infinite force.
    coefficient: Lanes,
    /// Force with which the suction presses a node on to the belt [N].
    press: Lanes,
}

impl Friction {
    /// Friction of up to eight fibres; none if all of them stick.
    pub(super) fn new(lanes: &[Feed], rest_length: &Lanes) -> Option<Self> {
        let pick = |i: usize| &lanes[if i < lanes.len() { i } else { 0 }];
        let numbers = |i: usize| match pick(i).line.contact {
            Contact::Stick => (f64::INFINITY, 0.0),
            Contact::Friction { coefficient, suction } => {
                (coefficient, suction * pick(i).fibre.diameter * rest_length.0[i])
            }
        };
        let slides = (0..WIDTH).any(|i| pick(i).line.contact != Contact::Stick);
        slides.then(|| Self {
            coefficient: Lanes::from_fn(|i| numbers(i).0),
            press: Lanes::from_fn(|i| numbers(i).1),
        })
    }

    /// The largest friction on a node [N].
    ///
    /// * `pull` – force of the chain and of gravity on to the belt [N]
    fn most(&self, lane: usize, pull: f64) -> f64 {
        self.coefficient.0[lane] * (self.press.0[lane] + pull).max(0.0)
    }

    /// The belt's force on a node that slides [N]; zero in the lanes where it does not. Friction slows the node down, at
    /// most to the belt's velocity within the step.
    ///
    /// * `v`, `belt_speed` – velocities of the node and of the belt [m/s]
    /// * `pull` – force of the chain and of gravity on to the belt [N]
    /// * `h` – the time step [s]
    pub(crate) fn on(
        &self,
        node: &Node,
        v: &Vec3<Lanes>,
        belt_speed: &Lanes,
        pull: &Lanes,
        h: f64,
    ) -> Vec3<Lanes> {
        let mut force = Vec3::ZERO;
        for lane in 0..WIDTH {
            if node.inverse_mass.0[lane] > 0.0 && node.inverse_mass_x.0[lane] == 0.0 {
                let slip = [v.y.0[lane] - belt_speed.0[lane], v.z.0[lane]];
                let speed = libm::hypot(slip[0], slip[1]);
                let stopping = node.mass.0[lane] / h;
                let drag = (self.most(lane, pull.0[lane]) / speed).min(stopping);
                let drag = if speed > 0.0 { drag } else { 0.0 };
                let [y, z] = slip.map(|slip| -drag * slip);
                force.set_lane(lane, Vec3::new(-pull.0[lane], y, z));
            }
        }
        force
    }
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
        let Some(friction) = self.constants.friction else { return };
        for from_end in 0..self.constants.tail.len() {
            let i = nodes - 1 - from_end;
            for lane in 0..WIDTH {
                let Self { velocity, constants: c, tensions, laying: Some(laying), .. } = &mut *self else {
                    return;
                };
                let node = &mut c.tail[from_end];
                let mass = node.mass.0[lane];
                if laying.landed_at[from_end].0[lane].is_nan() || mass == 0.0 {
                    continue;
                }
                let force = tensions.belt_force[i].lane(lane);
                let most = friction.most(lane, -force.x);
                if node.inverse_mass.0[lane] == 0.0 {
                    if libm::hypot(force.y, force.z) > most {
                        node.inverse_mass.0[lane] = 1.0 / mass;
                    }
                    continue;
                }
                // The slip that there would be without friction: what friction can stop sticks.
                let (v, rate) = (velocity[i].lane(lane), h / mass);
                let slip = [v.y - laying.belt_speed.0[lane] - rate * force.y, v.z - rate * force.z];
                if libm::hypot(slip[0], slip[1]) <= rate * most {
                    self.stop(i, lane);
                }
            }
        }
    }
}
