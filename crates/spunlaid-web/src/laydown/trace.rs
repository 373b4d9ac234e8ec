//! Statistics of a laid curve, point by point.

use super::{Footprint, LaggedProducts, half_lag};
use std::collections::VecDeque;
use std::f64::consts::PI;

/// Fed length of the chords that give orientation and texture [m].
const CHORD: f64 = 0.01;

/// Part of a spacing that counts as rounding [-].
const ROUNDING: f64 = 1e-9;

/// Most lags of an autocorrelation, lag zero included.
const LAGS: usize = 257;

/// How a laid curve is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TraceSettings {
    /// Fed length from one point to the next [m].
    pub spacing: f64,
    /// Speed of the belt over speed of the feed.
    pub belt_ratio: f64,
    /// Points at the start that are left out.
    pub skip: u64,
    /// Largest lag of the autocorrelations that is wanted [m].
    pub reach: f64,
}

/// The statistics of one laid curve, collected point by point with a memory that does not grow.
///
/// The points come in the order of feed, evenly spaced in the fed length s. Position is looked at relative to
/// the straight trace that a fibre leaves which comes down at one place: `ξ₁ = md + (v_b/v_f) s`, `ξ₂ = cd`.
#[derive(Clone, Debug)]
pub struct Trace {
    tracing: TraceSettings,
    fed: u64,
    /// First and last counted `md` [m].
    md: Option<(f64, f64)>,
    /// Of ξ₁ and ξ₂.
    positions: [LaggedProducts; 2],
    footprint: Footprint,
    /// Spacings of the points that a chord spans, the last of them in part.
    chord: usize,
    /// Part of the last spacing at which a chord ends, above zero and at most one.
    last_part: f64,
    /// The last points, as many as a chord spans spacings, the oldest first.
    recent: VecDeque<[f64; 2]>,
    chords: Chords,
}

/// Sums over chords.
#[derive(Clone, Debug)]
struct Chords {
    count: u64,
    /// Chords that are not a single point.
    directed: u64,
    length: f64,
    cos_squared: f64,
    directions: [u64; LaidCurve::DIRECTIONS],
}

/// What a laid curve was found to be. NaN stands for what cannot be said from the points there are.
#[derive(Clone, Debug, PartialEq)]
pub struct LaidCurve {
    /// Fed length of the counted points, from the first to the last [m].
    pub length: f64,
    /// Mean of `−d md/ds`. A fibre that stays in place above the belt has the belt's speed over the feed's.
    pub slope: f64,
    /// Mean of ξ₁ and ξ₂ [m]. That of ξ₁ depends on where s begins.
    pub mean: [f64; 2],
    /// Standard deviation of ξ₁, in machine direction [m].
    pub sigma_md: f64,
    /// Standard deviation of ξ₂, in cross direction [m].
    pub sigma_cd: f64,
    /// Step of the lag of the autocorrelations [m].
    pub lag_step: f64,
    /// Autocorrelation coefficient of ξ₁ from lag zero; products at a lag are divided by the number of pairs.
    pub correlation_md: Vec<f64>,
    /// The same of ξ₂.
    pub correlation_cd: Vec<f64>,
    /// Lag at which the autocorrelation of ξ₁ has fallen to ½ [m].
    pub half_correlation_length_md: f64,
    /// The same of ξ₂ [m].
    pub half_correlation_length_cd: f64,
    /// Fed length of the chords: 10 mm [m]. They begin at points; between points the curve is straight.
    pub chord: f64,
    /// `⟨cos²⟩` of the angle between a chord on the belt and the machine direction: ½ without orientation.
    pub orientation_md: f64,
    /// Mean length of a chord on the belt over its fed length. NaN if the points are farther apart than a chord, which
    /// then says nothing of how the curve folds.
    pub chord_over_arc: f64,
    /// Chords by direction on the belt, in the sense of feed: entry i counts angles to the machine direction
    /// from 10i to 10(i+1) degrees, positive towards the cross direction.
    pub directions: [u64; Self::DIRECTIONS],
    /// Where (ξ₁, ξ₂) was.
    pub footprint: Footprint,
}

