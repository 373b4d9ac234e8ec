//! Study files: reads a file to a [`Study`] with all its points, and writes it back.

mod base;
mod changes;
mod design;
mod fit;
mod knobs;
mod line;
mod links;
mod plan;
mod points;
mod web;
mod write;

pub use changes::{Changes, read_changes};
pub use fit::{FitFile, read_fit};
pub use knobs::{Knob, LineFile, Turn, TurnedLine, read_line};
pub use points::StudyNote;
pub use write::{differences, starter_study};

use super::document::{self, Document};
use super::written_values::{WrittenValue, sorted};
use super::{Overrides, Resources, file};
use plan::Plan;
use spunlaid_experiment::{Experiment, Factor, Quantity, Replicates, STUDY, Study};
use spunlaid_fibre::case::keys::{self, VariedKey};
use spunlaid_ground::error::Place;
use spunlaid_ground::{Diagnostic, Error, Fault, FileKind, Position};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// Largest number of points that is simulated without an explicit request.
pub(crate) const MOST_POINTS_UNASKED: u64 = 10_000;
/// Fewest replicates from which a standard error is a good guide to when to stop.
const FEWEST_REPLICATES: u64 = 6;
/// Largest number of fibres of a study.
const MOST_FIBRES: u64 = 4_000_000_000;

/// A study file, read.
#[derive(Clone, Debug)]
pub struct StudyFile {
    /// The study.
    pub study: Study,
    /// Remarks on its points.
    pub notes: Vec<StudyNote>,
    /// The text of what the points vary: of a case, unchanged; of a web, with every default, and with what is
    /// written of its filaments.
    pub base_text: String,
    /// Path of the base case or web, or its name if it is not a file.
    pub base_path: PathBuf,
    /// The study as a file with every default written out; it names [`StudyFile::base_name`].
    pub text: String,
}

impl StudyFile {
    /// The name of the file of what the points vary, in the folder of the study: `case.toml`, `web.toml` or
    /// `spinline.toml`.
    pub fn base_name(&self) -> &'static str {
        self.study.base_file()
    }
}

/// What is asked of a study besides its file.
#[derive(Clone, Copy, Debug)]
pub struct StudyChanges<'a> {
    /// The number of points requested; required above `MOST_POINTS_UNASKED`.
    pub points: Option<u64>,
    /// Number of replicates of every point, in place of that of the file.
    pub replicates: Option<u64>,
    /// Keys that are the same at all points, in place of those of the file's table `[set]` and of its case.
    pub set: Overrides<'a>,
}

impl StudyChanges<'_> {
    fn sets(&self, key: &str) -> bool {
        self.set.values.iter().any(|(other, _)| other.trim() == key)
    }
}

/// No changes, with this number of points requested.
impl From<Option<u64>> for StudyChanges<'_> {
    fn from(points: Option<u64>) -> Self {
        Self { points, ..Overrides::new(&[], "override").into() }
    }
}

/// Keys that are the same at all points, and no other changes.
impl<'a> From<Overrides<'a>> for StudyChanges<'a> {
    fn from(set: Overrides<'a>) -> Self {
        Self { points: None, replicates: None, set }
    }
}

/// Reads a study file and the case or web it names, and resolves and checks every point.
///
/// * `changes` – what is asked for besides the file: [`StudyChanges`], or the number of points requested, which is
///   required above `MOST_POINTS_UNASKED`
///
/// # Errors
/// When a file cannot be read, and when the study or any of its points is wrong; the error lists all
/// problems.
pub fn read_study<'a>(path: &Path, changes: impl Into<StudyChanges<'a>>) -> Result<StudyFile, Error> {
    let text = file::read(path, FileKind::Study)?;
    parse_study(&text, &path.display().to_string(), changes, |named, kind| {
        let base = path.parent().map_or_else(|| PathBuf::from(named), |folder| folder.join(named));
        Ok((file::read(&base, kind)?, base.display().to_string()))
    })
}

