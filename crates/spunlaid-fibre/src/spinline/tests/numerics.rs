//! What the solution of a spinline is made of: elimination, rates, steps, tables of the air and roots.

use super::super::elimination::Factors;
use super::super::filament::{
    ACROSS, ALONG, Filament, HEAT, LN_SPEED, PROGRESS, PULL, Phase, SIZE, State, TEMPERATURE, TENSION, WORK,
};
use super::super::integration::{Step, Stepper};
use super::super::shooting::brent;
use super::*;

/// Five equations with zeros where pivots would be, and two that need the larger pivot.
#[test]
fn analytic_elimination_solves_what_was_multiplied_out() {
    let rows = [
        [0.0, 2.0, 1.0, 0.0, 3.0],
        [4.0, 1.0, -1.0, 2.0, 0.0],
        [-8.0, 3.0, 0.0, 0.0, 1.0],
        [2.0, 0.0, 5.0, -7.0, 1.0],
        [1.0, -1.0, 0.0, 2.0, 0.5],
    ];
    let factors = Factors::of(5, |row, column| rows[row][column]);
    // The rows times (1, −2, 3, 0.5, 4).
    let mut side = [11.0, 0.0, -10.0, 17.5, 6.0];
    factors.solve(&mut side);
    for (found, expected) in side.into_iter().zip([1.0, -2.0, 3.0, 0.5, 4.0]) {
        assert!((found - expected).abs() < 1e-14, "{side:?}");
    }
    let mut side = [1.0, 2.0];
    Factors::of(2, |row, column| [[1e-20, 1.0], [-1.0, -1.0]][row][column]).solve(&mut side);
    assert_eq!(side, [-3.0, 1.0]);
}

