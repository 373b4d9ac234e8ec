//! Turbulence beyond the paper's: spectra by name and from tables, convected eddies, and fluctuations from a record.

use crate::common::*;
use spunlaid_air::{
    APART, Air, Eddies, EddyModel, FileContent, Measured, RecordNumbers, SpectrumShape, SpectrumTable,
    Stream, StreamKey, Wind,
};
use spunlaid_ground::{Isa, Vec3, WIDTH, Welch, Window};
use std::path::PathBuf;
use std::sync::Arc;

const ALONG: Vec3<f64> = Vec3::new(1.0, 0.0, 0.0);

/// Fluctuations `[sample][element]` of eight replicates along a fibre of a metre.
fn along(air: &Air, elements: usize, times: &[f64]) -> Vec<Vec<[Vec3<f64>; WIDTH]>> {
    let eddies = air.eddies_along(ALONG, elements);
    let turbulence = air.turbulence_along(ALONG, elements, &eddies);
    let stream = |replicate| Stream {
        air: air.clone(),
        eddies: turbulence.clone(),
        key: StreamKey { seed: 3, replicate },
    };
    let streams: Vec<Stream> = (0..WIDTH as u64).map(stream).collect();
    let longest = times.iter().copied().fold(0.0, f64::max);
    // One sum of cosines alone, over whose full period means are exact.
    let made = if air.records.is_empty() { Wind::repeating } else { Wind::along };
    let mut wind = made(Isa::detect(), streams, longest).expect("fibres that agree");
    let mean = Vec3::new(air.velocity, 0.0, 0.0);
    let at_elements = |eddies: &Eddies, now: &[Vec3<spunlaid_ground::Lanes>]| {
        eddies
            .index_of_element()
            .iter()
            .map(|&e| std::array::from_fn(|lane| now[e as usize].lane(lane) - mean))
            .collect()
    };
    times.iter().map(|&t| at_elements(&eddies, &wind.at(t))).collect()
}

/// One-sided spectra of the components along and across, averaged over replicates and elements.
fn spectra(air: &Air, interval: f64, samples: usize) -> [Vec<(f64, f64)>; 2] {
    let times: Vec<f64> = (0..samples).map(|i| i as f64 * interval).collect();
    let all = along(air, 4, &times);
    let segment = Welch::segment_length(samples);
    [0, 1].map(|component| {
        let mut spectrum = Welch::new(interval, segment, Window::Hann, 0.5);
        for lane in 0..WIDTH {
            for element in 0..4 {
                let pick = |v: Vec3<f64>| if component == 0 { v.x } else { v.y };
                let record: Vec<f64> = all.iter().map(|now| pick(now[element][lane])).collect();
                spectrum.add(&record, None);
            }
        }
        spectrum.finish().points().collect()
    })
}

/// For any shape the variance over a full period is u², up to the error of the interpolation.
#[test]
fn stat_variance_does_not_depend_on_the_shape() {
    let table = SpectrumTable { frequency: vec![5.0, 20.0, 60.0], energy: vec![1.0, 3.0, 0.0] };
    let table = FileContent::new(PathBuf::from("table.csv"), 1, Arc::new(table));
    for shape in [SpectrumShape::Flat, SpectrumShape::VonKarman, SpectrumShape::Measured(table)] {
        for eddies in [EddyModel::Independent, EddyModel::Convected { decay_time: 0.02 }] {
            let air = Air { spectrum: shape.clone(), eddies, harmonics: 128, ..table1_air() };
            let period = 2.0 * air.repeat_time();
            let times: Vec<f64> = (0..2048).map(|i| f64::from(i) * period / 2048.0).collect();
            for elements in [5, 20] {
                let all = along(&air, elements, &times);
                for element in 0..elements {
                    for lane in 0..WIDTH {
                        let squares = |pick: fn(Vec3<f64>) -> f64| {
                            all.iter().map(|now| pick(now[element][lane]).powi(2)).sum::<f64>() / 2048.0
                        };
                        for variance in [squares(|v| v.x), squares(|v| v.y), squares(|v| v.z)] {
                            let off = variance / air.rms().powi(2) - 1.0;
                            assert!(
                                off.abs() < 2e-6,
                                "{} {eddies:?} {element}: {off:e}",
                                air.spectrum.name()
                            );
                        }
                    }
                }
            }
        }
    }
}

