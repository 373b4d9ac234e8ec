//! What can be wrong with a study: with its file, with its journal.

use crate::units::{ExpressionFault, excerpt};
use std::path::{Path, PathBuf};

/// What is wrong with a value of a study file; reads on after `key = value `.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StudyFault {
    /// A required key is not there.
    #[error("is missing; add {line}")]
    Missing {
        /// A line that would do.
        line: &'static str,
    },
    /// No key has this name.
    #[error("is not a key of a study file; {advice}")]
    UnknownKey {
        /// The key that may be meant, or all there are.
        advice: String,
    },
    /// A table of a case.
    #[error(
        "is a table of a case; a study names its case, as case = \"table1.toml\", and `spunlaid run` flies a case"
    )]
    TableOfCase,
    /// A key that cannot be varied or linked.
    #[error("cannot be set by a study; {advice}")]
    NotVaried {
        /// Why, or which can.
        advice: String,
    },
    /// Varied and linked, or the like.
    #[error("is both varied and linked; keep one")]
    Twice,
    /// No values.
    #[error("has no values; list some, as [\"5 m/s\", \"10 m/s\"], or write {{ from, to, steps }}")]
    NoValues,
    /// Nothing varies.
    #[error(
        "names nothing to vary; write a key and its values, as \"air.velocity\" = [\"5 m/s\", \"10 m/s\"]"
    )]
    NothingVaries,
    /// A range without a number of values where one is needed.
    #[error("has no steps; design = \"{design}\" takes the values as they are: add steps = 5 or list them")]
    NoSteps {
        /// Name of the design.
        design: &'static str,
    },
    /// A range with a number of values where none is wanted.
    #[error("has steps, but design = \"{design}\" draws its values from the range; leave steps out")]
    NeedlessSteps {
        /// Name of the design.
        design: &'static str,
    },
    /// Logarithmic through zero.
    #[error("is spaced logarithmically, which takes two ends above zero; write spacing = \"linear\"")]
    LogThroughZero,
    /// A range of no width.
    #[error("starts where it ends; write two different ends, or a list of one value")]
    NoWidth,
    /// Lists of different lengths.
    #[error("has {found} values where \"{first}\" has {wanted}; paired lists are of one length")]
    Unpaired {
        /// Number of values.
        found: u64,
        /// Key of the first list.
        first: &'static str,
        /// Its number of values.
        wanted: u64,
    },
    /// More factors than the design takes.
    #[error("names {found} keys; design = \"{design}\" takes at most {most}")]
    TooManyFactors {
        /// Number of factors.
        found: usize,
        /// Name of the design.
        design: &'static str,
        /// The most it takes.
        most: usize,
    },
    /// More points than are flown unasked.
    #[error("makes {points} points, more than the {most} that are flown unasked; {advice}")]
    TooManyPoints {
        /// How many.
        points: String,
        /// The most unasked.
        most: u64,
        /// The way out.
        advice: String,
    },
    /// Another number of points than asked for.
    #[error("makes {points} points, not the {asked} that were asked for")]
    OtherPoints {
        /// How many.
        points: u64,
        /// How many were asked for.
        asked: u64,
    },
    /// More fibres than can be counted.
    #[error("flies {fibres:.1e} fibres in all, more than {most:e}; lower the replicates or the points")]
    TooManyFibres {
        /// How many.
        fibres: f64,
        /// The most.
        most: f64,
    },
    /// A key that the case leaves open.
    #[error("is not written in the case, where it follows from other keys; write it there, to {purpose}")]
    NotWritten {
        /// What for.
        purpose: &'static str,
    },
    /// A formula.
    #[error(transparent)]
    Expression(#[from] ExpressionFault),
    /// Links that follow from one another.
    #[error("follows from itself: {0}; break the circle")]
    Circle(String),
    /// A name of a result that there is none of.
    #[error("is not a result; {advice}")]
    UnknownResult {
        /// The result that may be meant, or all there are.
        advice: String,
    },
    /// A fraction out of range.
    #[error("is no fraction of the mean; write a number between 0 and 1, like 0.05 or \"5 %\"")]
    NoFraction,
    /// More at least than at most.
    #[error("is more than at_most = {most}; lower it")]
    MoreThanMost {
        /// The most replicates.
        most: u64,
    },
}

/// What is wrong with a journal, the records of a study.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JournalError {
    /// Another process writes it.
    #[error(
        "{}: another spunlaid is at work in this folder; wait for it, or use another folder",
        shown(path)
    )]
    InUse {
        /// The journal.
        path: PathBuf,
    },
    /// Not a journal.
    #[error(
        "{}: is not the journal of a study, or its first line is damaged; nothing of it can be used. Use another folder, or start anew",
        shown(path)
    )]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// A journal of another format.
    #[error(
        "{}: is a journal of format {format}, and this spunlaid knows {known}. Go on with the spunlaid that wrote it, use another folder, or start anew",
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
    /// It cannot be opened or read.
    #[error("{}: cannot be used: {source}", shown(path))]
    Unusable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// It cannot be added to.
    #[error(
        "{}: cannot be written: {source}; what has landed so far is kept. Mend that, then the same command goes on",
        shown(path)
    )]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Its records do not reach the disk.
    #[error("the journal does not reach the disk: {0}; mend that, then the same command goes on")]
    Unsynced(std::io::Error),
}

/// A path as messages name it, without control characters.
fn shown(path: &Path) -> String {
    excerpt(&path.display().to_string(), 1000)
}
