//! What is reported of whole lines: rows of holes, balances, the largest strain rate, states that are followed, a titre
//! that is asked for, and lines that cannot run.

use super::super::filament::{HEAT, PULL, WORK};
use super::super::shooting::{Hit, follow};
use super::super::steady::{largest_strain_rate, residuals};
use super::super::{behind, towards};
use super::*;

/// Polypropylene in air of 40 m/s.
fn melt_spinning() -> SpinSpec {
    let mut line = Spinline {
        material: Polymer::Pp.material(false),
        melt: Melt::FlowRate(35.0),
        die_temperature: 503.15,
        hole_diameter: 0.6e-3,
        throughput: 0.5e-3 / 60.0,
        length: 0.8,
        ..Spinline::UNKNOWN
    };
    line.air = Surroundings::Uniform(AirState { velocity: 40.0, cross_velocity: 0.0, temperature: 293.15 });
    let drag = Drag {
        along: FrictionLaw::Matsui { factor: 0.5 },
        across: crate::drag::NormalLaw::MarheinekeWegener,
    };
    SpinSpec { spinline: line, drag, air: None }
}

/// Air that crosses a row of 500 filaments per metre takes their heat and loses what drags them; it stops short of
/// them, and stays as it is where none crosses.                                                theory.md (99)
#[test]
fn analytic_air_behind_a_row() {
    let mut solution = melt_spinning().solve().unwrap();
    let station = Station {
        distance: 0.2,
        speed: 9.0,
        temperature: 400.0,
        air_velocity: 1.0,
        air_cross_velocity: 0.4,
        air_temperature: 300.0,
        convection: 20.0,
        friction: -0.01,
        ..Station::default()
    };
    let still = Station { distance: 0.3, air_cross_velocity: 0.0, ..station };
    let met = Station { distance: 0.4, speed: 1.0, temperature: 300.0, ..station };
    solution.stations = vec![station, still, met];
    let air = behind(&solution, HoleRows { rows: 2, filaments_per_metre: 500.0 });
    assert_eq!((air.distance, air.cross_velocity), (vec![0.2, 0.3, 0.4], vec![0.4, 0.0, 0.4]));
    // Air of 300 K has 1.1766 kg/m³ and 1006 J/(kg K): 1062.4 s/kg, 10.624 m/s and 21.12 K.
    let share = 500.0 / (101_325.0 / 287.05 / 300.0 * 0.4);
    close(share, 1062.4, 1e-4);
    let warmed = 100.0 * (1.0 - (-share * 20.0 / HEAT_CAPACITY_OF_AIR / 100.0).exp());
    let dragged = 8.0 * (1.0 - (-share * 0.01 / 8.0).exp());
    for (found, expected) in air.velocity.into_iter().zip([1.0 + dragged, 1.0, 1.0]) {
        close(found, expected, 1e-12);
    }
    for (found, expected) in air.temperature.into_iter().zip([300.0 + warmed, 300.0, 300.0]) {
        close(found, expected, 1e-12);
    }
    assert_eq!(towards(3.0, 0.0), 0.0);
    close(towards(-3.0, -1e9), -3.0, 1e-8);
}

/// Each row runs in the air that the row before has warmed and dragged.
#[test]
fn identical_rows_and_lines_in_the_air_behind_them() {
    let mut spec = melt_spinning();
    let Surroundings::Uniform(air) = &mut spec.spinline.air else { panic!("uniform air") };
    air.cross_velocity = 0.5;
    let alone = spec.spinline.solve_rows(spec.drag.along).unwrap();
    assert_eq!(alone, vec![spec.solve().unwrap()]);
    let curtain = HoleRows { rows: 3, filaments_per_metre: 300.0 };
    spec.spinline.curtain = Some(curtain);
    let rows = spec.spinline.solve_rows(spec.drag.along).unwrap();
    assert_eq!((rows.len(), &rows[0]), (3, &alone[0]));
    for pair in rows.windows(2) {
        let air = Surroundings::Behind(behind(&pair[0], curtain));
        let next = Spinline { air, ..spec.spinline.clone() }.solve(spec.drag.along).unwrap();
        close(pair[1].final_speed, next.final_speed, 1e-6);
        let rise = pair[1].stations[0].air_temperature - pair[0].stations[0].air_temperature;
        assert!(rise > 0.1, "{rise}");
    }
}

