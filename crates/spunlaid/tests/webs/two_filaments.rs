//! The CV of a web in shared turbulence from what two of its filaments have in common.

use crate::one_air::{case_in, cv, lay_by, row, sheet};
use spunlaid_air::Lateral;
use spunlaid_fibre::LaidPoint;
use spunlaid_ground::Isa;
use spunlaid_web::Sheet;

/// Lags along the filament, in elements.
const LAGS: usize = 60;

/// Mean of `max(0, 1 − |d|/side)/side` over normal distances d: twice the density of the point that is common
/// to two squares.
///
/// * `apart` – mean of the distances [m]
/// * `variance` – of the distances [m²]
fn overlap(apart: f64, variance: f64, side: f64) -> f64 {
    let sigma = variance.max(1e-16).sqrt();
    // The mean of what is above zero.
    let above = |mean: f64| {
        let z = mean / sigma;
        let density = (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
        0.5 * mean * libm::erfc(-z / std::f64::consts::SQRT_2) + sigma * density
    };
    (above(apart + side) - 2.0 * above(apart) + above(apart - side)) / (side * side)
}

/// Filaments whose places are jointly normal: with their correlations C of either direction at a distance
/// across and a fed length, `CV² = p Σ ∫ dv [T(v, 2σ₁²(1 − C₁)) T(z, 2σ₂²(1 − C₂)) − T(v, 2σ₁²) T(z, 2σ₂²)]`
/// over all neighbours at z and the belt v that passes meanwhile, with the pitch p and [`overlap`] T.
#[test]
#[ignore = "slow: eight webs of filaments in shared turbulence"]
fn stat_two_filaments_say_how_uneven_a_web_in_one_air_is() {
    // In single airs the sum is up to a tenth off, and 3 % too high on average of twelve.
    const AIRS: u64 = 8;
    let mut off = [0.0; 2];
    for seed in 1..=AIRS {
        for (off, ratio) in off.iter_mut().zip(expected_over_found(seed)) {
            *off += (ratio - 1.0) / AIRS as f64;
        }
    }
    assert!(off.iter().all(|off| off.abs() < 0.05), "10 and 20 mm: {off:?}");
}

/// The CV of the sum over that of the map, over patches of 10 and 20 mm.
fn expected_over_found(seed: u64) -> [f64; 2] {
    const COUNT: usize = 64;
    let sheet = Sheet { patches: vec![10e-3, 20e-3], ..sheet(COUNT, 2000) };
    let mut case = case_in("von-karman");
    case.run.seed = seed;
    // With coarser waves the sum is 4 to 6 % too high.
    case.air.lateral = Lateral::VonKarman { cutoff: 15.0 };
    let (laid, simulated) = lay_by(&case, &sheet, &row(&sheet, COUNT), Isa::detect(), 2);
    assert_eq!(simulated.kept.len(), COUNT);
    let (line, spacing) = (case.line.unwrap(), case.fibre.rest_length());
    let per_point = line.belt_ratio() * spacing;
    // Places about the straight trace, point by point of each filament.
    let skip = (line.feed_speed * case.run.spin_up() / spacing).round() as usize;
    let count = simulated.kept.iter().map(|(_, points)| points.len()).min().unwrap();
    let places = |(_, points): &(usize, Vec<LaidPoint>)| -> Vec<[f64; 2]> {
        let places = points[skip..count].iter().enumerate();
        let places: Vec<_> = places.map(|(k, point)| [point.md + k as f64 * per_point, point.cd]).collect();
        let mean = [0, 1].map(|d| places.iter().map(|place| place[d]).sum::<f64>() / places.len() as f64);
        places.iter().map(|place| [place[0] - mean[0], place[1] - mean[1]]).collect()
    };
    let curves: Vec<Vec<[f64; 2]>> = simulated.kept.iter().map(places).collect();
    let covariance = |neighbour: usize, lag: usize| {
        let (mut sums, mut pairs) = ([0.0; 2], 0.0);
        for (i, curve) in curves.iter().enumerate() {
            let other = &curves[(i + neighbour) % COUNT];
            // Without iterators, which are calls in a test that is hardly optimised.
            let mut k = 0;
            while k + lag < curve.len() {
                let (a, b) = (curve[k], other[k + lag]);
                sums = [sums[0] + a[0] * b[0], sums[1] + a[1] * b[1]];
                pairs += 1.0;
                k += 10;
            }
        }
        sums.map(|sum| sum / pairs)
    };
    let variance = covariance(0, 0);
    let pitch = sheet.width / COUNT as f64;
    let covariances: Vec<_> = (0..COUNT)
        .flat_map(|neighbour| (0..LAGS).map(move |lag| (neighbour, lag)))
        .map(|(neighbour, lag)| (neighbour, lag, covariance(neighbour, lag)))
        .collect();
    [10, 20].map(|side| {
        let patch = side as f64 * sheet.cell;
        let term = |(neighbour, lag, covariance): &(usize, usize, [f64; 2])| {
            // The nearest of them on the ring of the sheet; the belt runs before and after.
            let z = (*neighbour).min(COUNT - neighbour) as f64 * pitch;
            let (v, both) = (*lag as f64 * per_point, if *lag == 0 { 1.0 } else { 2.0 });
            let part = |share: [f64; 2]| overlap(v, share[0], patch) * overlap(z, share[1], patch);
            let rest = [0, 1].map(|d| 2.0 * (variance[d] - covariance[d]));
            pitch * per_point * both * (part(rest) - part(variance.map(|variance| 2.0 * variance)))
        };
        let alone: f64 = covariances.iter().filter(|(neighbour, ..)| *neighbour == 0).map(term).sum();
        let shared: f64 = covariances.iter().filter(|(neighbour, ..)| *neighbour != 0).map(term).sum();
        let (expected, found) = ((alone + shared).sqrt(), cv(&laid.map, side));
        println!("{seed}: {side} mm: {expected} for {found}");
        expected / found
    })
}
