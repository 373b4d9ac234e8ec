//! A step of implicit tension against the equations of theory.md (51) to (54), solved as full matrices.

use super::*;
use crate::body::Root;
use crate::chain::laying::tests::land;
use crate::chain::tests::{BELT_SPEED, SPACING, chain, crumple, line, scatter, strand};
use crate::chain::{FibreParameters, Scheme, explicit};
use crate::line::{Contact, Line};
use spunlaid_air::{Air, Atmosphere, Eddies, Instant, StreamKey, Wind};
use spunlaid_ground::Isa;
use std::f64::consts::PI;

type V = Vec3<f64>;

const EVERY: [usize; WIDTH] = [0, 1, 2, 3, 4, 5, 6, 7];

const H: f64 = 5e-4;
/// Mass of an element [kg] and its axial stiffness [N/m].
const MASS: f64 = 1000.0 * PI * 1e-6 / 4.0 * SPACING;
const STIFFNESS: f64 = 1e6 * PI * 1e-6 / 4.0 / SPACING;

/// The registers of any machine: all others give the same bits, and each takes several seconds to compile.
type Registers = spunlaid_ground::Plain;

/// A step without what follows it on a belt, in air of 20 m/s.
fn take_step(chain: &mut Chain, work: &mut WorkDone, damped: bool, is_implicit: bool) {
    let drift = if is_implicit || chain.laying.is_some() { H } else { 0.0 };
    let stride = Stride { kick: H, drift, damped, split: true };
    let elements = chain.elements();
    let eddies = Eddies::along(SPACING * elements as f64, elements, 1.0);
    let air = Air { harmonics: 8, ..Air::uniform(20.0, 0.0, 0.05, 100.0) };
    let key = StreamKey { seed: 0, replicate: 0 };
    let wind = Wind::uniform(Isa::detect(), &[(air, key)], eddies.count(), 1.0).unwrap();
    let mut air = Atmosphere::from((&eddies, &wind));
    let air = air.look::<Registers>(Instant { step: 0, time: 0.0 }, &chain.position);
    let mut block = ElementBlock::<Registers>::new();
    match (is_implicit, chain.laying.is_some()) {
        (true, true) => step::<_, true>(chain, &air, stride, work, &mut block),
        (true, false) => step::<_, false>(chain, &air, stride, work, &mut block),
        (false, true) => explicit::step::<_, true, true>(chain, &air, stride, work, &mut block),
        (false, false) => explicit::step::<_, false, false>(chain, &air, stride, work, &mut block),
    }
}

/// Solves linear equations.
fn solved(mut rows: Vec<Vec<f64>>, mut side: Vec<f64>) -> Vec<f64> {
    let size = side.len();
    for column in 0..size {
        let pivot =
            (column..size).max_by(|a, b| rows[*a][column].abs().total_cmp(&rows[*b][column].abs())).unwrap();
        rows.swap(column, pivot);
        side.swap(column, pivot);
        for row in (0..size).filter(|row| *row != column) {
            let factor = rows[row][column] / rows[column][column];
            (0..size).for_each(|k| rows[row][k] -= factor * rows[column][k]);
            side[row] -= factor * side[column];
        }
    }
    (0..size).map(|i| side[i] / rows[i][i]).collect()
}

fn times(a: V, b: V) -> V {
    V::new(a.x * b.x, a.y * b.y, a.z * b.z)
}

/// A lane in plain numbers.
#[derive(Clone)]
struct Plain {
    position: Vec<V>,
    velocity: Vec<V>,
    earlier: Vec<V>,
    tension: Vec<f64>,
    mass: Vec<f64>,
    /// The inverse mass of each node in each direction; zero where it is held.
    mobility: Vec<V>,
    h: f64,
    /// What iterations have pulled at nodes where these are held [N].
    held: Vec<V>,
}

