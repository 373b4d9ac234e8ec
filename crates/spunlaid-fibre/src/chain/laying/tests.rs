//! A fed chain at its start, at a birth, at the belt and as it leaves, by hand and by its energy.

use super::*;
use crate::chain::Scheme;
use crate::chain::tests::{BELT_SPEED, FEED_SPEED, SPACING, agree, chain, crumple, energies, line, strand};
use crate::line::Contact;
use std::f64::consts::{PI, TAU};

const H: f64 = 6.25e-4;
const HEIGHT: f64 = 0.1;

fn fed(elements: usize, root: Root, scheme: Scheme, kept_length: f64) -> Chain {
    chain(&strand(elements, root), Some(line(Contact::Stick, kept_length)), scheme)
}

fn laying(chain: &Chain) -> &LayingState {
    chain.laying.as_ref().unwrap()
}

/// `EI/l` [N·m].
fn turning() -> f64 {
    1e6 * PI * 1e-12 / 64.0 / SPACING
}

/// theory.md (59), (60): the root has passed the inlet by a sixteenth of an element less a half.
#[test]
fn analytic_a_fed_chain_at_its_start() {
    for root in [Root::Clamped, Root::Pinned] {
        let chain = fed(5, root, Scheme::ImplicitTension, 0.03);
        for (i, at) in chain.position.iter().enumerate() {
            let off = if i == 5 { 1e-3 * SPACING } else { 0.0 };
            agree(at.x, |_| (i as f64 - 7.0 / 16.0) * SPACING, 1e-12);
            for lane in 0..WIDTH {
                let turn = TAU * lane as f64 / 8.0;
                assert!((at.y.0[lane] - off * turn.cos()).abs() < 1e-15);
                assert!((at.z.0[lane] - off * turn.sin()).abs() < 1e-15);
            }
        }
        for v in chain.velocity.iter().chain(&chain.earlier) {
            assert_eq!(*v, Vec3::splat(Vec3::new(FEED_SPEED, 0.0, 0.0)));
        }
        let c = &chain.constants;
        assert_eq!([c.root.mass, c.root.weight], [c.between.mass, c.between.weight]);
        assert_eq!([c.root.inverse_mass, c.frame], [Lanes::ZERO, Lanes::splat(BELT_SPEED)]);
        assert_eq!(chain.origin(&[]), &*chain.position);
        assert_eq!([chain.nodes(), chain.in_air()], [[6; WIDTH]; 2]);
        assert_eq!((chain.fed(), laying(&chain).kept), (5, [3; WIDTH]));
    }
}

/// theory.md (60): `EI/(l (φ + ½))` of a clamped root; of a pinned one the node below has a part of its stiffness.
#[test]
fn analytic_stiffness_of_the_root_as_it_moves_down() {
    for since in 0..4 {
        let inside = 1.0 / 16.0 + f64::from(since) / 4.0;
        for (root, stiffness) in
            [(Root::Clamped, [1.0 / inside, 1.0]), (Root::Pinned, [0.0, inside.min(1.0)])]
        {
            let mut chain = fed(5, root, Scheme::ImplicitTension, 0.03);
            chain.clamp(u64::from(since as u32));
            let c = &chain.constants;
            agree(c.root_stiffness, |_| stiffness[0] * turning(), 1e-12);
            agree(c.second_stiffness, |_| stiffness[1] * turning(), 1e-12);
        }
    }
}

/// The sums of the energy that was carried in [J]: of the motion, of the stretch and of the bending.
fn carried(chain: &Chain) -> [Lanes; 3] {
    let carried = &laying(chain).carried;
    [carried.kinetic + carried.impacts, carried.axial, carried.bending]
}

/// What an event adds to the energies of a chain is what it enters as carried.
fn is_entered(chain: &mut Chain, event: impl Fn(&mut Chain)) {
    let before = chain.clone();
    event(chain);
    has_entered(&before, chain);
}