/// Von Kármán's spectra along and across, as the handbooks print them in the reduced frequency `n = fL/U`:
/// `f S/u² = 4n/(1+70.8n²)^(5/6)` and `4n'(1+755n'²)/(1+283n'²)^(11/6)` with half the length, up to the factor that
/// the cut-off leaves.
#[test]
fn published_von_karman_spectra_along_and_across() {
    let air = Air {
        spectrum: SpectrumShape::VonKarman,
        cutoff_frequency: 2000.0,
        harmonics: 1 << 14,
        ..table1_air()
    };
    let (l, u) = (air.length_scale, air.velocity);
    let printed = [
        |n: f64| 4.0 * n / (1.0 + 70.8 * n * n).powf(5.0 / 6.0),
        |n: f64| {
            let n = 0.5 * n;
            4.0 * n * (1.0 + 755.0 * n * n) / (1.0 + 283.0 * n * n).powf(11.0 / 6.0)
        },
    ];
    for (component, printed) in printed.into_iter().enumerate() {
        let spectrum = air.energy_spectrum(component);
        let density = |f: f64| spectrum.energy(2.0 * std::f64::consts::PI * f) * 2.0 * std::f64::consts::PI;
        // The energy above the cut-off is missing; the rest is raised to give the same variance.
        let kept: f64 =
            (0..200_000).map(|i| (f64::from(i) + 0.5) * 0.01).map(|f| printed(f * l / u) / f * 0.01).sum();
        let factor = density(20.0) * 20.0 / air.rms().powi(2) / printed(20.0 * l / u);
        assert!((factor * kept - 1.0).abs() < 2e-3, "{factor} {kept}");
        for f in [1.0, 10.0, 50.0, 200.0, 1000.0] {
            let ratio = density(f) * f / air.rms().powi(2) / printed(f * l / u);
            assert!((ratio / factor - 1.0).abs() < 2e-3, "{component} {f} Hz: {ratio} {factor}");
        }
    }
}

/// The realised spectra are those asked for: bins of 32 records of several segments each, to five standard
/// errors.
#[test]
fn stat_realised_spectra_follow_the_shape() {
    let table = SpectrumTable { frequency: vec![10.0, 40.0, 90.0], energy: vec![2.0, 6.0, 1.0] };
    let table = FileContent::new(PathBuf::from("table.csv"), 1, Arc::new(table));
    for shape in [SpectrumShape::VonKarman, SpectrumShape::Measured(table)] {
        let air = Air { spectrum: shape, harmonics: 1024, ..table1_air() };
        let samples = 4096;
        let synthesised = spectra(&air, 1.0 / 800.0, samples);
        let segments = samples / Welch::segment_length(samples);
        let error = 1.0 / ((32 * segments.max(1)) as f64).sqrt();
        for (component, synthesised) in synthesised.iter().enumerate() {
            let wanted = air.energy_spectrum(component);
            for f in [15.0, 30.0, 45.0, 60.0, 80.0] {
                let nearest =
                    synthesised.iter().min_by(|a, b| (a.0 - f).abs().total_cmp(&(b.0 - f).abs())).unwrap();
                let omega = 2.0 * std::f64::consts::PI * nearest.0;
                let ratio = nearest.1 / (wanted.energy(omega) * 2.0 * std::f64::consts::PI);
                assert!((ratio - 1.0).abs() < 5.0 * error, "{component} {f} Hz: {ratio} ± {error}");
            }
        }
    }
}

/// A frozen pattern: an element feels what the first one felt earlier, by the distance over the speed.
#[test]
fn analytic_a_frozen_pattern_is_carried_at_the_mean_velocity() {
    let air = Air { eddies: EddyModel::Convected { decay_time: f64::INFINITY }, ..table1_air() };
    let (elements, t0) = (40, 0.2);
    let delay = |j: usize| j as f64 / elements as f64 / air.velocity;
    let now = &along(&air, elements, &[t0])[0];
    for j in [1, 7, 39] {
        let before = &along(&air, elements, &[t0 - delay(j)])[0];
        for lane in 0..WIDTH {
            let difference = (now[j][lane] - before[0][lane]).norm();
            // Two interpolations of 1e-7 of the rms each, in three components, at worst doubled.
            assert!(difference < 1e-6 * air.rms(), "{j}: {difference:e}");
        }
    }
}

/// The correlation of the carried pattern decays as e^(−t/T), on any mesh.
#[test]
fn stat_a_carried_pattern_forgets_itself_in_its_decay_time() {
    let decay_time = 0.02;
    for elements in [10, 40] {
        let air = Air { eddies: EddyModel::Convected { decay_time }, harmonics: 2048, ..table1_air() };
        // Elements half a metre apart: 50 ms, and a tenth: 10 ms.
        for (share, wanted) in [(0.5, f64::exp(-0.05 / decay_time)), (0.1, f64::exp(-0.01 / decay_time))] {
            let apart = (share * elements as f64) as usize;
            let delay = share / air.velocity;
            let starts: Vec<f64> = (0..400).map(|i| 0.1 + f64::from(i) * 0.04).collect();
            let above = along(&air, elements, &starts.iter().map(|t| t - delay).collect::<Vec<_>>());
            let below = along(&air, elements, &starts);
            let mut sum = 0.0;
            for (above, below) in above.iter().zip(&below) {
                for lane in 0..WIDTH {
                    sum += above[0][lane].dot(below[apart][lane]);
                }
            }
            let n = (400 * WIDTH * 3) as f64;
            let correlation = sum / n / air.rms().powi(2);
            // Instants 40 ms apart are independent: the standard error of a correlation is below 1/√n.
            assert!(
                (correlation - wanted).abs() < 4.0 / n.sqrt(),
                "{elements} {share}: {correlation} {wanted}"
            );
        }
    }
}

