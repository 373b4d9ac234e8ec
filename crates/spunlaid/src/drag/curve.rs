//! Tables of the drag laws that are not a power of the velocity.

use super::boundary_layer::BoundaryLayer;
use super::normal::{PIECES, resistance};
use crate::lanes::{Lanes, Register, Wide, exp2};
use std::sync::LazyLock;

/// A law as a positive function `g(s)` of one positive number [-]: the ratio of drag to velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Curve {
    /// `1/α` over `s = V a²/(νx)`; moving through air at rest.                theory.md (43)
    Moving,
    /// `1/α` over `s = V a²/(νx)`; held in a stream.                          theory.md (43)
    Held,
    /// `w c_n(w)` over the Reynolds number `s = w` of Marheineke & Wegener.   theory.md (44)
    Normal,
}

impl Curve {
    /// Whether `s` decreases with the distance from the root.
    pub(super) const fn fades(self) -> bool {
        matches!(self, Self::Moving | Self::Held)
    }

    /// `g(s)` itself. The table agrees with it to 1e-6.
    pub fn exact(self, s: f64) -> f64 {
        match self {
            Self::Moving => 1.0 / BoundaryLayer::Moving.thickness(1.0 / s),
            Self::Held => 1.0 / BoundaryLayer::Held.thickness(1.0 / s),
            Self::Normal => resistance(s),
        }
    }

    pub(super) fn table(self) -> &'static Table {
        static MOVING: LazyLock<Table> = LazyLock::new(|| Table::of(Curve::Moving));
        static HELD: LazyLock<Table> = LazyLock::new(|| Table::of(Curve::Held));
        static NORMAL: LazyLock<Table> = LazyLock::new(|| Table::of(Curve::Normal));
        match self {
            Self::Moving => &MOVING,
            Self::Held => &HELD,
            Self::Normal => &NORMAL,
        }
    }
}

/// `log2 g` as a function of `q = log2 s²`: cubics from values and slopes at their ends, each about one unit of
/// `q` long. Outside the table, a straight line continues it, which is a power of the velocity.
#[derive(Clone, Debug)]
pub(super) struct Table {
    /// Coefficients by powers of the distance from the cubic's lower end, in units of a cubic.
    cubics: [[f64; 4]; CUBICS + 2],
    /// Number of cubics for one unit of `q`.
    per_unit: f64,
    /// Index at `q = 0`; it may be a fraction.
    zero: f64,
}

/// Number of cubics: `s` from 2^-32 to 2^32.
const CUBICS: usize = 128;
/// Limit of `q`, so that its power stays finite.
const FURTHEST: f64 = 1000.0;

impl Table {
    fn of(curve: Curve) -> Self {
        let middle = CUBICS as f64 / 2.0 + 1.0;
        let (per_unit, zero) = match curve {
            Curve::Moving | Curve::Held => (1.0, middle),
            Curve::Normal => {
                // The cubics end at the ends of the pieces of the law.
                let [from, to] = [PIECES.0, PIECES.1].map(|s| 2.0 * libm::log2(s));
                let per_unit = (to - from).round() / (to - from);
                (per_unit, (middle + per_unit * from).round() - per_unit * from)
            }
        };
        let log_g = |place: f64| libm::log2(curve.exact(libm::exp2(0.5 * (place - zero) / per_unit)));
        let end = |place: f64| {
            const STEP: f64 = 1.0 / 4096.0;
            (log_g(place), (log_g(place + STEP) - log_g(place - STEP)) / (2.0 * STEP))
        };
        let mut lower = end(1.0);
        let mut cubics = [[lower.0 - lower.1, lower.1, 0.0, 0.0]; CUBICS + 2];
        for (i, cubic) in cubics.iter_mut().enumerate().skip(1) {
            let upper = end(i as f64 + 1.0);
            let (curved, twisted) = (upper.0 - lower.0 - lower.1, upper.1 - lower.1);
            *cubic = [lower.0, lower.1, 3.0 * curved - twisted, twisted - 2.0 * curved];
            lower = upper;
        }
        cubics[CUBICS + 1][2..].fill(0.0);
        Self { cubics, per_unit, zero }
    }

