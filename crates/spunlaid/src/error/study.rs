//! Errors of studies: of the study file and of the journal.

use crate::units::{ExpressionFault, excerpt};
use std::path::{Path, PathBuf};

/// What is wrong with a value of a study file. The text continues after `key = value `.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StudyFault {
    /// A required key is missing.
    #[error("is missing; add {line}")]
    Missing {
        /// An example line.
        line: &'static str,
    },
    /// No key has this name.
    #[error("is not a key of a study file; {advice}")]
    UnknownKey {
        /// The most similar key, or all keys.
        advice: String,
    },
    /// A table that belongs to a case.
    #[error(
        "is a table of a case; a study names its case, as case = \"table1.toml\", and `spunlaid run` flies a case"
    )]
    TableOfCase,
    /// A key that cannot be varied or linked.
    #[error("cannot be set by a study; {advice}")]
    NotVaried {
        /// The reason, or the keys that can.
        advice: String,
    },
    /// A key is both varied and linked.
    #[error("is both varied and linked; keep one")]
    Twice,
    /// A key has no values.
    #[error("has no values; list some, as [\"5 m/s\", \"10 m/s\"], or write {{ from, to, steps }}")]
    NoValues,
    /// The study varies nothing.
    #[error(
        "names no key to vary; write a key and its values, as \"air.velocity\" = [\"5 m/s\", \"10 m/s\"]"
    )]
    NothingVaries,
    /// A range without the number of values that the design needs.
    #[error("has no steps; design = \"{design}\" needs single values: add steps = 5, or list the values")]
    NoSteps {
        /// Name of the design.
        design: &'static str,
    },
    /// A range with a number of values that the design does not use.
    #[error("has steps, but design = \"{design}\" draws its values from the range; leave steps out")]
    NeedlessSteps {
        /// Name of the design.
        design: &'static str,
    },
    /// A logarithmic range with an end at or below zero.
    #[error("has logarithmic spacing, which needs two ends above zero; write spacing = \"linear\"")]
    LogThroughZero,
    /// A range with two equal ends.
    #[error("has two equal ends; write two different ends, or a list of one value")]
    NoWidth,
    /// Paired lists of different lengths.
    #[error("has {found} values, but \"{first}\" has {wanted}; paired lists must have the same length")]
    Unpaired {
        /// Number of values.
        found: u64,
        /// Key of the first list.
        first: &'static str,
        /// Its number of values.
        wanted: u64,
    },
    /// More factors than the design allows.
    #[error("names {found} keys; design = \"{design}\" takes at most {most}")]
    TooManyFactors {
        /// Number of factors.
        found: usize,
        /// Name of the design.
        design: &'static str,
        /// The most that it allows.
        most: usize,
    },
    /// More points than are flown without asking.
    #[error("makes {points} points, more than the {most} that are flown without being asked for; {advice}")]
    TooManyPoints {
        /// Their number.
        points: String,
        /// The most without asking.
        most: u64,
        /// How to correct it.
        advice: String,
    },
    /// The number of points is not the one that was asked for.
    #[error("makes {points} points, not the {asked} that were asked for")]
    OtherPoints {
        /// Their number.
        points: u64,
        /// The number asked for.
        asked: u64,
    },
    /// More fibres than are allowed.
    #[error("flies {fibres:.1e} fibres in all, more than {most:e}; lower the replicates or the points")]
    TooManyFibres {
        /// Their number.
        fibres: f64,
        /// The most.
        most: f64,
    },
    /// A key that the case does not give.
    #[error("is not written in the case, so it follows from other keys; write it there to {purpose}")]
    NotWritten {
        /// The purpose.
        purpose: &'static str,
    },
    /// A faulty formula.
    #[error(transparent)]
    Expression(#[from] ExpressionFault),
    /// Links that depend on each other in a circle.
    #[error("follows from itself: {0}; break the circle")]
    Circle(String),
    /// An unknown name of a result.
    #[error("is not a result; {advice}")]
    UnknownResult {
        /// The most similar result, or all results.
        advice: String,
    },
    /// A fraction out of range.
    #[error("is not a fraction of the mean; write a number between 0 and 1, like 0.05 or \"5 %\"")]
    NoFraction,
    /// The smallest number of replicates is above the largest.
    #[error("is more than at_most = {most}; lower it")]
    MoreThanMost {
        /// The most replicates.
        most: u64,
    },
}

/// What is wrong with a journal, which holds the results of a study fibre by fibre.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JournalError {
    /// Another process is writing it.
    #[error(
        "{}: another spunlaid is at work in this folder; wait for it, or use another folder",
        shown(path)
    )]
    InUse {
        /// The journal.
        path: PathBuf,
    },
    /// The file is not a journal.
    #[error(
        "{}: is not the journal of a study, or its first line is damaged; it cannot be used. Use another folder, or start again from the beginning",
        shown(path)
    )]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// The journal has another format.
    #[error(
        "{}: is a journal of format {format}, but this spunlaid reads format {known}. Continue with the spunlaid that wrote it, use another folder, or start again from the beginning",
        shown(path)
    )]
    Format {
        /// The file.
        path: PathBuf,
        /// Its format.
        format: String,
        /// The format known.
        known: u32,
    },
    /// The journal cannot be opened or read.
    #[error("{}: cannot be used: {source}", shown(path))]
    Unusable {
        /// The file.
        path: PathBuf,
        /// Message of the operating system.
        source: std::io::Error,
    },
    /// Nothing can be added to the journal.
    #[error(
        "{}: cannot be written: {source}; the fibres done so far are kept. Correct the cause, then repeat the command to continue",
        shown(path)
    )]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Message of the operating system.
        source: std::io::Error,
    },
    /// Its records cannot be written to the disk.
    #[error(
        "the journal cannot be written to the disk: {0}; correct the cause, then repeat the command to continue"
    )]
    Unsynced(std::io::Error),
}

/// A path for messages, without control characters.
fn shown(path: &Path) -> String {
    excerpt(&path.display().to_string(), 1000)
}