fn has_entered(before: &Chain, chain: &Chain) {
    for lane in 0..WIDTH {
        let energies = [before, chain].map(|chain| energies(chain, lane));
        let entered = [before, chain].map(|chain| carried(chain).map(|sum| sum.0[lane]));
        for kind in 0..3 {
            let change = energies[1][kind] - energies[0][kind];
            let entered = entered[1][kind] - entered[0][kind];
            let size = energies[0][kind].max(energies[1][kind]);
            assert!(
                (change - entered).abs() < 1e-10 * size,
                "lane {lane}, {kind}: {change:e} {entered:e} of {size:e}"
            );
        }
    }
}

/// Bends from a thousandth of a radian to more than a right angle.
#[test]
fn invariant_births_and_the_clamp_enter_what_they_add_to_the_energy() {
    for scheme in [Scheme::ImplicitTension, Scheme::Leapfrog] {
        for (root, most) in [(Root::Clamped, 1e-3), (Root::Clamped, 0.9), (Root::Pinned, 0.9)] {
            let mut oblique = strand(5, root);
            oblique.fibre.direction = Vec3::new(0.8, 0.36, 0.48);
            let mut chain = chain(&oblique, Some(line(Contact::Stick, 0.03)), scheme);
            crumple(&mut chain, most);
            is_entered(&mut chain, |chain| chain.clamp(3));
            let (before, former) = (carried(&chain)[2], chain.clone());
            is_entered(&mut chain, |chain| chain.give_birth(4.0 * H));
            assert!(carried(&chain)[2].0.iter().zip(before.0).all(|(now, before)| *now != before));
            // Born above the former root, stretched as the element below is.
            let stretch = |lane: usize| match scheme {
                Scheme::ImplicitTension => {
                    former.tensions.tension[0].0[lane] / (1e6 * PI * 1e-6 / 4.0 / SPACING)
                }
                _ => (former.position[1].lane(lane) - former.position[0].lane(lane)).norm() - SPACING,
            };
            let born = |lane: usize| SPACING + stretch(lane);
            agree(chain.position[0].x, |lane| former.position[0].x.0[lane] - 0.8 * born(lane), 1e-12);
            agree(chain.position[0].y, |lane| former.position[0].y.0[lane] - 0.36 * born(lane), 1e-12);
            agree(chain.velocity[0].x, |lane| 0.8 * born(lane) / (4.0 * H), 1e-12);
            agree(chain.velocity[0].y, |lane| 0.36 * born(lane) / (4.0 * H), 1e-12);
            assert_eq!((chain.velocity[0], chain.position[1]), (chain.earlier[0], former.position[0]));
            assert_eq!((chain.elements(), chain.fed(), chain.nodes()), (6, 6, [7; WIDTH]));
            assert_eq!(laying(&chain).origin[0], chain.position[0]);
            if scheme == Scheme::ImplicitTension {
                let difference = chain.tensions.tension[0] - chain.tensions.tension[1];
                agree(difference + Lanes::splat(1.0), |_| 1.0, 1e-15);
            }
            is_entered(&mut chain, |chain| chain.clamp(0));
        }
    }
}

/// A chain of one element has no node that bends but its root.
#[test]
fn invariant_a_birth_above_a_single_element() {
    for root in [Root::Clamped, Root::Pinned] {
        let mut chain = fed(1, root, Scheme::ImplicitTension, 0.03);
        crumple(&mut chain, 0.5);
        is_entered(&mut chain, |chain| chain.give_birth(4.0 * H));
        assert_eq!((chain.elements(), chain.fed()), (2, 2));
    }
}