/// Reads the text of a study file.
///
/// * `base` – returns text and path of the case or web that the study names
///
/// # Errors
/// As [`read_study`].
pub fn parse_study<'a>(
    text: &str,
    name: &str,
    changes: impl Into<StudyChanges<'a>>,
    base: impl FnOnce(&str, FileKind) -> Result<(String, String), Error>,
) -> Result<StudyFile, Error> {
    let changes = changes.into();
    let own = Resources::default();
    let resources = changes.set.resources.unwrap_or(&own);
    let mut reader = open(text, name)?;
    let Some((named, kind)) = reader.base() else { return Err(reader.rejected()) };
    let (base_text, base_name) = base(&named, kind)?;
    let before = reader.problems();
    let set = reader.set(changes.set, kind);
    if reader.problems() > before {
        return Err(reader.rejected());
    }
    let word = format!("{name}: [set]");
    let of_file: Vec<_> = set.iter().filter(|(key, _)| !changes.sets(key)).cloned().collect();
    let set_by = [Overrides::new(&of_file, &word), changes.set];
    let base = match open_base(kind, base_text, &base_name, set_by, resources) {
        Err(_) if reader.problems() > 0 => return Err(reader.rejected()),
        base => base?,
    };
    let plan = reader.plan(&*base, &set, &changes);
    let Some(plan) = plan else {
        return Err(reader.rejected());
    };
    let resolver = points::Resolver { study: name, base: &*base, plan: &plan, resources };
    let (resolved, mut notes) = resolver.points()?;
    let Replicates { at_least, until, .. } = &plan.replicates;
    if !until.is_empty() && *at_least < FEWEST_REPLICATES {
        let place = Place::in_file(name, Position::Whole);
        let key = "replicates.at_least".to_owned();
        let value = Some(at_least.to_string());
        let what = Diagnostic::warning(
            "is too few to trust a standard error, so the study often stops before its results are as exact as \
            asked; write 6 or more",
        );
        let note = Diagnostic { place, key, value, ..what };
        notes.push(StudyNote { note, points: resolved.len() as u64, all: true });
    }
    let study = plan.study(resolved);
    let (base_text, set) = base.written(set);
    let text = write::write_study(&study, &set);
    Ok(StudyFile { study, notes, base_path: PathBuf::from(base_name), base_text, text })
}

