//! What elements along the way feel of the signals at the stations.

use super::{FibreAir, FibreOnWay, StationGrid, Stations, Way};
use crate::field::Hint;
use crate::motion::{
    Air, Atmosphere, EddyModel, FileContent, Flow, Instant, Profile, Stream, StreamKey, Velocities, Widening,
    Wind,
};
use spunlaid_ground::place::Inlet;
use spunlaid_ground::{Isa, Lanes, PerLane, Plain, Vec3, WIDTH};
use std::sync::Arc;

const SPEED: f64 = 35.0;
const DECAY: f64 = 5e-3;
/// Elements to a spacing.
const QUARTERS: usize = 4;
/// Instants, and the time between two, many times that of an eddy [s].
const INSTANTS: usize = 400;
const APART: f64 = 0.0107;

/// Fluctuations that elements along the way feel, in eight lanes.
struct Fluctuations {
    grid: StationGrid,
    air: Atmosphere,
    position: Vec<Vec3<Lanes>>,
    looks: u64,
}

impl Fluctuations {
    fn new(eddies: EddyModel) -> Self {
        let air = Air { eddies, harmonics: 64, ..Air::uniform(SPEED, 0.1, 16e-3, 940.0) };
        let grid = air.stations(0.5);
        let stream = |replicate| Stream {
            air: air.clone(),
            eddies: air.turbulence_at(&grid),
            key: StreamKey { seed: 1, replicate },
        };
        let last = APART * (INSTANTS as f64 + 1.0);
        let wind = Wind::along(Isa::detect(), (0..WIDTH as u64).map(stream).collect(), last).unwrap();
        // The first element has its centre at the first station.
        let place = |j: usize| grid.spacing * (0.5 + (j as f64 - 0.5) / QUARTERS as f64);
        let position: Vec<_> = (0..(grid.count - 1) * QUARTERS + 2)
            .map(|j| Vec3::splat(Vec3::new(place(j), 0.0, 0.0)))
            .collect();
        let around = FibreAir { air: air.clone(), inlet: Inlet::default() };
        let lanes = PerLane::new(vec![FibreOnWay { around, grid }]).unwrap();
        let stations = Stations::new(Way::from_air(&air, &grid, 1), &lanes, position.len() - 1);
        Self { grid, air: Atmosphere::Way(wind, stations), position, looks: 0 }
    }

