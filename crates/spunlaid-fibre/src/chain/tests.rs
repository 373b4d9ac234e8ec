//! Chains of some elements, crumpled by hand, for tests of what happens to them in a step.

use super::{Chain, ChainInvariants, FibreParameters, Scheme};
use crate::body::{Fibre, Root};
use crate::drag::{ElementDrag, Growth, Share};
use crate::line::{Contact, Line};
use spunlaid_ground::{Lanes, PerLane, Vec3, WIDTH};

/// Rest length of an element [m].
pub(crate) const SPACING: f64 = 0.01;
pub(crate) const FEED_SPEED: f64 = 4.0;
pub(crate) const BELT_SPEED: f64 = 2.0;

/// Numbers between −1 and 1 that look random.
pub(crate) fn scatter(i: usize) -> f64 {
    let x = (i as f64 * 12.9898).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

/// A thick fibre of a soft material without damping, on which drag grows as the root of the velocity.
pub(crate) fn strand(elements: usize, root: Root) -> FibreParameters {
    let fibre = Fibre {
        length: SPACING * elements as f64,
        diameter: 1e-3,
        density: 1000.0,
        youngs_modulus: 1e6,
        elements,
        root,
        ..Fibre::UNKNOWN
    };
    let share = |factor| Share { factor, growth: Growth::Power(0.5) };
    let drag = ElementDrag { along: share(2e-6), across: share(6e-6) };
    FibreParameters { fibre, drag, gravity: 9.81, damping: 0.0 }
}

/// Feed and belt, an element in four steps.
pub(crate) fn line(contact: Contact, kept_length: f64) -> Line {
    Line {
        feed_speed: FEED_SPEED,
        distance: 0.1,
        belt_speed: BELT_SPEED,
        contact,
        kept_length,
        steps_per_element: 4,
    }
}

/// A chain of equal fibres, and fed if there is a line.
pub(crate) fn chain(strand: &FibreParameters, line: Option<Line>, scheme: Scheme) -> Chain {
    let common = ChainInvariants::new(strand, line.as_ref());
    let strands = PerLane::new(vec![*strand]).expect("a fibre");
    let mut chain = Chain::straight(&common, &strands, scheme);
    if let Some(line) = line {
        let feed = |lane| super::laying::Feed { line, fibre: strand.fibre, turn: lane as f64 / 8.0 };
        chain.feed(&(0..WIDTH).map(feed).collect::<Vec<_>>(), line.steps_per_element);
    }
    chain
}

/// Moves the nodes by up to a part of an element, more in each lane, and gives them other velocities and tensions. What
/// is held stays where it is.
pub(crate) fn crumple(chain: &mut Chain, most: f64) {
    let elements = chain.elements();
    for lane in 0..WIDTH {
        let part = most * (lane + 1) as f64 / WIDTH as f64;
        let vector = |i: usize| {
            let number = |k: usize| scatter(1000 * lane + 10 * i + k);
            Vec3::new(number(0), number(1), number(2))
        };
        for i in (0..=elements).filter(|i| !chain.is_held(*i, lane)).collect::<Vec<_>>() {
            let (at, v) = (chain.position[i].lane(lane), chain.velocity[i].lane(lane));
            chain.position[i].set_lane(lane, at + vector(i) * (part * SPACING));
            chain.velocity[i].set_lane(lane, v + vector(i + 200) * 0.5);
            chain.earlier[i].set_lane(lane, v + vector(i + 400) * 0.5);
        }
        for (j, tension) in chain.tensions.tension.iter_mut().enumerate() {
            tension.0[lane] = 1e-3 * (scatter(7 * j + lane) + 0.7);
        }
    }
}

/// Energies of a lane [J], term by term: of the motion as seen from the belt, of the stretch and of the bending.
pub(crate) fn energies(chain: &Chain, lane: usize) -> [f64; 3] {
    let (c, nodes) = (&chain.constants, chain.position.len());
    let mass = |i: usize| c.node(i, nodes).mass.0[lane];
    let edge = |j: usize| chain.position[j + 1].lane(lane) - chain.position[j].lane(lane);
    let moves = |i: usize| {
        let v = chain.velocity[i].lane(lane) - Vec3::new(0.0, c.frame.0[lane], 0.0);
        0.5 * mass(i) * v.dot(v)
    };
    let counts = |i: &usize| mass(*i) > 0.0;
    let stretches = |j: usize| {
        let stretch = edge(j).norm() - c.element.rest_length.0[lane];
        0.5 * c.element.axial_stiffness.0[lane] * stretch * stretch
    };
    let bends = |i: usize| {
        let above = if i == 0 { c.root_direction.lane(lane) } else { edge(i - 1) };
        let angle = above.cross(edge(i)).norm().atan2(above.dot(edge(i)));
        0.5 * c.bending_stiffness(i).0[lane] * angle * angle
    };
    let inner = || (0..nodes - 1).filter(counts);
    [(0..nodes).map(moves).sum(), inner().map(stretches).sum(), inner().map(bends).sum()]
}

/// Numbers that agree in each lane to a part of it.
pub(crate) fn agree(found: Lanes, expected: impl Fn(usize) -> f64, tolerance: f64) {
    for lane in 0..WIDTH {
        let (found, expected) = (found.0[lane], expected(lane));
        assert!((found - expected).abs() <= tolerance * expected.abs(), "lane {lane}: {found} {expected}");
    }
}