impl Plain {
    fn of(chain: &Chain, lane: usize) -> Self {
        let nodes = chain.position.len();
        let all = |list: &[Vec3<Lanes>]| list.iter().map(|v| v.lane(lane)).collect();
        let node = |i: usize| chain.constants.node(i, nodes);
        let mobility = |i: usize| {
            let across = node(i).inverse_mass.0[lane];
            V::new(node(i).inverse_mass_x.0[lane], across, across)
        };
        Self {
            position: all(&chain.position),
            velocity: all(&chain.velocity),
            earlier: all(&chain.earlier),
            tension: chain.tensions.tension.iter().map(|tension| tension.0[lane]).collect(),
            mass: (0..nodes).map(|i| node(i).mass.0[lane]).collect(),
            mobility: (0..nodes).map(mobility).collect(),
            h: H,
            held: vec![V::default(); nodes],
        }
    }

    fn edge(&self, j: usize) -> V {
        self.position[j + 1] - self.position[j]
    }

    /// Forces of pulls along directions on the nodes [N].
    fn pulls(directions: &[V], pulls: &[f64]) -> Vec<V> {
        let mut forces = vec![V::default(); pulls.len() + 1];
        for (j, (direction, pull)) in directions.iter().zip(pulls).enumerate() {
            forces[j] += *direction * *pull;
            forces[j + 1] -= *direction * *pull;
        }
        forces
    }

    /// The directions of edges and the corrections of the tensions by (53).
    fn corrections(&self, edges: &[V]) -> (Vec<V>, Vec<f64>) {
        let directions: Vec<V> = edges.iter().map(|edge| *edge * (1.0 / edge.norm())).collect();
        let weight = |i: usize, a: V, b: V| self.h * self.h * STIFFNESS * times(self.mobility[i], a).dot(b);
        let count = edges.len();
        let mut rows = vec![vec![0.0; count]; count];
        for (j, here) in directions.iter().enumerate() {
            rows[j][j] = 1.0 + weight(j, *here, *here) + weight(j + 1, *here, *here);
            if j > 0 {
                rows[j][j - 1] = -weight(j, *here, directions[j - 1]);
            }
            if j + 1 < count {
                rows[j][j + 1] = -weight(j + 1, *here, directions[j + 1]);
            }
        }
        let missing = |j: usize| STIFFNESS * (edges[j].norm() - SPACING) - self.tension[j];
        let corrections = solved(rows, (0..count).map(missing).collect());
        (directions, corrections)
    }

    /// More iterations where an element that moves is off by more than 5 % in its squared length: the whole correction
    /// four times, and then seven tenths of it.
    fn iterate(&mut self) -> usize {
        for number in 0.. {
            let count = self.tension.len();
            let moves = |j: usize| self.mobility[j].y + self.mobility[j + 1].y > 0.0;
            let off = |j: usize| self.edge(j).norm() - SPACING - self.tension[j] / STIFFNESS;
            if !(0..count).any(|j| moves(j) && off(j).abs() > 0.025 * SPACING) {
                return number;
            }
            let edges: Vec<V> = (0..count).map(|j| self.edge(j)).collect();
            let (directions, mut corrections) = self.corrections(&edges);
            let part = if number < 4 { 1.0 } else { 0.7 };
            corrections.iter_mut().for_each(|correction| *correction *= part);
            for (i, force) in Self::pulls(&directions, &corrections).into_iter().enumerate() {
                let held = |force: f64, mobility: f64| if mobility == 0.0 { force } else { 0.0 };
                let at = self.mobility[i];
                self.held[i] += V::new(held(force.x, at.x), held(force.y, at.y), held(force.z, at.z));
                let kick = times(force, at) * self.h;
                self.velocity[i] += kick;
                self.position[i] += kick * self.h;
            }
            self.tension.iter_mut().zip(corrections).for_each(|(tension, correction)| *tension += correction);
        }
        unreachable!()
    }
}

