//! The paper's claims. Each gets its evidence and a verdict from the data.

use super::{LateralEstimates, Parameter, TrendPoint};
use spunlaid_experiment::{Claim, REAL, Verdict, goes, significance};
use spunlaid_ground::Difference;
use std::borrow::Cow;

/// Share of the variance that a straight line must explain for a trend to count as almost linear.
const ALMOST_LINEAR: f64 = 0.97;
/// Largest relative change that counts as "nearly constant".
const NEARLY: f64 = 0.1;

/// How amplitude [mm] and frequency [Hz] depend on a parameter.
struct Trend {
    amplitude: Vec<Spot>,
    frequency: Vec<Spot>,
}

/// A claim, and what judges it.
type Judged = (&'static str, fn(&Trend) -> (String, Verdict));

impl Parameter {
    /// What the paper claims of it.
    const fn claims(self) -> &'static [Judged] {
        match self {
            Self::Velocity => &[
                ("The amplitude grows almost linearly with the mean air velocity.", |of| {
                    straight(&of.amplitude, "mm per m/s")
                }),
                ("The frequency grows almost linearly with the mean air velocity.", |of| {
                    straight(&of.frequency, "Hz per m/s")
                }),
            ],
            Self::Intensity => &[
                ("The amplitude grows with the turbulence intensity.", rising),
                ("The frequency grows until Tu = 0.15 and then is nearly constant.", |of| {
                    plateau(&of.frequency, 0.15)
                }),
            ],
            Self::Diameter => &[
                ("A thick fibre has a larger amplitude than a thin one (200 µm against 18 µm).", |of| {
                    thicker(&of.amplitude)
                }),
                ("The amplitude is a sigmoid of the diameter.", |of| sigmoid(&of.amplitude)),
            ],
            Self::LengthScale => &[("The amplitude grows with the turbulent length scale.", rising)],
            Self::Cutoff => &[(
                "The amplitude falls strongly as the frequency of turbulence rises, at constant rms.",
                |of| monotone(&of.amplitude, -1.0, "mm"),
            )],
        }
    }
}

/// The paper's claims about a parameter. Empty if there are fewer than two replicates.
pub fn claims_of_trend(parameter: Parameter, points: &[TrendPoint]) -> Vec<Claim> {
    let spots = [spots(points, |p| p.amplitude, 1e3), spots(points, |p| p.frequency, 1.0)];
    let [Some(amplitude), Some(frequency)] = spots else { return Vec::new() };
    let (figure, trend) = (parameter.figure(), Trend { amplitude, frequency });
    let judge = |(claim, judge): &Judged| {
        let (evidence, verdict) = judge(&trend);
        Claim { figure, claim: Cow::Borrowed(claim), evidence, verdict }
    };
    parameter.claims().iter().map(judge).collect()
}

fn rising(of: &Trend) -> (String, Verdict) {
    monotone(&of.amplitude, 1.0, "mm")
}

/// The claims about the work error, from (time step [s], final error [%], median error over time [%]).
pub fn claims_of_step_errors(errors: &[(f64, f64, f64)]) -> Vec<Claim> {
    let Some(&(_, last, median)) = errors.iter().find(|e| (e.0 - 1e-6).abs() < 1e-12) else {
        return Vec::new();
    };
    let logs: Vec<Spot> = errors.iter().map(|&(h, _, e)| Spot { x: h.ln(), y: e.ln(), error: 0.0 }).collect();
    let order = line(&logs).slope;
    vec![
        Claim {
            figure: "8b",
            claim: Cow::Borrowed("A time step of 1 µs gives an error of less than 1 %."),
            evidence: format!("{last:.4} % at the end, {median:.4} % in the median over time"),
            verdict: Verdict::of(last < 1.0 && median < 1.0),
        },
        Claim {
            figure: "8b",
            claim: Cow::Borrowed("The error falls with the time step, in proportion."),
            evidence: format!("median error ∝ h^{order:.2} over {} steps", errors.len()),
            verdict: Verdict::of((order - 1.0).abs() < 0.2),
        },
    ]
}

/// The mean of y and z with its error, in units of `1/scale`. None if a point has no error.
fn spots(
    points: &[TrendPoint],
    quantity: fn(&TrendPoint) -> LateralEstimates,
    scale: f64,
) -> Option<Vec<Spot>> {
    points
        .iter()
        .map(|point| {
            let [(y, y_error), (z, z_error)] = quantity(point);
            let error = y_error?.hypot(z_error?) / 2.0 * scale;
            Some(Spot { x: point.value, y: (y + z) / 2.0 * scale, error })
        })
        .collect()
}

fn straight(spots: &[Spot], unit: &str) -> (String, Verdict) {
    let fit = line(spots);
    let evidence =
        format!("slope {:.3} ± {:.3} {unit}, R² = {:.3}", fit.slope, fit.slope_error, fit.r_squared);
    let rises = fit.slope > REAL * fit.slope_error;
    let verdict = match (rises, fit.r_squared >= ALMOST_LINEAR) {
        (true, true) => Verdict::Holds,
        (false, _) if fit.slope > 0.0 => Verdict::Open,
        _ => Verdict::Fails,
    };
    (evidence, verdict)
}

