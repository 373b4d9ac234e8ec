//! The surrogate: its autocorrelation against series and simulation, its paths, and the way back from a laid
//! curve to it.

use spunlaid_ground::{Isa, Lanes};
use spunlaid_web::surrogate::identify;
use spunlaid_web::{LaidCurve, PathKey, Paths, Surrogate, Trace, TraceSettings};

const SIGMA: f64 = 0.018;

/// The surrogate of a ratio σ₁/σ₂, with σ₂ = 18 mm.
fn surrogate(ratio: f64, noise: f64) -> Surrogate {
    Surrogate { sigma_md: ratio * SIGMA, sigma_cd: SIGMA, noise }
}

fn keys(seed: u64) -> Vec<PathKey> {
    (0..8).map(|fibre| PathKey { seed, fibre }).collect()
}

/// Eight paths of `points` points, 1 mm apart, laid on a belt of ratio 0.06, with their autocorrelations.
fn laid(of: Surrogate, seed: u64, points: usize) -> Vec<LaidCurve> {
    traced(of, seed, points, 12.0 * of.sigma_md.max(of.sigma_cd))
}

/// * `reach` – of the autocorrelations [m]
fn traced(of: Surrogate, seed: u64, points: usize, reach: f64) -> Vec<LaidCurve> {
    const STEP: f64 = 1e-3;
    const RATIO: f64 = 0.06;
    let mut paths = Paths::new(Isa::detect(), of, STEP, &keys(seed)).unwrap();
    let mut traces = vec![Trace::new(TraceSettings { spacing: STEP, belt_ratio: RATIO, skip: 0, reach }); 8];
    let mut block = [[Lanes::ZERO; 2]; 500];
    for start in (0..points).step_by(500) {
        paths.fill(&mut block);
        for (i, [md, cd]) in block.iter().enumerate() {
            let carried = RATIO * STEP * (start + i) as f64;
            for (lane, trace) in traces.iter_mut().enumerate() {
                trace.add(md.0[lane] - carried, cd.0[lane]);
            }
        }
    }
    traces.iter().map(Trace::finish).collect()
}

/// Mean and its standard error.
fn estimate(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0) / n).sqrt())
}

#[test]
fn analytic_autocorrelation_at_short_lags() {
    // With r = σ₁/σ₂, a = A²σ₁ and lags in σ₁: C = 1 − s²/4 + a s³/24 + ((3 + r² − a²)/8) s⁴/24 + …, from ⟨x₁, Lⁿ x₁⟩.
    for ratio in [1.0, 2.5, 0.4, 4.0] {
        let noise = 8.0;
        let of = surrogate(ratio, noise);
        let [md, cd] = of.autocorrelation(0.02 * SIGMA * ratio, 6).unwrap();
        let swapped = Surrogate { sigma_md: of.sigma_cd, sigma_cd: of.sigma_md, noise };
        let [across, along] = swapped.autocorrelation(0.02 * SIGMA * ratio, 6).unwrap();
        assert_eq!((&across, &along), (&cd, &md));
        let a = noise * noise * of.sigma_md;
        for (lag, c) in md.iter().enumerate() {
            let s = 0.02 * lag as f64;
            let fourth = (3.0 + ratio * ratio - a * a) / 8.0;
            let series = 1.0 - s * s / 4.0 + a * s.powi(3) / 24.0 + fourth * s.powi(4) / 24.0;
            // The next term is of the size (a r² + a³) s⁵/120/8, 5e-7 at most; the steps there are short.
            assert!((c - series).abs() < 1e-6, "{ratio} at {s}: {c}, {series}");
        }
    }
}

/// Integral of the autocorrelation over σ, for σ₁ = σ₂.
fn integral_length(relative_noise: f64) -> f64 {
    let of = Surrogate { sigma_md: 1.0, sigma_cd: 1.0, noise: relative_noise.sqrt() };
    let step = 0.05;
    let reach = (14.0 * relative_noise).clamp(40.0, 190.0);
    let [md, cd] = of.autocorrelation(step, (reach / step) as usize).unwrap();
    assert_eq!(md, cd);
    md.windows(2).map(|pair| 0.5 * step * (pair[0] + pair[1])).sum()
}

