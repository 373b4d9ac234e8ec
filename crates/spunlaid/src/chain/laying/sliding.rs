//! When a node on the belt slides and when it sticks.

use crate::chain::Chain;
use crate::lanes::WIDTH;

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
