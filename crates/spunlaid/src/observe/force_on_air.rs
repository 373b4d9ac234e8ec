//! The force of a fed fibre on its air, on the way from the inlet to the belt.

use super::{
    Declaration, FIBRE, Figure, Kind, MILLINEWTONS, Measure, Observation, Observer, RATIO, Value, fed, figure,
};
use crate::case::Case;
use crate::chain::schemes::Scheme;
use crate::flight::{Flight, Snapshot};
use crate::lanes::{Lanes, WIDTH};
use crate::load::WayPlace;
use crate::statistics::Estimate;
use crate::vec3::Vec3;

/// Classes of distance from the inlet.
const CLASSES: usize = 50;

/// Length of each of the stretches from which the change of the force at the inlet is found, of the way.
const THIRD: f64 = 0.06;

/// Length of a stretch of time that is independent of the next, in times from the inlet to the belt.
const WAYS_OF_STRETCH: f64 = 2.0;

/// Name of the measure.
pub const FORCE_ON_AIR: &str = "force_on_air";

/// Name of the other one.
pub const FIBRE_ON_WAY: &str = "fibre_on_way";

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[
        Measure {
            name: FORCE_ON_AIR,
            column: "force_on_air_n",
            label: "Force on the air",
            meaning: "mean force along x with which the fibre drives the air between the inlet and each distance \
                from it, by the balance of its momentum; negative where the air drives the fibre",
            unit: MILLINEWTONS,
            kind: Kind::Way,
            group: FIBRE,
            figure: &Figure {
                from_zero: false,
                caption: "Mean force with which the fibre drives the air between the inlet and a place. It falls \
                    where the air pulls the fibre along and rises where the fibre pulls the air.",
                ..figure("force_on_air", "Force on the air", "force on the air")
            },
            ..Measure::NUMBER
        },
        Measure {
            name: FIBRE_ON_WAY,
            column: "fibre_on_way",
            label: "Fibre per length of the way",
            meaning: "mean length of fibre per length of the way at each distance from the inlet; above one where \
                the fibre swings and folds",
            unit: RATIO,
            kind: Kind::Way,
            group: FIBRE,
            figure: &Figure {
                caption: "Mean length of fibre per length of the way from the inlet to the belt. It is above one \
                    where the fibre swings and folds.",
                ..figure("fibre_on_way", "Fibre per length of the way", "fibre per length of the way")
            },
            ..Measure::NUMBER
        },
    ],
    applies: fed,
    observer: |flight| Box::new(Balances::new(flight)),
};

/// What is known of the nodes of eight fibres at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nodes<'a> {
    /// Of the nodes [m, m/s].
    pub(crate) position: &'a [Vec3<Lanes>],
    pub(crate) velocity: &'a [Vec3<Lanes>],
    /// Of the elements [N].
    pub(crate) tension: &'a [Lanes],
    /// Number of nodes in each lane.
    pub(crate) count: [usize; WIDTH],
    /// By how much earlier than the positions the velocities are known, and the tensions [s].
    pub(crate) velocity_lag: f64,
    pub(crate) tension_lag: f64,
}

impl<'a> Nodes<'a> {
    /// Those of a flight between two steps, as its scheme keeps them.
    ///
    /// * `is_wanted` – whether to look at the fibre in a lane
    pub(crate) fn between_steps(
        flight: &'a Flight,
        tension: &'a [Lanes],
        is_wanted: impl Fn(usize) -> bool,
    ) -> Self {
        let (chain, count) = (flight.chain(), flight.chain().nodes());
        let lag = |lags: bool, steps: f64| if lags { steps * flight.time_step() } else { 0.0 };
        Self {
            position: &chain.position,
            velocity: &chain.velocity,
            tension,
            count: std::array::from_fn(|lane| if is_wanted(lane) { count[lane] } else { 0 }),
            velocity_lag: lag(flight.scheme().is_staggered(), 0.5),
            tension_lag: lag(flight.scheme() == Scheme::ImplicitTension, 1.0),
        }
    }