#[test]
fn analytic_integral_length_with_much_noise() {
    // Expanding (−L)⁻¹ x₁ in 1/a gives a + 1/2a + O(a⁻³); the first term is the diffusion with the constant 1/A².
    for a in [3.63, 6.3, 12.6] {
        let found = integral_length(a);
        assert!((found - a - 0.5 / a).abs() < 1.0 / (a * a * a), "{a}: {found}");
    }
}

#[test]
fn published_integral_length_with_little_noise() {
    // 0.68 at a = 0.4, from another program.
    assert!((integral_length(0.4) - 0.68).abs() < 0.005, "{}", integral_length(0.4));
}

#[test]
fn stat_autocorrelation_of_paths_is_that_of_the_generator() {
    for (ratio, noise) in [(1.0, 5.0), (1.0, 12.4), (2.5, 8.0), (0.25, 9.0)] {
        let of = surrogate(ratio, noise);
        let laid: Vec<LaidCurve> = (0..3).flat_map(|seed| laid(of, seed, 100_000)).collect();
        let lags = laid[0].correlation_md.len();
        let [md, cd] = of.autocorrelation(laid[0].lag_step, lags).unwrap();
        for lag in [lags / 24, lags / 12, lags / 6, lags / 3, lags / 2] {
            let values =
                |of: fn(&LaidCurve) -> &Vec<f64>| laid.iter().map(|l| of(l)[lag]).collect::<Vec<_>>();
            for (values, wanted) in
                [(values(|l| &l.correlation_md), md[lag]), (values(|l| &l.correlation_cd), cd[lag])]
            {
                let (mean, error) = estimate(&values);
                // Four standard errors, the order of the scheme at a step of σ/18, and the mean that was taken off.
                let length = 100.0;
                let bias = 2e-4 + 2.0 * of.relative_noise().max(1.0) * of.sigma_md.max(of.sigma_cd) / length;
                assert!(
                    (mean - wanted).abs() < 4.0 * error + bias,
                    "{ratio} {noise} {lag}: {mean} ± {error}, {wanted}"
                );
            }
        }
    }
}

#[test]
#[ignore = "slow: paths of many kilometres"]
fn stat_paths_are_stationary() {
    for ratio in [1.0, 2.0] {
        let of = surrogate(ratio, 10.0);
        let laid: Vec<LaidCurve> = (0..8).flat_map(|seed| traced(of, seed, 200_000, 0.0)).collect();
        let near = |value: fn(&LaidCurve) -> f64, wanted: f64, bias: f64| {
            let (mean, error) = estimate(&laid.iter().map(value).collect::<Vec<_>>());
            assert!((mean - wanted).abs() < 4.0 * error + bias, "{ratio}: {mean} ± {error}, {wanted}");
        };
        // The spread is measured about the mean of 200 m, and at the corners of the paths.
        near(|l| l.sigma_md, of.sigma_md, 1e-3 * of.sigma_md);
        near(|l| l.sigma_cd, of.sigma_cd, 1e-3 * of.sigma_cd);
        near(|l| l.mean[0], 0.0, 0.0);
        near(|l| l.mean[1], 0.0, 0.0);
        // −dy/ds is the belt's ratio within √2 σ/S.
        near(|l| l.slope, 0.06, 2.0_f64.sqrt() * of.sigma_md / 200.0);
        if ratio > 1.0 {
            continue;
        }
        // By fed length no direction is preferred, on a moving belt either: z(z − r)/(1 − rz) has the mean zero.
        near(|l| l.orientation_md, 0.5, 0.0);
        let count = |i: usize| laid.iter().map(|l| l.directions[i] as f64).sum::<f64>();
        let total: f64 = (0..36).map(count).sum();
        for class in 0..36 {
            // Those against the motion of the belt are more frequent, by 0.06 over the chord's 0.94.
            let angle = (f64::from(class) + 0.5).to_radians() * 10.0;
            let wanted = 1.0 - 0.06 / 0.94 * angle.cos();
            let found = count(class as usize) / total * 36.0;
            assert!((found - wanted).abs() < 0.04, "{class}: {found}, {wanted}");
        }
    }
}