/// The forces on the nodes without the tension, and the drag among them [N]: by a step of Euler's method of a chain of
/// which no node is held, with the velocities of the full step.
fn forces(strand: &FibreParameters, chain: &Chain, lane: usize) -> [Vec<V>; 2] {
    let with_drag = |drag: bool| {
        let mut free = chain.clone();
        free.laying = None;
        if !drag {
            let mut none = *strand;
            (none.drag.along.factor, none.drag.across.factor) = (0.0, 0.0);
            free.constants.element.half_drag =
                crate::chain::tests::chain(&none, None, Scheme::Leapfrog).constants.element.half_drag;
        }
        for node in std::iter::once(&mut free.constants.root).chain(&mut free.constants.tail) {
            node.inverse_mass = Lanes::from_fn(|i| 1.0 / node.mass.0[i]);
        }
        for (v, earlier) in free.velocity.iter_mut().zip(chain.earlier.iter()) {
            *v = *v + (*v - *earlier) * Lanes::splat(0.5);
        }
        let before = Plain::of(&free, lane);
        take_step(&mut free, &mut WorkDone::default(), strand.damping != 0.0, false);
        let after = Plain::of(&free, lane);
        let directions: Vec<V> =
            (0..chain.elements()).map(|j| before.edge(j) * (1.0 / before.edge(j).norm())).collect();
        let stretched: Vec<f64> =
            (0..chain.elements()).map(|j| STIFFNESS * (before.edge(j).norm() - SPACING)).collect();
        let tension = Plain::pulls(&directions, &stretched);
        let force = |i: usize| (after.velocity[i] - before.velocity[i]) * (before.mass[i] / H) - tension[i];
        (0..before.mass.len()).map(force).collect::<Vec<V>>()
    };
    let [all, without] = [true, false].map(with_drag);
    let drag = all.iter().zip(without).map(|(all, without)| *all - without).collect();
    [all, drag]
}

/// `Σ k |Δω|²` of the angular velocities `t × dt/dt` of neighbouring elements, with the spring of each node.
fn dissipated(chain: &Chain, lane: usize) -> f64 {
    let plain = Plain::of(chain, lane);
    let v = |i: usize| plain.velocity[i] + (plain.velocity[i] - plain.earlier[i]) * 0.5;
    let spin = |j: usize| {
        let (edge, length) = (plain.edge(j), plain.edge(j).norm());
        edge.cross(v(j + 1) - v(j)) * (1.0 / (length * length))
    };
    let above = |j: usize| if j == 0 { V::default() } else { spin(j - 1) };
    let bend = |j: usize| {
        let turning = spin(j) - above(j);
        turning.dot(turning) * chain.constants.bending_stiffness(j).0[lane]
    };
    (0..chain.elements()).map(bend).sum()
}

/// What a step leaves, and the sums of its work: of all forces, drag, damping, tension, feed and belt.
struct Expected {
    plain: Plain,
    both: [f64; 6],
    before: [f64; 6],
    belt_force: Vec<V>,
    iterations: usize,
}

