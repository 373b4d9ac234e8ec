//! The force of a fed fibre on its air along x: by the drag on its elements, and by the balance of its momentum, which
//! says what its air must have taken from what is seen of its nodes.
//!
//! ```text
//! nodes of a flight, or of a snapshot → NodeStates → MomentumBalance, sums over instants in classes of distance
//!   → force on the air down to each class and to the belt, fibre per length of the way
//!   └ StretchedBalance: of fibres in one air, in stretches of time that give the error
//! ```

#[cfg(test)]
mod tests;

use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Case, Flight, Snapshot, WayPlace};
use spunlaid_ground::{Estimate, Lanes, Vec3, WIDTH};

/// Classes of distance from the inlet.
const CLASSES: usize = 50;

/// Length of each of the stretches from which the change of the force at the inlet is found, of the way.
const THIRD: f64 = 0.06;

/// The drag on a fed fibre and the balance of its momentum along x, in classes of distance from the inlet: sums over
/// instants.
///
/// A class from `a` to `b` stands for the mean over all planes in it. What lies above a plane counts, so a force on
/// a node at `x` counts as `φ(x) = (b − x)/(b − a)`, one above the class and zero below it, and the momentum that
/// passes a plane is `m v_x²/(b − a)` of each node in the class. Sums over a class are therefore the means of those
/// over the classes that it is divided into. The drag is the force itself; the balance checks it, and stands for it
/// where a scheme does not give the drag.                                                 theory.md (116)
#[derive(Clone, Debug)]
pub(crate) struct MomentumBalance {
    distance: f64,
    /// Number of classes per distance [1/m].
    per_length: f64,
    /// Rest length [m], mass [kg], weight [N] and axial stiffness `EA` [N] of an element.
    element: f64,
    mass: f64,
    weight: f64,
    stiffness: f64,
    /// Mass flow [kg/s] and speed [m/s] of the feed, and the share of its direction that points along x.
    mass_flow: f64,
    feed_speed: f64,
    along: f64,
    instants: f64,
    /// Sum of the tensions of the first element [N].
    root_tension: f64,
    /// Of each class: force that counts from here on, momentum that passes [N], and fibre per length of the way [-].
    classes: Vec<[f64; 3]>,
    /// Drag that counts from each class on, and from the belt on [N]; empty as long as it is not known.
    drag: Vec<f64>,
}

impl MomentumBalance {
    /// That of a case, in the usual number of classes.
    pub(crate) fn of(case: &Case) -> Self {
        Self::new(case, CLASSES)
    }

    /// * `classes` – number of classes, from the inlet to the belt
    fn new(case: &Case, classes: usize) -> Self {
        let fibre = &case.fibre;
        let (distance, feed_speed) =
            case.line.map_or((f64::NAN, f64::NAN), |line| (line.distance, line.feed_speed));
        let mass = fibre.element_mass();
        Self {
            distance,
            per_length: classes as f64 / distance,
            element: fibre.rest_length(),
            mass,
            weight: mass * case.run.gravity,
            stiffness: fibre.youngs_modulus * fibre.cross_section(),
            mass_flow: case.filament().throughput(),
            feed_speed,
            along: fibre.direction.x,
            instants: 0.0,
            root_tension: 0.0,
            classes: vec![[0.0; 3]; classes],
            drag: Vec::new(),
        }
    }

    /// Adds an instant.
    ///
    /// * `balances` – one for each lane, or one for all of them
    pub(crate) fn see(balances: &mut [Self], nodes: &NodeStates<'_>) {
        let most = nodes.position.len().min(nodes.tension.len() + 1);
        let count = nodes.count.map(|count| count.min(most));
        let Some(last) = balances.len().checked_sub(1) else { return };
        let mut from_above = [0.0; WIDTH];
        // Node after node, because the lanes of a node lie together.
        for (i, (position, velocity)) in nodes.position.iter().zip(nodes.velocity).enumerate() {
            for lane in (0..WIDTH).filter(|lane| i < count[*lane]) {
                let balance = &mut balances[lane.min(last)];
                let (x, v) = (position.x.0[lane], velocity.x.0[lane]);
                let mut force = balance.weight - from_above[lane];
                if i + 1 < count[lane] {
                    let below = nodes.position[i + 1].lane(lane);
                    let edge = below - position.lane(lane);
                    let tension = nodes.tension[i].0[lane];
                    from_above[lane] = tension * edge.x / edge.norm();
                    force += from_above[lane];
                    if i == 0 {
                        balance.root_tension += tension;
                    }
                    balance.pass(End { x, v }, End { x: below.x, v: nodes.velocity[i + 1].x.0[lane] });
                    if let Some(drag) = nodes.drag.get(i) {
                        balance.drive(0.5 * (x + below.x), drag.x.0[lane]);
                    }
                }
                // What holds the root bears the forces on it.
                if i > 0 {
                    balance.push(x - nodes.tension_lag * v, force);
                } else {
                    // The fibre between the inlet and the root.
                    balance.pass(End { x: x - balance.element * balance.along, v }, End { x, v });
                    balance.instants += 1.0;
                }
            }
        }
    }

