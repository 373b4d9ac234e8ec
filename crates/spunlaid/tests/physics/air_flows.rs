//! Air that varies in space, compared with flows in closed form.

use crate::{cases, meshes};
use spunlaid_air::{
    Air, Atmosphere, Axis, Eddies, Field, FileContent, Flow, FlowNumbers, Hint, PlacedField, Profile,
    StreamKey, Surroundings, Values, Wind,
};
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Case, Flight};
use spunlaid_ground::{Error, Isa, RunContext, Vec3};
use spunlaid_input::read_case;
use spunlaid_simulation::ensemble::fly;
use spunlaid_simulation::{KeepShapes, Recorded, Trajectory};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64};

fn table1(changes: &[(&str, &str)]) -> Case {
    let changes: Vec<_> =
        changes.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    read_case((cases::papers_starter(), "Table 1"), &changes).unwrap().0
}

fn flights(case: &Case) -> Vec<Trajectory> {
    let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let computing = RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &steps };
    let mut flights = Vec::new();
    fly::<Error>(
        case,
        Recorded { shapes: KeepShapes { replicates: 1, every: 1 }, ..Recorded::SAMPLES },
        computing,
        |flight| {
            flights.push(flight);
            Ok(())
        },
    )
    .unwrap();
    flights
}

fn profile(profile: Profile) -> Flow {
    Flow::Profile(FileContent::new(PathBuf::from("profile.csv"), 1, Arc::new(profile)))
}

/// A field of 3 × 3 × 3 points in a box from `low` to `high`, values from a function of the place.
fn field(
    low: Vec3<f64>,
    high: Vec3<f64>,
    velocity: impl Fn(Vec3<f64>) -> Vec3<f64>,
    turbulence: impl Fn(Vec3<f64>) -> (f64, f64),
) -> Field {
    let row = |a: f64, b: f64| vec![a, 0.5 * (a + b), b];
    let axes = [row(low.x, high.x), row(low.y, high.y), row(low.z, high.z)];
    let mut values = Values::default();
    for &z in &axes[2] {
        for &y in &axes[1] {
            for &x in &axes[0] {
                let at = Vec3::new(x, y, z);
                values.velocity.push(velocity(at));
                let (k, epsilon) = turbulence(at);
                values.k.push(k);
                values.epsilon.push(epsilon);
            }
        }
    }
    Field::lattice(axes, &values).unwrap()
}

fn placed(field: Field, root: Vec3<f64>, axis: Axis, unit: f64) -> Flow {
    let machine_direction = PlacedField::usual_machine_direction(&field, axis);
    let field = FileContent::new(PathBuf::from("field.vti"), 1, Arc::new(field));
    Flow::Field(Box::new(PlacedField {
        field,
        root,
        axis,
        machine_direction,
        unit,
        length_constant: 0.43,
        time_constant: 0.3,
    }))
}

const REPORTED: FlowNumbers =
    FlowNumbers { turbulence_intensity: true, length_scale: true, cutoff_frequency: true };

/// A profile with the same values everywhere as the uniform case makes the same flight. Only rounding differs,
/// and the motion of the taut fibre does not amplify it.
#[test]
fn analytic_a_constant_profile_is_the_uniform_flow() {
    let uniform = table1(&[("run.time_step", "20 µs"), ("run.duration", "0.2 s"), ("run.replicates", "3")]);
    let mut case = uniform.clone();
    let constant = |value| vec![value; 2];
    case.air.flow = profile(Profile {
        x: vec![-1.0, 2.0],
        velocity: constant(10.0),
        turbulence_intensity: constant(0.1),
        length_scale: constant(0.05),
        cutoff_frequency: constant(100.0),
    });
    case.air.from_flow = REPORTED;
    case.air.settle_along(case.along());
    assert_eq!(case.check().unwrap(), []);
    for (one, other) in flights(&uniform).iter().zip(&flights(&case)) {
        assert_eq!(other.number("share_outside_flow"), 0.0);
        for (a, b) in one.samples.iter().zip(&other.samples) {
            assert!((a.end - b.end).norm() < 1e-9, "{} s: {}", a.time, (a.end - b.end).norm());
        }
    }
}

