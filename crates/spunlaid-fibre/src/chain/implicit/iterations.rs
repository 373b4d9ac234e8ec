//! Further iterations of Newton's method, for the rare steps in which one does not find the tensions.
//!
//! One iteration takes the lengths of the elements as linear in the corrections. Where a fibre folds on to the belt, or
//! where a strong eddy turns an element far in one step, they are not, and elements would be left too long or
//! too short. Each lane is computed by itself in plain numbers, so what it does not need does not touch it.
//!                                                                                             theory.md (53)

use crate::chain::Chain;
use crate::chain::work::WorkDone;
use spunlaid_ground::{Lanes, Vec3, WIDTH};

/// By how much the squared length of an element may be off from the one that belongs to its tension without more
/// iterations, in parts of it [-].
const TOO_FAR: f64 = 0.05;
/// Iterations that make the whole correction. A fibre that a fold pulls taut moves to and fro across its
/// direction with them; later ones make a part of the correction, which ends this.
const WHOLE: usize = 4;
const PART: f64 = 0.7;
/// Most iterations in a step.
const MOST: usize = 200;

impl Chain {
    /// Corrects the tensions again in the lanes that need it, after a step of `h` [s].
    ///
    /// * `off` – by how much the squared lengths of the elements are off at most in each lane, in parts of them [-]
    #[inline(always)]
    pub(super) fn iterate(&mut self, off: &Lanes, h: f64, split: bool, work: &mut WorkDone) {
        if off.0.iter().any(|&off| off > TOO_FAR) {
            self.iterate_lanes(off, h, split, work);
        }
    }

    #[cold]
    #[inline(never)]
    fn iterate_lanes(&mut self, off: &Lanes, h: f64, split: bool, work: &mut WorkDone) {
        for lane in (0..WIDTH).filter(|&lane| off.0[lane] > TOO_FAR) {
            let part = |iteration| if iteration < WHOLE { 1.0 } else { PART };
            let found = (0..MOST).any(|i| !self.iterate_once(lane, h, part(i), split, work));
            if !found {
                self.tensions.worst[lane] = self.furthest_off(lane);
            }
        }
    }

    /// One more iteration in a lane, which makes a part of the correction; returns whether it was needed.
    fn iterate_once(&mut self, lane: usize, h: f64, part: f64, split: bool, work: &mut WorkDone) -> bool {
        let Some((directions, corrections)) = self.corrections(lane, h) else { return false };
        let Self { position, velocity, earlier, constants: c, tensions: t, laying, .. } = self;
        let nodes = position.len();
        let mut above = Vec3::default();
        for i in 0..nodes {
            let mut below = Vec3::default();
            if let (Some(direction), Some(&correction)) = (directions.get(i), corrections.get(i)) {
                let correction = part * correction;
                below = *direction * correction;
                t.tension[i].0[lane] += correction;
            }
            let force = below - above;
            above = below;
            let node = c.node(i, nodes);
            let [x, across] = [node.inverse_mass_x.0[lane], node.inverse_mass.0[lane]];
            let before = velocity[i].lane(lane);
            let kick = Vec3::new(h * x * force.x, h * across * force.y, h * across * force.z);
            let after = before + kick;
            velocity[i].set_lane(lane, after);
            let here = position[i].lane(lane) + kick * h;
            position[i].set_lane(lane, here);

            // The same force as if it had been there in the step, but for the little that the others did on the way.
            let frame = Vec3::new(0.0, c.frame.0[lane], 0.0);
            let moved = before + after - frame * 2.0;
            let start = earlier[i].lane(lane) - frame;
            let held = |component: f64, inverse_mass: f64| if inverse_mass == 0.0 { component } else { 0.0 };
            let held = Vec3::new(held(force.x, x), held(force.y, across), held(force.z, across));
            let support = if i == 0 { &mut work.feed } else { &mut work.belt };
            for (sum, force) in
                [(&mut work.total, force - held), (&mut work.tension, force), (support, -held)]
            {
                sum.both.0[lane] += force.dot(moved);
                if split {
                    sum.before.0[lane] += force.dot(start);
                }
            }
            if i > 0 && laying.is_some() && c.friction.is_some() && c.may_be_held(i, nodes) {
                let force = t.belt_force[i].lane(lane) - held;
                t.belt_force[i].set_lane(lane, force);
            }
        }
        true
    }