    /// Adds the instants of another balance of the same case.
    fn add(&mut self, other: &Self) {
        self.instants += other.instants;
        self.root_tension += other.root_tension;
        self.drag.resize(self.drag.len().max(other.drag.len()), 0.0);
        self.drag.iter_mut().zip(&other.drag).for_each(|(sum, other)| *sum += other);
        for (sums, others) in self.classes.iter_mut().zip(&other.classes) {
            sums.iter_mut().zip(others).for_each(|(sum, other)| *sum += other);
        }
    }

    /// Enters a force on a node.
    fn push(&mut self, x: f64, force: f64) {
        let (class, inside) = self.class(x);
        if let Some(sums) = self.classes.get_mut(class) {
            sums[0] += force * (1.0 - inside);
        }
        if let Some(sums) = self.classes.get_mut(class + 1) {
            sums[0] += force * inside;
        }
    }

    /// Enters the drag on an element, unless it lies on the belt.
    fn drive(&mut self, x: f64, drag: f64) {
        let (class, inside) = self.class(x);
        if class < self.classes.len() {
            self.drag.resize(self.classes.len() + 1, 0.0);
            self.drag[class] += drag * (1.0 - inside);
            self.drag[class + 1] += drag * inside;
        }
    }

    /// The class of a place, and which share of it lies above the place.
    fn class(&self, x: f64) -> (usize, f64) {
        let place = (x * self.per_length).max(0.0);
        (place as usize, place.fract())
    }

    /// Enters an element: its length, and the momentum that it carries past planes. Its mass lies evenly between
    /// its ends, and each half has the momentum of its end.
    fn pass(&mut self, above: End, below: End) {
        let per_length = self.per_length;
        let from = above.x.min(below.x) * per_length;
        let to = above.x.max(below.x) * per_length;
        let squares = 0.375 * (above.v * above.v + below.v * below.v) + 0.25 * above.v * below.v;
        let flux = self.mass * squares * per_length;
        let classes = from.max(0.0) as usize..(to.max(0.0) as usize + 1).min(self.classes.len());
        for class in classes {
            let inside = (to.min(class as f64 + 1.0) - from.max(class as f64)).max(0.0);
            let share = if to > from { inside / (to - from) } else { 1.0 };
            let [_, passing, length] = &mut self.classes[class];
            *passing += flux * share;
            *length += self.element * per_length * share;
        }
    }

    /// The middles of the classes, and the belt [m].
    pub(super) fn places(&self) -> Vec<f64> {
        let classes = self.classes.len() as f64;
        let middle = |i: usize| (i as f64 + 0.5) / classes * self.distance;
        (0..self.classes.len()).map(middle).chain([self.distance]).collect()
    }

    /// The force on the air between the inlet and each of the places [N]; NaN without an instant.
    pub(super) fn forces(&self) -> Vec<f64> {
        if self.drag.is_empty() {
            return self.by_momentum();
        }
        let mut acting = 0.0;
        let drag = |drag: &f64| {
            acting -= drag;
            acting / self.instants
        };
        self.drag.iter().map(drag).collect()
    }

