//! Cases with random values, of fixed and of fed fibres: writing and reading gives the same bits.

use crate::cases::{bits, read_again, remarks};
use proptest::prelude::*;
use spunlaid_air::{Air, EddyModel, Lateral};
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{
    Case, Checks, Contact, Drag, FLIGHT_MEMORY_LIMIT, Fibre, FrictionLaw, Line, NormalLaw, Root, Run,
};
use spunlaid_ground::Vec3;
use spunlaid_input::{read_case, starter_case, write_case};

/// A number between powers of ten, with all its digits.
fn between(low: i32, high: i32) -> impl Strategy<Value = f64> {
    (f64::from(low)..f64::from(high)).prop_map(|power| 10f64.powf(power))
}

prop_compose! {
    fn fibre()(
        length in between(-2, 2), diameter in between(-5, -3), density in between(2, 4),
        youngs_modulus in between(7, 11),
        elements in 1usize..3000, root in prop::sample::select(vec![Root::Pinned, Root::Clamped, Root::Free]),
        x in prop_oneof![-1f64..-1e-3, 1e-3f64..1.0], y in -1f64..1.0, z in prop::sample::select(vec![0.0, -0.0, 0.3]),
    ) -> Fibre {
        let v = Vec3::new(x, y, z);
        let direction = v * (1.0 / v.norm());
        let n = direction.norm();
        let direction = Vec3::new(direction.x / n, direction.y / n, direction.z / n);
        Fibre {
            length,
            diameter,
            density,
            youngs_modulus,
            elements,
            root,
            direction,
            ..Fibre::UNKNOWN
        }
    }
}

fn lateral() -> impl Strategy<Value = Lateral> {
    prop_oneof![Just(Lateral::Uniform), between(0, 2).prop_map(|cutoff| Lateral::VonKarman { cutoff })]
}

fn friction_law() -> impl Strategy<Value = FrictionLaw> {
    let [_, others @ ..] = FrictionLaw::ALL;
    prop_oneof![
        (0f64..2.0).prop_map(|factor| FrictionLaw::Matsui { factor }),
        prop::sample::select(others.to_vec())
    ]
}

prop_compose! {
    fn case()(
        fibre in fibre(),
        (velocity, turbulence_intensity, length_scale, cutoff_frequency)
            in (-50f64..50.0, 0f64..1.0, between(-2, 1), between(0, 3)),
        (density, kinematic_viscosity, more_harmonics, along, across) in (
            0f64..2.0, between(-6, -4), 1usize..50, friction_law(), prop::sample::select(NormalLaw::ALL.to_vec()),
        ),
        (share, steps, spin_up, output, damping)
            in (0.01f64..0.99, 1u64..1_000_000_000, 0f64..1.0, 0f64..1.0, 0f64..100.0),
        (replicates, seed, leapfrog, gravity, lateral)
            in (1u64..100, any::<u64>(), any::<bool>(), -10f64..10.0, lateral()),
    ) -> Case {
        let air = Air {
            velocity, turbulence_intensity, length_scale, cutoff_frequency, density, kinematic_viscosity,
            harmonics: 1, lateral,
            ..Air::uniform(1.0, 0.0, 1.0, 1.0)
        };
        let scheme = if leapfrog { Scheme::Leapfrog } else { Scheme::SemiImplicitEuler };
        let spin_up_steps = (spin_up * steps as f64) as u64;
        let output_steps = 1 + (output * (steps - 1) as f64) as u64;
        let run = Run {
            time_step: 1.0, steps, spin_up_steps, output_steps, replicates, seed, scheme, gravity, damping,
            shapes: leapfrog.then_some(seed % 20_001), checks: Checks::ALL[(seed % 3) as usize],
            ..Run::UNKNOWN
        };
        let drag = Drag { along, across };
        let mut case = Case { fibre, air, drag, line: None, spinline: None, run };
        let limit = case.stable_step_limits().iter().map(|limit| limit.limit).fold(f64::INFINITY, f64::min);
        case.run.time_step = share * limit;
        case.air.harmonics = (case.air.cutoff_frequency * case.run.duration()) as usize + more_harmonics;
        case
    }
}