/// A step by the equations.
fn expected(strand: &FibreParameters, chain: &Chain, line: Option<Line>, lane: usize) -> Expected {
    let [mut others, drag] = forces(strand, chain, lane);
    let mut plain = Plain::of(chain, lane);
    let start = plain.clone();
    let (nodes, count) = (plain.mass.len(), plain.tension.len());
    // (51), with no more of the last tension than belongs to s = 2.25, or a half of a fed fibre.
    let most = if line.is_some() { 0.5 } else { 2.25 } * SPACING * MASS / (H * H);
    plain.tension.iter_mut().for_each(|tension| *tension = tension.clamp(0.0, most));
    let directions: Vec<V> = (0..count).map(|j| plain.edge(j) * (1.0 / plain.edge(j).norm())).collect();
    let pulls = Plain::pulls(&directions, &plain.tension);
    let friction = |i: usize| {
        let (at, pull) = (&plain.mobility[i], others[i] + pulls[i]);
        match line.map(|line| line.contact) {
            Some(Contact::Friction { coefficient, suction }) if at.x == 0.0 && at.y > 0.0 => {
                let slip = plain.velocity[i] - V::new(0.0, BELT_SPEED, 0.0);
                let slip = V { x: 0.0, ..slip };
                let most = coefficient * (suction * 1e-3 * SPACING + pull.x).max(0.0);
                let drag = (most / slip.norm()).min(plain.mass[i] / H);
                V { x: -pull.x, ..slip * -drag }
            }
            _ => V::default(),
        }
    };
    let friction: Vec<V> = (0..nodes).map(friction).collect();
    let across = |i: usize| V { x: 0.0, ..friction[i] };
    (0..nodes).for_each(|i| others[i] += across(i));
    let share = |j: usize| {
        let s = H * H * plain.tension[j] / (plain.edge(j).norm() * MASS);
        0.5 * MASS * s * s / (1.0 + s)
    };
    let mut rows = vec![vec![0.0; nodes]; nodes];
    for (i, row) in rows.iter_mut().enumerate() {
        row[i] = if plain.mobility[i].y > 0.0 { plain.mass[i] } else { 1.0 };
        for (j, other) in [(i.wrapping_sub(1), i.wrapping_sub(1)), (i, i + 1)] {
            if j < count && plain.mobility[i].y > 0.0 {
                row[i] += share(j);
                row[other] -= share(j);
            }
        }
    }
    let component = |of: fn(V) -> f64| {
        let free = |i: usize| if plain.mobility[i].y > 0.0 { of(others[i] + pulls[i]) } else { 0.0 };
        solved(rows.clone(), (0..nodes).map(free).collect())
    };
    let [x, y, z] = [component(|v| v.x), component(|v| v.y), component(|v| v.z)];
    // (52), and (61) where a node lands.
    let mut predicted: Vec<V> =
        (0..nodes).map(|i| plain.velocity[i] + V::new(x[i], y[i], z[i]) * H).collect();
    let mut lands = vec![false; nodes];
    if let Some(line) = line {
        for i in 0..nodes {
            if plain.mobility[i].x == 0.0 && plain.mobility[i].y > 0.0 {
                predicted[i].x = 0.0;
            }
            let (left, v) = (line.distance - plain.position[i].x, predicted[i]);
            if H * v.x > left {
                let share = left / (H * v.x);
                let along = share * v.y + (1.0 - share) * line.belt_speed;
                predicted[i] = V::new(share * v.x, along, share * v.z);
                (plain.mobility[i].x, lands[i]) = (0.0, true);
            }
        }
    }
    // (53), (54).
    let edges: Vec<V> = (0..count).map(|j| plain.edge(j) + (predicted[j + 1] - predicted[j]) * H).collect();
    let (along, corrections) = plain.corrections(&edges);
    let changes = Plain::pulls(&along, &corrections);
    let (mut both, mut before, mut belt_force) = ([0.0; 6], [0.0; 6], friction.clone());
    for i in 0..nodes {
        let former = plain.velocity[i];
        let now = predicted[i] + times(changes[i], plain.mobility[i]) * H;
        plain.velocity[i] = now;
        plain.position[i] += now * H;
        plain.earlier[i] = former;
        // Seen from the belt.
        let frame = V::new(0.0, if line.is_some() { BELT_SPEED } else { 0.0 }, 0.0);
        let moved = former + now - frame * 2.0;
        let all = (now - former) * (plain.mass[i] / H);
        let v = former + (former - start.earlier[i]) * 0.5;
        let damping = v * (-plain.mass[i] * strand.damping);
        let is_held = line.is_some() && (start.mobility[i].y == 0.0 || lands[i]);
        let held = if is_held { all - others[i] - pulls[i] - changes[i] } else { V::default() };
        belt_force[i] += held;
        let support = if i == 0 { 4 } else { 5 };
        let tension = all - others[i] - held;
        for (kind, force) in [(0, all), (1, drag[i]), (2, damping), (3, tension), (support, held)] {
            both[kind] += force.dot(moved);
            before[kind] += force.dot(former - frame);
        }
        if i > 0 {
            both[5] += across(i).dot(moved);
        }
    }
    before[5] = 0.0;
    plain.tension.iter_mut().zip(corrections).for_each(|(tension, correction)| *tension += correction);
    let iterations = if line.is_some() { plain.iterate() } else { 0 };
    Expected { plain, both, before, belt_force, iterations }
}