    /// The same by the balance of momentum.
    fn by_momentum(&self) -> Vec<f64> {
        let n = self.instants;
        let strain = self.root_tension / n / self.stiffness;
        let fed = self.mass_flow * self.feed_speed * (1.0 + strain) * self.along;
        let mut acting = 0.0;
        let balance = |[force, passing, _]: &[f64; 3]| {
            acting += force;
            fed + (acting - passing) / n
        };
        let mut forces: Vec<f64> = self.classes.iter().map(balance).collect();
        // What holds the root bears the drag on half of the first element too, which is that at the inlet.
        let on_root = 0.5 * self.element * self.along * self.slope_at_inlet(&forces);
        forces.iter_mut().for_each(|force| *force += on_root);
        // In the last class the belt stops the fibre, so it continues the two before.
        if let [.., before, last_before, last] = &mut forces[..] {
            let growth = *last_before - *before;
            *last = *last_before + growth;
            let at_belt = *last + 0.5 * growth;
            forces.push(at_belt);
        }
        forces
    }

    /// The force on the air by the balance of momentum, between the inlet and the last place before the belt disturbs
    /// it [N]; NaN without an instant.
    pub(crate) fn force_above_belt(&self) -> f64 {
        self.by_momentum().get(self.last_free_class()).copied().unwrap_or(f64::NAN)
    }

    /// How much a force at a distance from the inlet [m] counts in [`MomentumBalance::force_above_belt`].
    pub(crate) fn share_above_belt(&self, x: f64) -> f64 {
        (self.last_free_class() as f64 + 1.0 - x * self.per_length).clamp(0.0, 1.0)
    }

    fn last_free_class(&self) -> usize {
        self.classes.len().saturating_sub(3)
    }

    /// Length of fibre per length of the way in each class, and at the belt that of the last one [-]; NaN
    /// without an instant.
    pub(super) fn lengths(&self) -> Vec<f64> {
        let lengths = self.classes.iter().chain(self.classes.last());
        lengths.map(|[.., length]| length / self.instants).collect()
    }

    /// Change of the forces with the distance at the inlet [N/m], by the parabola that has their means over three
    /// equal stretches behind it.
    fn slope_at_inlet(&self, forces: &[f64]) -> f64 {
        let third = (forces.len() as f64 * THIRD).ceil() as usize;
        let mean = |of: usize| forces.iter().skip(of * third).take(third).sum::<f64>() / third as f64;
        let [first, second, last] = [0, 1, 2].map(mean);
        let length = third as f64 * self.distance / forces.len() as f64;
        (3.0 * second - 2.0 * first - last) / length
    }
}

/// An end of an element.
struct End {
    /// Its place [m] and velocity [m/s] along x.
    x: f64,
    v: f64,
}

/// What is known of the nodes of eight fibres at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodeStates<'a> {
    /// Of the nodes [m, m/s].
    pub(crate) position: &'a [Vec3<Lanes>],
    pub(crate) velocity: &'a [Vec3<Lanes>],
    /// Of the elements [N].
    pub(crate) tension: &'a [Lanes],
    /// Of the elements [N]; empty if it is not known.
    pub(crate) drag: &'a [Vec3<Lanes>],
    /// Number of nodes in each lane.
    pub(crate) count: [usize; WIDTH],
    /// By how much earlier than the positions the tensions are known [s].
    pub(crate) tension_lag: f64,
}

impl<'a> NodeStates<'a> {
    /// Those of a snapshot of a flight.
    ///
    /// * `tension_lag` – that of the flight, see [`tension_lag`]
    /// * `is_wanted` – whether to look at the fibre in a lane; the lanes after the last fibre repeat the first
    pub(crate) fn of(snapshot: &'a Snapshot, tension_lag: f64, is_wanted: impl Fn(usize) -> bool) -> Self {
        Self {
            position: &snapshot.position,
            velocity: &snapshot.velocity,
            tension: &snapshot.tension,
            drag: &snapshot.drag,
            count: std::array::from_fn(|lane| if is_wanted(lane) { snapshot.nodes[lane] } else { 0 }),
            tension_lag,
        }
    }
}

/// By how much earlier than the positions of a snapshot its tensions are known [s].
pub(crate) fn tension_lag(flight: &Flight) -> f64 {
    if flight.scheme() == Scheme::ImplicitTension { flight.time_step() } else { 0.0 }
}

/// Length of a stretch of time that is hardly correlated with the next but one, in times from the inlet to the belt.
const WAYS_OF_STRETCH: f64 = 2.0;