/// The rates of a state with all forces and all heat against the equations (84) to (95) themselves: those that are
/// solved for the strain rate are put together again, and the tension of a stretched melt is followed along the rates.
#[test]
fn analytic_the_rates_of_a_state_satisfy_the_equations() {
    let mut material = Polymer::Pp.material(true);
    (material.viscosity, material.surface_tension, material.modulus) = (300.0, 0.03, 2e4);
    (material.mobility, material.extensibility, material.stress_optical_temperature) = (0.3, 0.2, 503.15);
    let air = AirState { velocity: 30.0, cross_velocity: 0.5, temperature: 300.0 };
    let friction = FrictionLaw::Matsui { factor: 0.5 };
    for (law, crystallisation) in Law::ALL.into_iter().flat_map(|law| [(law, false), (law, true)]) {
        let line = Spinline {
            material,
            law,
            crystallisation,
            die_temperature: 503.15,
            hole_diameter: 0.5e-3,
            throughput: 1.2e-5,
            length: 1.0,
            air: Surroundings::Uniform(air),
            emissivity: 0.9,
            dissipation: true,
            nusselt_factor: 0.8,
            drag_factor: 1.1,
            ..Spinline::UNKNOWN
        };
        let filament = Filament { forces: 0.7, ..Filament::new(&line, friction, &line.air) };
        let mut state = [0.0; SIZE];
        (state[LN_SPEED], state[TEMPERATURE], state[TENSION]) = (12_f64.ln(), 400.0, 3e-4);
        (state[PROGRESS], state[ALONG], state[ACROSS]) = (0.4, 3.0, 0.6);
        let rates = |state: &State| filament.rates(0.3, state, Phase::Melt, &mut 0);
        let found = rates(&state);
        let (slopes, at) = (found.slopes, found.station);
        let crystals = line.material.crystals;
        let density = 1.0 / (material.specific_volume + material.specific_volume_slope * (400.0 - 273.15));
        let area = line.throughput / (density * 12.0);
        let radius = (area / PI).sqrt();
        let surface = 0.7 * PI * 0.03 * radius;
        let stretched = if law == Law::Newtonian { 3e-4 - surface } else { area * 2e4 * 2.4 };
        let theta = if crystallisation { 1.0 - (-0.4_f64.powf(crystals.avrami_exponent)).exp() } else { 0.0 };
        let hardening = if crystallisation { 4.0 * theta * theta } else { 0.0 };
        let activation = material.activation_energy / 8.314_462_618;
        let eta =
            300.0 * (activation * (1.0 / 400.0 - 1.0 / material.viscosity_temperature) + hardening).exp();
        // Of the air: 18 m/s faster, at a film of 350 K.
        let reynolds = 18.0 * 2.0 * radius / spunlaid_air::motion::kinematic_viscosity_at(300.0);
        let drag = 1.1 * PI * radius * 101_325.0 / 287.05 / 300.0
            * friction.coefficient(reynolds, 0.0)
            * 18.0
            * 18.0;
        let conductivity = 2.64638e-3 * 350_f64.powf(1.5) / (350.0 + 245.4 * 10_f64.powf(-12.0 / 350.0));
        let per_viscosity = 2.0 * radius / spunlaid_air::motion::kinematic_viscosity_at(350.0);
        let nusselt = 0.8 * 0.42 * (per_viscosity * (18.0 * 18.0_f64 + 64.0 * 0.25).sqrt()).cbrt();
        let convection = PI * conductivity * nusselt * 100.0;
        let radiation = 2.0 * PI * radius * 0.9 * 5.670_374_419e-8 * (400_f64.powi(4) - 300_f64.powi(4));
        let strain_rate = 12.0 * slopes[LN_SPEED];
        let pull = 0.7 * (line.throughput * 9.81 / 12.0 + drag);
        let orientation =
            material.stress_optical_coefficient * stretched / area / material.full_birefringence;
        let progress =
            if crystallisation { crystals.rate_at(400.0, orientation.min(1.0)) / 12.0 } else { 0.0 };
        let n = crystals.avrami_exponent;
        let fused = if crystallisation {
            crystals.heat_of_fusion
                * crystals.crystallinity
                * n
                * 0.4_f64.powf(n - 1.0)
                * (1.0 - theta)
                * progress
        } else {
            0.0
        };
        let capacity = material.heat_capacity + material.heat_capacity_slope * (400.0 - 273.15);
        let heat = convection + radiation;
        let warming = line.throughput * capacity * slopes[TEMPERATURE];
        let expected = [
            (at.convection, convection),
            (at.friction, drag),
            (at.tension, stretched + surface),
            (at.stress, stretched / area),
            (at.diameter, 2.0 * radius),
            (at.strain_rate, strain_rate),
            (slopes[PULL], pull),
            (slopes[HEAT], heat),
            (slopes[WORK], stretched * strain_rate),
            (slopes[TENSION], 0.7 * line.throughput * strain_rate - pull),
            (warming, line.throughput * fused - heat + stretched * strain_rate),
        ];
        for (number, (found, expected)) in expected.into_iter().enumerate() {
            assert!((found / expected - 1.0).abs() < 1e-9, "{law:?} {number}: {found} {expected}");
        }
        assert_eq!(at.transformed == 0.0, !crystallisation);
        assert!(
            (slopes[PROGRESS] - progress).abs() <= 1e-9 * progress && (at.transformed - theta).abs() < 1e-12
        );
        let relax = |c: f64| match law {
            Law::Giesekus => c - 1.0 + 0.3 * (c - 1.0) * (c - 1.0),
            Law::Ptt => (1.0 + 0.2 * (2.0 - 0.8)) * (c - 1.0),
            _ => (0.2 * (2.0_f64 - 0.8)).exp() * (c - 1.0),
        };
        if law == Law::Newtonian {
            assert!((strain_rate * 3.0 * eta * area / stretched - 1.0).abs() < 1e-9);
            assert_eq!([slopes[ALONG], slopes[ACROSS]], [0.0; 2]);
            assert_eq!(filament.relaxations(&state, 0.5, 0.6), 0.0);
        } else {
            let rates = [2.0 * strain_rate * 3.0, -strain_rate * 0.6];
            for ((slope, rate), c) in [slopes[ALONG], slopes[ACROSS]].into_iter().zip(rates).zip([3.0, 0.6]) {
                assert!(
                    (12.0 * slope - (rate - relax(c) * 2e4 / eta)).abs() < 1e-9 * rate.abs(),
                    "{law:?} {c}"
                );
            }
            // The tension is that of the stretched melt and its surface, a little before and a little after.
            let tension = |by: f64| {
                let near: State = std::array::from_fn(|i| state[i] + by * slopes[i]);
                self::tension(&filament, &near)
            };
            let slope = (tension(1e-7) - tension(-1e-7)) / 2e-7;
            assert!((slope / slopes[TENSION] - 1.0).abs() < 1e-5, "{law:?}: {slope} {}", slopes[TENSION]);
            let relaxations = 0.11 * 2e4 / (eta * 12.0);
            assert!((filament.relaxations(&state, 0.5, 0.6) / relaxations - 1.0).abs() < 1e-9);
        }
        let growth = 0.7 * density * 12.0 / (3.0 * eta) * 0.11;
        assert!((filament.growth(&state, 0.5, 0.6) / growth - 1.0).abs() < 1e-9);
        assert_eq!(filament.faster_air(0.3, &state, &mut 0), [30.0 - state[LN_SPEED].exp(), 0.5]);
    }
}

