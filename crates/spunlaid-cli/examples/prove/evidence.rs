//! Whether a number is further from what it should be than its error allows, while observations come one by one.
//!
//! Each observation is a deviation in units of the error, converted to a standard normal score. The evidence against
//! the error is the mean of several likelihood ratios, of scores that are shifted or wider against scores that are
//! standard normal. By Ville's inequality it exceeds 1/α once, however long one looks and whenever one stops, with a
//! probability of at most α: Ramdas et al., Statistical Science 38 (2023) 576.

use std::fmt;

/// How errors can be wrong.
pub struct Wrong {
    /// Shifts and widths of the scores that they make.
    alternatives: &'static [(f64, f64)],
    /// An error counts as wrong only if it is so by more than this factor.
    tolerance: f64,
    /// A score beyond this counts as this one.
    largest: f64,
    /// The evidence at which a number is reported: the inverse of the probability that a right one ever reaches it.
    pub reported: f64,
}

/// The errors of an input that are too small. There are some 10⁷ numbers of inputs in ten hours of a processor, so that
/// there is a false one in ten such runs.
pub static TOO_SMALL: Wrong =
    Wrong { alternatives: &SHIFTED_OR_WIDER, tolerance: 1.5, largest: f64::INFINITY, reported: 1e8 };
/// The errors of an input that are too large.
pub static TOO_LARGE: Wrong = Wrong {
    alternatives: &[(0.0, 0.25), (0.0, 0.06)],
    tolerance: 0.25,
    largest: f64::INFINITY,
    reported: 1e8,
};
/// The errors of a number in all inputs of a kind together. One input with a large deviation says nothing of all,
/// and is looked at by itself. There are some 10⁴ such numbers.
pub static TOO_SMALL_IN_ALL: Wrong = Wrong {
    alternatives: &[(0.0, 1.3), (0.0, 1.6), (0.0, 2.0)],
    tolerance: 1.5,
    largest: 3.0,
    reported: 1e6,
};

const SHIFTED_OR_WIDER: [(f64, f64); 10] = [
    (0.5, 1.0),
    (-0.5, 1.0),
    (1.0, 1.0),
    (-1.0, 1.0),
    (3.0, 1.0),
    (-3.0, 1.0),
    (0.0, 1.5),
    (0.0, 2.0),
    (0.0, 4.0),
    (0.0, 16.0),
];

/// The evidence against one number.
#[derive(Clone)]
pub struct Evidence {
    wrong: &'static Wrong,
    logarithms: Vec<f64>,
    pub observations: u32,
}

impl Evidence {
    /// Below this nothing is suspected.
    pub const SUSPECTED: f64 = 4.0;

    pub fn new(wrong: &'static Wrong) -> Self {
        Self { wrong, logarithms: vec![0.0; wrong.alternatives.len()], observations: 0 }
    }

    /// Takes a deviation, in units of its error, and the degrees of freedom of that error.
    pub fn take(&mut self, deviation: f64, degrees: f64) {
        let score = normal_score(deviation / self.wrong.tolerance, degrees);
        let score = score.clamp(-self.wrong.largest, self.wrong.largest);
        for (logarithm, (shift, width)) in self.logarithms.iter_mut().zip(self.wrong.alternatives) {
            *logarithm += 0.5 * (score * score - ((score - shift) / width).powi(2)) - width.ln();
        }
        self.observations += 1;
    }

    pub fn is_enough(&self) -> bool {
        self.value() > self.wrong.reported
    }

    /// By how much the observations are likelier if the error is wrong.
    pub fn value(&self) -> f64 {
        self.logarithms.iter().map(|logarithm| logarithm.exp()).sum::<f64>() / self.logarithms.len() as f64
    }
}

impl fmt::Display for Evidence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.0e} of {} observations", self.value(), self.observations)
    }
}

/// The standard normal score that is as likely to be exceeded as a value of Student's t, by Wallace (Annals of
/// Mathematical Statistics 30 (1959) 1121).
fn normal_score(t: f64, degrees: f64) -> f64 {
    let n = degrees.max(1.0);
    let score = (8.0 * n + 1.0) / (8.0 * n + 3.0) * (n * (t * t / n).ln_1p()).sqrt();
    score.min(40.0).copysign(t)
}

/// Claims of the program, of which one in twenty may be false.
#[derive(Clone, Debug, Default)]
pub struct Claims {
    pub all: u64,
    pub false_ones: u64,
}

impl Claims {
    /// More may be false by this factor before they count as wrong.
    const TOLERANCE: f64 = 2.0;

    pub fn take(&mut self, is_false: bool) {
        self.all += 1;
        self.false_ones += u64::from(is_false);
    }

    /// Whether there are too many false ones, by the likelihood of several larger shares.
    pub fn are_wrong(&self) -> bool {
        const REPORTED: f64 = 1e8;
        /// Shares of wrong claims.
        const SHARES: [f64; 4] = [0.2, 0.4, 0.7, 0.99];
        let usual = 0.05 * Self::TOLERANCE;
        let wrong = self.false_ones as f64;
        let right = (self.all - self.false_ones) as f64;
        let likelihood =
            |share: f64| (wrong * (share / usual).ln() + right * ((1.0 - share) / (1.0 - usual)).ln()).exp();
        SHARES.map(likelihood).iter().sum::<f64>() / SHARES.len() as f64 > REPORTED
    }
}
