//! The errors of the program, their messages and exit codes.

use spunlaid::error::{Error, FileError, FileFault, FileKind, RecordFault, ScanFault};
use spunlaid_results::Failure as Unwritten;
use std::fmt;
use std::io;
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};

/// An error that ends the program.
#[derive(Debug)]
pub(crate) enum Failure {
    /// An error of the library.
    Library(Error),
    /// The record for `analyse` cannot be used.
    Record(Box<FileError>),
    /// Results cannot be written.
    Results(spunlaid_results::Failure),
    /// The file of `new` cannot be written.
    NotWritten { path: PathBuf, source: io::Error },
    /// `new` would overwrite a file.
    Exists { path: PathBuf },
    /// Standard output cannot be written.
    Unheard { why: &'static io::Error },
    /// A study was interrupted.
    Paused { done: u64, of: u64, what: &'static str },
    /// A folder does not hold the results of a run.
    NotARun { folder: PathBuf, reason: String },
    /// A finished run cannot be flown for longer.
    NotContinued { folder: PathBuf, reason: String },
    /// Results that cannot be compared.
    NotCompared { folder: PathBuf, reason: String },
    /// An option of `analyse` is for files of the other kind, velocity records or scans.
    NotForThis { path: PathBuf, option: &'static str, is_scan: bool },
    /// More runs than a picture can show.
    TooManyRuns { runs: usize, most: usize },
    /// The paper has no such figure.
    NoSuchFigure { name: String, known: String },
    /// No key has this word.
    NoSuchKey { pattern: String, nearest: Vec<&'static str> },
    /// The study has fewer points.
    NoSuchPoint { point: u64, points: u64 },
    /// A case that `live` cannot fly.
    NotFlown { name: String, why: Vec<String> },
    /// The page of `live` cannot be served.
    NotServed { source: io::Error },
    /// Fibres were lost; the results are those of all others.
    FibresLost { lost: String },
    /// The program panicked; the message has been printed.
    Panicked,
}

impl Failure {
    /// A file or folder of results that cannot be written.
    pub(crate) fn unwritable(path: &Path) -> impl Fn(io::Error) -> Self + '_ {
        |source| spunlaid_results::Failure::unwritable(path)(source).into()
    }

    /// 1 if the input is wrong, 130 if interrupted, 2 otherwise.
    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Self::Library(Error::Interrupted) | Self::Paused { .. } => 130,
            Self::Library(error) => error.exit_code(),
            Self::Results(failure) => {
                if failure.is_wrong_input() {
                    1
                } else {
                    2
                }
            }
            Self::Record(_)
            | Self::Exists { .. }
            | Self::NotARun { .. }
            | Self::NotContinued { .. }
            | Self::NotForThis { .. }
            | Self::NotCompared { .. }
            | Self::TooManyRuns { .. }
            | Self::NoSuchFigure { .. }
            | Self::NoSuchKey { .. }
            | Self::NotFlown { .. }
            | Self::NoSuchPoint { .. } => 1,
            Self::NotWritten { .. }
            | Self::NotServed { .. }
            | Self::Unheard { .. }
            | Self::FibresLost { .. }
            | Self::Panicked => 2,
        }
    }

    /// Does `work`. A panic in it is a fault of the program and becomes a failure.
    pub(crate) fn catch_panic(work: impl FnOnce() -> Result<(), Self>) -> Result<(), Self> {
        // Nothing that the work has touched is used afterwards.
        panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or(Err(Self::Panicked))
    }
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Self::Record(Box::new(error))
    }
}