    /// `g` of eight fibres from `q`. NaN gives a finite number.
    #[inline(always)]
    pub(super) fn at<S: Register>(&self, q: Wide<S>) -> Wide<S> {
        let q = q.max(Wide::splat(-FURTHEST));
        let q = Wide::select_less(q, Wide::splat(FURTHEST), q, Wide::splat(FURTHEST));
        let place = q.mul_add(Wide::splat(self.per_unit), Wide::splat(self.zero));
        let (mut start, mut coefficients) = (Lanes::ZERO, [Lanes::ZERO; 4]);
        // No closures here, because they would not be compiled for the instruction set.
        for (i, place) in place.store().0.iter().enumerate() {
            let cubic = (*place as usize).min(CUBICS + 1);
            start.0[i] = cubic as f64;
            for (lanes, coefficient) in coefficients.iter_mut().zip(&self.cubics[cubic]) {
                lanes.0[i] = *coefficient;
            }
        }
        let t = place - Wide::load(&start);
        let mut log_g = Wide::load(&coefficients[3]);
        for k in [2, 1, 0] {
            log_g = log_g.mul_add(t, Wide::load(&coefficients[k]));
        }
        exp2(log_g)
    }
}

#[cfg(test)]
mod tests {
    use super::{Curve, FURTHEST};
    use crate::lanes::{Lanes, Plain, Register, Wide};

    /// Ends of the tables.
    const REACH: f64 = 63.0;
    const CURVES: [Curve; 3] = [Curve::Moving, Curve::Held, Curve::Normal];

    fn at(curve: Curve, q: f64) -> f64 {
        Register::store(curve.table().at::<Plain>(Wide::splat(q)).0).0[0]
    }

    #[test]
    fn analytic_table_follows_the_law() {
        // A cubic between values and slopes is off by g⁗/384 at most, g⁗ < 1e-4 in these laws; 2^x is to 7.5e-8.
        for curve in CURVES {
            for i in 0..=(2.0 * REACH * 37.0) as i32 {
                let q = f64::from(i) / 37.0 - REACH;
                let s = libm::exp2(0.5 * q);
                let error = at(curve, q) / curve.exact(s) - 1.0;
                assert!(error.abs() < 1e-4 / 384.0 + 7.5e-8, "{curve:?} at {s}: {error:e}");
            }
        }
    }

    #[test]
    fn analytic_powers_beyond_the_table() {
        for curve in CURVES {
            for sign in [1.0, -1.0] {
                let [a, b, c] = [1.0, 2.0, 3.0].map(|k| at(curve, sign * (REACH + 100.0 * k)));
                assert!((b * b / (a * c) - 1.0).abs() < 1e-6, "{curve:?}: {a} {b} {c}");
                assert_eq!(at(curve, sign * FURTHEST), at(curve, sign * 1e9));
                assert!(at(curve, sign * f64::INFINITY).is_finite());
            }
            // The drag grows faster than the velocity, and no faster than its square.
            for q in [-REACH, -1.0, 3.0, REACH] {
                let rise = at(curve, q + 0.5) / at(curve, q);
                assert!(rise > 1.0 && rise < f64::exp2(0.25) * (1.0 + 1e-6), "{curve:?} at {q}: {rise}");
            }
            assert!(at(curve, f64::NAN).is_finite());
        }
    }

    #[test]
    fn identical_lane_by_lane() {
        for curve in CURVES {
            let q = Lanes::from_fn(|i| 7.3 * i as f64 - 30.0);
            let all = Register::store(curve.table().at::<Plain>(Wide::load(&q)).0);
            assert_eq!(all, Lanes::from_fn(|i| at(curve, q.0[i])));
        }
    }
}
