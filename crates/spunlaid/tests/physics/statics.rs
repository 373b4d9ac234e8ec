//! Cantilevers at large deflection: the clamped fibre at rest against elastica.
//!
//! The discrete clamped chain is second order in the element length, so two meshes extrapolate (Richardson)
//! to fourth order, and what is left is bounded by the difference of the two meshes.

use crate::common::*;
use spunlaid::chain::Strand;
use spunlaid::chain::schemes::Scheme;
use spunlaid::fibre::{Fibre, Root};
use spunlaid::flight::Flight;
use spunlaid::lanes::{Isa, Lanes, WIDTH};
use spunlaid::vec3::Vec3;

/// Half a unit of the last digit published, and as much for the mesh and the stretch.
const PUBLISHED: f64 = 1e-5;

/// A beam along y, so slender that it bends and hardly stretches: `(d/L)² α/16` is a strain of 1e-5 at most.
fn beam(elements: usize) -> Fibre {
    Fibre {
        length: 1.0,
        diameter: 2e-3,
        density: 1000.0,
        youngs_modulus: 1e9,
        bending_viscosity_time: 0.0,
        elements,
        root: Root::Clamped,
        direction: Y,
    }
}

/// Tip deflection along x and shortening along y, by the length, of each lane's beam under a load at its
/// tip (lane by lane) and its own weight, once all motion has died out.
fn at_rest(elements: usize, tip_load: [f64; WIDTH], gravity: [f64; WIDTH]) -> Vec<(f64, f64)> {
    let fibre = beam(elements);
    // First mode: 3.516 √(EI/ρA)/L² = 0.88 rad/s; damping near critical for it stops everything.
    let stiffness = fibre.youngs_modulus * fibre.second_moment();
    let w1 = 3.516 * (stiffness / (fibre.density * fibre.cross_section())).sqrt();
    let strands: Vec<Strand> =
        gravity.iter().map(|&g| Strand { fibre, drag: NO_DRAG, gravity: g, damping: 2.0 * w1 }).collect();
    let h = 0.6 * fibre.axial_step_limit().min(fibre.bending_step_limit());
    let duration = 25.0 / w1;
    let (eddies, turbulence) = steady_air(0.0, elements, duration);
    let mut flight =
        Flight::assembled(Isa::detect(), &strands, (&eddies, &turbulence), Scheme::SemiImplicitEuler, h)
            .expect("fibres that agree");
    // The tip load as a kick of the tip's momentum before every step.
    let kick =
        Vec3::new(Lanes(tip_load), Lanes::ZERO, Lanes::ZERO) * Lanes::splat(h / fibre.node_mass(elements));
    for _ in 0..(duration / h) as u64 {
        flight.push(elements, kick);
        flight.advance(1);
    }
    let tip = flight.chain().position[elements];
    (0..WIDTH).map(|i| (tip.x.0[i], 1.0 - tip.y.0[i])).collect()
}

/// Richardson's extrapolation of a second-order result.
fn extrapolated(coarse: f64, fine: f64) -> f64 {
    fine + (fine - coarse) / 3.0
}

#[test]
fn published_cantilevers_under_end_load_and_own_weight() {
    let fibre = beam(32);
    let stiffness = fibre.youngs_modulus * fibre.second_moment();
    let weight = fibre.density * fibre.cross_section();
    // α = PL²/EI in the first three lanes, Γ = wL³/EI in the next two.
    let load = [1.0, 2.0, 10.0, 0.0, 0.0, 0.0, 0.0, 0.0].map(|alpha| alpha * stiffness);
    let gravity = [0.0, 0.0, 0.0, 1.0, 10.0, 0.0, 0.0, 0.0].map(|gamma| gamma * stiffness / weight);
    let coarse = at_rest(16, load, gravity);
    let middle = at_rest(32, load, gravity);
    let expected = [
        ("end load 1", 0.30172, Some(0.05643)),
        ("end load 2", 0.49346, Some(0.16064)),
        ("end load 10", 0.81061, Some(0.55500)),
        ("own weight 1", 0.12347, None),
        ("own weight 10", 0.70020, None),
    ];
    for (i, (name, deflection, shortening)) in expected.into_iter().enumerate() {
        let found = extrapolated(coarse[i].0, middle[i].0);
        // The fourth-order remainder: a share (1/N)² of the second-order error still there.
        let mesh = (coarse[i].0 - middle[i].0).abs() / 32.0;
        assert!((found - deflection).abs() < PUBLISHED + mesh, "{name}: {found}, expected {deflection}");
        if let Some(shortening) = shortening {
            let found = extrapolated(coarse[i].1, middle[i].1);
            let mesh = (coarse[i].1 - middle[i].1).abs() / 32.0;
            assert!((found - shortening).abs() < PUBLISHED + mesh, "{name}: {found}, expected {shortening}");
        }
    }
}

#[test]
fn analytic_pure_end_moment_bends_to_a_circle() {
    // All nodes turned alike (the clamped root's half cell by half) is the equilibrium under a moment
    // M = k_θ θ at the tip: no force anywhere but the couple ±M/l on the last two nodes.
    let elements = 40;
    let strand = in_vacuum(beam(elements), 0.0);
    let l = strand.fibre.rest_length();
    for turned in [0.5, 2.0, 2.0 * std::f64::consts::PI, 9.0] {
        // Half a cell at the root and half at the tip, which carries no node: N cells in all.
        let theta: f64 = turned / elements as f64;
        let mut at = V::default();
        let mut r = vec![at];
        for j in 0..elements {
            let angle = (j as f64 + 0.5) * theta;
            at += V::new(angle.sin(), angle.cos(), 0.0) * l;
            r.push(at);
        }
        let f = kernel_forces(&strand, 0.0, &r, &vec![V::default(); r.len()]);
        let moment = strand.fibre.rotational_stiffness() * theta;
        let rounding = 1e-15 * strand.fibre.axial_stiffness() * l * 10.0 + 1e-12 * moment / l;
        for (i, f) in f.iter().enumerate().take(elements - 1).skip(1) {
            assert!(f.norm() < rounding, "turned {turned}, node {i}: {f:?}, couple {}", moment / l);
        }
        let couple = f[elements].norm();
        assert!((couple - moment / l).abs() < rounding, "{couple} against {}", moment / l);
        assert!((f[elements] + f[elements - 1]).norm() < rounding);
        // And this polygon is the circle: its tip within the chord's second order, (θ²/24).
        let circle = V::new(1.0 - turned.cos(), turned.sin(), 0.0) * (1.0 / turned);
        let bound = theta * theta / 24.0 * 1.01;
        assert!((r[elements] - circle).norm() < bound, "tip {:?}, circle {circle:?}", r[elements]);
    }
}