impl LaidCurve {
    /// Number of classes of direction.
    pub const DIRECTIONS: usize = 36;
}

impl Trace {
    /// No points yet. With a spacing that is not positive and finite, no result has a meaning.
    pub fn new(tracing: TraceSettings) -> Self {
        // Not above a million, so that no request can ask for more memory than there is.
        let steps = |length: f64, round: fn(f64) -> f64| {
            (round(length / tracing.spacing).clamp(1.0, 1e6) as usize).max(1)
        };
        let reach = steps(tracing.reach, f64::ceil);
        let stride = reach.div_ceil(LAGS - 1);
        let chord = steps(CHORD, ceil_but_rounding);
        let last_part = CHORD / tracing.spacing - (chord - 1) as f64;
        let positions = LaggedProducts::new(stride, reach.div_ceil(stride) + 1);
        // A lattice can grow from any width but these.
        let cell = if tracing.spacing > 0.0 && tracing.spacing.is_finite() { tracing.spacing } else { 1.0 };
        Self {
            fed: 0,
            md: None,
            positions: [positions.clone(), positions],
            footprint: Footprint::new(cell, [0.0; 2]),
            chord,
            last_part: if (last_part - 1.0).abs() < ROUNDING { 1.0 } else { last_part.clamp(0.0, 1.0) },
            recent: VecDeque::new(),
            chords: Chords::NONE,
            tracing,
        }
    }

    /// Takes the next point.
    ///
    /// * `md`, `cd` – position on the belt, in its own frame: machine and cross direction [m]
    pub fn add(&mut self, md: f64, cd: f64) {
        let TraceSettings { spacing, belt_ratio, skip, .. } = self.tracing;
        let index = self.fed;
        self.fed += 1;
        if index < skip {
            return;
        }
        let (first, _) = self.md.unwrap_or((md, md));
        self.md = Some((first, md));
        let position = [md + belt_ratio * (index as f64 * spacing), cd];
        if self.positions[0].count() == 0 {
            self.footprint.centre = position;
        }
        self.footprint.add(position);
        for (sums, x) in self.positions.iter_mut().zip(position) {
            sums.add(x);
        }
        if self.recent.len() == self.chord
            && let Some(start) = self.recent.pop_front()
        {
            let before = self.recent.back().copied().unwrap_or(start);
            let part = self.last_part;
            // Without a part left over, the chord ends at the point itself.
            let end = |before: f64, now: f64| if part == 1.0 { now } else { before + part * (now - before) };
            self.chords.add(end(before[0], md) - start[0], end(before[1], cd) - start[1]);
        }
        self.recent.push_back([md, cd]);
    }

    /// Points that were taken after those left out.
    pub const fn points(&self) -> u64 {
        self.positions[0].count()
    }

    /// The statistics of the points so far.
    pub fn finish(&self) -> LaidCurve {
        let spacing = self.tracing.spacing;
        let length = spacing * self.points().saturating_sub(1) as f64;
        let covariances = self.positions.each_ref().map(LaggedProducts::covariances);
        // A single point has no spread to speak of. Rounding may make a heap's variance negative.
        let sigma = |covariances: &Vec<f64>| match covariances[..] {
            [variance, _, ..] => {
                if variance < 0.0 {
                    0.0
                } else {
                    variance.sqrt()
                }
            }
            _ => f64::NAN,
        };
        let sigma = covariances.each_ref().map(sigma);
        let lag_step = spacing * self.positions[0].stride() as f64;
        let [correlation_md, correlation_cd] = covariances.map(|covariances| {
            covariances.iter().map(|covariance| covariance / covariances[0]).collect::<Vec<f64>>()
        });
        let chord = spacing * ((self.chord - 1) as f64 + self.last_part);
        let resolved = spacing <= CHORD * (1.0 + ROUNDING);
        let Chords { count, directed, length: chords, cos_squared, directions } = self.chords;
        LaidCurve {
            length,
            slope: self.md.map_or(f64::NAN, |(first, last)| (first - last) / length),
            mean: self.positions.each_ref().map(LaggedProducts::mean),
            sigma_md: sigma[0],
            sigma_cd: sigma[1],
            lag_step,
            half_correlation_length_md: lag_step * half_lag(&correlation_md),
            half_correlation_length_cd: lag_step * half_lag(&correlation_cd),
            correlation_md,
            correlation_cd,
            chord,
            orientation_md: cos_squared / directed as f64,
            chord_over_arc: if resolved { chords / (count as f64 * chord) } else { f64::NAN },
            directions,
            footprint: self.footprint.clone(),
        }
    }
}

