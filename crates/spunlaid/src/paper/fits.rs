//! Lines, differences and slopes of a series of points with errors.

/// A point: x, y and the standard error of y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spot {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) error: f64,
}

/// A straight line fitted to points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    pub(super) slope: f64,
    /// Standard error of the slope, from the errors of the points.
    pub(super) slope_error: f64,
    /// Share of the variance that the line explains.
    pub(super) r_squared: f64,
}

/// The least-squares line.
pub(super) fn line(spots: &[Spot]) -> Line {
    let n = spots.len() as f64;
    let (mx, my) = (spots.iter().map(|s| s.x).sum::<f64>() / n, spots.iter().map(|s| s.y).sum::<f64>() / n);
    let sxx: f64 = spots.iter().map(|s| (s.x - mx).powi(2)).sum();
    let sxy: f64 = spots.iter().map(|s| (s.x - mx) * (s.y - my)).sum();
    let syy: f64 = spots.iter().map(|s| (s.y - my).powi(2)).sum();
    let variance: f64 = spots.iter().map(|s| ((s.x - mx) * s.error).powi(2)).sum();
    Line { slope: sxy / sxx, slope_error: variance.sqrt() / sxx, r_squared: sxy * sxy / (sxx * syy) }
}

/// The difference of two points, divided by its standard error.
pub(super) fn significance(from: &Spot, to: &Spot) -> f64 {
    let error = from.error.hypot(to.error);
    let difference = to.y - from.y;
    if error > 0.0 { difference / error } else { difference.signum() * f64::INFINITY }
}

/// The largest step against the general direction (`+1` up, `−1` down), in standard errors. Zero if there is none.
pub(super) fn worst_step_back(spots: &[Spot], direction: f64) -> f64 {
    spots.windows(2).map(|w| -direction * significance(&w[0], &w[1])).fold(0.0, f64::max)
}

/// Slopes between neighbouring points, each with its standard error.
pub(super) fn slopes(spots: &[Spot]) -> Vec<(f64, f64)> {
    let slope = |w: &[Spot]| {
        let dx = w[1].x - w[0].x;
        ((w[1].y - w[0].y) / dx, w[0].error.hypot(w[1].error) / dx.abs())
    };
    spots.windows(2).map(slope).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spots(pairs: &[(f64, f64)], error: f64) -> Vec<Spot> {
        pairs.iter().map(|&(x, y)| Spot { x, y, error }).collect()
    }

    #[test]
    fn analytic_line_through_points_on_it() {
        let l = line(&spots(&[(0.0, 1.0), (1.0, 3.0), (3.0, 7.0)], 0.1));
        assert!((l.slope - 2.0).abs() < 1e-12 && (l.r_squared - 1.0).abs() < 1e-12);
        // Σ(x−x̄)² = 14/3; the slope's error is 0.1/√(14/3).
        assert!((l.slope_error - 0.1 / (14.0f64 / 3.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn analytic_steps_back_and_slopes() {
        let s = spots(&[(0.0, 0.0), (1.0, 2.0), (2.0, 1.0)], 0.5);
        assert!((worst_step_back(&s, 1.0) - 1.0 / 0.5f64.hypot(0.5)).abs() < 1e-12);
        assert!((worst_step_back(&s, -1.0) - 2.0 / 0.5f64.hypot(0.5)).abs() < 1e-12);
        assert_eq!(slopes(&s).iter().map(|s| s.0).collect::<Vec<_>>(), [2.0, -1.0]);
    }
}
