//! A drag law for the kernel: cubics of its logarithm, evenly spaced.

use spunlaid_ground::lanes::{exp2, indices};
use spunlaid_ground::{Register, WIDTH, Wide};

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
pub(super) const CUBICS: usize = 128;
/// `q` is taken no further than this: its power stays finite.
pub(super) const FURTHEST: f64 = 1000.0;

impl Table {
    /// A law of which `log2 g` is known at every `q`, and is straight outside of `from` to `to`, where the cubics are.
    /// Their slopes are those over two cubics, so that rows that lie closer than cubics cannot make waves.
    pub(super) fn between([from, to]: [f64; 2], log_g: impl Fn(f64) -> f64) -> Self {
        let per_unit = (CUBICS - 2) as f64 / (to - from);
        Self::of(per_unit, 2.0 - per_unit * from, 1.0, log_g)
    }

    /// * `step` – over which slopes are found, in cubics
    pub(super) fn of(per_unit: f64, zero: f64, step: f64, log_g: impl Fn(f64) -> f64) -> Self {
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
    pub fn at<S: Register>(&self, q: Wide<S>) -> Wide<S> {
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
