//! A mean flow that widens as it slows (`air.widening = "md"`), against the continuity equation and its streamlines.

use spunlaid_air::{
    Air, AirAtPlaces, Extent, FileContent, Flow, Hint, Lateral, Profile, StreamKey, Widening,
};
use spunlaid_fibre::{Case, Flight, Job, Snapshot};
use spunlaid_ground::place::Inlet;
use spunlaid_ground::{Isa, Vec3};
use spunlaid_input::read_case;
use std::path::PathBuf;
use std::sync::Arc;

/// Velocities of a plane diffuser [m/s], and its length [m].
const SPEEDS: [f64; 2] = [60.0, 10.0];
const LENGTH: f64 = 0.5;
/// Where the roots of the fibres are [m].
const PLACES: [f64; 3] = [-10e-3, 0.0, 4e-3];

fn profile(x: &[f64], velocity: &[f64]) -> Flow {
    let rows = Profile { x: x.to_vec(), velocity: velocity.to_vec(), ..Profile::default() };
    Flow::Profile(FileContent::new(PathBuf::from("profile.csv"), 1, Arc::new(rows)))
}

/// A light fibre that hangs in the air of the diffuser, without turbulence. Little friction pulls it straight.
const HANGING: &str = "
[fibre]
length = '0.4 m'
diameter = '18 µm'
density = '91 kg/m³'
youngs_modulus = '20 MPa'
element_length = '5 mm'
[air]
velocity = '30 m/s'
turbulence_intensity = 0
length_scale = '16 mm'
cutoff_frequency = '400 Hz'
[drag]
across = 'marheineke-wegener'
friction_coefficient = 0.03
[run]
duration = '0.4 s'
scheme = 'implicit-tension'
gravity = '0 m/s²'
";

fn case(widening: Widening) -> Case {
    let (mut case, _) = read_case((HANGING, "case.toml"), &[]).unwrap();
    case.air.flow = profile(&[0.0, LENGTH], &SPEEDS);
    case.air.widening = Some(widening);
    case
}

/// The last instant of the fibres at [`PLACES`], side by side.
fn simulated(case: &Case) -> Snapshot {
    let jobs = PLACES.map(|y| Job { place: Inlet { y, z: 0.0 }, ..Job::new(case, 0) });
    let mut flight = Flight::new(&jobs, Isa::detect()).unwrap();
    flight.advance(case.run.steps);
    flight.snapshot()
}

/// Places `(x, y)` of the nodes of a fibre, from the middle of the slot [m].
fn nodes(at: &Snapshot, lane: usize) -> Vec<(f64, f64)> {
    at.position.iter().map(|node| (node.x.0[lane], PLACES[lane] + node.y.0[lane])).collect()
}

#[test]
fn analytic_the_widening_flow_has_no_divergence() {
    let mut air = Air { widening: Some(Widening::MachineDirection), ..Air::uniform(30.0, 0.1, 16e-3, 400.0) };
    air.flow = profile(&[0.0, 0.1, 0.25, 0.5], &[60.0, 55.0, 25.0, 10.0]);
    air.speed_factor = 0.8;
    let mut hint = Hint::default();
    let mut velocity = |x: f64, y: f64| air.local(Vec3::new(x, y, 0.01), &mut hint).velocity;
    let h = 1e-3;
    for (x, rate) in [(0.05, 40.0), (0.2, 160.0), (0.4, 48.0), (-0.1, 0.0), (0.6, 0.0)] {
        for y in [-0.03, 0.0, 0.01] {
            let [before, after] = [-h, h].map(|by| velocity(x + by, y).x);
            let [below, above] = [-h, h].map(|by| velocity(x, y + by).y);
            let divergence = (after - before + above - below) / (2.0 * h);
            assert!(divergence.abs() < 1e-9, "{x} {y}: {divergence}");
            // −y dU/dx
            assert!((velocity(x, y).y - rate * y).abs() < 1e-12, "{x} {y}");
            assert_eq!(velocity(x, y).z, 0.0);
        }
    }
}

/// A fibre that the air hardly pulls lies along the streamline of its root, `y U(x) = y₀ U(0)`. The tension
/// `T` of the friction along it pulls it a little straight: with the drag `c` per length and velocity across
/// it, its slope differs by about `T y″/(c U)`, which makes up to 8 % of `y` in the first 0.3 m here. Without
/// the widening `y` would be off by half there.
#[test]
fn analytic_a_hanging_fibre_lies_along_a_streamline_of_a_diffuser() {
    let at = simulated(&case(Widening::MachineDirection));
    for (lane, place) in PLACES.into_iter().enumerate() {
        let nodes = nodes(&at, lane);
        assert!(nodes.iter().any(|(x, _)| *x > 0.3), "{place}");
        for (x, y) in nodes.into_iter().filter(|(x, _)| *x < 0.3) {
            let streamline = place * SPEEDS[0] / (SPEEDS[0] + (SPEEDS[1] - SPEEDS[0]) * x / LENGTH);
            let off = (y - streamline).abs();
            assert!(off <= 0.09 * streamline.abs(), "{place} {x}: {y} for {streamline}");
        }
    }
    // Where the air only slows, it blows past the fibre.
    let at = simulated(&case(Widening::None));
    for (lane, place) in PLACES.into_iter().enumerate() {
        assert!(nodes(&at, lane).iter().all(|(_, y)| *y == place), "{place}");
    }
}

/// The plane at the end of a profile, where the belt is: the air widens there as in the last interval, from
/// 15 to 10 m/s over 50 mm, `v = −y dU/dx`.
#[test]
fn analytic_the_air_widens_at_the_last_row_of_its_profile() {
    let mut case = case(Widening::MachineDirection);
    case.air.flow = profile(&[0.0, 0.4, 0.45, LENGTH], &[60.0, 20.0, 15.0, 10.0]);
    // Large eddies, of which few are made; they have no velocity here.
    (case.air.length_scale, case.air.cutoff_frequency) = (0.1, 50.0);
    case.air.lateral = Lateral::VonKarman { cutoff: 2.0 };
    let key = StreamKey { seed: 1, replicate: 0 };
    let extent = Extent { y: 0.2, z: 0.2 };
    let mut air = AirAtPlaces::new(&case.air, LENGTH, extent, key, 1).unwrap();
    let places = [0.0, 0.08, -0.02].map(|y| Vec3::new(LENGTH, y, 0.01));
    for (found, place) in air.velocities(0.0, &places).unwrap().into_iter().zip(places) {
        assert!((found.y - 100.0 * place.y).abs() < 1e-9, "{place:?}: {found:?}");
        assert!((found.x - 10.0).abs() < 1e-9 && found.z.abs() < 1e-9, "{place:?}: {found:?}");
    }
}