impl From<Unwritten> for Failure {
    fn from(failure: Unwritten) -> Self {
        match failure {
            Unwritten::Simulation(error) => Self::Library(error),
            Unwritten::NotARun { folder, reason } => Self::NotARun { folder, reason },
            failure => Self::Results(failure),
        }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Library(error)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Library(Error::Interrupted) => {
                write!(f, "interrupted; nothing was written. Repeat the command to start again")
            }
            Self::Library(error) => write!(f, "{error}{}", options(error)),
            Self::Record(error) => write!(f, "{error}{}", record_options(&error.fault)),
            Self::Results(failure) => write!(f, "{failure}{}", folder_options(failure)),
            Self::NotWritten { path, source } => {
                write!(f, "{}: cannot be written: {source}; name another file", path.display())
            }
            Self::NotFlown { name, why } => write!(f, "{name}: {}", why.join("\n")),
            Self::NotServed { source } => {
                write!(f, "the page cannot be served: {source}")?;
                match source.kind() {
                    io::ErrorKind::AddrInUse | io::ErrorKind::PermissionDenied => {
                        f.write_str("; name another port with --port, or leave it out")
                    }
                    _ => Ok(()),
                }
            }
            Self::NoSuchFigure { name, known } => {
                write!(f, "--figures {name}: there is no such result figure; write some of {known}")
            }
            Self::NoSuchKey { pattern, nearest } => {
                write!(f, "no key has \"{}\" in its name or meaning; ", pattern.escape_debug())?;
                match &nearest[..] {
                    [] => f.write_str("`spunlaid keys` lists them all"),
                    keys => write!(f, "did you mean {}?", keys.join(" or ")),
                }
            }
            Self::Exists { path } => {
                write!(f, "{}: exists already and is not overwritten; name another file", path.display())
            }
            Self::Unheard { why } => {
                write!(f, "standard output: cannot be written: {why}; everything else is done")
            }
            Self::Paused { done, of, what } => {
                write!(
                    f,
                    "interrupted; {done} of {of} {what} are done and kept. Repeat the command to continue"
                )
            }
            Self::NotARun { folder, reason } => write!(
                f,
                "{}: does not hold the results of a run: {reason}; name folders that `spunlaid run` has written",
                folder.display()
            ),
            Self::NotContinued { folder, reason } => {
                write!(f, "{}: cannot be continued: {reason}", folder.display())
            }
            Self::NotCompared { folder, reason } => {
                write!(f, "{}: cannot be compared: {reason}", folder.display())
            }
            Self::NotForThis { path, option, is_scan: true } => write!(
                f,
                "{}: is read as a scan or a map of a web, and {option} is for velocity records only; leave it out",
                path.display()
            ),
            Self::NotForThis { path, option, is_scan: false } => write!(
                f,
                "{}: is read as a velocity record, and {option} is for scans and maps of a web only; if it is one, give the side of \
                 a pixel, as in --pixel \"0.1 mm\"",
                path.display()
            ),
            Self::TooManyRuns { runs, most } => {
                write!(f, "{runs} runs are named, and at most {most} are compared at a time; name fewer")
            }
            Self::NoSuchPoint { point, points } => {
                write!(f, "--print-point {point}: the study has {points} points, counted from 1")
            }
            Self::FibresLost { lost } => f.write_str(lost),
            Self::Panicked => write!(
                f,
                "the program has a fault, see above; please report it with the case or study that shows it"
            ),
        }
    }
}

/// The options that help where results cannot be written.
fn folder_options(failure: &Unwritten) -> String {
    let options = match failure {
        Unwritten::HoldsResults { .. } | Unwritten::OtherVersion { .. } => " (--out, --force)",
        Unwritten::FewerReplicates { held, .. } => return format!(" (--replicates {held}, --out, --force)"),
        Unwritten::Unwritable { .. } | Unwritten::NotAFolder { .. } => " (--out)",
        _ => "",
    };
    options.to_owned()
}

/// The options and commands that help with an error of the library.
fn options(error: &Error) -> String {
    let known = match error {
        Error::File(error) => match error.fault {
            FileFault::NotThere(FileKind::Case) => " (`spunlaid new` writes one)",
            FileFault::IsFolder(FileKind::Case) => " (--until flies a finished run for longer)",
            FileFault::NotThere(FileKind::Web) => " (`spunlaid help web` shows one)",
            FileFault::NotThere(FileKind::Study) => " (`spunlaid help sweep` shows one)",
            _ => "",
        },
        _ => "",
    };
    match error.option() {
        "" => known.to_owned(),
        option => format!(" ({option})"),
    }
}

