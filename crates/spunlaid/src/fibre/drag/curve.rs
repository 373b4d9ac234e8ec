//! Tables for the kernel of the drag laws that are not a power of the velocity.

use super::boundary_layer::BoundaryLayer;
use super::normal::{Form, NormalLaw};
use super::table::TableLaw;
use crate::ground::lanes::{exp2, indices};
use crate::ground::{Register, WIDTH, Wide};
use std::sync::{LazyLock, OnceLock};

/// A law as a positive function `g(s)` of one positive number [-]: the drag by the velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Curve {
    /// `1/α` over `s = V a²/(νx)`; moving through air at rest.                theory.md (43)
    Moving,
    /// `1/α` over `s = V a²/(νx)`; held in a stream.                          theory.md (43)
    Held,
    /// `½ s C_n(s)` over the Reynolds number `s` of a law across the fibre.   theory.md (45)
    Across(NormalLaw),
    /// `½ s C(s)` over the Reynolds number `s` of a law of a file, along or across the fibre.
    Table(TableLaw),
}

impl Curve {
    /// Whether `s` goes down with the distance from the root.
    pub(super) const fn fades(self) -> bool {
        matches!(self, Self::Moving | Self::Held)
    }

    /// `g(s)` itself, which the table of a named law follows to 1e-6.
    pub(crate) fn exact(self, s: f64) -> f64 {
        match self {
            Self::Moving => 1.0 / BoundaryLayer::Moving.thickness(1.0 / s),
            Self::Held => 1.0 / BoundaryLayer::Held.thickness(1.0 / s),
            Self::Across(law) => match law.form() {
                Form::Curve { resistance, .. } => resistance(s),
                Form::Power { coefficient, .. } => 0.5 * s * coefficient(s, 1.0),
                Form::Table(table) => 0.5 * s * table.coefficient(s),
            },
            Self::Table(table) => 0.5 * s * table.coefficient(s),
        }
    }

    pub(super) fn table(self) -> &'static Table {
        static MOVING: LazyLock<Table> = LazyLock::new(|| Table::new(Curve::Moving));
        static HELD: LazyLock<Table> = LazyLock::new(|| Table::new(Curve::Held));
        static ACROSS: [OnceLock<Table>; NormalLaw::ALL.len()] =
            [const { OnceLock::new() }; NormalLaw::ALL.len()];
        match self {
            Self::Moving => &MOVING,
            Self::Held => &HELD,
            Self::Table(law) | Self::Across(NormalLaw::Table(law)) => law.kernel(),
            Self::Across(law) => ACROSS[law.index()].get_or_init(|| Table::new(self)),
        }
    }
}

/// `log2 g` as a function of `q = log2 s²`: cubics of about a unit of `q` each from values and slopes at their
/// ends, and a straight line, a power of the velocity, beyond.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Table {
    /// By powers of the distance from the cubic's lower end, in cubics.
    cubics: [[f64; 4]; CUBICS + 2],
    /// Cubics to a unit of `q`.
    per_unit: f64,
    /// Index of the cubic that begins where `q = 0`, a fraction if need be.
    zero: f64,
}

/// Number of cubics: `s` from 2^-32 to 2^32.
const CUBICS: usize = 128;
/// `q` is taken no further than this: its power stays finite.
const FURTHEST: f64 = 1000.0;

impl Table {
    fn new(curve: Curve) -> Self {
        let middle = CUBICS as f64 / 2.0 + 1.0;
        let joins = match curve {
            Curve::Across(law) => match law.form() {
                Form::Curve { joins, .. } => joins,
                Form::Power { .. } | Form::Table(_) => None,
            },
            Curve::Moving | Curve::Held | Curve::Table(_) => None,
        };
        let (per_unit, zero) = joins.map_or((1.0, middle), |(from, to)| {
            // Cubics end where the pieces of the law do.
            let [from, to] = [from, to].map(|s| 2.0 * libm::log2(s));
            let per_unit = (to - from).round() / (to - from);
            (per_unit, (middle + per_unit * from).round() - per_unit * from)
        });
        Self::of((per_unit, zero), 1.0 / 4096.0, |q| libm::log2(curve.exact(libm::exp2(0.5 * q))))
    }