fn tension(filament: &Filament<'_>, state: &State) -> f64 {
    filament.rates(0.3, state, Phase::Melt, &mut 0).station.tension
}

/// A filament that cools by e^(−3z) while its speed rises by e^(2z). One step of each method leaves the errors [K] that
/// the tableaus leave in another program: at its end, at most between its ends, and as it estimates them.
#[test]
fn analytic_one_step_of_both_methods() {
    let line = isothermal(1000.0);
    let filament = Filament {
        gravity: 0.0,
        heat_transfer: Some(0.015),
        forces: 0.0,
        ..Filament::new(&line, NONE, &line.air)
    };
    let pull = 2.0 * 3.0 * VISCOSITY * AREA * SPEED;
    let exact = |s: f64| {
        let mut state = [0.0; SIZE];
        (state[ALONG], state[ACROSS]) = (1.0, 1.0);
        state[LN_SPEED] = SPEED.ln() + 2.0 * s * s;
        (state[TEMPERATURE], state[TENSION]) = (293.15 + 180.0 * (-3.0 * s * s).exp(), pull);
        state
    };
    let off = |state: State, s: f64| {
        assert!((state[LN_SPEED] - exact(s)[LN_SPEED]).abs() < 1e-5, "{s}");
        (state[TEMPERATURE] - exact(s)[TEMPERATURE]).abs()
    };
    let methods = [
        (false, 5.0, [1.173_996e-3, 2.023_778e-3, 4.427_707e-3]),
        (true, 4.0, [0.014_312_18, 0.035_830_75, 0.038_144_87]),
    ];
    for (is_stiff, order, expected) in methods {
        let mut stepper = Stepper::new(&filament, pull);
        stepper.is_stiff = is_stiff;
        let mut step: Step = stepper.step(0.3, 0.2, &exact(0.3));
        assert!(!stepper.is_elastic_wave && (step.end() - 0.5).abs() < 1e-15);
        let between = [0.34, 0.38, 0.42, 0.46].map(|s| off(step.at(s), s)).into_iter().fold(0.0, f64::max);
        let allowed = 1e-8 * exact(0.3)[TEMPERATURE] * 6_f64.sqrt();
        for (found, expected) in [off(step.to, 0.5), between, step.error * allowed].into_iter().zip(expected)
        {
            close(found, expected, 1e-3);
        }
        // The error of the order below that of the method decides how long the next step is.
        let power = |error: f64| 0.9 * f64::powf(error, -1.0 / order);
        for (error, expected) in
            [(1.0, 0.9), (2.0, power(2.0)), (0.1, power(0.1)), (1e9, 0.2), (0.0, 5.0), (f64::NAN, 0.2)]
        {
            step.error = error;
            close(step.next_length() / 0.2, expected, 1e-12);
        }
    }
}