/// What a study varies, read.
///
/// * `name` – of its file
/// * `set` – keys that are the same at all points: those of the study file, and those that replace them
fn open_base(
    kind: FileKind,
    text: String,
    name: &str,
    set: [Overrides<'_>; 2],
    resources: &Resources,
) -> Result<Box<dyn Base>, Error> {
    Ok(match kind {
        FileKind::Web => Box::new(web::WebBase::new(&text, name.to_owned(), &set, resources)?),
        _ => Box::new(base::CaseBase::new(text, name, &set, kind, resources)?),
    })
}

/// What a study varies: a case, or a web.
trait Base {
    /// The key with this name, or why a study cannot vary it.
    fn varied(&self, name: &str) -> Result<VariedKey, String>;

    /// The key with this name, if its values are numbers, as formulas need; or why it cannot be used.
    fn numeric(&self, name: &str) -> Result<VariedKey, String> {
        let is_number = |key: &VariedKey| key.words().is_empty();
        let key = self.varied(name)?;
        if is_number(&key) { Ok(key) } else { Err("a formula needs keys whose value is a number".to_owned()) }
    }

    /// The value of a key before anything varies: a number, or the index of a word. None if it has none.
    fn value(&self, key: &VariedKey) -> Option<f64>;

    /// The master seed, and the number of replicates, if the study does not say them.
    fn seed_and_replicates(&self) -> (u64, u64);

    /// The numbers that are kept of each replicate: `Study::quantities`, before there are points.
    fn quantities(&self) -> Vec<Quantity>;

    /// A point, with remarks on it.
    ///
    /// * `values` – of the keys that vary or follow from others
    /// * `at` – the place of these values
    /// * `seed` – if the point has one of its own
    /// * `resources` – the files of the point, and the tension if it is that of flights
    ///
    /// # Errors
    /// Every problem with it.
    fn point(
        &self,
        values: &[(VariedKey, f64)],
        at: &Place,
        plan: &Plan,
        seed: Option<u64>,
        resources: &Resources,
    ) -> ExperimentWithNotes;

    /// The file of what is varied, and what it does not have of the keys that are the same at all points.
    fn written(&self, set: Vec<(String, String)>) -> (String, Vec<(String, String)>);
}

/// The values of the factors before they vary; NaN where a factor has none.
fn values_before(base: &dyn Base, factors: &[Factor]) -> Vec<f64> {
    factors.iter().map(|factor| base.value(&factor.key).unwrap_or(f64::NAN)).collect()
}

/// Values of keys as if they were written at a place.
///
/// # Errors
/// Those that their keys do not take.
fn written_at(values: &[(VariedKey, f64)], at: &Place) -> Result<Vec<(String, WrittenValue)>, Error> {
    let (mut written, mut problems) = (Vec::new(), Vec::<Diagnostic>::new());
    for (key, value) in values {
        let (name, shown) = (key.name.clone(), Some(key.shown(*value)));
        match key.value(*value) {
            Ok(value) => written.push((name, WrittenValue::new(at, shown, value))),
            Err(what) => {
                problems.push(Diagnostic { place: at.clone(), key: name, value: shown, ..what.into() })
            }
        }
    }
    if problems.is_empty() { Ok(written) } else { Err(problems.into()) }
}

/// An experiment, and the remarks on it.
type ExperimentWithNotes = Result<(Experiment, Vec<Diagnostic>), Error>;

/// A study file, and the problems found in it so far.
type Reader<'a> = Document<'a, Study>;

/// Reads what the file says without that which varies.
///
/// # Errors
/// If the text is not TOML, is a file of another kind, or has a format that is newer than this library.
fn open<'a>(text: &'a str, name: &str) -> Result<Reader<'a>, Error> {
    let mut reader = document::open(&STUDY, text, name, &[])?;
    reader.check_relations();
    Ok(reader)
}

impl Reader<'_> {
    /// Number of problems so far.
    pub(super) const fn problems(&self) -> usize {
        self.key_values.problems.len()
    }

    /// All problems, in the order of the file.
    pub(super) fn rejected(self) -> Error {
        sorted(self.key_values.problems).into()
    }
}

/// Advice for a key whose values a study cannot vary.
const TAKE_A_NUMBER: &str = "take a key whose value is a number or one of a few words";

/// Advice for a name that a study cannot vary.
pub(super) fn advice(name: &str) -> String {
    if let Some(key) = keys::find(name) {
        let in_study = |line| format!("write {line} in the study file, above its tables");
        return key.relations.in_study.map_or_else(|| TAKE_A_NUMBER.to_owned(), in_study);
    }
    match keys::nearest(name) {
        Some(key) if key.varies => format!("did you mean {}?", key.name),
        _ => "write the full name of a key of the case, like air.velocity".to_owned(),
    }
}

/// A study cannot vary, link or set this key.
pub(super) fn not_varied(remedy: impl Into<Cow<'static, str>>) -> Fault {
    Fault::new("cannot be set by a study", remedy)
}

/// A key that is both set and varied or linked.
///
/// * `by` – the key that sets it, which may be another one that gives it in other words
pub(super) fn set_twice(key: &str, by: &str) -> Fault {
    let by = if by == key { String::new() } else { format!(" by {by}") };
    Fault::new(format!("is set to one value for all points{by}, and varied or linked as well"), "keep one")
}

/// The case does not give the key a value of its own.
pub(super) fn not_written(purpose: &str) -> Fault {
    let message = "has no value in the case, where it follows from other keys";
    Fault::new(message, format!("write it there to {purpose}"))
}