/// The next whole number, or the nearest one if only rounding is between.
fn ceil_but_rounding(x: f64) -> f64 {
    if (x - x.round()).abs() < ROUNDING { x.round() } else { x.ceil() }
}

impl Chords {
    const NONE: Self =
        Self { count: 0, directed: 0, length: 0.0, cos_squared: 0.0, directions: [0; LaidCurve::DIRECTIONS] };

    fn add(&mut self, md: f64, cd: f64) {
        let squared = md * md + cd * cd;
        self.count += 1;
        self.length += squared.sqrt();
        if squared == 0.0 {
            return;
        }
        self.directed += 1;
        self.cos_squared += md * md / squared;
        let turns = libm::atan2(cd, md) / (2.0 * PI);
        let class = (turns - turns.floor()) * LaidCurve::DIRECTIONS as f64;
        if class.is_finite() {
            self.directions[(class as usize).min(LaidCurve::DIRECTIONS - 1)] += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPACING: f64 = 0.002;
    const RATIO: f64 = 0.06;

    /// A curve with loops and wander, stored.
    fn curve(points: u32) -> Vec<[f64; 2]> {
        let at = |i: u32| {
            let s = f64::from(i) * SPACING;
            let wander = 0.01 * (7.3 * s).sin() + 0.004 * (31.0 * s).cos();
            [wander + 0.01 * (90.0 * s).cos() - RATIO * s, 0.008 * (70.0 * s).sin() - wander]
        };
        (0..points).map(at).collect()
    }

    fn traced(points: &[[f64; 2]], tracing: TraceSettings) -> LaidCurve {
        let mut trace = Trace::new(tracing);
        points.iter().for_each(|[md, cd]| trace.add(*md, *cd));
        trace.finish()
    }

    const TRACING: TraceSettings =
        TraceSettings { spacing: SPACING, belt_ratio: RATIO, skip: 100, reach: 0.5 };

    #[test]
    fn analytic_statistics_of_a_stored_curve() {
        let all = curve(5000);
        let found = traced(&all, TRACING);
        let counted = &all[100..];
        let n = counted.len() as f64;
        let position = |axis: usize| -> Vec<f64> {
            (100..5000)
                .map(|i| all[i][axis] + if axis == 0 { RATIO * SPACING * i as f64 } else { 0.0 })
                .collect()
        };
        let close = |found: f64, wanted: f64| {
            // Rounding of sums of 5000 numbers.
            assert!((found / wanted - 1.0).abs() < 1e-11, "{found}, {wanted}");
        };
        close(found.length, SPACING * (n - 1.0));
        close(found.slope, (counted[0][0] - counted[4899][0]) / found.length);
        let sigmas = [found.sigma_md, found.sigma_cd];
        let correlations = [&found.correlation_md, &found.correlation_cd];
        for axis in 0..2 {
            let xi = position(axis);
            let mean = xi.iter().sum::<f64>() / n;
            assert!((found.mean[axis] - mean).abs() < 1e-14);
            let covariance = |lag: usize| {
                let products = xi.iter().zip(&xi[lag..]).map(|(a, b)| (a - mean) * (b - mean));
                products.sum::<f64>() / (n - lag as f64)
            };
            close(sigmas[axis], covariance(0).sqrt());
            assert_eq!(correlations[axis].len(), 251);
            for lag in [0, 1, 100, 250] {
                let wanted = covariance(lag) / covariance(0);
                assert!((correlations[axis][lag] - wanted).abs() < 1e-12);
            }
        }
        close(found.chord, 0.01);
        let chords: Vec<[f64; 2]> = counted
            .windows(6)
            .map(|points| [points[5][0] - points[0][0], points[5][1] - points[0][1]])
            .collect();
        let mean =
            |quantity: fn(&[f64; 2]) -> f64| chords.iter().map(quantity).sum::<f64>() / chords.len() as f64;
        close(found.orientation_md, mean(|[x, y]| x * x / (x * x + y * y)));
        close(found.chord_over_arc, mean(|[x, y]| x.hypot(*y)) / 0.01);
        for (class, count) in found.directions.iter().enumerate() {
            let within = |[x, y]: &&[f64; 2]| {
                (y.atan2(*x).to_degrees().rem_euclid(360.0) / 10.0).floor() as usize == class
            };
            assert_eq!(*count, chords.iter().filter(within).count() as u64, "{class}");
        }
        assert_eq!(found.footprint.rows().flatten().sum::<u64>(), 4900);
    }

    #[test]
    fn analytic_circle_of_a_coiling_thread() {
        // One coil of radius R in 2000 points, laid on a belt that stands: ⟨ξ²⟩ = R²/2, ρ = cos(s/R), chord
        // 2R sin(5 mm/R).
        let (radius, points) = (0.05, 2000_u32);
        let spacing = 2.0 * PI * radius / f64::from(points);
        let circle: Vec<[f64; 2]> = (0..40 * points)
            .map(|i| 2.0 * PI * f64::from(i) / f64::from(points))
            .map(|angle| [radius * angle.cos(), radius * angle.sin()])
            .collect();
        let curve = traced(&circle, TraceSettings { spacing, belt_ratio: 0.0, skip: 0, reach: 0.1 });
        for sigma in [curve.sigma_md, curve.sigma_cd] {
            assert!((sigma / (radius / 2.0_f64.sqrt()) - 1.0).abs() < 1e-9, "{sigma}");
        }
        // Forty turns, cut off by the lag, leave 1/40 of a turn of the unbiased estimate uneven.
        for half in [curve.half_correlation_length_md, curve.half_correlation_length_cd] {
            assert!((half / (radius * PI / 3.0) - 1.0).abs() < 5e-3, "{half}");
        }
        // Between points the curve is straight: at most spacing²/(8R) inside the circle.
        let chord = 2.0 * radius * (CHORD / 2.0 / radius).sin();
        let inside = spacing * spacing / (8.0 * radius);
        assert!((curve.chord_over_arc * CHORD - chord).abs() < inside, "{} {chord}", curve.chord_over_arc);
        assert!((curve.orientation_md - 0.5).abs() < 1e-3 && curve.slope.abs() < 1e-3);
        assert!(curve.directions.iter().all(|count| count.abs_diff(40 * u64::from(points) / 36) < 60));
    }

    #[test]
    fn analytic_chords_are_of_10_mm_whatever_the_spacing() {
        // A circle of radius R whose points are 4 mm of arc apart: a chord ends in the middle between two points, at
        // R cos(2 mm/R) from the centre, 10 mm/R farther round.
        let (radius, spacing) = (0.05_f64, 0.004_f64);
        let on = |s: f64| [radius * (s / radius).cos(), radius * (s / radius).sin()];
        let circle: Vec<[f64; 2]> = (0..500).map(|i| on(spacing * f64::from(i))).collect();
        let laid_circle = traced(&circle, TraceSettings { spacing, belt_ratio: 0.0, skip: 0, reach: 0.1 });
        let short = radius * (0.5 * spacing / radius).cos();
        let chord = (radius * radius + short * short - 2.0 * radius * short * (CHORD / radius).cos()).sqrt();
        assert!(
            (laid_circle.chord - 0.01).abs() < 1e-15
                && (laid_circle.chord_over_arc / (chord / CHORD) - 1.0).abs() < 1e-12
        );
        // The same of a stored curve, along which 10 mm are walked from each point.
        for spacing in [0.0013, 0.003, 0.004, 0.0099, 0.01, 0.015, 0.026] {
            let walk = |points: &[[f64; 2]], s: f64| {
                let at = (s / spacing) as usize;
                let part = s / spacing - at as f64;
                [0, 1].map(|axis| points[at][axis] * (1.0 - part) + points[at + 1][axis] * part)
            };
            let points = curve(1002);
            let laid = traced(&points[..1001], TraceSettings { spacing, skip: 0, ..TRACING });
            let starts = 0..=1000 - (CHORD / spacing - 1e-9).ceil() as u32;
            let chords: Vec<[f64; 2]> = (starts.map(|i| (i as usize, f64::from(i) * spacing)))
                .map(|(i, s)| (points[i], walk(&points, s + CHORD)))
                .map(|(start, end)| [end[0] - start[0], end[1] - start[1]])
                .collect();
            let mean = |quantity: fn(&[f64; 2]) -> f64| {
                chords.iter().map(quantity).sum::<f64>() / chords.len() as f64
            };
            // Rounding of sums of a thousand numbers.
            let close = |found: f64, wanted: f64| {
                assert!((found / wanted - 1.0).abs() < 1e-11, "{spacing}: {found}, {wanted}")
            };
            close(laid.orientation_md, mean(|[x, y]| x * x / (x * x + y * y)));
            if spacing > CHORD {
                assert!(laid.chord_over_arc.is_nan(), "{spacing}");
            } else {
                close(laid.chord_over_arc, mean(|[x, y]| x.hypot(*y)) / CHORD);
            }
            assert!((laid.chord - CHORD).abs() < 1e-15);
        }
    }

    #[test]
    fn a_long_reach_takes_wider_lags() {
        let coarse = traced(&curve(3000), TraceSettings { reach: 3.0, ..TRACING });
        let fine = traced(&curve(3000), TraceSettings { reach: 1.0, ..TRACING });
        assert_eq!((coarse.lag_step, fine.lag_step), (6.0 * SPACING, 2.0 * SPACING));
        assert!(coarse.lag_step * (coarse.correlation_md.len() - 1) as f64 >= 3.0 - 1e-9);
        for lag in [0, 1, 80] {
            assert!((coarse.correlation_md[lag] - fine.correlation_md[3 * lag]).abs() < 1e-12);
        }
    }

    #[test]
    fn what_cannot_be_said_is_nan() {
        let none = traced(&[], TRACING);
        assert!(none.slope.is_nan() && none.sigma_md.is_nan() && none.mean[0].is_nan());
        assert!(
            none.orientation_md.is_nan() && none.chord_over_arc.is_nan() && none.correlation_md.is_empty()
        );
        let one = traced(&curve(101), TRACING);
        assert!(one.slope.is_nan() && one.sigma_cd.is_nan() && one.half_correlation_length_cd.is_nan());
        assert_eq!((one.length, one.mean[1]), (0.0, curve(101)[100][1]));
        let mut broken = curve(300);
        broken[200] = [f64::NAN; 2];
        let broken = traced(&broken, TRACING);
        assert!(broken.sigma_md.is_nan() && broken.orientation_md.is_nan());
        let heap = traced(&[[1.0, 2.0]; 200], TraceSettings { belt_ratio: 0.0, ..TRACING });
        assert!(heap.orientation_md.is_nan() && heap.half_correlation_length_md.is_nan());
        assert_eq!((heap.sigma_md, heap.chord_over_arc, heap.slope), (0.0, 0.0, 0.0));
        let _ = traced(&curve(200), TraceSettings { spacing: f64::NAN, ..TRACING });
        let _ = traced(&curve(200), TraceSettings { spacing: 0.0, reach: f64::INFINITY, ..TRACING });
    }
}