/// A straight fibre at rest in a flow that is linear in space: the acceleration of its elements in the first step
/// follows from the drag law at the velocity of their centres.
#[test]
fn analytic_elements_feel_the_velocity_at_their_centres() {
    let shear = |at: Vec3<f64>| Vec3::new(4.0 + 3.0 * at.x, 1.0 - 0.5 * at.x, 0.25 * at.x);
    let (low, high) = (Vec3::new(-0.1, -1.0, -1.0), Vec3::new(1.5, 1.0, 1.0));
    let mut case = table1(&[("run.gravity", "0 m/s²"), ("fibre.root", "free")]);
    case.air.flow = placed(field(low, high, shear, |_| (0.0, 0.0)), Vec3::default(), Axis::ALL[0], 1.0);
    let (n, h) = (case.fibre.elements, 1e-6);
    let key = StreamKey { seed: 1, replicate: 0 };
    let calm = Air { turbulence_intensity: 0.0, ..case.air.clone() };
    let eddies = Eddies::along(1.0, n, 0.05);
    let turbulence = Wind::uniform(
        Isa::detect(),
        &[(Air { velocity: 0.0, flow: Flow::Uniform, ..calm.clone() }, key)],
        eddies.count(),
        0.01,
    )
    .expect("fibres that agree");
    let surroundings = Surroundings::new(vec![calm], n, 5).expect("one air");
    let strand = case.strand();
    let air = Atmosphere::from((&eddies, &turbulence, surroundings));
    let mut flight = Flight::assembled(Isa::detect(), &[strand], air, Scheme::SemiImplicitEuler, h)
        .expect("fibres that agree");
    flight.advance(1);

    let drag = |j: usize| {
        let v = shear(Vec3::new((j as f64 + 0.5) / n as f64, 0.0, 0.0));
        let across = Vec3::new(0.0, v.y, v.z);
        let d = strand.drag;
        let along = d.along.force(v.x, 0.0) * v.x.signum();
        across * (d.across.force(across.norm(), 0.0) / across.norm()) + Vec3::new(along, 0.0, 0.0)
    };
    for i in 1..n {
        let force = (drag(i - 1) + drag(i)) * 0.5;
        let wanted = force * (h / case.fibre.node_mass(i));
        let got = flight.chain().velocity[i].lane(0);
        // The powers are good to 1e-7.
        assert!((got - wanted).norm() < 1e-7 * wanted.norm(), "node {i}: {got:?} {wanted:?}");
    }
}

/// Between looks the air is extrapolated linearly. A flight with a look at every step and one with the case's own
/// interval differ only to second order.
#[test]
fn order_the_air_between_looks_is_of_second_order() {
    let swirl = |at: Vec3<f64>| Vec3::new(10.0 - 4.0 * at.x, 2.0 + 40.0 * at.z, -40.0 * at.y);
    let (low, high) = (Vec3::new(-0.1, -0.5, -0.5), Vec3::new(1.5, 0.5, 0.5));
    let mut case = table1(&[("run.duration", "0.1 s")]);
    case.air.flow = placed(field(low, high, swirl, |_| (0.0, 0.0)), Vec3::default(), Axis::ALL[0], 1.0);
    let eddies = case.eddies();
    let still = Air { velocity: 0.0, flow: Flow::Uniform, ..case.air.clone() };
    let key = StreamKey { seed: 1, replicate: 0 };
    let turbulence =
        Wind::uniform(Isa::detect(), &[(still, key)], eddies.count(), 0.11).expect("fibres that agree");
    let calm = Air { turbulence_intensity: 0.0, ..case.air.clone() };
    let path = |every: u64| {
        let surroundings =
            Surroundings::new(vec![calm.clone()], case.fibre.elements, every).expect("one air");
        let air = Atmosphere::from((&eddies, &turbulence, surroundings));
        let mut flight = Flight::assembled(Isa::detect(), &[case.strand()], air, Scheme::Leapfrog, 1e-5)
            .expect("fibres that agree");
        let mut path = Vec::new();
        for _ in 0..100 {
            flight.advance(100);
            path.push(flight.chain().position[20].lane(0));
        }
        path
    };
    let exact = path(1);
    let error = |every: u64| {
        let path = path(every);
        let squares: f64 = path.iter().zip(&exact).map(|(a, b)| (*a - *b).dot(*a - *b)).sum();
        (squares / exact.len() as f64).sqrt()
    };
    let amplitude = exact.iter().map(|p| (p.y * p.y + p.z * p.z).sqrt()).fold(0.0, f64::max);
    assert!(amplitude > 0.01, "{amplitude}");
    let (coarse, fine) = (error(200), error(100));
    let order = (coarse / fine).log2();
    assert!((1.7..2.6).contains(&order), "order {order}: {coarse:e} {fine:e}");
    assert!(error(case.steps_between_looks() / 10) < 1e-4 * amplitude);
}

