//! Errors of studies: of the study file and of the journal.

use crate::units::{ExpressionFault, excerpt};
use std::path::{Path, PathBuf};

/// What is wrong with a value of a study file; the message continues after `key = value `.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StudyFault {
    /// A required key is missing.
    #[error("is missing; add {line}")]
    Missing {
        /// A line that would be valid.
        line: &'static str,
    },
    /// No key has this name.
    #[error("is not a key of a study file; {advice}")]
    UnknownKey {
        /// The most similar key, or all keys.
        advice: String,
    },
    /// A table that belongs in a case file.
    #[error(
        "is a table of a case file; a study names its case, as in case = \"table1.toml\". To fly a single case, name the case itself"
    )]
    TableOfCase,
    /// The file of a web.
    #[error(
        "is a table of the file of a web; a study names its web, as in web = \"web.toml\". To lay a single web, name its file itself"
    )]
    IsWeb,
    /// A study of a case and of a web at once.
    #[error("stands beside web; a study varies a case or a web, keep one")]
    CaseAndWeb,
    /// A study cannot vary or link this key.
    #[error("cannot be set by a study; {advice}")]
    NotVaried {
        /// The reason, or a key that can be varied.
        advice: String,
    },
    /// The key is both varied and linked.
    #[error("is both varied and linked; keep one")]
    Twice,
    /// A range of a key that takes words.
    #[error("takes words, which have no range; list them, as in [{}]", quoted(words))]
    WordsInRange {
        /// The words that it takes.
        words: Vec<&'static str>,
    },
    /// A link to a key that takes words.
    #[error("takes words, and a formula gives a number; list the words under [vary]")]
    WordsLinked,
    /// A file for all points.
    #[error("names a file, which a study takes from its case; write it there")]
    FileSet,
    /// The key is both set and varied or linked.
    #[error("is set to one value for all points, and varied or linked as well; keep one")]
    SetTwice,
    /// A number of replicates out of range.
    #[error("= {asked} are asked for; ask for 1 to {most}")]
    Replicates {
        /// Number asked for.
        asked: u64,
        /// The largest number.
        most: u64,
    },
    /// The list of values is empty.
    #[error("has no values; list some, as in [\"5 m/s\", \"10 m/s\"], or write {{ from, to, steps }}")]
    NoValues,
    /// The table `[vary]` is empty.
    #[error(
        "names no key to vary; write a key and its values, as in \"air.velocity\" = [\"5 m/s\", \"10 m/s\"]"
    )]
    NothingVaries,
    /// A range without a number of values where one is needed.
    #[error("has no steps, which design = \"{design}\" needs; add steps = 5, or list the values")]
    NoSteps {
        /// Name of the design.
        design: &'static str,
    },
    /// A range with a number of values in a design that draws its own values.
    #[error("has steps, but design = \"{design}\" draws its values from the range; leave steps out")]
    NeedlessSteps {
        /// Name of the design.
        design: &'static str,
    },
    /// Logarithmic spacing with an end at or below zero.
    #[error("has logarithmic spacing, which needs both ends above zero; write spacing = \"linear\"")]
    LogThroughZero,
    /// Both ends of a range are equal.
    #[error("has two equal ends; write two different ends, or a list of one value")]
    NoWidth,
    /// Lists of different lengths.
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
    #[error("varies {found} keys; design = \"{design}\" allows at most {most}")]
    TooManyFactors {
        /// Number of factors.
        found: usize,
        /// Name of the design.
        design: &'static str,
        /// The largest number allowed.
        most: usize,
    },
    /// More points than are flown without an explicit request.
    #[error("makes {points} points; more than {most} must be requested by their number; {advice}")]
    TooManyPoints {
        /// Number of points.
        points: String,
        /// The largest number without a request.
        most: u64,
        /// The way out.
        advice: String,
    },
    /// The number of points differs from the number requested.
    #[error("makes {points} points, but {asked} were requested")]
    OtherPoints {
        /// Number of points.
        points: u64,
        /// Number requested.
        asked: u64,
    },
    /// More fibres than a study may have.
    #[error(
        "needs {fibres:.1e} fibres in total; at most {most:e} are possible. Reduce the replicates or the points"
    )]
    TooManyFibres {
        /// Number of fibres.
        fibres: f64,
        /// The largest number.
        most: f64,
    },
    /// The case does not give the key a value of its own.
    #[error("has no value in the case, where it follows from other keys; write it there to {purpose}")]
    NotWritten {
        /// What the value is needed for.
        purpose: &'static str,
    },
    /// A formula is wrong.
    #[error(transparent)]
    Expression(#[from] ExpressionFault),
    /// Links that depend on each other in a circle.
    #[error("depends on itself: {0}; remove one of these links")]
    Circle(String),
    /// No result has this name.
    #[error("is not the name of a result; {advice}")]
    UnknownResult {
        /// The most similar result, or all results.
        advice: String,
    },
    /// A fraction is out of range.
    #[error("is not a fraction of the mean; write a number between 0 and 1, like 0.05 or \"5 %\"")]
    NoFraction,
    /// `at_least` exceeds `at_most`.
    #[error("is larger than at_most = {most}; lower it")]
    MoreThanMost {
        /// The largest number of replicates.
        most: u64,
    },
}

/// Two words in quotes.
fn quoted(words: &[&str]) -> String {
    words.iter().take(2).map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ")
}

/// What is wrong with a journal, the file that holds the records of a study.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JournalError {
    /// Another process has the journal open.
    #[error(
        "{}: another spunlaid process is using this folder; wait until it ends, or use another folder",
        shown(path)
    )]
    InUse {
        /// The journal.
        path: PathBuf,
    },
    /// The file is not a journal.
    #[error(
        "{}: is not the journal of a study, or its first line is damaged, so its records cannot be used. Use another folder, or start again",
        shown(path)
    )]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// The journal has another format.
    #[error(
        "{}: is a journal of format {format}, but this spunlaid reads format {known}. Continue with the version of spunlaid that wrote it, use another folder, or start again",
        shown(path)
    )]
    Format {
        /// The file.
        path: PathBuf,
        /// The format found.
        format: String,
        /// The format that this version reads.
        known: u32,
    },
    /// The file cannot be opened or read.
    #[error("{}: cannot be read: {source}", shown(path))]
    Unusable {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// Records cannot be appended.
    #[error(
        "{}: cannot be written: {source}. All finished fibres are kept. Solve this problem, then continue the study",
        shown(path)
    )]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// The records cannot be flushed to the disk.
    #[error("the journal cannot be saved to the disk: {0}. Solve this problem, then continue the study")]
    Unsynced(std::io::Error),
}

/// A path as it appears in messages, without control characters.
fn shown(path: &Path) -> String {
    excerpt(&path.display().to_string(), 1000)
}
