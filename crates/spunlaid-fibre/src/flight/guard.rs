//! The guard: a fibre whose computation has diverged, or which does not come down, is lost. No mean may contain it.

use super::{Entry, Flight};
use crate::body::Root;
use crate::chain::Chain;
use spunlaid_ground::{Dimension, Error, Fault, Lanes, Register, Task, Vec3, WIDTH, Wide};

/// By how much an element may be off from the length that belongs to its tension, in parts of its rest length
/// [-]. Where the tensions are found it is a hundredth at most, after a landing in a single step some
/// hundredths.
const MOST_OFF: f64 = 0.1;
/// Largest strain, either way [-].
const MOST_STRAIN: f64 = 1.0;
/// How many times faster than all that drives it a node may be [-]. The end of a fibre that whips is several
/// times faster.
const MOST_SPEED: f64 = 20.0;
/// Length of fibre in the air, in distances to the belt, above which it does not reach the belt.
const MOST_IN_AIR: f64 = 10.0;
/// The part of a limit from which a fibre is looked at by itself: rounding differs between the two looks.
const DOUBTFUL: f64 = 0.99;

impl Flight {
    /// The lane of the first fibre that is lost and the reason, if there is one.
    pub fn lost(&self) -> Option<(usize, Error)> {
        let doubtful = self.doubtful();
        let diverged = |lane: usize| Some((lane, doubtful[lane].then(|| self.diverged(lane))??));
        let adrift = |lane: usize| Some((lane, self.adrift(lane)?));
        (0..self.fibres()).find_map(diverged).or_else(|| (0..self.fibres()).find_map(adrift))
    }

    /// The lanes of all fibres that are lost, each with the reason.
    pub fn losses(&self) -> impl Iterator<Item = (usize, Error)> {
        let doubtful = self.doubtful();
        let diverged = move |lane: usize| doubtful[lane].then(|| self.diverged(lane)).flatten();
        let lost = move |lane: usize| diverged(lane).or_else(|| self.adrift(lane));
        (0..self.fibres()).filter_map(move |lane| Some((lane, lost(lane)?)))
    }

    /// The fibres that may have diverged. All are looked at together, since this is done at every recorded
    /// instant and hardly ever finds one.
    fn doubtful(&self) -> [bool; WIDTH] {
        // A lane without a case has no limit.
        let most_speed = Lanes::from_fn(|lane| {
            self.case(lane).map_or(f64::INFINITY, |case| MOST_SPEED * case.air.velocity.abs())
        });
        let found = self.isa.run(SuspectNodes { chain: &self.chain, most_speed });
        std::array::from_fn(|lane| found.0[lane] > 0.0 || self.chain.tensions.worst[lane].0 > MOST_OFF)
    }

    /// Whether the computation of the fibre in a lane has diverged. A lane is judged by itself, so a fibre is
    /// lost in any company or in none.
    fn diverged(&self, lane: usize) -> Option<Error> {
        let (node, sign) = self.sign_of_divergence(lane)?;
        let entry = self.entries.get(lane);
        Some(Error::Diverged {
            replicate: entry.map_or(lane as u64, |entry| entry.replicate) + 1,
            node: node + 1,
            time: self.time(),
            sign,
            cause: entry.map_or_else(
                || "lower the time step".to_owned(),
                |entry| entry.case.likely_cause_of_divergence(),
            ),
        })
    }

    /// The node, and in words what shows that the computation has diverged there.
    fn sign_of_divergence(&self, lane: usize) -> Option<(usize, String)> {
        let (chain, nodes) = (&self.chain, self.chain.nodes()[lane]);
        let at = |i: usize| chain.position[i].lane(lane);
        let case = self.case(lane);
        if let Some(node) = (0..nodes).find(|&i| !at(i).norm().is_finite()) {
            // A held root becomes NaN only through the first element.
            let held = case.is_some_and(|case| case.fibre.root != Root::Free);
            let node = node.max(usize::from(held));
            return Some((node, format!("node {} is no longer finite", node + 1)));
        }
        let (off, node) = chain.furthest_off(lane);
        if off > MOST_OFF {
            let (below, off) = (node + 1, percent(off));
            return Some((
                node,
                format!(
                    "the element below node {below} is off by {off} from the length that its tension gives it"
                ),
            ));
        }
        let rest_length = chain.constants.element.rest_length.0[lane];
        let strain = |j: usize| (at(j + 1) - at(j)).norm() / rest_length - 1.0;
        if let Some(node) = (0..nodes.saturating_sub(1)).find(|&j| strain(j) > MOST_STRAIN) {
            let (below, strain) = (node + 1, percent(strain(node)));
            return Some((
                node,
                format!("the element below node {below} has a strain of {strain}, which no fibre can have"),
            ));
        }
        let case = case?;
        let speeds = (0..nodes).map(|i| (chain.velocity[i].lane(lane).norm(), i));
        let (speed, node) = speeds.fold((0.0, 0), |most, one| if one.0 > most.0 { one } else { most });
        // The air is looked at only where this may be so.
        let doubtful = speed > MOST_SPEED * case.air.velocity.abs();
        let given = if doubtful { case.driving_speed() } else { f64::INFINITY };
        (speed > MOST_SPEED * given).then(|| {
            let [speed, given] = [speed, given].map(|v| Dimension::Velocity.pretty_to(v, 3));
            let moving = node + 1;
            let sign = format!(
                "node {moving} moves with {speed}, while air, feed, belt, gravity and elasticity together give no more \
                 than about {given}"
            );
            (node, sign)
        })
    }

