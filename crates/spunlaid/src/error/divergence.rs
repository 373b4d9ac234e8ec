//! What shows that the computation of a fibre has diverged.

use crate::units::Dimension;

/// What shows that the computation of a fibre has diverged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DivergenceSign {
    /// A position has become infinite or NaN.
    NotFinite,
    /// An element has not the length that belongs to its tension.
    Length {
        /// By how much it is off, in parts of its rest length [-].
        off: f64,
    },
    /// An element is far longer or shorter than a fibre can be.
    Strain {
        /// Its strain [-].
        strain: f64,
    },
    /// A node is far faster than anything that drives the fibre.
    Speed {
        /// Its speed [m/s].
        speed: f64,
        /// The speed that air, feed, belt, gravity and elasticity can give it [m/s].
        given: f64,
    },
}

impl DivergenceSign {
    /// The sign in words.
    ///
    /// * `node` – counted from 1 at the root
    pub(super) fn at(self, node: usize) -> String {
        let percent = |share: f64| format!("{} %", Dimension::Ratio.pretty_to(100.0 * share, 3));
        let speed = |v: f64| Dimension::Velocity.pretty_to(v, 3);
        match self {
            Self::NotFinite => format!("node {node} is no longer finite"),
            Self::Length { off } => {
                format!(
                    "the element below node {node} is off by {} from the length that its tension gives it",
                    percent(off)
                )
            }
            Self::Strain { strain } => {
                format!(
                    "the element below node {node} has a strain of {}, which no fibre can have",
                    percent(strain)
                )
            }
            Self::Speed { speed: seen, given } => format!(
                "node {node} moves with {}, while air, feed, belt, gravity and elasticity together give no more than about {}",
                speed(seen),
                speed(given)
            ),
        }
    }
}