    /// Those of a snapshot, which has its velocities at the time of its positions.
    ///
    /// * `fibres` – number of fibres; the lanes after the last one repeat the first
    pub(crate) fn of(snapshot: &'a Snapshot, fibres: usize, tension_lag: f64) -> Self {
        Self {
            position: &snapshot.position,
            velocity: &snapshot.velocity,
            tension: &snapshot.tension,
            count: std::array::from_fn(|lane| if lane < fibres { snapshot.nodes[lane] } else { 0 }),
            velocity_lag: 0.0,
            tension_lag,
        }
    }
}

/// The balance of the momentum of a fed fibre along x, in classes of distance from the inlet: sums over instants.
///
/// A class from `a` to `b` stands for the mean over all planes in it. What lies above a plane counts, so a force on
/// a node at `x` counts as `φ(x) = (b − x)/(b − a)`, one above the class and zero below it, and the momentum that
/// passes a plane is `m v_x²/(b − a)` of each node in the class. Sums over a class are therefore the means of those
/// over the classes that it is divided into.                                              theory.md (116)
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
            mass_flow: case.linear_density() * feed_speed,
            feed_speed,
            along: fibre.direction.x,
            instants: 0.0,
            root_tension: 0.0,
            classes: vec![[0.0; 3]; classes],
        }
    }

    /// Adds an instant.
    ///
    /// * `balances` – one for each lane, or one for all of them
    pub(crate) fn see(balances: &mut [Self], nodes: &Nodes<'_>) {
        let most = nodes.position.len().min(nodes.tension.len() + 1);
        let count = nodes.count.map(|count| count.min(most));
        let Some(last) = balances.len().checked_sub(1) else { return };
        let mut from_above = [0.0; WIDTH];
        // Node after node, because the lanes of a node lie together.
        for (i, (position, velocity)) in nodes.position.iter().zip(nodes.velocity).enumerate() {
            for lane in (0..WIDTH).filter(|lane| i < count[*lane]) {
                let balance = &mut balances[lane.min(last)];
                let (x, v) = (position.x.0[lane], velocity.x.0[lane]);
                let at = (x - nodes.velocity_lag * v, v);
                let mut force = balance.weight - from_above[lane];
                if i + 1 < count[lane] {
                    let below = nodes.position[i + 1].lane(lane);
                    let edge = below - position.lane(lane);
                    let v_below = nodes.velocity[i + 1].x.0[lane];
                    let tension = nodes.tension[i].0[lane];
                    from_above[lane] = tension * edge.x / edge.norm();
                    force += from_above[lane];
                    if i == 0 {
                        balance.root_tension += tension;
                    }
                    balance.pass([at, (below.x - nodes.velocity_lag * v_below, v_below)]);
                }
                // What holds the root bears the forces on it.
                if i > 0 {
                    balance.push(x - nodes.tension_lag * v, force);
                } else {
                    // The fibre between the inlet and the root.
                    balance.pass([(at.0 - balance.element * balance.along, v), at]);
                    balance.instants += 1.0;
                }
            }
        }
    }

    /// Adds the instants of another balance of the same case.
    fn add(&mut self, other: &Self) {
        self.instants += other.instants;
        self.root_tension += other.root_tension;
        for (sums, others) in self.classes.iter_mut().zip(&other.classes) {
            sums.iter_mut().zip(others).for_each(|(sum, other)| *sum += other);
        }
    }

    /// Enters a force on a node.
    fn push(&mut self, x: f64, force: f64) {
        let place = (x * self.per_length).max(0.0);
        let (class, inside) = (place as usize, place.fract());
        if let Some(sums) = self.classes.get_mut(class) {
            sums[0] += force * (1.0 - inside);
        }
        if let Some(sums) = self.classes.get_mut(class + 1) {
            sums[0] += force * inside;
        }
    }

    /// Enters an element: its length, and the momentum that it carries past planes. Its mass lies evenly between its ends, of which the
    /// places and velocities along x are given, and each half has the momentum of its end.
    fn pass(&mut self, [(x, v), (x_below, v_below)]: [(f64, f64); 2]) {
        let per_length = self.per_length;
        let (from, to) = (x.min(x_below) * per_length, x.max(x_below) * per_length);
        let flux = self.mass * (0.375 * (v * v + v_below * v_below) + 0.25 * v * v_below) * per_length;
        let classes = from.max(0.0) as usize..(to.max(0.0) as usize + 1).min(self.classes.len());
        for class in classes {
            let inside = (to.min(class as f64 + 1.0) - from.max(class as f64)).max(0.0);
            let share = if to > from { inside / (to - from) } else { 1.0 };
            let [_, passing, length] = &mut self.classes[class];
            *passing += flux * share;
            *length += self.element * per_length * share;
        }
    }

    /// The middles of the classes [m].
    fn places(&self) -> Vec<f64> {
        let classes = self.classes.len() as f64;
        (0..self.classes.len()).map(|i| (i as f64 + 0.5) / classes * self.distance).collect()
    }

    /// The force on the air between the inlet and each class [N]; NaN without an instant.
    fn forces(&self) -> Vec<f64> {
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
            *last = 2.0 * *last_before - *before;
        }
        forces
    }

    /// The force on the air between the inlet and the last place before the belt disturbs the balance [N]; NaN without
    /// an instant.
    pub(crate) fn force_above_belt(&self) -> f64 {
        self.forces().get(self.last_free_class()).copied().unwrap_or(f64::NAN)
    }

    /// How much a force at a distance from the inlet [m] counts in [`MomentumBalance::force_above_belt`].
    pub(crate) fn share_above_belt(&self, x: f64) -> f64 {
        (self.last_free_class() as f64 + 1.0 - x * self.per_length).clamp(0.0, 1.0)
    }

    fn last_free_class(&self) -> usize {
        self.classes.len().saturating_sub(3)
    }

    /// Length of fibre per length of the way in each class [-]; NaN without an instant.
    fn lengths(&self) -> Vec<f64> {
        self.classes.iter().map(|[.., length]| length / self.instants).collect()
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

/// Balances of one or more fibres of a case in stretches of time, one after the other.
///
/// Fibres that fly in one air are not independent of each other, but their stretches are, if these are long enough.
#[derive(Clone, Debug)]
pub(crate) struct StretchedBalance {
    stretch: f64,
    empty: MomentumBalance,
    stretches: Vec<MomentumBalance>,
}

impl StretchedBalance {
    pub(crate) fn new(case: &Case) -> Self {
        let way = case.line.map_or(f64::NAN, |line| line.distance / line.feed_speed);
        let empty = MomentumBalance::of(case);
        Self { stretch: WAYS_OF_STRETCH * way, empty, stretches: Vec::new() }
    }

    /// Adds an instant of all lanes.
    ///
    /// * `time` – since the end of the spin-up [s]; nothing is added before
    pub(crate) fn see(&mut self, nodes: &Nodes<'_>, time: f64) {
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
    /// whole.
    pub(crate) fn way(&self) -> Vec<WayPlace> {
        let fullest = self.stretches.iter().map(|balance| balance.instants).fold(0.0, f64::max);
        let whole = || self.stretches.iter().filter(|balance| balance.instants > 0.9 * fullest);
        let all: Vec<[Vec<f64>; 2]> = whole().map(|balance| [balance.forces(), balance.lengths()]).collect();
        let at = |(class, distance): (usize, f64)| {
            let values =
                |which: usize| all.iter().filter_map(move |of| of[which].get(class).copied()).collect();
            let [force, fibre] = [0, 1].map(|which| Estimate::new(values(which)));
            WayPlace { distance, force: force.mean, standard_error: force.standard_error, fibre: fibre.mean }
        };
        let places = whole().next().map(MomentumBalance::places).unwrap_or_default();
        places.into_iter().enumerate().map(at).collect()
    }
}

/// The balances of the fibres of a flight.
#[derive(Debug)]
struct Balances {
    of_lanes: Vec<MomentumBalance>,
    tension_lag: f64,
}

impl Balances {
    fn new(flight: &Flight) -> Self {
        let lanes = (0..WIDTH).map_while(|lane| flight.case(lane));
        // A snapshot has its velocities at the time of its positions.
        let lags = flight.scheme() == Scheme::ImplicitTension;
        let tension_lag = if lags { flight.time_step() } else { 0.0 };
        Self { of_lanes: lanes.map(MomentumBalance::of).collect(), tension_lag }
    }
}

impl Observer for Balances {
    fn see(&mut self, observation: &Observation<'_>) {
        if !observation.settled {
            return;
        }
        let nodes = Nodes::of(observation.snapshot, self.of_lanes.len(), self.tension_lag);
        MomentumBalance::see(&mut self.of_lanes, &nodes);
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        let Some(balance) = self.of_lanes.get(lane) else { return Vec::new() };
        [balance.forces(), balance.lengths()].map(|values| Value::Curve(balance.places(), values)).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::air::Air;
    use crate::fibre::{Fibre, Root};
    use crate::flight::Job;
    use crate::lanes::Isa;
    use crate::line::Line;

    const STEP: f64 = 4e-5;

    /// The line of `cases/spunbond.toml` in air that is as fast everywhere [m/s].
    fn line(air: f64) -> Case {
        let mut case = Case::unset();
        case.fibre = Fibre {
            diameter: 18e-6,
            density: 910.0,
            youngs_modulus: 2e9,
            root: Root::Clamped,
            ..Fibre::UNKNOWN
        };
        case.fibre.span(0.5, 4e-3);
        let [feed_speed, distance, belt_speed, kept_length] = [50.0, 0.5, 3.0, 0.03];
        case.line = Some(Line {
            feed_speed,
            distance,
            belt_speed,
            kept_length,
            steps_per_element: 2,
            ..Line::UNKNOWN
        });
        case.air = Air::uniform(air, 0.1, 0.016, 500.0);
        case.run.time_step = STEP;
        (case.run.steps, case.run.output_steps) = (5000, 25);
        (case.run.scheme, case.run.gravity, case.run.damping) = (Scheme::ImplicitTension, 9.81, 0.0);
        case
    }

    /// The drag of each node is that with which the flight has moved it. What a plane counts of a node falls from one
    /// to zero across a class, as in the balance.
    #[test]
    fn invariant_the_force_on_the_air_is_the_sum_of_the_drag() {
        const STEPS: u64 = 3000;
        let case = line(40.0);
        let mut flight = Flight::new(&[Job::new(&case, 0)], Isa::detect()).unwrap();
        flight.advance(1000);
        let mut balances = [25, 50, 100].map(|classes| MomentumBalance::new(&case, classes));
        // What the nodes above a plane have lost of their momentum, and the drag on them.
        let (mut lost, mut drag) = (vec![0.0; 50], vec![0.0; 50]);
        let time = STEPS as f64 * flight.time_step();
        for step in 0..=STEPS {
            let snapshot = flight.observe();
            let nodes = Nodes::of(&snapshot, 1, flight.time_step());
            if step < STEPS {
                balances
                    .iter_mut()
                    .for_each(|balance| MomentumBalance::see(std::slice::from_mut(balance), &nodes));
            }
            let momentum = match step {
                0 => 1.0,
                STEPS => -1.0,
                _ => 0.0,
            };
            for i in 0..snapshot.nodes[0] {
                let (x, v) = (snapshot.position[i].x.0[0], snapshot.velocity[i].x.0[0]);
                let force = if step < STEPS { flight.chain().tensions.drag(i).x.0[0] } else { 0.0 };
                for class in 0..50 {
                    let share = (class as f64 + 1.0 - x / 0.5 * 50.0).clamp(0.0, 1.0);
                    drag[class] += share * force / STEPS as f64;
                    lost[class] += momentum * share * case.fibre.element_mass() * v / time;
                }
            }
        }
        let [coarse, usual, fine] = balances.map(|balance| balance.forces());
        let largest = usual.iter().fold(0.0, |largest: f64, force| largest.max(force.abs()));
        assert!(largest > 1.5e-4 && usual[0] > 0.0, "{usual:?}");
        let off = |class: usize| (usual[class] + lost[class] + drag[class]) / largest;
        // The last class continues the others; in the one before, arches leave the chain that are taken as laid.
        assert!(
            (0..48).all(|class| off(class).abs() < 2e-3) && off(48).abs() < 1e-2,
            "{:?}",
            (0..49).map(off).collect::<Vec<_>>()
        );
        assert!((0..48).map(off).sum::<f64>().abs() / 48.0 < 1e-3);
        for (class, force) in usual.iter().enumerate().take(48) {
            assert!((0.5 * (fine[2 * class] + fine[2 * class + 1]) - force).abs() < 1e-12 * largest);
        }
        for (class, force) in coarse.iter().enumerate().take(24) {
            let of_usual = 0.5 * (usual[2 * class] + usual[2 * class + 1]);
            assert!((of_usual - force).abs() < 1e-3 * largest, "{force} {of_usual}");
        }
    }

    /// A slack thread in still air, let fall, drives no air: gravity speeds it up as it thins out.
    #[test]
    fn analytic_a_thread_without_drag_drives_no_air() {
        let mut balance = MomentumBalance {
            distance: 1.0,
            per_length: 50.0,
            element: 0.01,
            mass: 1e-6,
            weight: 9.81e-6,
            stiffness: 1.0,
            mass_flow: 1e-4,
            feed_speed: 1.0,
            along: 1.0,
            instants: 0.0,
            root_tension: 0.0,
            classes: vec![[0.0; 3]; 50],
        };
        // An element is fed each 10 ms. Its root is let go half an element below the inlet, and falls.
        let instants: u32 = 64;
        for instant in 0..instants {
            let since_birth = (f64::from(instant) + 0.5) / f64::from(instants) * 0.01;
            let node = |i: u32| match since_birth + 0.01 * (f64::from(i) - 1.0) {
                _ if i == 0 => (since_birth - 0.005, 1.0),
                time => (0.005 + time + 0.5 * 9.81 * time * time, 1.0 + 9.81 * time),
            };
            let nodes: Vec<(f64, f64)> = (0..60).map(node).collect();
            let position: Vec<_> =
                nodes.iter().map(|(x, _)| Vec3::new(*x, 0.0, 0.0)).map(Vec3::splat).collect();
            let velocity: Vec<_> =
                nodes.iter().map(|(_, v)| Vec3::new(*v, 0.0, 0.0)).map(Vec3::splat).collect();
            let nodes = Nodes {
                position: &position,
                velocity: &velocity,
                tension: &[Lanes::ZERO; 59],
                count: [60; WIDTH],
                velocity_lag: 0.0,
                tension_lag: 0.0,
            };
            MomentumBalance::see(std::slice::from_mut(&mut balance), &nodes);
        }
        let passing = 1e-4 * (1.0 + 2.0 * 9.81_f64).sqrt();
        let off = balance.forces().into_iter().fold(0.0, |most: f64, force| most.max(force.abs()));
        // Elements of a hundredth of the way, across which the speed changes by up to a tenth.
        assert!(off < 3e-3 * passing, "{off} of {passing}");
        // As long as the speed that it gains makes it thin.
        let last = balance.lengths()[48];
        assert!((last - 1.0 / (1.0 + 2.0 * 9.81 * 0.965_f64).sqrt()).abs() < 2e-3, "{last}");
    }
}
