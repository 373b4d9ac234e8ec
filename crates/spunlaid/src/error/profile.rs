//! Errors of profiles and spectra.

use super::listed;
use crate::units::shortest;

/// What is wrong with a profile or a spectrum, and how to correct it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProfileFault {
    /// A required column is missing.
    #[error("has no column {wanted} (it has {}); name one like {example}", listed(found))]
    NoColumn {
        /// The quantity in it.
        wanted: &'static str,
        /// An example header.
        example: &'static str,
        /// The columns in the file.
        found: Vec<String>,
    },
    /// Two columns hold the same quantity.
    #[error("the columns \"{first}\" and \"{second}\" both are columns {what}; keep one")]
    Twice {
        /// The quantity in them.
        what: &'static str,
        /// The first header.
        first: String,
        /// The second header.
        second: String,
    },
    /// A cell is not a finite number.
    #[error("\"{text}\" is not a finite number; every cell of the table needs one")]
    NotANumber {
        /// The cell.
        text: String,
    },
    /// A number has the wrong sign.
    #[error("{} is {}; {}", shortest(*value), if *value < 0.0 { "negative" } else { "zero" }, if *zero { "zero or more is needed" } else { "more than zero is needed" })]
    Sign {
        /// The number [SI].
        value: f64,
        /// Whether zero is allowed.
        zero: bool,
    },
    /// The table has too few rows.
    #[error("has {found} {} of numbers; at least {least} are needed for interpolation", if *found == 1 { "row" } else { "rows" })]
    TooFewRows {
        /// Number of rows.
        found: usize,
        /// Smallest number of rows.
        least: usize,
    },
    /// The spectrum is zero everywhere.
    #[error("is zero at every frequency; at least one value must be positive")]
    NoEnergy,
}
