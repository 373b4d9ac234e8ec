//! Why the factors of a study cannot be ranked.

/// Why the factors of a study are not ranked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// The fit would pass through all points.
    #[error(
        "{points} points cannot rank {keys} keys: the fit would pass through every point, whatever the results; fly at \
         least {needed} points"
    )]
    TooFewPoints {
        /// Number of points.
        points: usize,
        /// Number of factors.
        keys: usize,
        /// Smallest number of points that can be ranked.
        needed: usize,
    },
    /// A factor has only one value.
    #[error("{key} has the same value at all points; give it at least two values")]
    OneValue {
        /// Its key.
        key: String,
    },
    /// Two factors vary together.
    #[error(
        "{first} and {second} vary together (correlation {correlation:.2}), so their effects cannot be told \
        apart; vary them independently, for example with design = \"grid\""
    )]
    Together {
        /// Key of the one.
        first: String,
        /// Key of the other.
        second: String,
        /// Correlation of their values.
        correlation: f64,
    },
    /// Several factors depend on each other.
    #[error("{key} follows from the other keys at all points, so its effect cannot be separated from theirs")]
    Dependent {
        /// Key of one of them.
        key: String,
    },
    /// A point has no result.
    #[error("point {point} has no fibre that was completed")]
    NoResult {
        /// Number of the point, counted from 1.
        point: usize,
    },
}
