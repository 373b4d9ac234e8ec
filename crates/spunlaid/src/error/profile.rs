//! What can be wrong with a profile of the air or a spectrum.

use super::record::listed;
use crate::units::shortest;

/// What is wrong with a profile or a spectrum, and the way out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProfileFault {
    /// A column that must be there.
    #[error("has no column {wanted}, among {}; name one like {example}", listed(found))]
    NoColumn {
        /// What it holds.
        wanted: &'static str,
        /// A header that would do.
        example: &'static str,
        /// The columns there are.
        found: Vec<String>,
    },
    /// Two columns for the same.
    #[error("the columns \"{first}\" and \"{second}\" both are {what}; keep one")]
    Twice {
        /// What they hold.
        what: &'static str,
        /// The first header.
        first: String,
        /// The second header.
        second: String,
    },
    /// A cell that is no finite number.
    #[error("\"{text}\" is not a finite number; every cell of the table needs one")]
    NotANumber {
        /// The cell.
        text: String,
    },
    /// A number of the wrong sign.
    #[error("{} is {}; {}", shortest(*value), if *value < 0.0 { "negative" } else { "zero" }, if *zero { "zero or more is needed" } else { "more than zero is needed" })]
    Sign {
        /// The number [SI].
        value: f64,
        /// Whether zero would do.
        zero: bool,
    },
    /// Too few rows.
    #[error("has {found} {} of numbers; {least} at least are needed to draw lines between", if *found == 1 { "row" } else { "rows" })]
    TooFewRows {
        /// Rows there are.
        found: usize,
        /// Least number.
        least: usize,
    },
    /// A spectrum without energy.
    #[error("has no energy at any frequency; a spectrum needs some")]
    NoEnergy,
}
