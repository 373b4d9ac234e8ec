//! Study files: reads a file to a [`Study`] with all its points, and writes it back.

mod design;
mod differences;
mod levels;
mod links;
mod plan;
mod points;
mod reader;
mod replicates;
mod webs;
mod write;

pub use differences::differences;
pub use points::StudyNote;
pub use webs::{WebPoint, WebStudy, WebStudyFile, parse_web_study, read_web_study, varies_a_web};

use super::data::DataFiles;
use super::document::Document;
use super::web::WebKey;
use super::{Overrides, file, open};
use crate::case::Remark;
use crate::case::keys::{self, Key, Kind, Value};
use crate::error::{Error, FileKind, Finding, Place, Position};
use crate::study::{Factor, Levels, Replicates, Study};
use crate::units::Dimension;
use std::path::{Path, PathBuf};

/// Largest number of points that is flown without an explicit request.
pub const MOST_POINTS_UNASKED: u64 = 10_000;
/// Largest number of points of a study.
const MOST_POINTS: u64 = 10_000_000;
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
    /// The text of the base case, unchanged.
    pub case_text: String,
    /// Path of the base case, or its name if it is not a file.
    pub case_path: PathBuf,
    /// The study as a file with every default written out; it names the case `case.toml`.
    pub text: String,
}

/// What is asked of a study besides its file.
#[derive(Clone, Copy, Debug)]
pub struct StudyChanges<'a> {
    /// The number of points requested; required above [`MOST_POINTS_UNASKED`].
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

    /// No changes, with this number of points requested.
    pub const fn points(points: Option<u64>) -> Self {
        Self { points, replicates: None, set: Overrides { values: &[], word: "override" } }
    }
}

/// Reads a study file and the case it names, and resolves and checks every point.
///
/// * `points` – the number of points requested; required above [`MOST_POINTS_UNASKED`]
///
/// # Errors
/// When a file cannot be read, and when the study or any of its points is wrong; the error lists all problems.
pub fn read_study(path: &Path, points: Option<u64>) -> Result<StudyFile, Error> {
    read_changed_study(path, &StudyChanges::points(points))
}

/// [`read_study`] with changes.
///
/// # Errors
/// As [`read_study`].
pub fn read_changed_study(path: &Path, changes: &StudyChanges<'_>) -> Result<StudyFile, Error> {
    let text = file::read(path, FileKind::Study)?;
    let beside = |case: &str| path.parent().map_or_else(|| PathBuf::from(case), |folder| folder.join(case));
    parse_changed_study(&text, &path.display().to_string(), changes, |case| {
        let case = beside(case);
        Ok((file::read(&case, FileKind::Case)?, case.display().to_string()))
    })
}

/// Reads the text of a study file.
///
/// * `case` – returns text and path of the case that the study names
///
/// # Errors
/// As [`read_study`].
pub fn parse_study(
    text: &str,
    name: &str,
    points: Option<u64>,
    case: impl FnOnce(&str) -> Result<(String, String), Error>,
) -> Result<StudyFile, Error> {
    parse_changed_study(text, name, &StudyChanges::points(points), case)
}

/// [`parse_study`] with changes.
///
/// # Errors
/// As [`read_study`].
pub fn parse_changed_study(
    text: &str,
    name: &str,
    changes: &StudyChanges<'_>,
    case: impl FnOnce(&str) -> Result<(String, String), Error>,
) -> Result<StudyFile, Error> {
    let mut reader = reader::Reader::new(text, name)?;
    let (case_text, case_name) = match reader.case() {
        Some(named) => case(&named)?,
        None => return Err(reader.rejected()),
    };
    let files = DataFiles::default();
    let set = reader.set(changes.set);
    if reader.has_problems() {
        return Err(reader.rejected());
    }
    let word = format!("{name}: [set]");
    let of_file: Vec<_> = set.iter().filter(|(key, _)| !changes.sets(key)).cloned().collect();
    let overrides = [Overrides { values: &of_file, word: &word }, changes.set];
    let base = open::open(Document::read(&case_text, &case_name, &overrides)?, &files)?;
    let plan = reader.plan(&base, &set, changes);
    let Some(plan) = plan else {
        return Err(reader.rejected());
    };
    let resolver = points::Resolver { study: name, files: &files, base: &base, plan: &plan };
    let (resolved, mut notes) = resolver.points()?;
    let Replicates { at_least, until, .. } = &plan.replicates;
    if !until.is_empty() && *at_least < FEWEST_REPLICATES {
        let place = Place::in_file(name, Position::Whole);
        let (key, value) = ("replicates.at_least".to_owned(), Some(at_least.to_string()));
        let note = Finding { place, key, value, what: Remark::FewReplicates };
        notes.push(StudyNote { note, points: resolved.len() as u64, all: true });
    }
    let study = plan.study(resolved);
    let text = write::write_study(&study, &set);
    Ok(StudyFile { study, notes, case_path: PathBuf::from(&case_name), case_text, text })
}

/// What a study needs to know of a key that it varies, of a case or of a web.
#[derive(Clone, Copy)]
struct Varied {
    name: &'static str,
    kind: &'static Kind,
}

impl Varied {
    fn is_whole(self) -> bool {
        matches!(self.kind, Kind::Whole(..))
    }

    fn words(self) -> Vec<&'static str> {
        self.kind.words()
    }

    fn dimension(self) -> Dimension {
        self.kind.dimension().unwrap_or(Dimension::Ratio)
    }

    /// A value in the form of a study file, without rounding.
    fn exact(self, value: f64) -> String {
        match self.words().get(value as usize) {
            Some(word) => format!("\"{word}\""),
            None if self.is_whole() => format!("{value:.0}"),
            None => format!("\"{}\"", self.dimension().exact(value)),
        }
    }

    fn factor(self, levels: Levels) -> Factor {
        Factor {
            key: self.name,
            dimension: self.dimension(),
            whole: self.is_whole(),
            words: self.words(),
            levels,
        }
    }
}

impl From<&'static Key> for Varied {
    fn from(key: &'static Key) -> Self {
        Self { name: key.name, kind: &key.kind }
    }
}

impl From<&'static WebKey> for Varied {
    fn from(key: &'static WebKey) -> Self {
        Self { name: key.name, kind: &key.kind }
    }
}

/// The key with this name, if a study may vary it.
fn varied(name: &str) -> Option<&'static Key> {
    keys::find(name).filter(|key| key.varies)
}

/// The key with this name, if a study may vary it and its values are numbers, as formulas need.
fn numeric(name: &str) -> Option<&'static Key> {
    varied(name).filter(|key| key.kind.words().is_empty())
}

/// The value of a key as a number: of a word, its place among the words of the key.
fn level(key: &Key, value: &Value) -> Option<f64> {
    match value {
        Value::Text(word) => key.kind.words().iter().position(|one| one == word).map(|i| i as f64),
        value => value.number(),
    }
}

/// Physical dimension of a key's values.
fn dimension(key: &Key) -> Dimension {
    key.dimension().unwrap_or(Dimension::Ratio)
}

/// Advice for a name that a study cannot vary.
fn advice(name: &str) -> String {
    match name {
        "run.replicates" => return "write replicates = 10 in the study file, above its tables".to_owned(),
        "run.seed" => return "write seed = 1 in the study file, above its tables".to_owned(),
        _ => {}
    }
    if keys::find(name).is_some() {
        return "take a key whose value is a number or one of a few words".to_owned();
    }
    match keys::nearest(name) {
        Some(key) if key.varies => format!("did you mean {}?", key.name),
        _ => "write the full name of a key of the case, like air.velocity".to_owned(),
    }
}