fn agree(what: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    let size = expected.iter().fold(0.0, |size: f64, one| size.max(one.abs()));
    assert_eq!(found.len(), expected.len(), "{what}");
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!(
            (found - expected).abs() <= tolerance * size,
            "{what} {i}: {found:e} {expected:e} of {size:e}"
        );
    }
}

fn parts(list: &[V]) -> Vec<f64> {
    list.iter().flat_map(|v| [v.x, v.y, v.z]).collect()
}

/// Takes a step and compares it in every lane; returns how many more iterations each needed.
fn is_by_the_equations(strand: &FibreParameters, start: &Chain, line: Option<Line>) -> [usize; WIDTH] {
    let mut chain = start.clone();
    let mut work = WorkDone::default();
    take_step(&mut chain, &mut work, strand.damping != 0.0, true);
    std::array::from_fn(|lane| {
        let expected = expected(strand, start, line, lane);
        let found = Plain::of(&chain, lane);
        // Two computations of the drag agree to 1e-7, as its powers have single precision.
        for (what, found, wanted, tolerance) in [
            ("position", &found.position, &expected.plain.position, 1e-9),
            ("velocity", &found.velocity, &expected.plain.velocity, 1e-8),
            ("earlier", &found.earlier, &expected.plain.earlier, 1e-15),
        ] {
            agree(what, &parts(found), &parts(wanted), tolerance);
        }
        agree("tension", &found.tension, &expected.plain.tension, 1e-7);
        let viscous = strand.fibre.bending_viscosity_time * dissipated(start, lane) * H;
        agree("viscous", &[work.viscous.0[lane]], &[viscous], 1e-9);
        let sums = [work.total, work.drag, work.damping, work.tension, work.feed, work.belt];
        if expected.iterations == 0 {
            for (kind, sum) in sums.into_iter().enumerate() {
                agree("work", &[sum.both.0[lane]], &[expected.both[kind]], 1e-6);
                agree("work before", &[sum.before.0[lane]], &[expected.before[kind]], 1e-6);
            }
            if chain.constants.friction.is_some() {
                for i in (1..expected.belt_force.len()).filter(|i| chain.is_held(*i, lane)) {
                    let found = chain.tensions.belt_force[i].lane(lane);
                    agree("belt", &parts(&[found]), &parts(&[expected.belt_force[i]]), 1e-7);
                }
            }
        }
        expected.iterations
    })
}

/// Held and free roots, with and without damping and bending viscosity; tensions from compression to more than the
/// prediction keeps.
#[test]
fn analytic_a_step_of_a_fibre_of_fixed_length_is_that_of_the_equations() {
    for (root, damping, viscosity) in
        [(Root::Clamped, 0.0, 1e-5), (Root::Free, 30.0, 0.0), (Root::Pinned, 0.0, 1e-5)]
    {
        let mut strand = strand(10, root);
        (strand.damping, strand.fibre.bending_viscosity_time) = (damping, viscosity);
        let mut start = chain(&strand, None, Scheme::ImplicitTension);
        crumple(&mut start, 0.5);
        let most = 2.25 * SPACING * MASS / (H * H);
        for (j, tension) in start.tensions.tension.iter_mut().enumerate() {
            tension.0[3] = most * [0.2, 1.1][j % 2];
        }
        is_by_the_equations(&strand, &start, None);
    }
}