/// The options of `analyse` that help with a record.
fn record_options(fault: &FileFault) -> &'static str {
    match fault {
        FileFault::NoUnit { .. } => " (or --time-unit, --velocity-unit)",
        FileFault::Record(fault) => match fault {
            RecordFault::NoVelocity { .. } => " (--columns, --velocity-unit)",
            RecordFault::TooManyComponents { .. } => " (--columns)",
            RecordFault::NoTime { .. }
            | RecordFault::TimeNotIncreasing { .. }
            | RecordFault::Uneven { .. } => " (--rate)",
            RecordFault::MixedUnits { .. } => " (--time-unit, --velocity-unit)",
            RecordFault::GapTooLong { .. } => " (or allow longer gaps with --max-gap)",
            RecordFault::NoMean { .. } => " (--mean-velocity)",
            RecordFault::IntegralTooLong { .. } => " (--integral)",
            RecordFault::Segment { .. } => " (--segment)",
            _ => "",
        },
        FileFault::Scan(fault) => match fault {
            ScanFault::NotDarker { .. } => " (--white, --lamp, --light weight)",
            ScanFault::NoPixel | ScanFault::Oblong { .. } => " (--pixel)",
            ScanFault::OtherLamp { .. } => " (--lamp)",
            ScanFault::Bare { .. } | ScanFault::Dark { .. } => " (--keep-spots)",
            ScanFault::Patch { .. } => " (--patches)",
            ScanFault::NoiseTooLarge { .. } => " (--noise)",
            _ => "",
        },
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spunlaid::error::{Error, Fault};
    use spunlaid::study::{foreign, in_use, unsynced};
    use std::sync::LazyLock;

    static FULL: LazyLock<io::Error> = LazyLock::new(|| io::ErrorKind::StorageFull.into());

    /// Every failure of the program, and those of the library that are not about the text of an input.
    #[test]
    fn each_failure_has_the_exit_code_of_whose_fault_it_is() {
        let path = || PathBuf::from("there");
        let full = || io::Error::from(io::ErrorKind::StorageFull);
        for wrong_input in [
            Unwritten::HoldsResults { folder: path(), found: "figures".to_owned() }.into(),
            Unwritten::NotAFolder { path: path() }.into(),
            Unwritten::OtherStudy { folder: path(), differences: Vec::new() }.into(),
            Unwritten::OtherVersion { folder: path(), version: "0".to_owned() }.into(),
            Unwritten::FewerReplicates { folder: path(), held: 8, asked: 4 }.into(),
            Failure::Exists { path: path() },
            Failure::NotARun { folder: path(), reason: "it is a file".to_owned() },
            Failure::NotContinued { folder: path(), reason: "it is longer".to_owned() },
            Failure::NoSuchFigure { name: "12".to_owned(), known: "2".to_owned() },
            Failure::NoSuchPoint { point: 3, points: 2 },
            Failure::NotForThis { path: path(), option: "--rate", is_scan: true },
            Failure::NotCompared { folder: path(), reason: "it holds no web".to_owned() },
            Failure::NotFlown { name: "a.toml".to_owned(), why: Vec::new() },
            Unwritten::NothingToLay { of: path(), reason: "it lies too regularly".to_owned() }.into(),
            Error::Flight(Fault::plain("no fibre")).into(),
            Error::Rejected(Vec::new()).into(),
            in_use(&path()).into(),
            foreign(&path()).into(),
        ] {
            assert_eq!(wrong_input.exit_code(), 1, "{wrong_input:?}");
        }
        for not_the_inputs_fault in [
            Failure::unwritable(&path())(full()),
            Failure::NotWritten { path: path(), source: full() },
            Unwritten::Figure { name: "9".to_owned(), reason: "no".to_owned() }.into(),
            Failure::NotServed { source: full() },
            Failure::Unheard { why: &FULL },
            Failure::FibresLost { lost: "1 of 2 fibres was lost".to_owned() },
            Failure::Panicked,
            Error::Diverged {
                replicate: 1,
                node: 2,
                time: 0.1,
                sign: "node 2 is no longer finite".to_owned(),
                cause: "stiff".to_owned(),
            }
            .into(),
            Error::system(&path(), Fault::plain("cannot be read")).into(),
            unsynced(&full()).into(),
        ] {
            assert_eq!(not_the_inputs_fault.exit_code(), 2, "{not_the_inputs_fault:?}");
        }
        for interrupted in [
            Failure::Paused { done: 1, of: 2, what: "fibres" },
            Error::Interrupted.into(),
            Unwritten::Simulation(Error::Interrupted).into(),
        ] {
            assert_eq!(interrupted.exit_code(), 130, "{interrupted:?}");
        }
    }

    #[test]
    fn a_panic_is_a_failure_of_the_program() {
        let failure = Failure::catch_panic(|| panic!("as a test of it"));
        assert_eq!(failure.map_err(|failure| failure.exit_code()), Err(2));
        assert!(Failure::catch_panic(|| Ok(())).is_ok());
    }
}
