//! The laydown: nodes touch down, move with the belt, and leave the chain.

use super::{LaidPoint, LayingState};
use crate::chain::Chain;
use spunlaid_ground::{Lanes, Register, Vec3, WIDTH, Wide};

/// Nodes that stay in the chain after they have left it in every lane, because they hold the bending of the last one.
const HOLDING: usize = 2;
/// Nodes that leave the arrays together.
const TOGETHER: usize = 4;

impl LayingState {
    /// Whether a node passes the belt within a step, in any lane.
    #[inline(always)]
    pub(crate) fn reached<S: Register>(&self, x: Wide<S>, vx: Wide<S>, h: Wide<S>) -> bool {
        (vx.mul_add(h, x) - Wide::load(&self.height)).any_above(0.0)
    }

    /// Lets a node land: changes its velocity of this step so that it ends on the belt, and returns 0 in the
    /// lanes where it does, 1 in the others. It keeps its own velocity until it touches down, then it has
    /// that of the belt.
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

impl LayingState {
    /// The inverse mass along the belt of a node, zero in the lanes where it lands in this step.
    #[inline(always)]
    pub(crate) fn inverse_mass_unless_landing<S: Register>(
        &self,
        node: usize,
        inverse_mass: Wide<S>,
    ) -> Wide<S> {
        let Some((_, shares)) = self.landing.iter().find(|(landing, _)| *landing == node) else {
            return inverse_mass;
        };
        // Comparisons with NaN are false.
        Wide::select_less(Wide::load(shares), Wide::splat(2.0), Wide::zero(), inverse_mass)
    }
}

impl Chain {
    /// Holds the nodes that land in this step at the belt. Along it the tension may still move them.
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
        let Self { constants: c, tensions, laying: Some(laying), .. } = self else { return };
        for (node, shares) in &laying.landing {
            let from_end = nodes - 1 - node;
            while c.tail.len() <= from_end {
                // No belt has held it yet; a node before it in this place has been held.
                if let Some(force) = tensions.belt_force.get_mut(nodes - 1 - c.tail.len()) {
                    *force = Vec3::ZERO;
                }
                c.tail.push(c.between);
                laying.landed_at.push(Lanes::splat(f64::NAN));
            }
            for lane in (0..WIDTH).filter(|&lane| !shares.0[lane].is_nan()) {
                c.tail[from_end].inverse_mass_x.0[lane] = 0.0;
            }
        }
    }

    #[cold]
    #[inline(never)]
    pub(super) fn touch_down(&mut self, step: u64, h: f64) {
        let nodes = self.position.len();
        let time = step as f64 * h;
        self.lengthen_tail();
        let landing =
            self.laying.as_mut().map_or_else(Vec::new, |laying| std::mem::take(&mut laying.landing));
        let mut changed = [false; WIDTH];
        for (node, shares) in landing {
            for lane in (0..WIDTH).filter(|&lane| !shares.0[lane].is_nan()) {
                self.stop(node, lane);
                let Some(laying) = &mut self.laying else { return };
                let from_end = nodes - 1 - node;
                let number = laying.root_number - node as u64;
                self.position[node].x.0[lane] = laying.height.0[lane];
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

    /// A node moves with the belt from now on. The belt takes the energy of its motion relative to it.
    pub(super) fn stop(&mut self, node: usize, lane: usize) {
        let from_end = self.position.len() - 1 - node;
        let Self { velocity, earlier, constants: c, laying: Some(laying), .. } = self else { return };
        let with_belt = Vec3::new(0.0, laying.belt_speed.0[lane], 0.0);
        let slip = velocity[node].lane(lane) - with_belt;
        laying.carried.impacts.0[lane] -= 0.5 * c.tail[from_end].mass.0[lane] * slip.dot(slip);
        velocity[node].set_lane(lane, with_belt);
        earlier[node].set_lane(lane, with_belt);
        c.tail[from_end].hold(lane);
    }

    /// Nodes far behind the newest touch-down leave the chain. Those that hang in the air as an arch stay
    /// where they are from now on.
    fn leave(&mut self, lane: usize, time: f64) {
        loop {
            let Some(laying) = &self.laying else { return };
            let number = laying.left[lane];
            if number + laying.kept[lane] >= laying.touched[lane] {
                return;
            }
            let node = (laying.root_number - number) as usize;
            let from_end = self.position.len() - 1 - node;
            let moves = !self.is_held(node, lane);
            if moves {
                self.stop(node, lane);
            }
            let Self { position, constants: c, laying: Some(laying), .. } = self else { return };
            if moves && laying.landed_at[from_end].0[lane].is_nan() {
                laying.landed_at[from_end].0[lane] = time;
            }
            let at = position[node].lane(lane);
            let fed = number as f64 * laying.element_length.0[lane];
            let touch_down = laying.landed_at[from_end].0[lane];
            let md = at.y - laying.belt_speed.0[lane] * time;
            laying.laid[lane].push(LaidPoint { fed, time: touch_down, md, cd: at.z });
            laying.left[lane] += 1;

            // Without mass it counts no longer: its element towards the end, its bending and its weight neither.
            let fallen = at.x - laying.origin[node].x.0[lane];
            laying.carried.gravity_work.0[lane] += c.tail[from_end].weight.0[lane] * fallen;
            c.tail[from_end].weight.0[lane] = 0.0;
            c.tail[from_end].mass.0[lane] = 0.0;
            let (axial, bending) = self.element_energy(node, lane);
            if let Some(laying) = &mut self.laying {
                laying.carried.axial.0[lane] -= axial;
                laying.carried.bending.0[lane] -= bending;
            }
        }
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