/// Relative error of the variance at the corners, both coordinates, and its standard error.
fn widening(step: f64) -> (f64, f64) {
    let of = Surrogate { sigma_md: 1.0, sigma_cd: 1.0, noise: 1.5 };
    let mut points = vec![[Lanes::ZERO; 2]; 4000];
    let mut means = Vec::new();
    for seed in 0..16 {
        let mut paths = Paths::new(Isa::detect(), of, step, &keys(seed)).unwrap();
        let mut sums = [0.0; 8];
        for _ in 0..100 {
            paths.fill(&mut points);
            for [x, y] in &points {
                for (lane, sum) in sums.iter_mut().enumerate() {
                    *sum += 0.5 * (x.0[lane] * x.0[lane] + y.0[lane] * y.0[lane]);
                }
            }
        }
        means.extend(sums.map(|sum| sum / 400_000.0 - 1.0));
    }
    estimate(&means)
}

#[test]
fn order_two_of_the_spread_in_the_step() {
    // A straight piece of length h has h²/12 less variance in each coordinate, on average over it, than its ends.
    let (coarse, error) = widening(0.25);
    assert!((coarse - 0.25 * 0.25 / 12.0).abs() < 4.0 * error + 2e-4, "{coarse} ± {error}");
    assert!(coarse > 8.0 * error, "{coarse} ± {error}");
    let (fine, error) = widening(0.125);
    assert!((fine - 0.125 * 0.125 / 12.0).abs() < 4.0 * error + 5e-5, "{fine} ± {error}");
}

#[test]
fn invariant_pieces_of_a_path_have_the_same_length() {
    let mut paths = Paths::new(Isa::detect(), surrogate(2.0, 12.0), 1e-3, &keys(3)).unwrap();
    let mut points = vec![[Lanes::ZERO; 2]; 100_000];
    paths.fill(&mut points);
    for pair in points.windows(2) {
        for lane in 0..8 {
            let [x, y] = [0, 1].map(|axis: usize| pair[1][axis].0[lane] - pair[0][axis].0[lane]);
            // Rounding of positions of some centimetres, and cosines that are good to 4e-16.
            assert!((x.hypot(y) - 1e-3).abs() < 5e-17, "{}", x.hypot(y));
        }
    }
}

#[test]
fn identical_paths_on_every_instruction_set_in_any_lane_and_in_any_portion() {
    let of = surrogate(1.5, 14.0);
    let path = |isa: Isa, keys: &[PathKey], portions: &[usize]| {
        let mut paths = Paths::new(isa, of, 1e-3, keys).unwrap();
        let mut points = vec![[Lanes::ZERO; 2]; 1000];
        let mut rest = points.as_mut_slice();
        for portion in portions.iter().cycle() {
            let (now, later) = rest.split_at_mut((*portion).min(rest.len()));
            paths.fill(now);
            rest = later;
            if rest.is_empty() {
                return points;
            }
        }
        points
    };
    let keys = keys(9);
    let wanted = path(Isa::detect(), &keys, &[1000]);
    for isa in Isa::available() {
        assert_eq!(path(isa, &keys, &[1, 63, 200, 7]), wanted, "{}", isa.name());
    }
    let alone = path(Isa::detect(), &keys[5..6], &[1000]);
    for (one, all) in alone.iter().zip(&wanted) {
        assert_eq!([one[0].0[0], one[1].0[7]], [all[0].0[5], all[1].0[5]]);
    }
    let mut reordered = keys.clone();
    reordered.reverse();
    for (one, all) in path(Isa::detect(), &reordered, &[1000]).iter().zip(&wanted) {
        assert!((0..8).all(|lane| one[0].0[lane] == all[0].0[7 - lane]));
    }
}

