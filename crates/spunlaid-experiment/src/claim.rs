//! What is claimed of results, and whether the data support it.

use spunlaid_ground::Difference;
use std::borrow::Cow;

/// Number of standard errors from which a difference counts as real.
pub const REAL: f64 = 3.0;
/// Number of standard errors up to which a step in the wrong direction counts as chance.
pub(crate) const CHANCE: f64 = 2.5;

named! {
    /// Whether a claim holds.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Verdict {
        /// The data support it.
        Holds = "holds",
        /// The data contradict it.
        Fails = "does not hold",
        /// The errors are too large to decide. More replicates would help.
        Open = "open",
    }
}

impl Verdict {
    /// Of something that is known without doubt.
    pub const fn of(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::Fails }
    }

    /// Of a difference that the claim says is above zero. Without an error every difference counts.
    pub fn of_difference(difference: Difference) -> Self {
        match significance(difference) {
            _ if difference.standard_error == 0.0 => Self::of(difference.value > 0.0),
            errors if errors > REAL => Self::Holds,
            errors if errors < -REAL => Self::Fails,
            _ => Self::Open,
        }
    }
}

/// A difference in standard errors.
pub fn significance(difference: Difference) -> f64 {
    match difference.value {
        0.0 => 0.0,
        value if difference.standard_error == 0.0 => value.signum() * f64::INFINITY,
        value => value / difference.standard_error,
    }
}

/// How a result goes in a direction (`+1` up, `−1` down) from the first to the last value of a key: the largest step
/// the other way in standard errors, zero if there is none, and whether it goes there.
///
/// * `ends`, `steps` – from the first to the last value, and from each to the next
pub fn goes(ends: Difference, steps: &[Difference], direction: f64) -> (f64, Verdict) {
    let back = steps.iter().map(|step| -direction * significance(*step)).fold(0.0, f64::max);
    let forth = Difference { value: direction * ends.value, ..ends };
    (back, if back > CHANCE { Verdict::Fails } else { Verdict::of_difference(forth) })
}

/// Written as its name.
impl serde::Serialize for Verdict {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// A claim, judged.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Claim {
    /// The figure of the paper that it is about; empty if it is about none.
    #[serde(skip_serializing_if = "str::is_empty")]
    pub figure: &'static str,
    /// The claim.
    pub claim: Cow<'static, str>,
    /// The numbers for or against it.
    pub evidence: String,
    /// The verdict.
    pub verdict: Verdict,
}