fn record(components: usize, samples: usize) -> FileContent<Measured> {
    let value = |c: usize, i: usize| ((i * (7 + 2 * c)) % 1009) as f64 + (i as f64 * 0.1).sin();
    let values: Vec<Vec<f64>> =
        (0..components).map(|c| (0..samples).map(|i| value(c, i)).collect()).collect();
    let views: Vec<&[f64]> = values.iter().map(Vec::as_slice).collect();
    let measured = Measured::new(1e-3, &views, 2e-3, RecordNumbers::default());
    FileContent::new(PathBuf::from("probe.csv"), 7, Arc::new(measured))
}

/// At the instants of its samples the fluctuation is the record's, over its rms and times the air's; stretches
/// start as far apart as promised, and components measured together stay together.
#[test]
fn identical_samples_of_the_record_in_stretches_far_apart() {
    for components in [1, 2, 3] {
        let record = record(components, 20_000);
        let air = Air { records: vec![record.clone()], ..table1_air() };
        let n = 50;
        let times: Vec<f64> = (0..n).map(|i| f64::from(i) * 1e-3).collect();
        let all = along(&air, 20, &times);
        for lane in [0, 5] {
            let mut starts: Vec<Vec<usize>> = vec![Vec::new(); components];
            let mut together = 0;
            for element in 0..20 {
                let mut places = Vec::new();
                for direction in 0..3 {
                    let pick = |v: Vec3<f64>| [v.x, v.y, v.z][direction] / air.rms();
                    let signal: Vec<f64> = all.iter().map(|now| pick(now[element][lane])).collect();
                    let found = record.components.iter().enumerate().find_map(|(c, values)| {
                        let fits = |start: usize| {
                            signal.iter().zip(&values[start..]).all(|(a, b)| (a - b).abs() < 1e-9)
                        };
                        Some((c, (1..values.len() - signal.len()).find(|start| fits(*start))?))
                    });
                    let (component, start) = found.unwrap();
                    starts[component].push(start);
                    places.push(start);
                }
                together += usize::from(places[0] == places[1]);
            }
            assert_eq!(together, if components == 1 { 0 } else { 20 });
            let mut all: Vec<usize> = starts.concat();
            all.sort_unstable();
            all.dedup();
            let closest = all.windows(2).map(|pair| pair[1] - pair[0]).min().unwrap() as f64 * 1e-3;
            assert!(closest >= APART * record.integral_time, "{components}: {closest}");
        }
    }
}

/// Between its samples the fluctuation is Catmull and Rom's cubic: exact for parabolas.
#[test]
fn analytic_between_samples_parabolas_are_exact() {
    let values: Vec<f64> = (0..4000).map(|i| (f64::from(i) - 1700.0).powi(2)).collect();
    let measured = Measured::new(1e-3, &[&values], 1e-3, RecordNumbers::default());
    let (mean, rms) = {
        let mean = values.iter().sum::<f64>() / 4000.0;
        (mean, (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 4000.0).sqrt())
    };
    let air = Air {
        records: vec![FileContent::new(PathBuf::from("p.csv"), 1, Arc::new(measured))],
        length_scale: 1.0,
        ..table1_air()
    };
    let times = [0.0, 0.01, 0.0101, 0.0104, 0.01079];
    let all = along(&air, 1, &times);
    // x is a stretch of the parabola: three points give it, the fourth and fifth test it.
    let x: Vec<f64> = all.iter().map(|now| now[0][0].x / air.rms() * rms + mean).collect();
    let start = 1700.0 + if x[1] > x[0] { x[0].sqrt() } else { -x[0].sqrt() };
    for (t, x) in times.iter().zip(&x) {
        let wanted = (start + t / 1e-3 - 1700.0).powi(2);
        assert!((x - wanted).abs() < 1e-6 * wanted.max(1.0), "{t}: {x} {wanted}");
    }
}

/// A frozen record: an element feels what the root felt earlier, to the nearest sample.
#[test]
fn analytic_a_record_is_carried_along_the_fibre() {
    let air = Air {
        eddies: EddyModel::Convected { decay_time: f64::INFINITY },
        records: vec![record(3, 20_000)],
        ..table1_air()
    };
    // 20 elements of 5 ms each: five samples.
    let times: Vec<f64> = (0..200).map(|i| f64::from(i) * 1e-3).collect();
    let all = along(&air, 20, &times);
    for j in [1, 5, 19] {
        for i in (5 * j)..200 {
            assert_eq!(all[i][j], all[i - 5 * j][0], "{j} {i}");
        }
    }
}
