//! The amplitude of a melt-blowing fibre along its way beside a measured one, as a trend.

use spunlaid_air::{FileContent, Flow};
use spunlaid_fibre::{Case, Flight, Job};
use spunlaid_ground::{Isa, WIDTH};
use spunlaid_input::read_case;
use std::path::Path;
use std::sync::Arc;

/// Mean amplitudes at distances from the die [mm]: Polymers 2024, 16, 469, abstract (hot wire and high-speed camera).
const MEASURED: [[f64; 2]; 4] = [[15.0, 1.05], [25.0, 1.71], [40.0, 2.83], [55.0, 3.97]];

/// The standard deviation across the flow of a replicate of each lane, at the distances of the measurement [mm].
fn amplitudes(case: &Case) -> [f64; 4] {
    let jobs: Vec<Job<'_>> = (0..WIDTH as u64).map(|replicate| Job::new(case, replicate)).collect();
    let mut flight = Flight::new(&jobs, Isa::detect()).unwrap();
    let (mut squares, mut count) = ([0.0; 4], 0.0);
    for instant in 0.. {
        let time = case.run.spin_up() + f64::from(instant) * case.run.output_interval();
        if time > case.run.duration() {
            break;
        }
        flight.step_to(time).unwrap();
        let snapshot = flight.snapshot();
        for lane in 0..WIDTH {
            let ends = snapshot.position[..snapshot.in_air[lane]].windows(2);
            let ends: Vec<_> = ends.map(|ends| [ends[0].lane(lane), ends[1].lane(lane)]).collect();
            for (square, [x, _]) in squares.iter_mut().zip(MEASURED) {
                let [a, b] = ends.iter().find(|ends| ends[1].x > 1e-3 * x).unwrap();
                let at = *a + (*b - *a) * ((1e-3 * x - a.x) / (b.x - a.x));
                *square += 0.5 * (at.y * at.y + at.z * at.z);
            }
            count += 1.0;
        }
    }
    squares.map(|square| 1e3 * (square / count).sqrt())
}

/// The exponent with which amplitudes grow with the distance, by least squares.
fn exponent(amplitudes: [f64; 4]) -> f64 {
    let logs: Vec<[f64; 2]> =
        MEASURED.iter().zip(amplitudes).map(|([x, _], amplitude)| [x.ln(), amplitude.ln()]).collect();
    let mean = |i: usize| logs.iter().map(|log| log[i]).sum::<f64>() / 4.0;
    let product = |i: usize| logs.iter().map(|log| (log[0] - mean(0)) * (log[i] - mean(i))).sum::<f64>();
    product(1) / product(0)
}

/// Where eddies grow as a jet spreads, the amplitude grows in proportion to the distance, as it was measured; where
/// they stay as large, it grows more slowly. The level depends on assumptions. Bounds: three standard errors of these
/// flights.
#[test]
fn published_the_amplitude_below_a_slot_die_grows_in_proportion_to_the_distance() {
    let (case, _) = read_case(Path::new("../../cases/published/melt_blowing.toml"), &[]).unwrap();
    let growing = amplitudes(&case);
    assert!((exponent(MEASURED.map(|[_, amplitude]| amplitude)) - 1.02).abs() < 0.01);
    assert!((0.9..1.3).contains(&exponent(growing)), "{growing:?} {}", exponent(growing));
    for ([x, measured], ours) in MEASURED.into_iter().zip(growing) {
        assert!((0.4..0.7).contains(&(ours / measured)), "{x} mm: {ours} {measured}");
    }
    let mut even = case;
    let Flow::Profile(profile) = &mut even.air.flow else { panic!("a profile") };
    let mut table = (**profile).clone();
    (table.length_scale, table.cutoff_frequency) =
        (vec![5e-3; 4], table.velocity.iter().map(|u| u / 0.02).collect());
    *profile = FileContent::new("even.csv".into(), 0, Arc::new(table));
    let even = amplitudes(&even);
    assert!((0.7..1.0).contains(&exponent(even)), "{even:?} {}", exponent(even));
}