    /// The element of a lane whose length is furthest off from the one that belongs to its tension, and by
    /// how much, in parts of its rest length [-]: now, or after a step in which the iterations did not find
    /// the tensions. Elements that lie on the belt are left out: nothing can correct them.
    pub(crate) fn furthest_off(&self, lane: usize) -> (f64, usize) {
        let c = &self.constants;
        let nodes = self.nodes()[lane];
        let off = |j: usize, tension: &Lanes| {
            let c = &c.element;
            let stiffness = c.axial_stiffness.0[lane];
            let rest_length = c.rest_length.0[lane];
            let length = (self.position[j + 1].lane(lane) - self.position[j].lane(lane)).norm();
            let held = self.is_held(j, lane) && self.is_held(j + 1, lane);
            if held {
                0.0
            } else {
                ((length - rest_length) - tension.0[lane] / stiffness).abs() / rest_length
            }
        };
        let tensions = self.tensions.tension.iter().take(nodes.saturating_sub(1)).enumerate();
        let all = tensions.map(|(j, tension)| (off(j, tension), j));
        all.fold(self.tensions.worst[lane], |worst, one| if one.0 > worst.0 { one } else { worst })
    }

    /// The directions of a lane's elements and the corrections of their tensions [N]: the rows of theory.md
    /// (53) at the end of the step. None if no element is too far from the length that belongs to its
    /// tension.
    fn corrections(&self, lane: usize, h: f64) -> Option<(Vec<Vec3<f64>>, Vec<f64>)> {
        let c = &self.constants;
        let nodes = self.position.len();
        let weight = |i: usize, stiffness: f64| {
            let node = c.node(i, nodes);
            [node.inverse_mass_x.0[lane], node.inverse_mass.0[lane]]
                .map(|inverse| h * h * stiffness * inverse)
        };
        let between = |[x, across]: [f64; 2], a: Vec3<f64>, b: Vec3<f64>| {
            x * a.x * b.x + across * (a.y * b.y + a.z * b.z)
        };
        let mut directions: Vec<Vec3<f64>> = Vec::with_capacity(nodes);
        let mut rows: Vec<(f64, f64)> = Vec::with_capacity(nodes);
        let mut needed = false;
        // From the root on, each row is eliminated with the one above.
        let mut last = (0.0, 0.0);
        for j in 0..nodes - 1 {
            let element = &c.element;
            let stiffness = element.axial_stiffness.0[lane];
            let rest_length = element.rest_length.0[lane];
            let [upper, lower] = [j, j + 1].map(|i| weight(i, stiffness));
            let edge = self.position[j + 1].lane(lane) - self.position[j].lane(lane);
            let length = edge.norm();
            let direction = edge * (1.0 / length);
            let moves = upper[1] + lower[1] > 0.0;
            let wanted = stiffness * (length - rest_length) - self.tensions.tension[j].0[lane];
            needed |= moves && wanted.abs() > 0.5 * TOO_FAR * stiffness * rest_length;
            let own = 1.0 + between(upper, direction, direction) + between(lower, direction, direction);
            let above = directions.last().map_or(0.0, |&above| -between(upper, above, direction));
            let next = match j + 2 < nodes {
                true => self.position[j + 2].lane(lane) - self.position[j + 1].lane(lane),
                false => Vec3::default(),
            };
            let below =
                if j + 2 < nodes { -between(lower, direction, next * (1.0 / next.norm())) } else { 0.0 };
            let pivot = 1.0 / (own - above * last.1);
            last = ((wanted - above * last.0) * pivot, below * pivot);
            rows.push(last);
            directions.push(direction);
        }
        if !needed {
            return None;
        }
        let mut corrections = vec![0.0; rows.len()];
        let mut below = 0.0;
        for (correction, (value, slope)) in corrections.iter_mut().zip(rows).rev() {
            below = value - slope * below;
            *correction = below;
        }
        Some((directions, corrections))
    }
}