/// The balances report what was taken from them: 1 % of the heat, a thousandth of the tension.
#[test]
fn analytic_balances_miss_what_is_taken_from_them() {
    let mut spec = melt_spinning();
    (spec.spinline.dissipation, spec.spinline.crystallisation) = (true, true);
    spec.spinline.material = Polymer::Pp.material(true);
    let line = &spec.spinline;
    let filament = Filament::new(line, spec.drag.along, &line.air);
    let hit = find(&filament, false).unwrap_or_else(|miss| panic!("{miss:?}"));
    let solution = spec.solve().unwrap();
    let largest = solution.stations.iter().map(|station| station.tension.abs()).fold(hit.tension, f64::max);
    let [momentum, energy] = [solution.momentum_residual, solution.energy_residual];
    assert!(momentum.abs() < 1e-6 && energy.abs() < 1e-6, "{momentum:e} {energy:e}");
    let missed = |change: fn(&mut Hit)| {
        let mut changed = Hit { tension: hit.tension, shot: hit.shot.clone(), has_second: false };
        change(&mut changed);
        residuals(&filament, &changed, &solution.stations)
    };
    let end = hit.shot.end;
    for (change, expected) in [
        ((|hit| hit.shot.end[HEAT] *= 0.99) as fn(&mut Hit), [0.0, 0.01 / 0.99]),
        (|hit| hit.shot.end[WORK] *= 0.5, [0.0, -0.5 * end[WORK] / end[HEAT]]),
        (|hit| hit.shot.end[PULL] += 1e-7, [1e-7 / largest, 0.0]),
        (|hit| hit.tension -= 1e-7, [1e-7 / largest, 0.0]),
    ] {
        let found = missed(change);
        assert!((found.0 - momentum - expected[0]).abs() < 1e-9, "{found:?} {expected:?}");
        assert!((found.1 - energy - expected[1]).abs() < 1e-9, "{found:?} {expected:?}");
    }
    assert!(end[WORK] > 1e-3 * end[HEAT]);
}

/// A Newtonian filament drawn from `v₀` to `D v₀` is stretched fastest at its end, with `v₀ D ln D/L`. If its viscosity
/// rises as it cools, the largest rate lies between the ends.
#[test]
fn analytic_the_largest_strain_rate() {
    let line = Spinline { end: End::TakeUp(20.0 * SPEED), ..isothermal(1e-6) };
    let filament = Filament { gravity: 0.0, ..Filament::new(&line, NONE, &line.air) };
    let hit = find(&filament, false).unwrap_or_else(|miss| panic!("{miss:?}"));
    let (rate, place) = largest_strain_rate(&filament, &hit.shot);
    close(rate, 20.0 * SPEED * 20_f64.ln() / LENGTH, EXACT);
    close(place, LENGTH, 1e-9);

    let solution = melt_spinning().solve().unwrap();
    let (rate, place) = (solution.largest_strain_rate, solution.largest_strain_rate_at);
    assert!(place > 0.02 && place < solution.solidification.distance, "{place}");
    let spec = melt_spinning();
    let filament = Filament::new(&spec.spinline, spec.drag.along, &spec.spinline.air);
    let hit = find(&filament, false).unwrap_or_else(|miss| panic!("{miss:?}"));
    let at = |distance: f64| {
        let s = distance.sqrt();
        let step = hit.shot.steps.iter().find(|step| step.end() >= s).expect("a step");
        filament.rates(distance, &step.at(s), super::super::filament::Phase::Melt, &mut 0).station.strain_rate
    };
    close(at(place), rate, 1e-9);
    for by in [0.99, 0.999, 1.001, 1.01] {
        assert!(at(by * place) < rate, "{by}");
    }
}

/// The state of a line that is pulled a little more, less or as much is followed from a state nearby, and is the one
/// that a search finds.
#[test]
fn identical_a_state_that_is_followed_and_sought() {
    let spec = melt_spinning();
    let filament = Filament::new(&spec.spinline, spec.drag.along, &spec.spinline.air);
    let sought = find(&filament, false).unwrap_or_else(|miss| panic!("{miss:?}"));
    for by in [1.0, 1.002, 0.998, 1.05, 0.95, 1.3, 0.75] {
        let followed = follow(&filament, by * sought.tension, true).unwrap_or_else(|| panic!("{by} is lost"));
        close(followed.tension, sought.tension, 1e-8);
        assert!(followed.has_second);
    }
    // Further away than this it is not the same one.
    assert!(follow(&filament, 4.0 * sought.tension, false).is_none());
}

/// The speed alone of a line next to a known one is that of its state.
#[test]
fn identical_speed_of_a_line_next_to_a_known_one() {
    let spec = melt_spinning();
    let near = spec.solve().unwrap();
    assert!(near.has_low_birefringence);
    let line = Spinline { throughput: 1.01 * spec.spinline.throughput, ..spec.spinline.clone() };
    let expected = line.solve(spec.drag.along).unwrap();
    close(line.final_speed_near(spec.drag.along, &near).unwrap(), expected.final_speed, 1e-6);
    let pet = Spinline { polymer: PolymerSource::Known(Polymer::Pet), ..line };
    assert!(!pet.has_low_birefringence());
}

