//! The balance against the drag itself, and against a thread that falls freely.

use super::*;
use spunlaid_air::Air;
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Fibre, Flight, Job, Line, Root};
use spunlaid_ground::{Isa, Lanes, Vec3};

const STEP: f64 = 4e-5;

/// The line of `cases/spunbond.toml` in air that is as fast everywhere [m/s].
fn line(air: f64) -> Case {
    let mut case = Case::unset();
    case.fibre =
        Fibre { diameter: 18e-6, density: 910.0, youngs_modulus: 2e9, root: Root::Clamped, ..Fibre::UNKNOWN };
    case.fibre.span(0.5, 4e-3);
    let [feed_speed, distance, belt_speed, kept_length] = [50.0, 0.5, 3.0, 0.03];
    case.line =
        Some(Line { feed_speed, distance, belt_speed, kept_length, steps_per_element: 2, ..Line::UNKNOWN });
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
        let nodes = NodeStates::of(&snapshot, tension_lag(&flight), |lane| lane == 0);
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
    // The drag, summed element by element in classes, is that of the nodes but for half an element at the belt.
    let by_drag = balances[1].forces();
    assert_eq!((by_drag.len(), balances[1].places()[50]), (51, 0.5));
    let [coarse, usual, fine] = balances.map(|balance| balance.by_momentum());
    let largest = usual.iter().fold(0.0, |largest: f64, force| largest.max(force.abs()));
    assert!(largest > 1.5e-4 && usual[0] > 0.0, "{usual:?}");
    let summed = |class: usize| (by_drag[class] + drag[class]) / largest;
    assert!((0..50).all(|class| summed(class).abs() < 3e-3), "{:?}", (0..50).map(summed).collect::<Vec<_>>());
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
        drag: Vec::new(),
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
        let position: Vec<_> = nodes.iter().map(|(x, _)| Vec3::new(*x, 0.0, 0.0)).map(Vec3::splat).collect();
        let velocity: Vec<_> = nodes.iter().map(|(_, v)| Vec3::new(*v, 0.0, 0.0)).map(Vec3::splat).collect();
        let nodes = NodeStates {
            position: &position,
            velocity: &velocity,
            tension: &[Lanes::ZERO; 59],
            drag: &[],
            count: [60; WIDTH],
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

/// Over many series of values, each of which keeps a part of the one before, the reported variance of the mean is
/// that of the weighted sums of the known covariances `kᵈ`, and its scatter the sum of all.
#[test]
fn stat_the_error_of_a_series_contains_what_its_values_have_in_common() {
    const SERIES: usize = 4000;
    const VALUES: usize = 12;
    let mut state = 1_u64;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        // Of variance one.
        ((state >> 11) as f64 / 9_007_199_254_740_992.0 - 0.5) * 12f64.sqrt()
    };
    for (kept, memory) in [(0.0_f64, 1), (0.5, 2), (0.5, 0)] {
        let all: Vec<(usize, usize)> = (0..VALUES).flat_map(|i| (0..VALUES).map(move |j| (i, j))).collect();
        let covariance = |i: usize, j: usize| kept.powi(i.abs_diff(j) as i32);
        let with_mean = |i: usize| (0..VALUES).map(|j| covariance(i, j)).sum::<f64>() / VALUES as f64;
        let of_mean = (0..VALUES).map(with_mean).sum::<f64>() / VALUES as f64;
        let weight = |i: usize, j: usize| (1.0 - i.abs_diff(j) as f64 / (memory as f64 + 1.0)).max(0.0);
        let left = |&(i, j): &(usize, usize)| {
            weight(i, j) * (covariance(i, j) - with_mean(i) - with_mean(j) + of_mean)
        };
        let weights = all.iter().map(|&(i, j)| weight(i, j)).sum::<f64>();
        let expected = all.iter().map(left).sum::<f64>() / ((VALUES * VALUES) as f64 - weights);
        let (mut squares, mut reported) = (0.0, 0.0);
        for _ in 0..SERIES {
            let mut value = uniform();
            let values: Vec<f64> = (0..VALUES)
                .map(|_| {
                    value = kept * value + (1.0 - kept * kept).sqrt() * uniform();
                    value
                })
                .collect();
            squares += (values.iter().sum::<f64>() / VALUES as f64).powi(2) / SERIES as f64;
            reported += error_of_series(&values, memory).unwrap().powi(2) / SERIES as f64;
        }
        // Four standard errors of a mean of 4000 squares, whose deviations are about √2 of their mean.
        let allowed = 4.0 * (2.0 / SERIES as f64).sqrt();
        assert!((reported / expected - 1.0).abs() < allowed, "{kept} {memory}: {reported} {expected}");
        assert!((squares / of_mean - 1.0).abs() < allowed, "{kept}: {squares} {of_mean}");
    }
    assert_eq!(error_of_series(&[1.0], 1), None);
    assert_eq!(error_of_series(&[1.0, 2.0], usize::MAX), None);
}

/// Air with a shortest period of 67 ms is correlated for 50 ms, three stretches of 20 ms: eight of them have an error.
#[test]
fn a_balance_in_slow_air_has_an_error_from_many_stretches_only() {
    let mut case = line(40.0);
    case.air.cutoff_frequency = 15.0;
    let mut flight = Flight::new(&[Job::new(&case, 0)], Isa::detect()).unwrap();
    flight.advance(1000);
    let snapshot = flight.observe();
    let nodes = NodeStates::of(&snapshot, tension_lag(&flight), |lane| lane == 0);
    for (stretches, is_known) in [(7, false), (8, true)] {
        let mut balance = StretchedBalance::new(&case);
        (0..stretches).for_each(|number| balance.see(&nodes, 0.02 * f64::from(number) + 0.01));
        assert_eq!(balance.way()[10].standard_error.is_some(), is_known, "{stretches}");
    }
}
