//! Fibres whose elements differ.

use super::Flight;
use crate::air::{Air, Eddies, StreamKey, Wind};
use crate::chain::constants::{Constants, ElementProperties};
use crate::chain::schemes::Scheme;
use crate::chain::{self, Chain, Strand};
use crate::company::PerLane;
use crate::drag::{ElementDrag, Growth, Share};
use crate::fibre::{Fibre, Root};
use crate::lanes::Isa;
use crate::vec3::Vec3;

const ELEMENTS: usize = 12;
const H: f64 = 2e-6;
/// Instants at which energies are looked at.
const INSTANTS: usize = 40;

/// A fibre in calm air or a steady wind along x; `drag` is the force across an element at 1 m/s [N].
fn strand(direction: Vec3<f64>, root: Root, gravity: f64, drag: f64) -> Strand {
    let fibre = Fibre {
        length: 0.3,
        diameter: 50e-6,
        density: 950.0,
        youngs_modulus: 2e9,
        bending_viscosity_time: 0.0,
        elements: ELEMENTS,
        root,
        direction,
    };
    let share = |factor| Share { factor, growth: Growth::Power(0.5) };
    Strand { fibre, drag: ElementDrag { along: share(0.0), across: share(drag) }, gravity, damping: 0.0 }
}

/// The properties of an element, each of which varies along the fibre in its own way.
fn varied(strand: &Strand, j: usize) -> ElementProperties {
    let like = strand.element(j);
    let vary = |phase: f64| 1.0 + 0.4 * libm::sin(0.9 * j as f64 + phase);
    let across = Share { factor: like.drag.across.factor * vary(4.0), ..like.drag.across };
    ElementProperties {
        rest_length: like.rest_length * vary(0.0),
        mass: like.mass * vary(1.0),
        axial_stiffness: like.axial_stiffness * vary(2.0),
        rotational_stiffness: like.rotational_stiffness * vary(3.0),
        drag: ElementDrag { across, ..like.drag },
    }
}

/// Two fibres, the second of which varies along its length, in a wind [m/s].
fn flight(strand: Strand, wind: f64, scheme: Scheme, h: f64) -> Flight {
    let air = Air { harmonics: 8, ..Air::uniform(wind, 0.0, 0.05, 100.0) };
    let eddies = Eddies::along(strand.fibre.length, ELEMENTS, 1.0);
    let key = StreamKey { seed: 0, replicate: 0 };
    let wind = Wind::uniform(Isa::detect(), &[(air, key)], eddies.count(), 1.0).unwrap();
    let mut flight = Flight::assembled(Isa::detect(), &[strand; 2], (&eddies, &wind), scheme, h).unwrap();
    // The second strand is told from the first by its damping, which nothing reads in a flight that is not damped.
    let strands = PerLane::new(vec![strand, Strand { damping: 1.0, ..strand }]).unwrap();
    let common = chain::Common::new(&strand, None);
    let element = |s: &Strand, j| if s.damping > 0.0 { varied(s, j) } else { s.element(j) };
    let constants = Constants::varying(&common, &strands, ELEMENTS, element);
    flight.chain = Chain::with_constants(constants, ELEMENTS, scheme);
    flight.begin();
    flight
}

const DOWN: Vec3<f64> = Vec3::new(1.0, 0.0, 0.0);
const ACROSS: Vec3<f64> = Vec3::new(0.0, 1.0, 0.0);

#[test]
fn identical_a_uniform_fibre_beside_one_that_varies() {
    for scheme in Scheme::ALL {
        let strand = strand(ACROSS, Root::Clamped, 9.81, 1e-6);
        let mut together = flight(strand, 3.0, scheme, H);
        let mut alone = together.clone();
        let strands = PerLane::new(vec![strand]).unwrap();
        alone.chain = Chain::straight(&chain::Common::new(&strand, None), &strands, scheme);
        alone.begin();
        for flight in [&mut together, &mut alone] {
            flight.advance(2000);
        }
        let [together, alone] = [together, alone].map(|mut flight| flight.observe());
        for i in 0..=ELEMENTS {
            assert_eq!(together.position[i].lane(0), alone.position[i].lane(0), "{scheme:?} {i}");
            assert_ne!(together.position[ELEMENTS].lane(1), alone.position[ELEMENTS].lane(1));
        }
        assert_eq!(together.energy.imbalance().0[0], alone.energy.imbalance().0[0]);
    }
}