/// theory.md (61) of a node 2 mm above the belt: lanes in which it passes the belt within the step, touches it at its
/// end and stays above it.
#[test]
fn analytic_a_node_that_lands_keeps_its_velocity_until_it_touches_the_belt() {
    let mut chain = fed(5, Root::Clamped, Scheme::ImplicitTension, 0.03);
    let state = chain.laying.as_mut().unwrap();
    let position = Vec3::splat(Vec3::new(HEIGHT - 2e-3, 0.3, -0.2));
    let speed = |lane: usize| [3.2, 4.0, 6.4, 12.8, -1.0, 0.0, 64.0, 3.0][lane];
    let mut v = Vec3::splat(Vec3::new(0.0, 7.0, -3.0));
    v.x = Lanes::from_fn(speed);
    let others = state.land(4, &position, &mut v, H);
    for lane in 0..WIDTH {
        let share = 2e-3 / (speed(lane) * H);
        let expected = match share > 0.0 && share < 1.0 {
            true => Vec3::new(2e-3 / H, share * 7.0 + (1.0 - share) * BELT_SPEED, share * -3.0),
            false => Vec3::new(speed(lane), 7.0, -3.0),
        };
        let lands = [2, 3, 6, 1].contains(&lane);
        assert_eq!(lands, share > 0.0 && share < 1.0);
        assert!((v.lane(lane) - expected).norm() < 1e-9, "{lane}: {:?} {expected:?}", v.lane(lane));
        assert_eq!(others.0[lane], if lands { 0.0 } else { 1.0 });
    }
}

/// Lets nodes land in some lanes at the end of a step, each after a part of it. What that takes of the energies is
/// entered.
pub(in crate::chain) fn land(chain: &mut Chain, nodes: &[usize], lanes: &[usize], step: u64) {
    let nodes: Vec<(usize, Lanes)> = nodes
        .iter()
        .map(|node| {
            let share = 0.25 + 0.05 * *node as f64;
            (*node, Lanes::from_fn(|lane| if lanes.contains(&lane) { share } else { f64::NAN }))
        })
        .collect();
    // At the end of such a step they are on the belt but for rounding.
    for (node, shares) in &nodes {
        (0..WIDTH).filter(|lane| !shares.0[*lane].is_nan()).for_each(|lane| {
            chain.position[*node].x.0[lane] = HEIGHT * (1.0 + 1e-14);
        });
    }
    chain.laying.as_mut().unwrap().landing = nodes;
    let before = chain.clone();
    chain.touch_down(step, H);
    has_entered(&before, chain);
}