    /// At each element at a time: a number for each lane and component.
    fn at(&mut self, t: f64) -> Vec<Vec<f64>> {
        self.looks += 1;
        let now = Instant { step: self.looks, time: t };
        let Velocities::Way(velocities) = self.air.look::<Plain>(now, &self.position) else {
            panic!("another kind of air")
        };
        (0..self.position.len() - 1)
            .map(|j| {
                let felt = velocities.at(j).store();
                (0..WIDTH).flat_map(|i| [felt.x.0[i] - SPEED, felt.y.0[i], felt.z.0[i]]).collect()
            })
            .collect()
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Plain linear interpolation would leave half of the variance in the middle between independent stations.
#[test]
fn invariant_the_variance_between_stations_is_that_of_the_stations() {
    for eddies in [EddyModel::Independent, EddyModel::Convected { decay_time: DECAY }] {
        let mut felt = Fluctuations::new(eddies);
        let (mut sums, mut count) = ([0.0; QUARTERS], 0.0);
        for i in 0..INSTANTS {
            let values = felt.at(i as f64 * APART);
            // As many elements of each kind: the last station has none after it.
            for (j, values) in values[..values.len() - 1].iter().enumerate() {
                sums[j % QUARTERS] += product(values, values);
            }
            count += ((felt.grid.count - 1) * 3 * WIDTH) as f64;
        }
        let whole = 0.01 * SPEED * SPEED;
        // 400 instants, 24 signals and three or more eddies along the way: a standard error of less than
        // 0.85 %. Neighbours of carried eddies know of each other, so that their ratio is more certain.
        for sum in sums {
            assert!(
                (sum / count / whole - 1.0).abs() < 0.035,
                "{eddies:?}: {:?}",
                sums.map(|s| s / count / whole)
            );
        }
        if eddies != EddyModel::Independent {
            for sum in sums {
                assert!((sum / sums[0] - 1.0).abs() < 0.005, "{:?}", sums.map(|s| s / sums[0]));
            }
        }
    }
}

#[test]
fn analytic_a_carried_pattern_forgets_itself_with_its_decay_time() {
    let mut felt = Fluctuations::new(EddyModel::Convected { decay_time: DECAY });
    for share in [0.2, 0.5, 1.0] {
        let lag = (share * DECAY * SPEED / felt.grid.spacing).round() as usize;
        let later = lag as f64 * felt.grid.spacing / SPEED;
        let (mut both, mut own) = (0.0, 0.0);
        for i in 0..INSTANTS {
            let t = i as f64 * APART;
            let [now, then] = [t, t + later].map(|t| felt.at(t));
            for (now, then) in now.iter().step_by(QUARTERS).zip(then.iter().step_by(QUARTERS).skip(lag)) {
                both += product(now, then);
                own += 0.5 * (product(now, now) + product(then, then));
            }
        }
        let expected = (-later / DECAY).exp();
        // As above, for the product of two signals.
        assert!((both / own - expected).abs() < 0.03, "{share}: {} for {expected}", both / own);
    }
}

/// Without turbulence, elements at any distance from the middle feel the velocity of the profile and of
/// its widening.
#[test]
fn analytic_fed_fibres_feel_the_widening_of_a_profile() {
    let rows = Profile { x: vec![0.0, 0.5], velocity: vec![60.0, 10.0], ..Profile::default() };
    let flow = Flow::Profile(FileContent::new("profile.csv".into(), 1, Arc::new(rows)));
    for widening in Widening::ALL {
        let eddies = EddyModel::Convected { decay_time: DECAY };
        let air = Air {
            flow: flow.clone(),
            widening: Some(widening),
            eddies,
            ..Air::uniform(SPEED, 0.0, 16e-3, 940.0)
        };
        let grid = air.stations(0.5);
        let eddies = air.turbulence_at(&grid);
        let stream = Stream { air: air.clone(), eddies, key: StreamKey { seed: 1, replicate: 0 } };
        let wind = Wind::along(Isa::detect(), vec![stream], 1.0).unwrap();
        let roots = [0.01, -0.004];
        let around = |y| FibreAir { air: air.clone(), inlet: Inlet { y, z: 0.0 } };
        let lanes = PerLane::new(roots.map(|y| FibreOnWay { around: around(y), grid }).to_vec()).unwrap();
        // Elements of a fibre that leans, between the first and the last station.
        let position: Vec<_> =
            (1..25).map(|j| Vec3::splat(Vec3::new(0.02 * f64::from(j), 1e-3 * f64::from(j), 2e-3))).collect();
        let stations = Stations::new(Way::from_air(&air, &grid, 1), &lanes, position.len() - 1);
        let mut air_at_fibre = Atmosphere::Way(wind, stations);
        let now = Instant { step: 0, time: 0.0 };
        let Velocities::Way(velocities) = air_at_fibre.look::<Plain>(now, &position) else {
            panic!("another kind of air")
        };
        for (lane, root) in roots.into_iter().enumerate() {
            for (j, ends) in position.windows(2).enumerate() {
                let middle = (ends[0].lane(lane) + ends[1].lane(lane)) * 0.5;
                let at = Vec3::new(middle.x, middle.y + root, middle.z);
                let expected = air.local(at, &mut Hint::default()).velocity;
                let felt = velocities.at(j).store().lane(lane);
                assert!((felt - expected).norm() < 1e-10, "{widening:?} {at:?}: {felt:?} for {expected:?}");
                let rate = if widening == Widening::None { 0.0 } else { 100.0 };
                assert!((expected.y - rate * at.y).abs() < 1e-10, "{at:?}: {expected:?}");
            }
        }
    }
}

/// Three eddies of 10 mm pass in 0.5 ms at 60 m/s, and three quarters of a period of 50 Hz in 15 ms.
#[test]
fn analytic_air_is_correlated_while_eddies_pass_or_for_its_shortest_period() {
    let memory = |intensity: f64, cutoff: f64| Air::uniform(60.0, intensity, 10e-3, cutoff).memory();
    for (found, wanted) in [(memory(0.1, 10e3), 5e-4), (memory(0.1, 50.0), 15e-3), (memory(0.0, 50.0), 0.0)] {
        assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
    }
    assert_eq!(Air::uniform(0.0, 0.1, 10e-3, 50.0).memory(), 0.0);
}