#[test]
fn rejects_paths_that_cannot_be_made() {
    let (isa, of) = (Isa::detect(), surrogate(1.0, 12.0));
    assert!(Paths::new(isa, of, 1e-3, &[]).is_none());
    assert!(Paths::new(isa, of, 1e-3, &[PathKey { seed: 1, fibre: 1 }; 9]).is_none());
    for step in [0.0, -1e-3, f64::NAN, 0.26 * SIGMA] {
        assert!(Paths::new(isa, of, step, &keys(1)).is_none(), "{step}");
    }
    for noise in [f64::NAN, 46.0] {
        assert!(Paths::new(isa, Surrogate { noise, ..of }, 1e-3, &keys(1)).is_none());
    }
    for sigma_md in [0.0, f64::NAN, f64::INFINITY] {
        assert!(Paths::new(isa, Surrogate { sigma_md, ..of }, 1e-3, &keys(1)).is_none());
    }
}

#[test]
fn invariant_identification_returns_the_surrogate_of_an_exact_autocorrelation() {
    for (ratio, noise) in [(1.0, 4.2), (1.0, 7.0), (2.5, 8.0), (0.25, 12.0), (1.0, 30.0), (4.0, 12.4)] {
        let of = surrogate(ratio, noise);
        let step = 0.1 * SIGMA * ratio.min(1.0);
        let [md, cd] = of.autocorrelation(step, (12.0 * SIGMA * ratio.max(1.0) / step) as usize + 2).unwrap();
        let found = identify([of.sigma_md, of.sigma_cd], step, [&md, &cd]).unwrap();
        // Curves of other sizes of the basis differ by 3e-4 at the least noise.
        let tolerance = if of.relative_noise() < 0.8 { 1e-3 } else { 1e-4 };
        assert!((found.surrogate.noise / noise - 1.0).abs() < tolerance, "{ratio} {noise}: {found:?}");
        assert!(found.residual < 3e-4, "{found:?}");
    }
}

#[test]
fn analytic_residual_of_fibres_that_differ_from_a_surrogate_by_known_amounts() {
    const OFF: f64 = 0.1;
    const APART: f64 = 0.02;
    let of = surrogate(1.0, 12.0);
    let step = 0.2 * SIGMA;
    let [md, cd] = of.autocorrelation(step, 61).unwrap();
    let by = |by: f64| [&md, &cd].map(|c| c.iter().map(|c| c + by).collect::<Vec<f64>>());
    let [less, more] = [by(OFF - APART), by(OFF + APART)];
    let both = [&less, &more].map(|[md, cd]| [&md[..], &cd[..]]);
    let found = of.residual(step, &both).unwrap();
    // Of two values m ± d the standard error is d.
    assert!((found.rms - OFF).abs() < 1e-12 && (found.by_chance.unwrap() - APART).abs() < 1e-12, "{found:?}");
    // The surrogate's own, once.
    let own = of.residual(step, &[[&md, &cd]]).unwrap();
    assert!(own.rms < 1e-12 && own.by_chance.is_none(), "{own:?}");
    assert!(of.residual(step, &[[&md[..4], &cd[..4]]]).is_none());
    assert!(of.residual(step, &[]).is_none());
}

#[test]
#[ignore = "slow: six closed loops of two kilometres"]
fn stat_closed_loops_find_the_noise() {
    for (ratio, noise) in [(1.0, 12.4), (1.0, 30.0), (2.5, 8.0)] {
        let of = surrogate(ratio, noise);
        let found: Vec<f64> = (0..2)
            .flat_map(|seed| laid(of, seed, 250_000))
            .map(|l| {
                let of =
                    identify([l.sigma_md, l.sigma_cd], l.lag_step, [&l.correlation_md, &l.correlation_cd]);
                of.unwrap().surrogate.noise
            })
            .collect();
        let (mean, error) = estimate(&found);
        // The mean that is taken off 250 m lowers A by less than 0.3 %.
        assert!((mean - noise).abs() < 4.0 * error + 3e-3 * noise, "{ratio} {noise}: {mean} ± {error}");
        assert!(error < 0.01 * noise, "{error}");
    }
}

