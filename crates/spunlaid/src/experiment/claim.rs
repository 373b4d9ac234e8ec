//! What is claimed of results, and whether the data support it.

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
    pub(crate) const fn of(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::Fails }
    }

    /// Of a difference in standard errors, which the claim says is above zero.
    pub(crate) fn of_difference(difference: f64) -> Self {
        match difference {
            _ if difference > REAL => Self::Holds,
            _ if difference < -REAL => Self::Fails,
            _ => Self::Open,
        }
    }
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