/// Each element is stretched by the weight below it, by its own stiffness.
#[test]
fn analytic_a_varied_fibre_hangs_at_rest() {
    for scheme in Scheme::ALL {
        let strand = strand(DOWN, Root::Pinned, 9.81, 0.0);
        let mut flight = flight(strand, 0.0, scheme, H);
        let elements: Vec<_> = (0..ELEMENTS).map(|j| varied(&strand, j)).collect();
        let mut place = vec![Vec3::ZERO; ELEMENTS + 1];
        for j in 0..ELEMENTS {
            let below: f64 = elements[j + 1..].iter().map(|element| element.mass).sum();
            let weight = 9.81 * (0.5 * elements[j].mass + below);
            let length = elements[j].rest_length + weight / elements[j].axial_stiffness;
            place[j + 1] = place[j] + Vec3::splat(DOWN * length);
        }
        flight.restart_from(place.clone(), vec![Vec3::ZERO; ELEMENTS + 1]).unwrap();
        flight.advance(1000);
        for (i, (now, place)) in flight.chain().position.iter().zip(&place).enumerate() {
            // The last bit of a place, times a stiffness over a mass, leaves accelerations of some 1e-7 m/s² for 2 ms.
            let off = (now.lane(1) - place.lane(1)).norm();
            assert!(off < 1e-12, "{scheme:?} {i}: {off:e}");
        }
    }
}

/// Half of the drag of an element belongs to each of its nodes.
#[test]
fn analytic_drag_of_each_element() {
    let strand = strand(ACROSS, Root::Free, 0.0, 1e-6);
    let mut flight = flight(strand, 1.0, Scheme::SemiImplicitEuler, H);
    flight.advance(1);
    let elements: Vec<_> = (0..ELEMENTS).map(|j| varied(&strand, j)).collect();
    for i in 0..=ELEMENTS {
        let around = [i.checked_sub(1).map(|j| &elements[j]), elements.get(i)];
        let half = |property: fn(&ElementProperties) -> f64| {
            around.iter().flatten().map(|e| 0.5 * property(e)).sum::<f64>()
        };
        let expected = H * half(|e| e.drag.across.factor) / half(|e| e.mass);
        let found = flight.chain().velocity[i].lane(1).x;
        // The power of the drag law is good to 1e-7.
        assert!((found / expected - 1.0).abs() < 2e-7, "{i}: {found:e} {expected:e}");
    }
}

/// The forces are minus the gradient of the energies: without air, the sum of the energies is off to second
/// order in the step. With the properties of another element in one of the two it would be off by a part of
/// itself.
#[test]
fn order_the_energy_of_a_varied_fibre_in_vacuum() {
    let imbalance = |scheme: Scheme, h: f64| {
        let strand = strand(ACROSS, Root::Clamped, 9.81, 0.0);
        let mut flight = flight(strand, 0.0, scheme, h);
        let bent = |i: usize| {
            let x = i as f64 / ELEMENTS as f64;
            let along = flight.chain().position[i].lane(1);
            Vec3::splat(along + Vec3::new(0.02 * x * x, 0.0, 0.01 * x * x * x))
        };
        let position: Vec<_> = (0..=ELEMENTS).map(bent).collect();
        flight.restart_from(position, vec![Vec3::ZERO; ELEMENTS + 1]).unwrap();
        let mut squares = 0.0;
        for _ in 0..INSTANTS {
            flight.advance((1e-4 / h).round() as u64);
            let energy = flight.snapshot().energy;
            squares += (energy.imbalance().0[1] / energy.initial.0[1]).powi(2);
        }
        (squares / INSTANTS as f64).sqrt()
    };
    for scheme in [Scheme::Leapfrog, Scheme::ImplicitTension] {
        let (coarse, fine) = (imbalance(scheme, 1e-6), imbalance(scheme, 0.5e-6));
        assert!(coarse < 1e-2, "{scheme:?}: {coarse:e}");
        assert!((coarse / fine - 4.0).abs() < 0.1, "{scheme:?}: {coarse:e} {fine:e}");
    }
}