/// A fed chain at the belt: its end lies there, held or sliding; the node above it lands in every second lane. In some
/// lanes elements are so far from their lengths that the corrections are iterated.
#[test]
fn analytic_a_step_of_a_fed_fibre_is_that_of_the_equations() {
    let suction = 5e-4 / (1e-3 * SPACING);
    for contact in [Contact::Stick, Contact::Friction { coefficient: 0.5, suction }] {
        for damping in [0.0, 30.0] {
            let mut strand = strand(9, Root::Clamped);
            strand.damping = damping;
            let line = line(contact, 0.05);
            let mut start = chain(&strand, Some(line), Scheme::ImplicitTension);
            let above = |lane: usize| if lane % 2 == 1 { 5e-4 } else { 4e-3 };
            for i in 0..9 {
                let to_end = (8 - i) as f64 * SPACING;
                start.position[i].x = Lanes::from_fn(|lane| line.distance - above(lane) - to_end);
            }
            land(&mut start, &[9], &EVERY, 1);
            crumple(&mut start, 0.9);
            for lane in 0..WIDTH {
                start.position[8].x.0[lane] = line.distance - above(lane);
                let across = (SPACING * SPACING - above(lane) * above(lane)).sqrt();
                start.position[9].y.0[lane] = start.position[8].y.0[lane] - across;
                if contact != Contact::Stick && lane % 2 == 0 {
                    // The end slides, in lane 6 faster than the friction of a step can stop.
                    start.constants.tail[0].inverse_mass.0[lane] = 1.0 / (0.5 * MASS);
                    let slip = if lane == 6 { 5.0 } else { 1e-3 * (lane as f64 + 1.0) };
                    start.velocity[9].y.0[lane] += slip;
                    start.velocity[9].z.0[lane] -= 0.5 * slip;
                    start.earlier[9] = start.velocity[9];
                }
            }
            let iterations = is_by_the_equations(&strand, &start, Some(line));
            assert_eq!(iterations[..2], [0; 2]);
            assert!(iterations.iter().any(|count| *count > 0), "{iterations:?}");
        }
    }
}

/// Elements far from their lengths: the iterations bring all of them to it that may move, and enter the work of their
/// forces, which is what they add to the energy of motion. Lanes that do not need them stay as they are.
#[test]
fn analytic_iterations_end_at_the_lengths_of_the_tensions_and_enter_their_work() {
    for off in [[0.0, 0.05, 0.051, 1.0, 1.0, 0.3, 0.2, 9.0], [0.1; WIDTH]] {
        iterates(Lanes(off));
    }
}

/// * `off` – by how much elements are off, as reported by the step
fn iterates(off: Lanes) {
    let strand = strand(9, Root::Clamped);
    let line = line(Contact::Friction { coefficient: 0.5, suction: 0.0 }, 0.05);
    let mut chain = chain(&strand, Some(line), Scheme::ImplicitTension);
    land(&mut chain, &[9, 8], &EVERY, 1);
    crumple(&mut chain, 0.9);
    // An element whose ends are held is left as it is.
    chain.position[9].y = chain.position[8].y + Lanes::splat(1.2 * SPACING);
    for (i, force) in chain.tensions.belt_force.iter_mut().enumerate() {
        *force = Vec3::splat(V::new(scatter(i), 0.0, 0.0));
    }
    let before = chain.clone();
    let mut work = WorkDone::default();
    let h = 4.0 * H;
    chain.iterate(&off, h, true, &mut work);
    let mut most = 0;
    for lane in 0..WIDTH {
        let mut expected = Plain { h, ..Plain::of(&before, lane) };
        let iterations = if off.0[lane] <= 0.05 { 0 } else { expected.iterate() };
        most = most.max(iterations);
        let found = Plain::of(&chain, lane);
        agree("position", &parts(&found.position), &parts(&expected.position), 1e-7);
        agree("tension", &found.tension, &expected.tension, 1e-6);
        let start = Plain::of(&before, lane);
        let frame = V::new(0.0, BELT_SPEED, 0.0);
        let moves = |plain: &Plain| -> f64 {
            (0..9)
                .map(|i| 0.5 * plain.mass[i] * (plain.velocity[i] - frame).dot(plain.velocity[i] - frame))
                .sum()
        };
        let gained = moves(&found) - moves(&start);
        let [total, tension, feed, belt] = [work.total, work.tension, work.feed, work.belt]
            .map(|sum| [sum.both.0[lane], sum.before.0[lane]]);
        agree("gained", &[0.5 * h * total[0]], &[gained], 1e-9);
        agree("all", &[tension[0] + feed[0] + belt[0]], &[total[0]], 1e-9);
        // The whole impulse at the velocities before the step.
        let impulse = |i: usize| (found.velocity[i] - start.velocity[i]) * (start.mass[i] / h);
        let of_start = |i: usize| impulse(i).dot(start.earlier[i] - frame);
        agree("before", &[total[1]], &[(0..10).map(of_start).sum()], 1e-8);
        agree("all before", &[tension[1] + feed[1] + belt[1]], &[total[1]], 1e-8);
        // The pull on a node that lies on the belt changes what the belt holds it with.
        for i in 0..10 {
            let force = |chain: &Chain| chain.tensions.belt_force[i].lane(lane);
            let expected = if i < 8 { force(&before) } else { force(&before) - expected.held[i] };
            agree("belt", &parts(&[force(&chain)]), &parts(&[expected]), 1e-6);
        }
        if iterations == 0 {
            assert_eq!(found.position, start.position);
        }
    }
    assert!(most > 4, "{most}");
}