/// Three nodes behind the newest touch-down stay. In lanes 0 to 3 nodes land one by one; in lane 4 the node fed fifth
/// lands second, so that two leave, one of them from an arch; in the others none lands.
#[test]
fn analytic_nodes_land_move_with_the_belt_and_leave() {
    let mut chain = fed(5, Root::Clamped, Scheme::ImplicitTension, 0.025);
    crumple(&mut chain, 0.5);
    let former = chain.clone();
    let in_turn = [0, 1, 2, 3];
    land(&mut chain, &[5, 4, 3], &in_turn, 10);
    assert_eq!(chain.in_air(), [3, 3, 3, 3, 6, 6, 6, 6]);
    assert_eq!((chain.nodes(), laying(&chain).touched), ([6; WIDTH], [3, 3, 3, 3, 0, 0, 0, 0]));
    assert!(laying(&chain).laid.iter().all(Vec::is_empty));
    for lane in 0..WIDTH {
        for i in 3..6 {
            let (at, before) = (chain.position[i].lane(lane), former.position[i].lane(lane));
            let landed = in_turn.contains(&lane);
            assert_eq!(chain.is_held(i, lane), landed);
            assert_eq!([at.y, at.z], [before.y, before.z]);
            assert_eq!(at.x, if landed { HEIGHT } else { before.x });
            let v = if landed { Vec3::new(0.0, BELT_SPEED, 0.0) } else { former.velocity[i].lane(lane) };
            assert_eq!(chain.velocity[i].lane(lane), v);
        }
    }
    // The first node of lane 3 slides when it leaves.
    chain.constants.tail[0].inverse_mass.0[3] = 1.0;
    land(&mut chain, &[2], &in_turn, 20);
    land(&mut chain, &[5, 1], &[4], 30);
    assert_eq!((chain.nodes(), chain.in_air()), ([5, 5, 5, 5, 4, 6, 6, 6], [2, 2, 2, 2, 1, 6, 6, 6]));
    let ended = |step: f64, node: f64| step * H - (1.0 - (0.25 + 0.05 * node)) * H;
    for (lane, points) in
        [(0, vec![(20.0, ended(10.0, 5.0))]), (3, vec![(20.0, ended(10.0, 5.0))]), (5, vec![])]
            .into_iter()
            .chain([(4, vec![(30.0, ended(30.0, 5.0)), (30.0, 30.0 * H)])])
    {
        let laid = &laying(&chain).laid[lane];
        assert_eq!(laid.len(), points.len());
        for (number, (point, (now, time))) in laid.iter().zip(points).enumerate() {
            let at = chain.position[5 - number].lane(lane);
            let expected = [number as f64 * SPACING, time, at.y - BELT_SPEED * now * H, at.z];
            for (found, expected) in [point.fed, point.time, point.md, point.cd].into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-15, "{lane} {number}: {point:?} {expected}");
            }
            // What has left has no mass, and the work that its weight has done is kept.
            let node = chain.constants.node(5 - number, 6);
            assert_eq!([node.mass.0[lane], node.weight.0[lane], node.inverse_mass.0[lane]], [0.0; 3]);
        }
    }
    let weight = 1000.0 * PI * 1e-6 / 4.0 * SPACING * 9.81;
    for (lane, most, left) in [(0, 5, 1.0), (4, 5, 2.0), (5, 5, 0.0)] {
        let fallen = |i: usize| chain.position[i].x.0[lane] - laying(&chain).origin[i].x.0[lane];
        // The last node has half of the others' weight.
        let work =
            weight * (0.5 * fallen(most) * f64::min(left, 1.0) + fallen(4) * f64::max(left - 1.0, 0.0));
        assert!((laying(&chain).carried.gravity_work.0[lane] - work).abs() < 1e-12 * weight * HEIGHT);
    }
}

/// Six of nine nodes leave in every lane, of eight five: the arrays keep two nodes more than the chains have, and are
/// shortened by four nodes or more.
#[test]
fn analytic_arrays_are_shortened_by_what_has_left_in_all_lanes() {
    for (elements, room) in [(8, 5), (7, 8)] {
        for scheme in [Scheme::ImplicitTension, Scheme::Leapfrog] {
            let mut chain = fed(elements, Root::Clamped, scheme, 0.01);
            crumple(&mut chain, 0.3);
            let former = chain.clone();
            let nodes: Vec<usize> = (2..=elements).rev().collect();
            land(&mut chain, &nodes, &(0..7).collect::<Vec<_>>(), 10);
            assert_eq!(chain.position.len(), elements + 1);
            land(&mut chain, &nodes, &[7], 20);
            assert_eq!((chain.nodes(), chain.position.len()), ([3; WIDTH], room));
            let state = laying(&chain);
            let tensions = if scheme == Scheme::ImplicitTension { room - 1 } else { 0 };
            let lengths = [chain.velocity.len(), chain.earlier.len(), state.origin.len()];
            assert_eq!((lengths, chain.tensions.tension.len()), ([room; 3], tensions));
            let tail = chain.constants.tail.len();
            assert_eq!([tail, state.landed_at.len()], [room - 2; 2]);
            for i in 2..room {
                assert_eq!(chain.position[i].y, former.position[i].y);
                let share = 0.25 + 0.05 * i as f64;
                let time = |lane: usize| (if lane < 7 { 10.0 } else { 20.0 } - (1.0 - share)) * H;
                agree(state.landed_at[room - 1 - i], time, 1e-12);
                assert!(chain.is_held(i, 0) && !chain.is_held(1, 0));
            }
        }
    }
}

