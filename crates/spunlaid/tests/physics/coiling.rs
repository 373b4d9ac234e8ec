//! The reference for threads that coil on a plane, against solutions of others and against the balance of its
//! own pieces.

use crate::common::coiling::{Coil, RodState, Thread, coil, coil_from_a_pin};
use crate::common::{V, X, Y};

/// Feed speed 0.05 √(gH), damping 0.1 √(g/H).
const FROUDE: f64 = 0.05 * 0.05;
const DAMPING: f64 = 0.1 * 0.05;

/// The coil by two numbers of steps, the second twice the first.
fn by_two_steps(thread: Thread, steps: usize) -> [Coil; 2] {
    [1, 2].map(|times| thread.coil(times * steps))
}

#[test]
fn analytic_static_coils() {
    // Two independent solutions of the same problem, made elsewhere; half a unit of their last digit.
    let made_elsewhere = [
        (0.0, 0.6811, 1.792),
        (1.0, 0.6204, 1.714),
        (5.35, 0.5039, 1.568),
        (12.4, 0.4268, 1.473),
        (28.6, 0.3502, 1.379),
        (66.2, 0.2811, 1.294),
        (153.0, 0.2231, 1.223),
    ];
    for (g, radius, length) in made_elsewhere {
        let found = coil(g, 0.0, 0.0);
        assert!((found.radius - radius).abs() < 0.5e-4, "G = {g}: R/H = {}, not {radius}", found.radius);
        assert!((found.length - length).abs() < 0.5e-3, "G = {g}: S/H = {}, not {length}", found.length);
    }
}

#[test]
fn analytic_coils_with_inertia_and_damping() {
    // Made elsewhere, half a unit of the last digit.
    for (g, radius) in [(28.6, 0.3513), (153.0, 0.2251)] {
        let found = coil(g, FROUDE, DAMPING).radius;
        assert!((found - radius).abs() < 0.5e-4, "G = {g}: R/H = {found}, not {radius}");
    }
}

#[test]
fn order_of_the_shots_is_four() {
    let thread = Thread { g: 28.6, froude: FROUDE, damping: DAMPING, give: 0.0 };
    let [a, b] = by_two_steps(thread, 50);
    let c = thread.coil(200);
    for (name, ratio) in [
        ("radius", (a.radius - b.radius) / (b.radius - c.radius)),
        ("length", (a.length - b.length) / (b.length - c.length)),
        ("tension", (a.root_tension - b.root_tension) / (b.root_tension - c.root_tension)),
    ] {
        // 2⁴ and a term of fifth order, which these steps still show.
        assert!((ratio - 16.0).abs() < 3.0, "{name}: the error falls by {ratio}");
    }
}

#[test]
fn invariant_whole_threads_are_in_balance() {
    // Force along x, with what flows in at the root and out at the touch-down; without motion also the moment
    // about x, and the integral n·t + m²/2 + Gx. What Runge–Kutta leaves is 1e-7.
    for (g, speed) in [(1.0, 0.0), (28.6, 0.0), (153.0, 0.0), (28.6, 1.0), (153.0, 1.0)] {
        let found = coil(g, FROUDE * speed, DAMPING * speed);
        let (root, down) = (found.shape[0], found.shape[found.shape.len() - 1]);
        let fed = root.tangent.x * FROUDE - DAMPING;
        let weight = (root.force - down.force).x - g * speed * fed;
        let size = g * found.length;
        assert!((weight / size - 1.0).abs() < 1e-7, "G = {g}: carries {weight}, weighs {size}");
        if speed == 0.0 {
            for place in &found.shape {
                let moment = (place.moment + place.position.cross(place.force)).x;
                assert!(moment.abs() < 1e-6, "G = {g}: moment {moment} about x at s = {}", place.s);
                let sum = |at: &RodState| {
                    at.force.dot(at.tangent) + 0.5 * at.moment.dot(at.moment) + g * at.position.x
                };
                let off = sum(place) - sum(&root);
                assert!(off.abs() < 1e-6 * size.max(1.0), "G = {g}: {off} at s = {}", place.s);
            }
        }
    }
}

