//! The kernel's forces against the plain scalar model, against the energy, and against the laws of
//! mechanics.

use crate::common::reference::{ReferenceDrag, elastic_energy, forces};
use crate::common::*;
use proptest::prelude::*;
use spunlaid_fibre::{Fibre, FibreParameters, Root};

const AIR: ReferenceDrag = ReferenceDrag { air_density: 1.204, viscosity: 1.51e-5, beta: 0.9 };

/// A stubby fibre, so that tension, bending, drag and gravity all count in the sum.
fn stubby(root: Root) -> FibreParameters {
    let fibre =
        Fibre { length: 0.05, diameter: 300e-6, youngs_modulus: 1e6, elements: 10, root, ..table1_fibre() };
    let drag = paper_drag().element_drag(&fibre, AIR.air_density, AIR.viscosity);
    FibreParameters { fibre, drag, gravity: 9.81, damping: 0.0 }
}

/// A fibre bent by up to `angle` [rad] or so at each node, strained by up to a tenth.
fn crooked(strand: &FibreParameters, angle: f64, seed: usize) -> Vec<V> {
    let l = strand.fibre.rest_length();
    let mut at = V::default();
    let mut heading = X;
    let mut nodes = vec![at];
    for j in 0..strand.fibre.elements {
        let turned = heading + scattered_vector(seed * 100 + j) * angle;
        heading = turned * (1.0 / turned.norm());
        at += heading * (l * (1.0 + 0.1 * scatter(seed * 100 + j + 50)));
        nodes.push(at);
    }
    nodes
}

fn largest(f: &[V]) -> f64 {
    f.iter().map(|f| f.norm()).fold(0.0, f64::max)
}

/// Relative error of the drag that the kernel is allowed: 1e-7 is stated of its power laws.
const KERNEL: f64 = 1e-7;
/// And of the forces inside the chain: 2e-13 is stated of the bending, the rest is rounding.
const INTERNAL: f64 = 1e-11;

#[test]
fn analytic_forces_equal_the_plain_scalar_model() {
    for (seed, &angle) in [0.0, 1e-6, 0.01, 0.3, 1.0, 3.0, 30.0].iter().enumerate() {
        for (root, air_drag) in
            [(Root::Free, true), (Root::Clamped, true), (Root::Free, false), (Root::Clamped, false)]
        {
            let mut strand = stubby(root);
            if !air_drag {
                strand.drag = NO_DRAG;
            }
            let tolerance = if air_drag { KERNEL } else { INTERNAL };
            let r = crooked(&strand, angle, seed);
            let v: Vec<V> = (0..r.len()).map(|i| scattered_vector(1000 + seed * 50 + i) * 3.0).collect();
            let air = vec![X * 7.0; strand.fibre.elements];
            let expected = forces(&strand, air_drag.then_some(&AIR), &air, &r, &v);
            let found = kernel_forces(&strand, 7.0, &r, &v);
            let scale = largest(&expected);
            // A held root's force is not seen.
            let first = usize::from(root != Root::Free);
            for i in first..r.len() {
                let off = (found[i] - expected[i]).norm();
                assert!(off < tolerance * scale, "angle {angle}, node {i}: off by {off:e} of {scale:e} N");
            }
        }
    }
}