/// Nodes on the belt that the belt would have to hold with 5 mN, with half a millinewton of suction, and nodes that
/// slide.
#[test]
fn analytic_nodes_begin_and_end_to_slide() {
    let suction = 5e-4 / (1e-3 * SPACING);
    let contact = Contact::Friction { coefficient: 0.5, suction };
    let strand = strand(5, Root::Clamped);
    let mass = strand.fibre.element_mass();
    let start = || chain(&strand, Some(line(contact, 0.03)), Scheme::ImplicitTension);
    // The largest friction is half of the suction and what the node is pressed with.
    for (pressed, slides) in [(9.4e-3, true), (9.6e-3, false)] {
        let mut chain = start();
        // The force on another node that had this position in the list is forgotten when the first node lands there.
        chain.tensions.belt_force.iter_mut().for_each(|force| *force = Vec3::splat(Vec3::new(1.0, 2.0, 3.0)));
        land(&mut chain, &[4], &(0..6).collect::<Vec<_>>(), 10);
        let zero: Vec<bool> =
            chain.tensions.belt_force[..6].iter().map(|force| *force == Vec3::ZERO).collect();
        assert_eq!(zero, [false, false, false, false, true, false]);
        chain.tensions.belt_force[4] = Vec3::splat(Vec3::new(-pressed, 3e-3, -4e-3));
        let held = chain.clone();
        chain.slide(H);
        for lane in 0..WIDTH {
            let inverse = chain.constants.node(4, 6).inverse_mass.0[lane];
            let expected =
                if slides && lane < 6 { 1.0 / mass } else { held.constants.node(4, 6).inverse_mass.0[lane] };
            assert!((inverse - expected).abs() <= 1e-12 * expected, "{lane}: {inverse} {expected}");
        }
        // Pressed by 9.5 mN less 0.5 mN the friction is 5 mN: it stops 5 mN H/m within a step.
        if slides {
            let most = 0.5 * (5e-4 + pressed);
            for (part, stops) in [(0.99, true), (1.01, false)] {
                let mut chain = chain.clone();
                let (slip, force) = (part * most * H / mass, Vec3::new(-pressed, 2e-3, 1e-3));
                chain.tensions.belt_force[4] = Vec3::splat(force);
                let v = Vec3::new(
                    0.0,
                    BELT_SPEED + 0.8 * slip + force.y * H / mass,
                    -0.6 * slip + force.z * H / mass,
                );
                chain.velocity[4] = Vec3::splat(v);
                chain.slide(H);
                for lane in 0..6 {
                    assert_eq!(chain.is_held(4, lane), stops);
                    let expected = if stops { Vec3::new(0.0, BELT_SPEED, 0.0) } else { v };
                    assert_eq!(chain.velocity[4].lane(lane), expected);
                }
                // A node that has not landed is not looked at.
                assert_eq!([chain.velocity[4].lane(6), chain.velocity[4].lane(7)], [v; 2]);
            }
        }
    }
    // Nothing holds a node without mass, and nothing slides that sticks.
    let mut chain = start();
    land(&mut chain, &[4], &[0], 10);
    chain.tensions.belt_force[4] = Vec3::splat(Vec3::new(0.0, 1.0, 0.0));
    chain.constants.tail[1].mass.0[0] = 0.0;
    chain.slide(H);
    assert!(chain.is_held(4, 0));
}

