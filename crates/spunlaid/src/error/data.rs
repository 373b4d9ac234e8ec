//! What can be wrong with a file that a case names.

use super::record::listed;
use super::{FieldError, RecordProblem, memory};
use crate::units::{Dimension, Wanted, shortest};
use std::path::PathBuf;

/// A reason why a file that a case names cannot be used; reads on after `air.profile = "a.csv" cannot be used: `.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DataError {
    /// A table.
    #[error("{}{}: {fault}", path.display(), line.map_or(String::new(), |line| format!(":{line}")))]
    Table {
        /// The file.
        path: PathBuf,
        /// Line, from 1, where one is to blame.
        line: Option<u64>,
        /// What is wrong.
        fault: TableFault,
    },
    /// A velocity record.
    #[error("{0}")]
    Record(Box<RecordProblem>),
    /// A field.
    #[error("{0}")]
    Field(Box<FieldError>),
}

/// What is wrong with a table of numbers, and the way out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TableFault {
    /// The file is not there.
    #[error(
        "there is no such file; a path counts from the folder of the case file, one given by --set from here"
    )]
    NotThere,
    /// A folder.
    #[error("is a folder; name the table in it")]
    IsFolder,
    /// The system does not let it be read.
    #[error("cannot be read: {message}")]
    Unreadable {
        /// What the system says.
        message: String,
    },
    /// Larger than any such table.
    #[error("is larger than {}, which no such table is; a velocity over time is air.record", memory(*most as f64))]
    TooLarge {
        /// The largest size read [bytes].
        most: u64,
    },
    /// Not text, or not a table.
    #[error("is no table of comma-, semicolon- or tab-separated values in UTF-8: {message}")]
    NotATable {
        /// What the reader says.
        message: String,
    },
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
    /// A column without a unit, or with one of something else.
    #[error("column \"{header}\" holds {}; write the unit into its name, like {example}", Wanted(*dimension))]
    Unit {
        /// The header.
        header: String,
        /// What it must measure.
        dimension: Dimension,
        /// A header that would do.
        example: &'static str,
    },
    /// A cell that is no finite number.
    #[error("column \"{header}\": \"{text}\" is not a finite number; every cell of the table needs one")]
    NotANumber {
        /// The header.
        header: String,
        /// The cell.
        text: String,
    },
    /// A number of the wrong sign.
    #[error("column \"{header}\": {} is {}; {}", shortest(*value), if *value < 0.0 { "negative" } else { "zero" }, if *zero { "zero or more is needed" } else { "more than zero is needed" })]
    Sign {
        /// The header.
        header: String,
        /// The number [SI].
        value: f64,
        /// Whether zero would do.
        zero: bool,
    },
    /// Rows out of order.
    #[error("column \"{header}\" goes from {} to {}; rows must be in rising order", shortest(*before), shortest(*after))]
    NotRising {
        /// The header.
        header: String,
        /// The number of the row before [SI].
        before: f64,
        /// The number of this row [SI].
        after: f64,
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
