//! Fibres that are fed and laid: what must hold exactly, and what is known from outside the code.
#![allow(clippy::unwrap_used)]

mod common;

use common::laying::{GRAVITY, Thread, flight, laid_until, spunbond};
use common::{NO_DRAG, X, in_all_lanes, steady_air};
use spunlaid::air::Air;
use spunlaid::case::Case;
use spunlaid::chain::Strand;
use spunlaid::chain::schemes::Scheme;
use spunlaid::flight::Flight;
use spunlaid::lanes::{Isa, Lanes};
use spunlaid::vec3::Vec3;

/// Elements of a fed fibre at its start.
const AT_START: u64 = 2;

#[test]
fn invariant_what_was_born_is_on_the_chain_or_laid() {
    let case = spunbond(&[("run.time_step", "20 µs")]);
    let line = case.line.unwrap();
    let l = case.fibre.rest_length();
    let mut flight = flight(&case, 0..8);
    let mut laid = vec![Vec::new(); 8];
    for steps in (0..40).map(|i| 97 * i) {
        flight.step_to(steps as f64 * case.run.time_step).unwrap();
        let born = steps / line.steps_per_element + AT_START + 1;
        let seen = flight.snapshot();
        for (lane, laid) in laid.iter_mut().enumerate() {
            laid.extend(flight.take_laid(lane));
            assert_eq!(laid.len() + seen.nodes[lane], born as usize, "lane {lane} after {steps} steps");
            assert!(seen.in_air[lane] <= seen.nodes[lane]);
        }
    }
    for laid in &laid {
        assert!(laid.len() > 300, "only {} points were laid", laid.len());
        let longest = laid
            .windows(2)
            .map(|pair| (pair[1].md - pair[0].md).hypot(pair[1].cd - pair[0].cd))
            .fold(0.0, f64::max);
        println!("longest {}", longest / l);
        for (i, (point, next)) in laid.iter().zip(&laid[1..]).enumerate() {
            assert_eq!(point.fed, i as f64 * l);
            // Two neighbours lie at most an element apart, which is strained by less than 2 %.
            assert!((next.md - point.md).hypot(next.cd - point.cd) < 1.02 * l);
        }
    }
}

#[test]
fn invariant_the_laid_fibre_follows_the_belt() {
    let case = spunbond(&[("run.duration", "0.4 s")]);
    let line = case.line.unwrap();
    let ratio = line.belt_speed / line.feed_speed;
    for laid in laid_until(&mut flight(&case, 0..8), 0.4) {
        let counted: Vec<_> = laid.iter().filter(|point| point.fed > line.distance).collect();
        let (first, last) = (counted[0], counted[counted.len() - 1]);
        let off: Vec<f64> = counted.iter().map(|point| point.md + ratio * point.fed).collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        let sigma = (off.iter().map(|off| (off - mean).powi(2)).sum::<f64>() / off.len() as f64).sqrt();
        let length = last.fed - first.fed;
        let slope = (first.md - last.md) / length;
        let error = 2f64.sqrt() * sigma / length;
        println!("slope {slope:.5} of {ratio}, {:.2} errors", (slope - ratio) / error);
        assert!((slope - ratio).abs() < 4.0 * error);
        assert!(4.0 * error < 0.25 * ratio);
    }
}

/// A thread without bending that hangs from the feed: its tension at a distance from the inlet is the weight below,
/// because all of it moves at the feed speed, and its end is at `L + w L²/2EA` after a length `L`. What is left is of the
/// order of `(v/c)²` with the speed of axial waves `c`, and the waves that the first elements make.
#[test]
fn analytic_a_fed_fibre_hangs_by_its_weight() {
    for scheme in [Scheme::SemiImplicitEuler, Scheme::Leapfrog, Scheme::ImplicitTension] {
        let thread = Thread { element: 0.02, scheme, ..Thread::new(1e4) };
        let case = thread.case(0.9 * thread.height / thread.feed_speed());
        let l = case.fibre.rest_length();
        let mut flight = flight(&case, 0..1);
        flight.advance(case.run.steps);
        let seen = flight.snapshot();
        let hung = seen.nodes[0] - 1;
        let stiffness = case.fibre.axial_stiffness() * l;
        for (j, tension) in seen.tension[..hung].iter().enumerate() {
            let below = (hung - 1 - j) as f64 * l + 0.5 * l;
            println!("{j}: T/wx {:.6}", tension.0[0] / thread.weight() / below);
        }
        let (top, end) = (seen.position[0].x.0[0], seen.position[hung].x.0[0]);
        let length = hung as f64 * l;
        println!(
            "{scheme:?}: end {:.8} stretch {:.6e} expected {:.6e} speed {}",
            end,
            end - top - length,
            thread.weight() * length * length / (2.0 * stiffness),
            seen.velocity[hung].x.0[0] / thread.feed_speed()
        );
    }
}