/// Balances of one or more fibres of a case in stretches of time, one after the other.
///
/// Fibres that fly in shared turbulence are not independent of each other, but their stretches are, if these are long
/// enough.
#[derive(Clone, Debug)]
pub(crate) struct StretchedBalance {
    stretch: f64,
    /// See [`Air::memory`](spunlaid_air::Air::memory) [s].
    memory: f64,
    empty: MomentumBalance,
    stretches: Vec<MomentumBalance>,
}

impl StretchedBalance {
    pub(crate) fn new(case: &Case) -> Self {
        let way = case.line.map_or(f64::NAN, |line| line.distance / line.feed_speed);
        let empty = MomentumBalance::of(case);
        Self { stretch: WAYS_OF_STRETCH * way, memory: case.air.memory(), empty, stretches: Vec::new() }
    }

    /// Adds an instant of all lanes.
    ///
    /// * `time` – since the end of the spin-up [s]; nothing is added before
    pub(crate) fn see(&mut self, nodes: &NodeStates<'_>, time: f64) {
        if time < 0.0 {
            return;
        }
        let stretch = (time / self.stretch) as usize;
        self.reach(stretch + 1);
        MomentumBalance::see(&mut self.stretches[stretch..=stretch], nodes);
    }

    /// Adds what other fibres have done during the same time.
    pub(crate) fn add(&mut self, other: &Self) {
        self.reach(other.stretches.len());
        self.stretches.iter_mut().zip(&other.stretches).for_each(|(all, other)| all.add(other));
    }

    fn reach(&mut self, stretches: usize) {
        if self.stretches.len() < stretches {
            self.stretches.resize(stretches, self.empty.clone());
        }
    }

    /// Means and standard errors over the stretches; empty without one. The last one is left out if it is not
    /// whole. A slack fibre takes longer to the belt, and its stretches know of more of those before, as do those in
    /// air that changes slowly.
    pub(crate) fn way(&self) -> Vec<WayPlace> {
        let fullest = self.stretches.iter().map(|balance| balance.instants).fold(0.0, f64::max);
        let whole = || self.stretches.iter().filter(|balance| balance.instants > 0.9 * fullest);
        let all: Vec<[Vec<f64>; 2]> = whole().map(|balance| [balance.forces(), balance.lengths()]).collect();
        let lengths = || all.iter().flat_map(|[_, lengths]| lengths);
        let of_fibre = (lengths().sum::<f64>() / lengths().count() as f64).round();
        let of_air = (self.memory / self.stretch).ceil();
        let memory = of_fibre.max(of_air) as usize;
        // The series does not show how long the air is correlated unless it is much longer.
        let are_enough = of_air <= 1.0 || all.len() as f64 >= 2.0 * (of_air + 1.0);
        let at = |(class, distance): (usize, f64)| {
            let values =
                |which: usize| all.iter().filter_map(move |of| of[which].get(class).copied()).collect();
            let [force, fibre]: [Vec<f64>; 2] = [0, 1].map(values);
            let standard_error = error_of_series(&force, memory).filter(|_| are_enough);
            let [force, fibre] = [force, fibre].map(|values| Estimate::new(values).mean);
            WayPlace { distance, force, standard_error, fibre }
        };
        let places = whole().next().map(MomentumBalance::places).unwrap_or_default();
        places.into_iter().enumerate().map(at).collect()
    }
}

/// Standard error of the mean of values one after the other, which know of each other over some steps: with products of
/// neighbours that count less the farther they are apart (Bartlett), and with what is lost because the mean is found
/// from the same values. None of less than two.
///
/// * `memory` – steps
fn error_of_series(values: &[f64], memory: usize) -> Option<f64> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let pairs = (0..values.len()).flat_map(|i| (0..values.len()).map(move |j| (i, j)));
    let (products, weights) = pairs.fold((0.0, 0.0), |(products, weights), (i, j)| {
        let weight = (1.0 - i.abs_diff(j) as f64 / (memory as f64 + 1.0)).max(0.0);
        (products + weight * (values[i] - mean) * (values[j] - mean), weights + weight)
    });
    let left = count * count - weights;
    (values.len() > 1 && left > 0.0).then(|| (products.max(0.0) / left).sqrt())
}