/// Air of a table is linear between its rows and that of the nearest row beyond them, whatever the hint.
#[test]
fn analytic_air_between_the_rows_of_a_table() {
    let table = AirTable {
        distance: vec![0.1, 0.3, 0.4],
        velocity: vec![10.0, 20.0, 5.0],
        cross_velocity: vec![1.0, 0.0, 2.0],
        temperature: vec![300.0, 310.0, 290.0],
    };
    let air = Surroundings::Behind(table.clone());
    for (distance, expected) in [
        (0.0, [10.0, 1.0, 300.0]),
        (0.1, [10.0, 1.0, 300.0]),
        (0.15, [12.5, 0.75, 302.5]),
        (0.3, [20.0, 0.0, 310.0]),
        (0.325, [16.25, 0.5, 305.0]),
        (0.4, [5.0, 2.0, 290.0]),
        (9.0, [5.0, 2.0, 290.0]),
    ] {
        for hint in 0..6 {
            let mut hint = hint;
            let found = air.at(distance, &mut hint);
            let found = [found.velocity, found.cross_velocity, found.temperature];
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{distance}: {found:?}");
            assert_eq!(hint, table.distance.iter().filter(|row| **row <= distance).count());
        }
        assert!((table.velocity_at(distance) - expected[0]).abs() < 1e-12);
    }
    assert_eq!(air.rows(), table.distance);
    assert!(isothermal(1.0).air.rows().is_empty() && isothermal(1.0).air.table().is_none());
    let change = AirChange {
        velocity_factor: 2.0,
        cross_velocity_factor: 3.0,
        temperature_offset: -5.0,
        follows_air: false,
    };
    let changed = change.apply(AirState { velocity: 7.0, cross_velocity: 0.5, temperature: 300.0 });
    assert_eq!(changed, AirState { velocity: 14.0, cross_velocity: 1.5, temperature: 295.0 });
    // A table is changed as a whole; the air behind a row was changed already.
    let line = Spinline { air_change: change, ..isothermal(1.0) };
    let of = |air: &Surroundings| Filament::new(&line, NONE, air).coldest_air();
    assert_eq!(
        [of(&air), of(&Surroundings::Field { temperature: 0.0, table }), of(&line.air)],
        [290.0, 285.0, 293.15]
    );
}

/// Roots of functions that are straight, curved, flat at the root, steep and infinite at an end, to the wanted error
/// and with at most so many evaluations.
#[test]
fn analytic_roots_between_two_places() {
    type Curve = fn(f64) -> f64;
    let curves: [(Curve, [f64; 2], f64, usize); 6] = [
        (|x| 3.0 * x - 1.5, [0.0, 2.0], 0.5, 3),
        (|x| x * x - 2.0, [0.0, 2.0], std::f64::consts::SQRT_2, 9),
        (|x| (x - 1.0).powi(3), [-1.0, 2.5], 1.0, 100),
        (|x| x.exp() - 5.0, [-20.0, 6.0], 5_f64.ln(), 14),
        (|x| if x > 1.0 { f64::INFINITY } else { x - 0.3 }, [-4.0, 9.0], 0.3, 12),
        (|x| 1.0 - x.powi(9), [0.0, 3.0], 1.0, 16),
    ];
    for (number, (curve, ends, root, most)) in curves.into_iter().enumerate() {
        for ends in [ends, [ends[1], ends[0]]] {
            let mut calls = 0;
            let counted = |x| {
                calls += 1;
                curve(x)
            };
            let ends = ends.map(|x| (x, curve(x).clamp(-f64::MAX, f64::MAX)));
            let found = brent(counted, ends, 1e-10);
            assert!((found - root).abs() < 1e-10, "{number}: {found} {root}");
            assert!(calls <= most, "{number}: {calls}");
        }
    }
}