#[test]
fn analytic_draw_ratio_is_speed_over_speed_at_the_die() {
    let solution = melt_spinning().solve().unwrap();
    // 0.5 g/min of 739.27 kg/m³ through a hole of 0.6 mm.
    let die_speed = 0.5e-3 / 60.0 / 739.268 / (PI * 0.09e-6);
    close(solution.die_speed, die_speed, 1e-5);
    close(solution.draw_ratio(), solution.final_speed / die_speed, 1e-5);
    close(solution.linear_density, 0.5e-3 / 60.0 / solution.final_speed, 1e-12);
    close(PI / 4.0 * solution.final_diameter.powi(2) * 905.0, solution.linear_density, 1e-12);
}

/// Stations at the squares of the parts of the root of the length, at the point where the filament becomes solid, and
/// nowhere else in air that does not change.
#[test]
fn analytic_stations_are_even_in_the_root_of_the_distance() {
    let solution = melt_spinning().solve().unwrap();
    let distances: Vec<f64> = solution.stations.iter().map(|station| station.distance).collect();
    assert_eq!(distances.len(), 402);
    assert!(distances.contains(&solution.solidification.distance) && distances.is_sorted());
    for i in [0, 1, 57, 200, 400] {
        let expected = 0.8 * (i as f64 / 400.0).powi(2);
        assert!(distances.iter().any(|distance| (distance - expected).abs() < 1e-15), "{expected}");
    }
}

/// (98): 4.25e-9/Pa at 400 K, in proportion to 1/T, of polyester, and 0.9e-9/Pa at every temperature of polypropylene.
#[test]
fn analytic_birefringence_and_known_crystals() {
    let [pet, pp] = [Polymer::Pet, Polymer::Pp].map(|polymer| polymer.material(false));
    close(pet.birefringence(1e6, 400.0), 4.25e-3, 1e-12);
    close(pet.birefringence(2e6, 320.0), 8.5e-3 * 1.25, 1e-12);
    close(pp.birefringence(3e6, 320.0), 2.7e-3, 1e-12);
    let known = Polymer::ALL.map(|polymer| polymer.material(true).crystals.is_known());
    assert_eq!(known, [true, true, true, false, false]);
}

