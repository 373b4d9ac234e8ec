//! Friction on the belt.

use super::constants::Node;
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
    /// Friction of eight fibres; none if all of them stick.
    ///
    /// * `contact` – of each fibre with its belt
    /// * `diameter`, `rest_length` – of each fibre, and of its elements [m]
    pub(super) fn new(contact: [Contact; WIDTH], diameter: &Lanes, rest_length: &Lanes) -> Option<Self> {
        let numbers = |i: usize| match contact[i] {
            Contact::Stick => (f64::INFINITY, 0.0),
            Contact::Friction { coefficient, suction } => {
                (coefficient, suction * diameter.0[i] * rest_length.0[i])
            }
        };
        let slides = contact.iter().any(|contact| *contact != Contact::Stick);
        slides.then(|| Self {
            coefficient: Lanes::from_fn(|i| numbers(i).0),
            press: Lanes::from_fn(|i| numbers(i).1),
        })
    }

    /// The largest friction on a node [N].
    ///
    /// * `pull` – force of the chain and of gravity on to the belt [N]
    pub(super) fn most(&self, lane: usize, pull: f64) -> f64 {
        self.coefficient.0[lane] * (self.press.0[lane] + pull).max(0.0)
    }

    /// The belt's force on a node that slides [N]; zero in the lanes where it does not. Friction slows the
    /// node down, at most to the belt's velocity within the step.
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