/// The largest that is missing from the balances of forces and of moments, and from `m = t × t'`, by
/// differences between places: the material goes through the shape while the shape turns.
fn unbalanced(thread: Thread, coil: &Coil) -> [f64; 3] {
    let step = coil.shape[1].s - coil.shape[0].s;
    let (sin, cos) = (step / coil.radius).sin_cos();
    // While the thread goes one step down, the shape turns by −step/R about x: the piece that is here now will
    // be at the next place, turned, and was at the one before, turned the other way.
    let turned = |v: V, by: f64| V::new(v.x, cos * v.y + by * sin * v.z, cos * v.z - by * sin * v.y);
    let mut largest = [0.0f64; 3];
    for at in coil.shape.windows(3) {
        let before = turned(at[0].position, -1.0);
        let now = at[1].position;
        let after = turned(at[2].position, 1.0);
        let velocity = (after - before) * (0.5 / step);
        let acceleration = (after - now * 2.0 + before) * (1.0 / (step * step));
        let slope = |of: fn(&RodState) -> V| (of(&at[2]) - of(&at[0])) * (0.5 / step);
        let moved = (acceleration * thread.froude + velocity * thread.damping) * thread.g;
        let missing = [
            slope(|p| p.force) + X * thread.g - moved,
            slope(|p| p.moment) + at[1].tangent.cross(at[1].force),
            at[1].tangent.cross(slope(|p| p.tangent)) - at[1].moment,
        ];
        for (largest, missing) in largest.iter_mut().zip(missing) {
            *largest = largest.max(missing.norm());
        }
    }
    largest
}

#[test]
fn invariant_every_piece_is_in_balance() {
    // Differences are of second order: what is missing falls by four when the steps halve. The thread is so
    // fast that forces of 1 would be missing without one of the terms of its acceleration.
    for give in [0.0, 0.3, 1.0] {
        let thread = Thread { g: 28.6, froude: 0.02, damping: 0.05, give };
        let [coarse, fine] = by_two_steps(thread, 200);
        let (coarse, fine) = (unbalanced(thread, &coarse), unbalanced(thread, &fine));
        for (i, name) in ["forces", "moments", "curvature"].into_iter().enumerate() {
            let ratio = coarse[i] / fine[i];
            assert!(fine[i] < 0.01, "{name}, give {give}: {} is missing", fine[i]);
            assert!((ratio - 4.0).abs() < 0.2, "{name}, give {give}: what is missing falls by {ratio}");
        }
    }
}

#[test]
fn ends_are_held_as_they_should_be() {
    for (name, found) in
        [("clamped", coil(28.6, FROUDE, DAMPING)), ("pinned", coil_from_a_pin(28.6, FROUDE, DAMPING))]
    {
        let (root, down) = (found.shape[0], found.shape[found.shape.len() - 1]);
        assert!(root.position.norm() < 1e-9, "{name}: root at {:?}", root.position);
        let missed = if name == "clamped" { root.tangent - X } else { root.moment };
        // The length of t and m·t are as good as Runge–Kutta keeps them.
        assert!(missed.norm() < 1e-7, "{name}: {missed:?}");
        assert!((down.position - X - Y * found.radius).norm() < 1e-12, "{name}: {:?}", down.position);
        let lies_still = down.tangent - X.cross(down.position) * (1.0 / found.radius);
        assert!(lies_still.norm() < 1e-12, "{name}: laid at {lies_still:?}");
        assert!((down.moment - X * (1.0 / found.radius)).norm() < 1e-12, "{name}: {:?}", down.moment);
    }
}

#[test]
fn shape_is_smooth_between_its_places_and_into_the_circle() {
    let thread = Thread { g: 28.6, froude: FROUDE, damping: DAMPING, give: 0.0 };
    let [coarse, fine] = by_two_steps(thread, 200);
    for place in &fine.shape {
        // The cubic's error is step⁴ |r|/384, with r of some n/step⁰ ~ 200.
        let off = (coarse.position(place.s) - place.position).norm();
        assert!(off < 1e-8, "s = {}: off by {off}", place.s);
    }
    let before = fine.position(fine.length - 1e-6);
    let after = fine.position(fine.length + 1e-6);
    let tangent = (after - before) * 0.5e6;
    assert!((tangent - V::new(0.0, 0.0, 1.0)).norm() < 1e-5, "{tangent:?}");
}