#[test]
fn analytic_no_force_where_nothing_moves_or_bends() {
    let strand = FibreParameters { gravity: 0.0, ..stubby(Root::Free) };
    let l = strand.fibre.rest_length();
    let r: Vec<V> = (0..=strand.fibre.elements).map(|i| X * (l * i as f64)).collect();
    let v = vec![X * 7.0; r.len()];
    // The air moves along with the fibre: no relative velocity, and so no drag, and no NaN.
    let rounding = strand.fibre.axial_stiffness() * l * 1e-15;
    for f in kernel_forces(&strand, 7.0, &r, &v) {
        assert!(f.norm() <= rounding * 10.0, "{f:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn invariant_internal_forces_and_moments_sum_to_zero(seed in 0usize..10_000, angle in 0.0..4.0f64) {
        let strand = FibreParameters { gravity: 0.0, drag: NO_DRAG, ..stubby(Root::Free) };
        let r = crooked(&strand, angle, seed);
        let f = kernel_forces(&strand, 0.0, &r, &vec![V::default(); r.len()]);
        let sum = f.iter().fold(V::default(), |s, &f| s + f);
        let moment = r.iter().zip(&f).fold(V::default(), |s, (&r, &f)| s + r.cross(f));
        let scale = largest(&f) + strand.fibre.axial_stiffness() * strand.fibre.rest_length() * 1e-3;
        prop_assert!(sum.norm() < 1e-12 * scale, "{sum:?} of {scale}");
        prop_assert!(moment.norm() < 1e-12 * scale * strand.fibre.length, "{moment:?}");
    }

    #[test]
    fn invariant_force_is_minus_the_gradient_of_the_energy(
        seed in 0usize..10_000, angle in 0.0..1.5f64, node in 1usize..11,
    ) {
        for root in [Root::Free, Root::Clamped] {
            let strand = FibreParameters { gravity: 0.0, drag: NO_DRAG, ..stubby(root) };
            let r = crooked(&strand, angle, seed);
            let f = kernel_forces(&strand, 0.0, &r, &vec![V::default(); r.len()])[node];
            // Fourth-order central difference: step ε l leaves ε⁴ of truncation and 1e-16/ε of rounding.
            let step = 2e-3 * strand.fibre.rest_length();
            let energy = |axis: usize, by: f64| {
                let mut moved = r.clone();
                match axis { 0 => moved[node].x += by, 1 => moved[node].y += by, _ => moved[node].z += by };
                elastic_energy(&strand, &moved)
            };
            let slope = |axis| {
                let d = |k: f64| energy(axis, k * step) - energy(axis, -k * step);
                (8.0 * d(1.0) - d(2.0)) / (12.0 * step)
            };
            let gradient = V::new(slope(0), slope(1), slope(2));
            let scale = strand.fibre.axial_stiffness() * strand.fibre.rest_length();
            prop_assert!((f + gradient).norm() < 1e-8 * scale, "{f:?} against {gradient:?}");
        }
    }

    #[test]
    fn invariant_forces_turn_with_the_frame(seed in 0usize..10_000, angle in 0.0..2.0f64, turn in -3.0..3.0f64) {
        // About x, the axis of the flow and of gravity.
        let (sin, cos) = turn.sin_cos();
        let rotate = |v: V| V::new(v.x, cos * v.y - sin * v.z, sin * v.y + cos * v.z);
        let strand = stubby(Root::Free);
        let r = crooked(&strand, angle, seed);
        let v: Vec<V> = (0..r.len()).map(|i| scattered_vector(seed + i) * 2.0).collect();
        let f = kernel_forces(&strand, 5.0, &r, &v);
        let turned = |x: &[V]| x.iter().map(|&x| rotate(x)).collect::<Vec<_>>();
        let g = kernel_forces(&strand, 5.0, &turned(&r), &turned(&v));
        let scale = largest(&f);
        for (f, g) in f.iter().zip(&g) {
            prop_assert!((rotate(*f) - *g).norm() < 1e-11 * scale);
        }
    }
}

#[test]
fn analytic_terminal_velocity_along_and_across() {
    // A free, straight, rigidly falling fibre: weight = drag, from the law alone.
    let strand = stubby(Root::Free);
    let d = strand.fibre.diameter;
    let nu = AIR.viscosity;
    let rho = AIR.air_density;
    let weight = strand.fibre.density * strand.fibre.cross_section() * 9.81;
    // ½πdρβ(Vd/ν)^-0.61 V² = w and ½dρ·6.96(Vd/ν)^-0.44(d/d₀)^0.404 V² = w, per length, for V.
    let along =
        (weight / (0.5 * std::f64::consts::PI * d * rho * 0.9 * (d / nu).powf(-0.61))).powf(1.0 / 1.39);
    let across = (weight / (0.5 * d * rho * 6.96 * (d / nu).powf(-0.44) * (d / 78e-6f64).powf(0.404)))
        .powf(1.0 / 1.56);
    let l = strand.fibre.rest_length();
    for (heading, speed) in [(X, along), (Y, across)] {
        let r: Vec<V> = (0..=strand.fibre.elements).map(|i| heading * (l * i as f64)).collect();
        let f = kernel_forces(&strand, 0.0, &r, &vec![X * speed; r.len()]);
        let scale = weight * l;
        for f in f {
            assert!(f.norm() < KERNEL * scale, "heading {heading:?}: {f:?} of {scale:e} N at {speed} m/s");
        }
    }
}

#[test]
fn analytic_terminal_velocity_is_reached_by_falling() {
    use spunlaid_fibre::Flight;
    use spunlaid_fibre::chain::Scheme;
    use spunlaid_ground::Isa;
    for heading in [X, Y] {
        let mut strand = stubby(Root::Free);
        strand.fibre.direction = heading;
        let d = strand.fibre.diameter;
        let nu = AIR.viscosity;
        let rho = AIR.air_density;
        let weight = strand.fibre.density * strand.fibre.cross_section() * 9.81;
        let expected = if heading == X {
            (weight / (0.5 * std::f64::consts::PI * d * rho * 0.9 * (d / nu).powf(-0.61))).powf(1.0 / 1.39)
        } else {
            (weight / (0.5 * d * rho * 6.96 * (d / nu).powf(-0.44) * (d / 78e-6f64).powf(0.404)))
                .powf(1.0 / 1.56)
        };
        // Small departures die out as e^(−1.39 g t/V): forty times V/g leaves nothing to see.
        let h = 2e-5;
        let steps = (40.0 * expected / 9.81 / h) as u64;
        let (eddies, turbulence) = steady_air(0.0, strand.fibre.elements, 100.0);
        let mut flight =
            Flight::assembled(Isa::detect(), &[strand], (&eddies, &turbulence), Scheme::SemiImplicitEuler, h)
                .expect("fibres that agree");
        flight.advance(steps);
        for v in &flight.chain().velocity {
            let v = v.lane(0);
            assert!(
                (v - X * expected).norm() < 1e-6 * expected,
                "{heading:?}: {v:?}, expected {expected} m/s"
            );
        }
    }
}
