//! Cantilevers at large deflection: the clamped fibre at rest against elastica.
//!
//! The discrete clamped chain is second order in the element length, so two meshes extrapolate (Richardson)
//! to fourth order, and what is left is bounded by the difference of the two meshes.

use crate::common::beams::{at_rest, slender_beam};
use crate::common::*;

/// Half a unit of the last digit published, and as much for the mesh and the stretch.
const PUBLISHED: f64 = 1e-5;

/// Richardson's extrapolation of a second-order result.
fn extrapolated(coarse: f64, fine: f64) -> f64 {
    fine + (fine - coarse) / 3.0
}

#[test]
fn published_cantilevers_under_end_load_and_own_weight() {
    let fibre = slender_beam(32);
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
    let strand = in_vacuum(slender_beam(elements), 0.0);
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