/// Shares of closed loops whose 95 % intervals, from eight paths of 60 m each, hold σ₁, σ₂ and A.
fn coverage(of: Surrogate, loops: u64) -> [f64; 3] {
    let held = |seed: u64| {
        let found = laid(of, 1000 + seed, 60_000).into_iter().map(|l| {
            let sigmas = [l.sigma_md, l.sigma_cd];
            let noise = identify(sigmas, l.lag_step, [&l.correlation_md, &l.correlation_cd]).unwrap();
            [sigmas[0], sigmas[1], noise.surrogate.noise]
        });
        let found: Vec<[f64; 3]> = found.collect();
        std::array::from_fn(|i| {
            let (mean, error) = estimate(&found.iter().map(|of| of[i]).collect::<Vec<_>>());
            // Student's t of seven degrees of freedom.
            ((mean - [of.sigma_md, of.sigma_cd, of.noise][i]).abs() <= 2.365 * error) as u32
        })
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from) as u64;
    let counts: Vec<[u32; 3]> = std::thread::scope(|scope| {
        let held = &held;
        let of_thread = |thread: u64| move || (thread..loops).step_by(threads as usize).map(held).collect();
        let running: Vec<_> = (0..threads).map(|thread| scope.spawn(of_thread(thread))).collect();
        running.into_iter().flat_map(|thread| -> Vec<[u32; 3]> { thread.join().unwrap() }).collect()
    });
    std::array::from_fn(|i| f64::from(counts.iter().map(|of| of[i]).sum::<u32>()) / loops as f64)
}

#[test]
#[ignore = "slow: eighty closed loops"]
fn stat_intervals_of_the_identified_numbers_hold() {
    for (ratio, noise) in [(1.0, 12.4), (2.5, 8.0)] {
        let held = coverage(surrogate(ratio, noise), 40);
        // 95 %; 3.4 % is the standard deviation of a share of 40. docs/validation.md has the shares of 200.
        assert!(held.iter().all(|share| (0.85..=1.0).contains(share)), "{ratio} {noise}: {held:?}");
    }
}

#[test]
fn rejects_curves_of_no_surrogate() {
    let of = surrogate(1.0, 12.0);
    let step = 0.2 * SIGMA;
    let [md, cd] = of.autocorrelation(step, 61).unwrap();
    let is_one = |sigmas: [f64; 2], md: &[f64], cd: &[f64]| identify(sigmas, step, [md, cd]).is_some();
    let sigmas = [SIGMA; 2];
    assert!(is_one(sigmas, &md, &cd));
    for wrong in [[0.0, SIGMA], [f64::NAN, SIGMA], [SIGMA, 6.0 * SIGMA]] {
        assert!(!is_one(wrong, &md, &cd), "{wrong:?}");
    }
    let mut hole = md.clone();
    hole[20] = f64::NAN;
    let slow: Vec<f64> = (0..61).map(|lag| (-0.0026 * f64::from(lag)).exp()).collect();
    let coil: Vec<f64> = (0..61).map(|lag| (0.25 * f64::from(lag)).cos()).collect();
    for (md, cd) in
        [(&md[..0], &cd[..]), (&md[..], &cd[..12]), (&hole[..], &cd[..]), (&md[..], &[1.0; 61][..])]
    {
        assert!(!is_one(sigmas, md, cd));
    }
    assert!(!is_one(sigmas, &slow, &slow) && !is_one(sigmas, &coil, &coil));
    // Beyond the least noise, as far from it as a curve with more noise on the other side.
    let [least, more] = [0.25_f64, 0.5].map(|a| surrogate(1.0, (a / SIGMA).sqrt() * (1.0 + 1e-12)));
    let [least, more] = [least, more].map(|of| of.autocorrelation(step, 61).unwrap()[0].clone());
    let beyond: Vec<f64> = least.iter().zip(&more).map(|(least, more)| 2.0 * least - more).collect();
    assert!(!is_one(sigmas, &beyond, &beyond));
    assert!(of.autocorrelation(1.0, 61).is_none() && surrogate(6.0, 12.0).autocorrelation(step, 9).is_none());
    assert!(surrogate(1.0, 60.0).autocorrelation(step, 9).is_none());
    assert!(surrogate(1.0, f64::NAN).autocorrelation(step, 9).is_none());
}