    /// A law of which `log2 g` is known at every `q`, and is straight outside of `from` to `to`, where the cubics are.
    /// Their slopes are those over two cubics, so that rows that lie closer than cubics cannot make waves.
    pub(super) fn between([from, to]: [f64; 2], log_g: impl Fn(f64) -> f64) -> Self {
        let per_unit = (CUBICS - 2) as f64 / (to - from);
        Self::of((per_unit, 2.0 - per_unit * from), 1.0, log_g)
    }

    /// * `step` – over which slopes are found, in cubics
    fn of((per_unit, zero): (f64, f64), step: f64, log_g: impl Fn(f64) -> f64) -> Self {
        let log_g = |place: f64| log_g((place - zero) / per_unit);
        let end = |place: f64| (log_g(place), (log_g(place + step) - log_g(place - step)) / (2.0 * step));
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

    /// `g` of eight fibres from `q`; NaN gives some finite number.
    #[inline(always)]
    pub(super) fn at<S: Register>(&self, q: Wide<S>) -> Wide<S> {
        let q = q.max(Wide::splat(-FURTHEST));
        let q = Wide::select_less(q, Wide::splat(FURTHEST), q, Wide::splat(FURTHEST));
        let place = q.mul_add(Wide::splat(self.per_unit), Wide::splat(self.zero));
        let last = Wide::splat((CUBICS + 1) as f64);
        let start = place.max(Wide::zero()).floor();
        let start = Wide::select_less(start, last, start, last);
        // No closures here: they would not be compiled for the instruction set.
        let mut rows = [&self.cubics[0]; WIDTH];
        for (row, index) in rows.iter_mut().zip(indices(start)) {
            *row = &self.cubics[index.min(CUBICS + 1)];
        }
        let [c0, c1, c2, c3] = S::load_rows(rows);
        let t = place - start;
        let log_g = Wide(c3).mul_add(t, Wide(c2)).mul_add(t, Wide(c1)).mul_add(t, Wide(c0));
        exp2(log_g)
    }
}

#[cfg(test)]
mod tests {
    use super::{Curve, FURTHEST, Form, NormalLaw};
    use crate::ground::{Lanes, Plain, Register, Wide};

    /// Ends of the tables.
    const REACH: f64 = 63.0;
    fn curves() -> impl Iterator<Item = Curve> {
        let across = NormalLaw::ALL.into_iter().filter(|law| matches!(law.form(), Form::Curve { .. }));
        [Curve::Moving, Curve::Held].into_iter().chain(across.map(Curve::Across))
    }

    fn at(curve: Curve, q: f64) -> f64 {
        Register::store(curve.table().at::<Plain>(Wide::splat(q)).0).0[0]
    }

    /// Fourth derivative of `log2 g`, the largest of three at and beside `q`; large where pieces of a law meet.
    fn fourth(curve: Curve, q: f64) -> f64 {
        const STEP: f64 = 0.5;
        let log_g = |steps: f64| libm::log2(curve.exact(libm::exp2(0.5 * (q + steps * STEP))));
        let terms = [(-2.0, 1.0), (-1.0, -4.0), (0.0, 6.0), (1.0, -4.0), (2.0, 1.0)];
        let difference = |at: f64| terms.iter().map(|(step, factor)| factor * log_g(at + step)).sum::<f64>();
        [-2.0, 0.0, 2.0].map(|at| difference(at).abs() / STEP.powi(4)).into_iter().fold(0.0, f64::max)
    }

    #[test]
    fn analytic_table_follows_the_law() {
        // A cubic between values and slopes is off by g⁗/384 at most; 2^x is to 7.5e-8.
        for curve in curves() {
            for i in 0..=(2.0 * REACH * 37.0) as i32 {
                let q = f64::from(i) / 37.0 - REACH;
                let s = libm::exp2(0.5 * q);
                let error = at(curve, q) / curve.exact(s) - 1.0;
                assert!(error.abs() < fourth(curve, q) / 384.0 + 7.5e-8, "{curve:?} at {s}: {error:e}");
                assert!(error.abs() < 1e-6, "{curve:?} at {s}: {error:e}");
            }
        }
    }

    #[test]
    fn analytic_powers_beyond_the_table() {
        for curve in curves() {
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
        for curve in curves() {
            let q = Lanes::from_fn(|i| 7.3 * i as f64 - 30.0);
            let all = Register::store(curve.table().at::<Plain>(Wide::load(&q)).0);
            assert_eq!(all, Lanes::from_fn(|i| at(curve, q.0[i])));
        }
    }
}