/// The interval between looks follows the gradients of the field, not only its eddies: waves of 20 mm.
#[test]
fn the_interval_between_looks_follows_the_gradients() {
    let wave = |s: f64| 4.0 * (s * std::f64::consts::TAU / 0.02).sin();
    let row = |low: f64, high: f64, n: usize| -> Vec<f64> {
        (0..=n).map(|i| low + (high - low) * i as f64 / n as f64).collect()
    };
    let axes = [row(-0.1, 1.2, 1), row(-0.12, 0.12, 240), row(-0.12, 0.12, 240)];
    let mut values = Values::default();
    for &z in &axes[2] {
        for &y in &axes[1] {
            values.velocity.extend(axes[0].iter().map(|_| Vec3::new(10.0, wave(z) + 1.0, wave(y))));
        }
    }
    let waves = Field::lattice(axes, &values).unwrap();
    let mut case = table1(&[("run.duration", "0.1 s"), ("air.length_scale", "500 mm")]);
    case.run.time_step = 1e-5;
    case.air.flow = placed(waves, Vec3::default(), Axis::ALL[0], 1.0);
    let calm = Air { turbulence_intensity: 0.0, ..case.air.clone() };
    let eddies = case.eddies();
    let still = Air { velocity: 0.0, flow: Flow::Uniform, ..case.air.clone() };
    let key = StreamKey { seed: 1, replicate: 0 };
    let wind = Wind::uniform(Isa::detect(), &[(still, key)], eddies.count(), 0.11).unwrap();
    let path = |every: u64| -> Vec<Vec3<f64>> {
        let surroundings = Surroundings::new(vec![calm.clone()], case.fibre.elements, every).unwrap();
        let air = Atmosphere::from((&eddies, &wind, surroundings));
        let strands = [case.strand()];
        let mut flight = Flight::assembled(Isa::detect(), &strands, air, Scheme::Leapfrog, 1e-5).unwrap();
        let place = |_| {
            flight.advance(100);
            flight.chain().position[case.fibre.elements].lane(0)
        };
        (0..100).map(place).collect()
    };
    let (exact, found) = (path(1), path(case.steps_between_looks()));
    let farthest = exact.iter().map(|p| p.y.hypot(p.z)).fold(0.0, f64::max);
    let off = exact.iter().zip(&found).map(|(a, b)| (*a - *b).norm()).fold(0.0, f64::max);
    assert!(farthest > 0.01 && off < 1e-3 * farthest, "{off:e} of {farthest}");
}

/// k and ε of a uniform turbulence: rms √(2k/3), length scale C_L k^1.5/ε, and the cut-off frequency from passing
/// and decay. A speed factor changes them by similarity.
#[test]
fn analytic_turbulence_from_k_and_epsilon() {
    let (k, epsilon) = (1.5, 30.0);
    let (low, high) = (Vec3::new(-0.1, -0.2, -0.2), Vec3::new(1.5, 0.2, 0.2));
    let uniform = field(low, high, |_| Vec3::new(8.0, 0.0, 0.0), |_| (k, epsilon));
    let mut air = Air {
        flow: placed(uniform, Vec3::default(), Axis::ALL[0], 1.0),
        from_flow: REPORTED,
        ..Air::uniform(1.0, 0.0, 1.0, 1.0)
    };
    let at = Vec3::new(0.5, 0.01, 0.0);
    let slow = air.local(at, &mut Hint::default());
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12 * b.abs(), "{a} {b}");
    near(slow.rms, 1.0);
    let length = 0.43 * k.powf(1.5) / epsilon;
    near(slow.length_scale, length);
    near(slow.cutoff_frequency, 0.25 * (8.0 / length + epsilon / (0.3 * k)));
    air.speed_factor = 2.0;
    let fast = air.local(at, &mut Hint::default());
    near(fast.velocity.x, 16.0);
    near(fast.rms, 2.0);
    near(fast.length_scale, length);
    near(fast.cutoff_frequency, 2.0 * slow.cutoff_frequency);
    air.settle_along(Vec3::new(1.0, 0.0, 0.0));
    near(air.velocity, 16.0);
    near(air.turbulence_intensity, 0.125);
    // Eddies twice as long at half the rms take twice the time to pass, and four times to decay.
    (air.speed_factor, air.length_factor, air.intensity_factor) = (1.0, 2.0, 0.5);
    let longer = air.local(at, &mut Hint::default());
    near(longer.rms, 0.5);
    near(longer.length_scale, 2.0 * length);
    near(longer.cutoff_frequency, 0.25 * (8.0 / (2.0 * length) + epsilon / (0.3 * k) / 4.0));
}