/// By hand, in parts of the rest length: an element half as long again without tension, and one of three lengths whose
/// ends are held, which does not count. The worst so far counts as well.
#[test]
fn analytic_the_element_that_is_furthest_off() {
    let strand = strand(9, Root::Clamped);
    let line = line(Contact::Stick, 0.05);
    let mut chain = chain(&strand, Some(line), Scheme::ImplicitTension);
    land(&mut chain, &[9, 8], &EVERY, 1);
    for i in 0..10 {
        chain.position[i] =
            Vec3::splat(V::new(0.0, SPACING * (i as f64 + if i > 4 { 0.5 } else { 0.0 }), 0.0));
    }
    chain.position[9].y = chain.position[8].y + Lanes::splat(3.0 * SPACING);
    chain.tensions.tension[4].0[5] = 0.2 * SPACING * STIFFNESS;
    // An element of which one end is held counts.
    (chain.position[8].y.0[3], chain.position[9].y.0[3]) = (9.4 * SPACING, 12.4 * SPACING);
    chain.position[0].y.0[4] = -0.8 * SPACING;
    for (lane, expected, number) in [(0, 0.5, 4), (3, 0.9, 7), (4, 0.8, 0), (5, 0.3, 4)] {
        let (off, element) = chain.furthest_off(lane);
        assert!((off - expected).abs() < 1e-12 && element == number, "{off} {element}");
    }
    chain.tensions.worst[0] = (0.7, 1);
    assert_eq!(chain.furthest_off(0), (0.7, 1));
}

/// In the air no node is looked at as one that the belt may hold, and bending viscosity dissipates what it should.
#[test]
fn analytic_nothing_lands_in_the_air() {
    for scheme in [Scheme::ImplicitTension, Scheme::Leapfrog] {
        let mut viscous = strand(9, Root::Clamped);
        viscous.fibre.bending_viscosity_time = 1e-6;
        let mut chain = chain(&viscous, Some(line(Contact::Stick, 0.05)), scheme);
        chain.position.iter_mut().for_each(|at| at.x = at.x - Lanes::splat(0.01));
        crumple(&mut chain, 0.1);
        let mut work = WorkDone::default();
        let expected = EVERY.map(|lane| 1e-6 * H * dissipated(&chain, lane));
        take_step(&mut chain, &mut work, false, scheme == Scheme::ImplicitTension);
        agree("viscous", &work.viscous.0, &expected, 1e-9);
        chain.feed_and_lay(1, H);
        assert_eq!((chain.constants.tail.len(), chain.in_air()), (1, [10; WIDTH]));
    }
}