fn monotone(spots: &[Spot], direction: f64, unit: &str) -> (String, Verdict) {
    let (first, last) = (spots[0], spots[spots.len() - 1]);
    let steps: Vec<Difference> = spots.windows(2).map(|pair| pair[0].to(pair[1])).collect();
    let (back, verdict) = goes(first.to(last), &steps, direction);
    let evidence = format!(
        "{:.2} ± {:.2} to {:.2} ± {:.2} {unit}; largest step in the other direction {back:.1} standard errors",
        first.y, first.error, last.y, last.error
    );
    (evidence, verdict)
}

/// Whether a trend rises up to a place and changes by less than a tenth after it.
fn plateau(spots: &[Spot], place: f64) -> (String, Verdict) {
    let at = spots.iter().position(|s| s.x >= place * (1.0 - 1e-9)).unwrap_or(spots.len() - 1);
    let first = spots[0];
    let knee = spots[at];
    let last = spots[spots.len() - 1];
    let (rise, after) = (significance(first.to(knee)), (last.y - knee.y) / knee.y);
    let error = last.error.hypot(knee.error) / knee.y;
    let evidence = format!(
        "{:.1} to {:.1} Hz up to {place} ({rise:.1} standard errors), then {:+.0} ± {:.0} %",
        first.y,
        knee.y,
        100.0 * after,
        100.0 * error
    );
    let verdict = if rise < REAL {
        Verdict::Open
    } else if after.abs() <= NEARLY {
        Verdict::Holds
    } else if (after.abs() - NEARLY) < 2.0 * error {
        Verdict::Open
    } else {
        Verdict::Fails
    };
    (evidence, verdict)
}

fn thicker(spots: &[Spot]) -> (String, Verdict) {
    let find = |x: f64| spots.iter().find(|s| (s.x / x - 1.0).abs() < 1e-6);
    let (Some(thin), Some(thick)) = (find(18e-6), find(200e-6)) else {
        return ("18 and 200 µm were not simulated".to_owned(), Verdict::Open);
    };
    let evidence = format!(
        "{:.2} ± {:.2} mm at 18 µm, {:.2} ± {:.2} mm at 200 µm",
        thin.y, thin.error, thick.y, thick.error
    );
    (evidence, Verdict::of_difference(thin.to(*thick)))
}

/// Whether the curve over the diameter is steepest between its ends and flatter at both ends. The paper plots the
/// diameter on a linear axis.
fn sigmoid(spots: &[Spot]) -> (String, Verdict) {
    let slopes = slopes(spots);
    let steepest = (0..slopes.len()).max_by(|&a, &b| slopes[a].0.total_cmp(&slopes[b].0)).unwrap_or(0);
    let middle = |i: usize| 0.5e6 * (spots[i].x + spots[i + 1].x);
    let first = slopes[0];
    let most = slopes[steepest];
    let last = slopes[slopes.len() - 1];
    let per = |slope: (f64, f64)| format!("{:.3} ± {:.3}", slope.0 * 1e-6, slope.1 * 1e-6);
    let evidence = format!(
        "slope {} mm/µm at the thin end, at most {} at {:.0} µm, {} at the thick end",
        per(first),
        per(most),
        middle(steepest),
        per(last)
    );
    let significance_over = |end: (f64, f64)| (most.0 - end.0) / most.1.hypot(end.1);
    let verdict = if significance_over(first) > 2.0 && significance_over(last) > 2.0 {
        Verdict::Holds
    } else if steepest > 0 && steepest + 1 < slopes.len() {
        Verdict::Open
    } else {
        // A point of inflection between the last two points cannot be seen.
        let end = if steepest == 0 { last } else { first };
        if significance_over(end) > 2.0 { Verdict::Fails } else { Verdict::Open }
    };
    (evidence, verdict)
}

/// A point: x, y and the standard error of y.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Spot {
    x: f64,
    y: f64,
    error: f64,
}

impl Spot {
    /// The difference to another point.
    fn to(self, other: Self) -> Difference {
        let (value, standard_error) = (other.y - self.y, self.error.hypot(other.error));
        Difference { value, standard_error, degrees: f64::INFINITY }
    }
}

/// A straight line fitted to points.
#[derive(Clone, Copy, Debug, PartialEq)]
struct StraightLine {
    slope: f64,
    /// Standard error of the slope, from the errors of the points.
    slope_error: f64,
    /// Share of the variance that the line explains.
    r_squared: f64,
}