/// Where a profile gives the turbulence, factors on its eddies and its intensity keep their places, and the
/// cut-off follows by Taylor's hypothesis.
#[test]
fn analytic_longer_eddies_of_a_profile_pass_more_slowly() {
    let table = Profile {
        x: vec![0.0, 1.0],
        velocity: vec![40.0, 20.0],
        turbulence_intensity: vec![0.1, 0.2],
        length_scale: vec![0.01, 0.03],
        cutoff_frequency: vec![1000.0, 400.0],
    };
    let plain = Air { flow: profile(table), from_flow: REPORTED, ..Air::uniform(1.0, 0.0, 1.0, 1.0) };
    let changed = Air { length_factor: 2.0, intensity_factor: 0.5, ..plain.clone() };
    for x in [0.0, 0.25, 1.0] {
        let at = Vec3::new(x, 0.0, 0.0);
        let [before, after] = [&plain, &changed].map(|air| air.local(at, &mut Hint::default()));
        assert_eq!(after.velocity, before.velocity);
        for (after, before) in [
            (after.rms, 0.5 * before.rms),
            (after.length_scale, 2.0 * before.length_scale),
            (after.cutoff_frequency, 0.5 * before.cutoff_frequency),
        ] {
            assert!((after / before - 1.0).abs() < 1e-12, "{x}: {after} {before}");
        }
    }
    // Without a flow that gives them there is nothing to multiply.
    let uniform = [("air.length_factor".to_owned(), "2".to_owned())];
    let refused = read_case((cases::papers_starter(), "Table 1"), &uniform).unwrap_err().to_string();
    assert!(
        refused.contains("a profile or a field that gives length_scale; change air.length_scale"),
        "{refused}"
    );
}

/// A field in millimetres whose flow is along −z gives the flight that the same flow along x does.
#[test]
fn analytic_a_field_turned_and_in_other_units_is_the_same_air() {
    let short = [("run.time_step", "20 µs"), ("run.duration", "0.1 s"), ("run.replicates", "2")];
    let (mut straight, mut turned) = (table1(&short), table1(&short));
    let flow = |x: f64, y: f64, z: f64| Vec3::new(10.0 - 3.0 * x, 0.5 * y, 0.5 * z);
    let turbulence = |x: f64| (0.5 + 0.2 * x, 20.0 + 10.0 * x);
    let (low, high) = (Vec3::new(-0.5, -0.5, -0.5), Vec3::new(1.5, 0.5, 0.5));
    let along_x = field(low, high, |p| flow(p.x, p.y, p.z), |p| turbulence(p.x));
    straight.air.flow = placed(along_x, Vec3::default(), Axis::ALL[0], 1.0);
    // x of the fibre is −z of the field, y is −x, z is y; the root is 7 m up, in the middle of the box.
    let there = |p: Vec3<f64>| (7.0 - 1e-3 * p.z, 0.3 - 1e-3 * p.x, 1e-3 * p.y - 0.2);
    let low = Vec3::new(-200.0, -300.0, 5500.0);
    let high = Vec3::new(800.0, 700.0, 7500.0);
    let turned_flow = |p: Vec3<f64>| {
        let (x, y, z) = there(p);
        let v = flow(x, y, z);
        Vec3::new(-v.y, v.z, -v.x)
    };
    let down = field(low, high, turned_flow, |p| turbulence(there(p).0));
    turned.air.flow = placed(down, Vec3::new(0.3, 0.2, 7.0), Axis::ALL[5], 1e-3);
    for case in [&mut straight, &mut turned] {
        case.air.from_flow = REPORTED;
        case.air.settle_along(case.along());
        case.air.harmonics = case.air.default_harmonics(0.1);
        case.check().unwrap();
    }
    for (a, b) in flights(&straight).iter().zip(&flights(&turned)) {
        let difference = (a.samples[100].end - b.samples[100].end).norm();
        assert!(difference < 1e-8, "{difference:e}");
    }
}