    /// Whether the fibre in a lane does not reach the belt: ten times the way has been fed and has not landed.
    fn adrift(&self, lane: usize) -> Option<Error> {
        let Entry { case, replicate, .. } = self.entries.get(lane)?;
        let line = case.line.as_ref()?;
        let rest_length = self.chain.constants.element.rest_length.0[lane];
        let in_air = self.chain.in_air()[lane] as f64 * rest_length / line.distance;
        (in_air > MOST_IN_AIR).then(|| {
            let time = self.time();
            let reached = self.chain.position.iter().map(|p| p.x.0[lane]).fold(f64::NEG_INFINITY, f64::max);
            let reached = Dimension::Length.pretty_to(reached, 3);
            let distance = Dimension::Length.pretty(line.distance);
            let what = Fault::new(
                format!(
                    "the fibre does not reach the belt: after {time:.3} s, {MOST_IN_AIR} times the way to the belt has \
                     been fed and has not landed, and the lowest node is {reached} from the inlet of {distance}"
                ),
                "give faster air towards the belt, more weight, or a belt that is nearer (belt.distance)",
            );
            Error::NotLanding { replicate: replicate + 1, time, what }
        })
    }
}

/// Looks for what [`Flight::sign_of_divergence`] would find, in all lanes at once: 1 where it may find
/// something, otherwise 0.
struct SuspectNodes<'a> {
    chain: &'a Chain,
    /// Of a node, that needs no closer look [m/s].
    most_speed: Lanes,
}

impl Task for SuspectNodes<'_> {
    type Output = Lanes;

    #[inline(always)]
    fn call<S: Register>(self) -> Lanes {
        let (chain, c) = (self.chain, &self.chain.constants);
        let (nodes, zero) = (chain.position.len(), Wide::<S>::zero());
        let most_off = Wide::splat(DOUBTFUL * MOST_OFF);
        let most_strain = Wide::splat(DOUBTFUL * MOST_STRAIN);
        // What is NaN or infinite makes the sum of the squares so. In the others a NaN is passed over, as it
        // is in the closer look.
        let mut squares = zero;
        let mut fastest = zero;
        let mut doubts = zero;
        for (position, velocity) in chain.position.iter().zip(chain.velocity.iter()) {
            let (position, velocity) = (Vec3::load(position), Vec3::load(velocity));
            squares = position.dot_add(position, squares);
            fastest = velocity.dot(velocity).max(fastest);
        }
        let one = Wide::splat(1.0);
        for (j, pair) in chain.position.windows(2).enumerate() {
            let element = &c.element;
            let rest_length = Wide::load(&element.rest_length);
            let edge = Vec3::load(&pair[1]) - Vec3::load(&pair[0]);
            let stretch = edge.dot(edge).sqrt() - rest_length;
            doubts = Wide::select_less(most_strain * rest_length, stretch, one, doubts);
            if let Some(tension) = chain.tensions.tension.get(j) {
                let off = Wide::load(tension).neg_mul_add(Wide::load(&element.compliance), stretch).abs();
                // An element that lies on the belt is held at both nodes.
                let above = Wide::load(&c.node(j, nodes).inverse_mass);
                let below = Wide::load(&c.node(j + 1, nodes).inverse_mass);
                let moved = Wide::select_less(zero, above.max(below), off, zero);
                doubts = Wide::select_less(most_off * rest_length, moved, one, doubts);
            }
        }
        let most_speed = Wide::load(&self.most_speed) * Wide::splat(DOUBTFUL);
        doubts = Wide::select_less(most_speed * most_speed, fastest, one, doubts);
        Wide::select_less(squares, Wide::splat(f64::INFINITY), doubts, one).store()
    }
}

fn percent(share: f64) -> String {
    format!("{} %", Dimension::Ratio.pretty_to(100.0 * share, 3))
}