fn contact() -> impl Strategy<Value = Contact> {
    let friction = (0f64..2.0, 0f64..1000.0)
        .prop_map(|(coefficient, suction)| Contact::Friction { coefficient, suction });
    prop_oneof![Just(Contact::Stick), friction]
}

prop_compose! {
    /// A case whose fibre is fed on to a belt. All of them are valid.
    fn fed_case()(
        case in case(),
        (distance, elements, feed_speed, belt_speed) in (between(-2, 1), 3usize..1000, between(-2, 2), 0f64..10.0),
        (kept_length, contact, share) in (between(-3, 0), contact(), 0.1f64..0.9),
        (decay_time, convected, implicit, pinned) in (between(-4, 0), any::<bool>(), any::<bool>(), any::<bool>()),
        viscosity in prop_oneof![Just(0.0), between(-3, 1)],
        (cycles, spin_up, output, more_harmonics) in (between(-1, 3), 0f64..1.0, 1e-3f64..1.0, 1usize..50),
    ) -> Case {
        let mut case = case;
        // Elements are at least as long as the fibre is thick.
        let element = (distance / elements as f64).max(case.fibre.diameter);
        case.fibre.span(distance, element);
        case.fibre.direction = case.fibre.direction * case.fibre.direction.x.signum();
        case.fibre.root = if pinned { Root::Pinned } else { Root::Clamped };
        case.air.length_scale = case.air.length_scale.max(0.05 * distance);
        if convected {
            case.air.eddies = EddyModel::Convected { decay_time };
        }
        // No other scheme computes how a fibre slides.
        if implicit || contact != Contact::Stick {
            case.run.scheme = Scheme::ImplicitTension;
        }
        let feeding = case.fibre.rest_length() / feed_speed;
        case.line = Some(Line { feed_speed, distance, belt_speed, contact, kept_length, steps_per_element: 2 });
        let limit = |case: &Case| {
            case.stable_step_limits().iter().map(|limit| limit.limit).fold(f64::INFINITY, f64::min)
        };
        // In times of the limit without it: up to a step ten times as short.
        case.fibre.bending_viscosity_time = viscosity * limit(&case);
        let limit = limit(&case);
        case.set_time_step(share * limit.min(0.5 * feeding));
        let run = &mut case.run;
        run.steps = (cycles / case.air.cutoff_frequency / run.time_step).ceil().min(1e9) as u64;
        run.spin_up_steps = (spin_up * run.steps as f64) as u64;
        run.output_steps = 1 + (output * (run.steps - 1) as f64) as u64;
        case.air.harmonics = cycles as usize + more_harmonics;
        // A field of many generations takes more memory than is allowed.
        if case.flight_memory().total() > FLIGHT_MEMORY_LIMIT {
            case.air.lateral = Lateral::Uniform;
        }
        case
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn identical_fed_cases_after_writing_and_reading(case in fed_case()) {
        prop_assert!(case.check().is_ok(), "{:?}", case.check());
        prop_assert_eq!(bits(&read_again(&case)), bits(&case));
    }

    #[test]
    fn identical_after_writing_and_reading(case in case()) {
        prop_assume!(case.check().is_ok());
        prop_assert_eq!(bits(&read_again(&case)), bits(&case));
    }

    #[test]
    fn identical_once_rounded(
        length in 0.1f64..3.0, element in 1e-2f64..0.2, step in 1e-8f64..5e-6, duration in 1e-4f64..2.0,
        output in 1e-7f64..1e-4,
    ) {
        let set = [
            ("fibre.length", format!("{length} m")), ("fibre.element_length", format!("{element} m")),
            ("run.time_step", format!("{step} s")), ("run.duration", format!("{duration} s")),
            ("run.output_interval", format!("{output} s")),
        ].map(|(key, value)| (key.to_owned(), value));
        let read = read_case((starter_case(), "starter.toml"), &set);
        prop_assume!(read.is_ok());
        let (case, _) = read.unwrap();
        prop_assert!((case.run.duration() / duration - 1.0).abs() < 1e-14);
        prop_assert!(case.run.time_step <= step * (1.0 + 1e-14));
        prop_assert_eq!(bits(&read_again(&case)), bits(&case));
        // What has been resolved leaves nothing to remark on rounding.
        let notes = remarks(&write_case(&case));
        prop_assert!(notes.iter().all(|note| !note.contains("whole number")), "{:?}", notes);
    }
}