/// Seen from the air that it is fed into, a fibre that moves with this air is one that lies still in still air, and a
/// push at its end does not know of the inlet until it gets there: one node further in a step.
#[test]
fn identical_to_a_fibre_of_fixed_length_in_air_of_its_own_speed() {
    let speed = 5.0;
    let mut case = spunbond(&[
        ("feed.speed", "5 m/s"),
        ("run.scheme", "semi-implicit-euler"),
        ("run.gravity", "0 m/s²"),
    ]);
    case.air = Air { harmonics: 8, ..Air::uniform(speed, 0.0, 0.016, 100.0) };
    case.line.as_mut().unwrap().belt_speed = 0.0;
    case.set_time_step(0.5e-6);
    let elements = 100;
    let line = case.line.unwrap();
    let mut fed = flight(&case, 0..1);
    fed.advance((elements - AT_START) * line.steps_per_element);
    let seen = fed.snapshot();
    assert_eq!(seen.nodes[0], elements as usize + 1);

    let l = case.fibre.rest_length();
    let fibre =
        spunlaid::fibre::Fibre { length: elements as f64 * l, elements: elements as usize, ..case.fibre };
    let strand = Strand {
        fibre,
        drag: case.drag.of_element(&fibre, case.air.density, case.air.kinematic_viscosity),
        gravity: 0.0,
        damping: 0.0,
    };
    let (eddies, wind) = steady_air(0.0, elements as usize, 1.0);
    let mut fixed = Flight::assembled(
        Isa::detect(),
        &[strand],
        (&eddies, &wind),
        Scheme::SemiImplicitEuler,
        fed.time_step(),
    )
    .unwrap();
    let drift = Vec3::splat(X * speed);
    let start = seen.time;
    let velocity = seen.velocity.iter().map(|v| *v - drift).collect();
    fixed.restart_from(seen.position.clone(), velocity).unwrap();
    let push = Vec3::splat(spunlaid::vec3::Vec3::new(0.3, 1.0, -0.5));
    fed.push(elements as usize, push);
    fixed.push(elements as usize, push);
    for steps in [10, 20, 40, 80, 400, 4000] {
        let left = steps - fixed.snapshot().time as u64;
        let _ = left;
        let now = (fixed.time() / fixed.time_step()).round() as u64;
        fed.advance(steps - now);
        fixed.advance(steps - now);
        let (a, b) = (fed.snapshot(), fixed.snapshot());
        let (n, m) = (a.nodes[0], elements as usize + 1);
        let off = (1..20)
            .map(|i| {
                (a.position[n - i].lane(0) - X * (speed * (a.time - start)) - b.position[m - i].lane(0))
                    .norm()
            })
            .fold(0.0, f64::max);
        let way = (b.position[m - 1].lane(0) - seen.position[m - 1].lane(0)).norm();
        println!("{steps}: way {way:.3e}, off {off:.3e}");
    }
}

#[test]
fn energy_scan() {
    for scheme in [Scheme::SemiImplicitEuler, Scheme::Leapfrog, Scheme::ImplicitTension] {
        for viscosity in [0.0, 1e-3] {
            let mut last = 0.0;
            for step in [1.0, 0.5, 0.25] {
                let thread = Thread { element: 0.1, viscosity, scheme, step, ..Thread::new(28.6) };
                let case = thread.case(thread.time_of_turns(2.0));
                let mut flight = flight(&case, 0..1);
                let (mut worst, mut scale) = (0.0f64, 0.0f64);
                let pieces = 40;
                for piece in 1..=pieces {
                    flight.step_to(case.run.duration() * piece as f64 / pieces as f64).unwrap();
                    let e = flight.snapshot().energy;
                    worst = worst.max(e.imbalance().0[0].abs());
                    scale = e.gravity_work.0[0];
                }
                println!(
                    "{scheme:?} tau {viscosity} step {step}: {:.3e} of gravity's work, ratio {:.3}, steps/el {}, h {:e}",
                    worst / scale,
                    last / worst,
                    case.line.unwrap().steps_per_element,
                    case.run.time_step
                );
                last = worst;
            }
        }
        let mut last = 0.0;
        for div in [2.0, 4.0, 8.0, 16.0] {
            if scheme != Scheme::ImplicitTension && div > 2.0 {
                continue;
            }
            let mut case = spunbond(&[("run.scheme", scheme.name()), ("run.duration", "0.05 s")]);
            if scheme == Scheme::ImplicitTension {
                case.set_time_step(4e-3 / 50.0 / div);
            }
            let mut flight = flight(&case, 0..8);
            flight.step_to(0.05).unwrap();
            let e = flight.snapshot().energy;
            let scale = e.feed_work.0[0].abs() + e.drag_work.0[0].abs() + e.belt_work.0[0].abs();
            let imbalance = e.imbalance().0[0].abs();
            println!(
                "spunbond {scheme:?} h {:e}: {:.3e}, ratio {:.2}; drag {:.2e} feed {:.2e} belt {:.2e}",
                case.run.time_step,
                imbalance / scale,
                last / imbalance,
                e.drag_work.0[0],
                e.feed_work.0[0],
                e.belt_work.0[0]
            );
            last = imbalance;
        }
    }
}

#[test]
fn path_scan() {
    for scheme in [Scheme::SemiImplicitEuler, Scheme::Leapfrog, Scheme::ImplicitTension] {
        for viscosity in [0.0, 1e-3] {
            let ends: Vec<_> = [1.0, 0.5, 0.25, 0.125]
                .map(|step| {
                    let mut thread = Thread { element: 0.1, viscosity, scheme, step, ..Thread::new(28.6) };
                    thread.belt = 0.0;
                    let mut case = thread.case(0.9 * thread.height / thread.feed_speed());
                    case.fibre.direction = Vec3::new(0.8, 0.6, 0.0);
                    let mut flight = flight(&case, 0..1);
                    flight.step_to(case.run.duration()).unwrap();
                    let s = flight.snapshot();
                    s.position[s.nodes[0] - 1].lane(0)
                })
                .into();
            let d: Vec<f64> = ends.windows(2).map(|p| (p[1] - p[0]).norm()).collect();
            println!(
                "{scheme:?} {viscosity}: {:?} {:e} {:e} {:e} orders {:.2} {:.2}",
                ends[3],
                d[0],
                d[1],
                d[2],
                (d[0] / d[1]).log2(),
                (d[1] / d[2]).log2()
            );
        }
    }
}