/// The friction on a node that slides, by hand: against the slip, and no more than stops it within the step.
#[test]
fn analytic_friction_on_a_node_that_slides() {
    let suction = 5e-4 / (1e-3 * SPACING);
    let contact = Contact::Friction { coefficient: 0.5, suction };
    let chain = chain(&strand(5, Root::Clamped), Some(line(contact, 0.03)), Scheme::ImplicitTension);
    let friction = chain.constants.friction.unwrap();
    let mass = 1e-6;
    let node = |free: f64, free_x: f64| Node {
        mass: Lanes::splat(mass),
        inverse_mass: Lanes::splat(free),
        inverse_mass_x: Lanes::splat(free_x),
        weight: Lanes::ZERO,
    };
    let on = |node: Node, slip: [f64; 2], pull: f64| {
        let v = Vec3::splat(Vec3::new(0.0, BELT_SPEED + slip[0], slip[1]));
        friction.on(&node, &v, &Lanes::splat(BELT_SPEED), &Lanes::splat(pull), H).lane(3)
    };
    let sliding = node(1.0 / mass, 0.0);
    for (slip, pull, expected) in [
        ([6.0, -8.0], 1.5e-3, [-1.5e-3, -0.6e-3, 0.8e-3]),
        ([6.0, -8.0], -1e-3, [1e-3, 0.0, 0.0]),
        ([3e-2, 4e-2], 1.5e-3, [-1.5e-3, -3e-2 * mass / H, -4e-2 * mass / H]),
        ([0.0, 0.0], 1.5e-3, [-1.5e-3, 0.0, 0.0]),
    ] {
        let found = on(sliding, slip, pull);
        let [x, y, z] = expected;
        assert!((found - Vec3::new(x, y, z)).norm() < 1e-15, "{found:?} {expected:?}");
    }
    for other in [node(0.0, 0.0), node(1.0 / mass, 1.0 / mass)] {
        assert_eq!(on(other, [6.0, -8.0], 1.5e-3), Vec3::default());
    }
}

/// Three times as stiff, twice as heavy and of other weight: the tensions and the springs of the clamp go with it, what
/// the belt holds stays held, and what has left stays without mass.
#[test]
fn analytic_a_fed_fibre_that_becomes_another_one() {
    let former = strand(5, Root::Clamped);
    let line = line(Contact::Stick, 0.01);
    let mut chain = chain(&former, Some(line), Scheme::ImplicitTension);
    crumple(&mut chain, 0.3);
    land(&mut chain, &[5, 4, 3], &[2], 10);
    chain.clamp(2);
    let before = chain.clone();
    let mut other = former;
    (other.fibre.youngs_modulus, other.fibre.density, other.gravity) = (3e6, 2000.0, 5.0);
    let strands = spunlaid_ground::PerLane::new(vec![other]).unwrap();
    chain.become_of(&crate::chain::ChainInvariants::new(&other, Some(&line)), &strands);
    for (now, before) in chain.tensions.tension.iter().zip(before.tensions.tension.iter()) {
        agree(*now, |lane| 3.0 * before.0[lane], 1e-12);
    }
    let (c, former) = (&chain.constants, &before.constants);
    agree(c.root_stiffness, |_| turning() * 3.0 / (1.0 / 16.0 + 0.5), 1e-12);
    agree(c.second_stiffness, |_| turning() * 3.0, 1e-12);
    assert_eq!([c.root.mass, c.root.weight], [c.between.mass, c.between.weight]);
    assert_eq!((c.frame, c.tail.len()), (Lanes::splat(BELT_SPEED), 3));
    let mass = 2.0 * 1000.0 * PI * 1e-6 / 4.0 * SPACING;
    for (now, before) in c.tail.iter().zip(&former.tail) {
        for lane in 0..WIDTH {
            let kept = |value: f64, before: f64| if before == 0.0 { 0.0 } else { value };
            for (found, expected) in [
                (now.mass.0[lane], kept(mass, before.mass.0[lane])),
                (now.weight.0[lane], kept(mass * 5.0, before.weight.0[lane])),
                (now.inverse_mass.0[lane], kept(1.0 / mass, before.inverse_mass.0[lane])),
                (now.inverse_mass_x.0[lane], kept(1.0 / mass, before.inverse_mass_x.0[lane])),
            ] {
                assert!((found - expected).abs() <= 1e-12 * expected, "{lane}: {found} {expected}");
            }
        }
    }
    assert!(c.tail[0].mass.0[2] == 0.0 && c.tail[2].inverse_mass.0[2] == 0.0 && c.tail[2].mass.0[2] > 0.0);
}