/// The least-squares line.
fn line(spots: &[Spot]) -> StraightLine {
    let n = spots.len() as f64;
    let mx = spots.iter().map(|s| s.x).sum::<f64>() / n;
    let my = spots.iter().map(|s| s.y).sum::<f64>() / n;
    let sxx: f64 = spots.iter().map(|s| (s.x - mx).powi(2)).sum();
    let sxy: f64 = spots.iter().map(|s| (s.x - mx) * (s.y - my)).sum();
    let syy: f64 = spots.iter().map(|s| (s.y - my).powi(2)).sum();
    let variance: f64 = spots.iter().map(|s| ((s.x - mx) * s.error).powi(2)).sum();
    StraightLine { slope: sxy / sxx, slope_error: variance.sqrt() / sxx, r_squared: sxy * sxy / (sxx * syy) }
}

/// Slopes between neighbouring points, each with its standard error.
fn slopes(spots: &[Spot]) -> Vec<(f64, f64)> {
    let slope = |w: &[Spot]| {
        let dx = w[1].x - w[0].x;
        ((w[1].y - w[0].y) / dx, w[0].error.hypot(w[1].error) / dx.abs())
    };
    spots.windows(2).map(slope).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use spunlaid_experiment::Point;

    fn points(parameter: Parameter, law: impl Fn(f64) -> f64) -> Vec<TrendPoint> {
        let point = |point: &Point| {
            let value = point.values[0];
            let amplitude = [(law(value), Some(0.01 * law(value).abs())); 2];
            TrendPoint { value, amplitude, frequency: amplitude, n: 10 }
        };
        parameter.study().unwrap().points.iter().map(point).collect()
    }

    fn verdicts(parameter: Parameter, law: impl Fn(f64) -> f64) -> Vec<Verdict> {
        claims_of_trend(parameter, &points(parameter, law)).iter().map(|c| c.verdict).collect()
    }

    #[test]
    fn analytic_verdicts_on_known_shapes() {
        use Verdict::{Fails, Holds};
        assert_eq!(verdicts(Parameter::Velocity, |u| 1.0 + 2.0 * u), [Holds, Holds]);
        assert_eq!(verdicts(Parameter::Velocity, |u| (u - 12.0).powi(2)), [Fails, Fails]);
        assert_eq!(verdicts(Parameter::Intensity, |t| 10.0 * t.min(0.15)), [Holds, Holds]);
        assert_eq!(verdicts(Parameter::Intensity, |t| 10.0 * t), [Holds, Fails]);
        assert_eq!(verdicts(Parameter::Intensity, |t| 2.0 - 5.0 * t)[0], Fails);
        let sigmoid = |d: f64| 1.0 / (1.0 + (-(d * 1e6 - 100.0) / 15.0).exp()) + 0.2;
        assert_eq!(verdicts(Parameter::Diameter, sigmoid), [Holds, Holds]);
        assert_eq!(verdicts(Parameter::Diameter, |d| (d * 1e6).sqrt()), [Holds, Fails]);
        assert_eq!(verdicts(Parameter::Cutoff, |f| 1.0 / f), [Holds]);
        assert_eq!(verdicts(Parameter::LengthScale, |l| 1.0 / l), [Fails]);
    }

    #[test]
    fn analytic_errors_in_proportion_to_the_step() {
        let good = [(1e-6, 0.01, 0.02), (4e-6, 0.04, 0.08), (1.6e-5, 0.16, 0.32)];
        assert!(claims_of_step_errors(&good).iter().all(|c| c.verdict == Verdict::Holds));
        let quadratic = [(1e-6, 2.0, 1.5), (4e-6, 32.0, 24.0)];
        assert!(claims_of_step_errors(&quadratic).iter().all(|c| c.verdict == Verdict::Fails));
    }

    fn spots_of(pairs: &[(f64, f64)], error: f64) -> Vec<Spot> {
        pairs.iter().map(|&(x, y)| Spot { x, y, error }).collect()
    }

    #[test]
    fn analytic_line_through_points_on_it() {
        let l = line(&spots_of(&[(0.0, 1.0), (1.0, 3.0), (3.0, 7.0)], 0.1));
        assert!((l.slope - 2.0).abs() < 1e-12 && (l.r_squared - 1.0).abs() < 1e-12);
        // Σ(x−x̄)² = 14/3; the slope's error is 0.1/√(14/3).
        assert!((l.slope_error - 0.1 / (14.0f64 / 3.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn analytic_steps_back_and_slopes() {
        let s = spots_of(&[(0.0, 0.0), (1.0, 2.0), (2.0, 1.0)], 0.5);
        let steps = [s[0].to(s[1]), s[1].to(s[2])];
        let back = |direction| goes(s[0].to(s[2]), &steps, direction).0;
        assert!((back(1.0) - 1.0 / 0.5f64.hypot(0.5)).abs() < 1e-12);
        assert!((back(-1.0) - 2.0 / 0.5f64.hypot(0.5)).abs() < 1e-12);
        assert_eq!(slopes(&s).iter().map(|s| s.0).collect::<Vec<_>>(), [2.0, -1.0]);
    }
}