/// A factor on the drag gives a titre, and the titre gives the factor; what cannot be reached is named.
#[test]
fn analytic_the_drag_factor_of_a_titre() {
    let spec = melt_spinning();
    for factor in [0.5, 1.0, 2.5] {
        let mut changed = spec.clone();
        changed.spinline.drag_factor = factor;
        let titre = changed.solve().unwrap().linear_density;
        close(spec.drag_factor_of_titre(titre).unwrap(), factor, 1e-5);
    }
    // 340 m/s, and 0.1 m/s, which is slower than the filament falls.
    for (speed, shown) in [(340.0, "a speed of 340 m/s"), (0.1, "a speed of 0.1 m/s")] {
        let failure = spec.drag_factor_of_titre(0.5e-3 / 60.0 / speed).unwrap_err();
        assert_eq!((failure.key, failure.value), ("spinline.drag_factor", None));
        let message = failure.fault.message;
        assert!(message.contains(shown), "{message}");
        let tried: f64 = message.split("with ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
        let mut last = spec.clone();
        last.spinline.drag_factor = tried;
        // The titre is that of the last factor, which the message has to two digits.
        let reached = message.split("has ").nth(1).unwrap();
        let per_si = if reached.contains("dtex,") { 1e7 } else { 1e6 };
        let titre: f64 = reached.split(' ').next().unwrap().parse().unwrap();
        close(per_si * last.solve().unwrap().linear_density, titre, 0.02);
    }
}

/// A filament of 10 m/s in air that has 5 m/s and gains 20 m/s in each metre: they are equally fast at 0.25 m. The
/// cusp is sharp if eight times the cross velocity is less than a tenth of the speed.
#[test]
fn analytic_the_position_where_filament_and_air_are_equally_fast() {
    for (cross, is_sharp) in [(0.12, true), (0.13, false), (-0.13, false)] {
        let table = AirTable {
            distance: vec![0.0, 2.0],
            velocity: vec![5.0, 45.0],
            cross_velocity: vec![cross; 2],
            temperature: vec![300.0; 2],
        };
        let mut line = isothermal(1e-6);
        line.throughput *= 1000.0;
        line.air = Surroundings::Behind(table);
        let filament = Filament { gravity: 0.0, forces: 0.0, ..Filament::new(&line, NONE, &line.air) };
        let state = filament.at_die(1e-15).unwrap();
        let speed = state[LN_SPEED].exp();
        assert!((speed - 10.0).abs() < 1e-9);
        let mut stepper = super::super::integration::Stepper::new(&filament, 1e-15);
        for (start, length, expected) in [(0.3, 0.4, Some(0.2)), (0.2, 0.25, None), (0.55, 0.1, None)] {
            let step = stepper.step(start, length, &state);
            let found = stepper.cusp(&step);
            assert_eq!(found.map(|(_, sharp)| sharp), expected.map(|_| is_sharp), "{start}");
            if let (Some((found, _)), Some(expected)) = (found, expected) {
                assert!((found - expected).abs() < 1e-9, "{found}");
            }
        }
        // That it starts there is no new cusp.
        let step = stepper.step(0.5, 0.1, &state);
        assert!(stepper.cusp(&step).is_none());
    }
}

/// A surface pulls with half of its tension times the circumference, and the melt needs more than that.
#[test]
fn analytic_the_tension_at_the_die_exceeds_that_of_the_surface() {
    let mut line = isothermal(1000.0);
    line.material.surface_tension = 0.03;
    line.die_swell = 1.5;
    let filament = Filament { forces: 0.5, ..Filament::new(&line, NONE, &line.air) };
    let surface = 0.5 * 0.5 * PI * 0.03 * 1.5e-3;
    assert!(filament.at_die(0.999 * surface).is_none() && filament.at_die(surface * 1.001).is_some());
    // u³ − S u − 1 = 0 with u = √c_zz, by the stress over the modulus.
    let state = filament.at_die(surface + 1e-2).unwrap();
    let stretch = 1e-2 / (PI / 4.0 * 2.25e-6 * 1000.0);
    let u = state[super::super::filament::ALONG].sqrt();
    assert!((u * u * u - stretch * u - 1.0).abs() < 1e-12 * u * u * u);
    close(state[super::super::filament::ACROSS], 1.0 / u, 1e-12);
    close(state[LN_SPEED].exp(), SPEED / 2.25, 1e-12);
}

/// The key to blame of lines that cannot run.
#[test]
fn rejects_lines_that_cannot_run() {
    type Change = fn(&mut Spinline);
    fn air(line: &mut Spinline) -> &mut AirState {
        match &mut line.air {
            Surroundings::Uniform(air) => air,
            _ => panic!("uniform air"),
        }
    }
    let changes: [(Change, &str, &str); 6] = [
        (|line| line.die_temperature = 383.15, "spinline.die_temperature", "not above 110 °C"),
        (|line| air(line).temperature = 383.15, "spinline.temperature", "nowhere colder than 110 °C"),
        (
            |line| line.end = End::TakeUp(0.0398),
            "spinline.take_up_speed",
            "the speed of the melt in the hole",
        ),
        (|line| line.length = 0.03, "spinline.length", "is too short"),
        (|line| line.end = End::TakeUp(0.5), "spinline.take_up_speed", "without a godet it runs at"),
        (|line| line.break_stress = 1e5, "spinline.break_stress", "is exceeded"),
    ];
    for (change, key, words) in changes {
        let mut spec = melt_spinning();
        change(&mut spec.spinline);
        let failure = spec.solve().expect_err(key);
        assert_eq!(failure.key, key, "{failure:?}");
        assert!(failure.fault.message.contains(words), "{key}: {}", failure.fault.message);
    }
    // As hot as the solidification temperature is too hot; a hundredth of a kelvin colder is not.
    let mut spec = melt_spinning();
    air(&mut spec.spinline).temperature = 383.14;
    assert_ne!(spec.solve().err().map(|failure| failure.key), Some("spinline.temperature"));
    // A melt that crystallises may do so in hot air.
    spec.spinline.crystallisation = true;
    spec.spinline.material = Polymer::Pp.material(true);
    air(&mut spec.spinline).temperature = 350.15;
    assert_ne!(spec.solve().err().map(|failure| failure.key), Some("spinline.temperature"));
    // A stress that is just not reached.
    let mut spec = melt_spinning();
    let solution = spec.solve().unwrap();
    let melt = |station: &&Station| station.distance <= solution.solidification.distance;
    let most = solution.stations.iter().filter(melt).map(|station| station.stress).fold(0.0, f64::max);
    for (part, breaks) in [(1.001, false), (0.999, true)] {
        spec.spinline.break_stress = part * most;
        assert_eq!(spec.solve().is_err(), breaks, "{part}");
    }
}