/// Eddies grow down the flow, as long as the length scale where they begin.
#[test]
fn analytic_eddies_grow_with_the_length_scale() {
    // L(s) = 0.1 + 0.5 s: borders 0, 0.1, 0.25, 0.475, 0.8125.
    let eddies = Eddies::growing(1.0, 40, |s| 0.1 + 0.5 * s);
    let borders = [0.1, 0.25, 0.475, 0.8125, 2.0];
    for (j, &eddy) in eddies.index_of_element().iter().enumerate() {
        let centre = (j as f64 + 0.5) / 40.0;
        assert_eq!(eddy as usize, borders.iter().filter(|border| **border <= centre).count(), "{j}");
    }
    assert_eq!(eddies.count(), 5);
}

/// Elements outside the data are counted, and a warning says so before the run.
#[test]
fn a_fibre_that_leaves_the_flow_is_reported() {
    let mut case = table1(&[("run.time_step", "20 µs"), ("run.duration", "0.05 s"), ("run.replicates", "1")]);
    let velocity = vec![10.0, 10.0];
    case.air.flow = profile(Profile { x: vec![0.0, 0.5], velocity, ..Profile::default() });
    let notes = case.check().unwrap();
    assert_eq!(notes.len(), 1);
    assert!(notes[0].to_string().contains("out of the region where the flow is known"), "{}", notes[0]);
    // Ten of twenty elements hang below; a few less when the end rises.
    let outside = flights(&case)[0].number("share_outside_flow");
    assert!((0.45..=0.55).contains(&outside), "{outside}");
}

/// The flight of a fibre in a field does not depend on its neighbours, the threads or the instruction set.
#[test]
fn identical_in_any_flight_on_any_instruction_set() {
    let (low, high) = (Vec3::new(-0.5, -0.5, -0.5), Vec3::new(0.9, 0.5, 0.5));
    let flow = |p: Vec3<f64>| Vec3::new(10.0 - 3.0 * p.x, 4.0 * p.z, -4.0 * p.y);
    let lattice = || field(low, high, flow, |p| (0.5 + 0.2 * p.x, 20.0 + 10.0 * p.x));
    check_identical(|| placed(lattice(), Vec3::default(), Axis::ALL[0], 1.0));
    // The fibre hangs on faces between cells.
    let waves = |[x, y, z]: [f64; 3]| {
        [10.0 + (6.0 * y).sin(), (5.0 * x).cos(), (4.0 * z * x).sin(), 0.5 + 0.2 * x, 20.0 + 10.0 * x]
    };
    let mesh = || meshes::field(&meshes::Block::cube(32, 0.0), meshes::Made::Hexahedra, waves);
    check_identical(|| placed(mesh(), Vec3::new(0.0, 0.5, 0.5), Axis::ALL[0], 1.0));
}

/// * `flow` – made again for each run, because a field keeps what is looked up in it
fn check_identical(flow: impl Fn() -> Flow) {
    let mut case =
        table1(&[("run.time_step", "20 µs"), ("run.scheme", "leapfrog"), ("run.duration", "0.05 s")]);
    case.run.replicates = 11;
    case.air.flow = flow();
    case.air.from_flow = REPORTED;
    case.air.settle_along(case.along());
    case.air.harmonics = case.air.default_harmonics(0.1);
    let bits = |flight: &Trajectory| -> Vec<u64> {
        flight.samples.iter().flat_map(|s| [s.end.x, s.end.y, s.end.z]).map(f64::to_bits).collect()
    };
    let whole = flights(&case);
    for isa in Isa::available() {
        for threads in [1, 3] {
            let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
            let computing = RunContext { threads, isa, stop: &stop, done: &steps };
            let mut fewer = case.clone();
            fewer.run.replicates = 3;
            fewer.air.flow = flow();
            let mut n = 0;
            fly::<Error>(&fewer, Recorded::SAMPLES, computing, |flight| {
                assert_eq!(bits(&flight), bits(&whole[n]), "{} {threads}", isa.name());
                n += 1;
                Ok(())
            })
            .unwrap();
            assert_eq!(n, 3);
        }
    }
}
