//! Reads and writes the files of cases, studies and webs (TOML). In memory, all values are in SI units.
//!
//! A quantity is written with its unit, `diameter = "50 µm"`. All problems of a file are reported at once, each
//! with line, key, value, what is allowed and how to correct it.
//!
//! It is a part of `spunlaid`, which is the crate to depend on: the interface here may change with any version.

// Units are written in brackets, [m/s], which rustdoc would take for broken links.
#![allow(rustdoc::broken_intra_doc_links)]

#[macro_use]
extern crate spunlaid_ground;

mod count;
mod data;
mod document;
mod edit;
mod entry;
mod file;
mod influence;
mod open;
mod overrides;
pub mod paper;
mod settle;
mod slip;
mod source;
mod spinline;
mod study;
mod text_with_lines;
mod unknown;
mod web;
mod write;
mod written_values;

pub use data::read_points;
pub use influence::{Influence, OfFilament};
pub use settle::Resources;
pub use source::Source;
pub use spinline::{SpinFile, read_spinline, write_spinline};
pub use spunlaid_simulation::{LaydownSource, LayerSpec, WEB_KEYS, WEB_TABLES, WebKey, WebSpec};
pub use study::{
    Changes, FitFile, Knob, LineFile, StudyChanges, StudyFile, StudyNote, Turn, TurnedLine, differences,
    parse_study, read_changes, read_fit, read_line, read_study, starter_study,
};
pub use web::{WebFile, read_web, write_web};
pub use write::write_case;

use data::DataFiles;
use open::OpenCase;
use spunlaid_experiment::Experiment;
use spunlaid_fibre::Case;
use spunlaid_fibre::case::keys;
use spunlaid_fibre::case::keys::{Key, Value};
use spunlaid_ground::{Diagnostic, Error, Fault, FileError, FileKind};
use std::path::Path;
use toml::de::DeTable;
use written_values::WrittenValues;

/// What is read of a case file: the case, with notes and warnings about it.
pub type CaseWithNotes = (Case, Vec<Diagnostic>);

/// The version of the case file format that this library writes, and the newest one that it reads.
pub(crate) const FORMAT_VERSION: u32 = 1;
/// Size of the largest case file that is read [bytes].
pub const LARGEST_FILE: u64 = 1 << 20;

/// Values that replace values of a case file or add to them.
#[derive(Clone, Copy, Debug)]
pub struct Overrides<'a> {
    /// Keys and values, `("air.velocity", "20 m/s")`. A value that is not TOML is taken as text. The value `auto`
    /// removes a key of the file, so that its default applies.
    pub values: &'a [(String, String)],
    /// What messages write before the key. A program with an option for overrides gives its name.
    pub word: &'a str,
    /// What else is known, if the file is read several times.
    pub resources: Option<&'a Resources>,
}

impl<'a> Overrides<'a> {
    /// Keys and values, and what messages write before the key.
    pub const fn new(values: &'a [(String, String)], word: &'a str) -> Self {
        Self { values, word, resources: None }
    }

    /// The same for a reading with what is known from readings before: [`Resources::resolve_tension`] reads so.
    #[must_use]
    pub const fn with(self, resources: &'a Resources) -> Self {
        Self { resources: Some(resources), ..self }
    }
}

impl<'a, T: AsRef<[(String, String)]> + ?Sized> From<&'a T> for Overrides<'a> {
    fn from(values: &'a T) -> Self {
        Self::new(values.as_ref(), "override")
    }
}

/// Reads and checks a case. Of the file of a web it is the case of its filament.
///
/// * `overrides` – keys and values that replace values of the file or add to them: `&[]`, `&[(key, value)]` or
///   [`Overrides`]
///
/// Returns the case, with notes and warnings about it. A tension of flights at the end of its spinline is 0 N
/// until [`Resources::resolve_tension`] has found it, which a note says.
///
/// # Errors
/// If the file cannot be read, or if the case cannot be run; then with every problem found.
pub fn read_case<'a>(
    source: impl Into<Source<'a>>,
    set: impl Into<Overrides<'a>>,
) -> Result<CaseWithNotes, Error> {
    let set = set.into();
    source.into().open(FileKind::Case, set, |text, name, resources| {
        let values = values_of_case(resources, text, name, &[set])?;
        resources.resolve(open_values(values, &resources.files)?)
    })
}

/// Reads the text of a file of this library, which is no larger than [`LARGEST_FILE`].
///
/// # Errors
/// If the file cannot be read, or is no UTF-8 text.
pub fn read_text(path: &Path, kind: FileKind) -> Result<String, Error> {
    file::read(path, kind)
}

/// The text of a file of this library that was read as bytes. Messages call the file `name`.
///
/// # Errors
/// If it is no UTF-8 text; the message says what it may be, and in which line.
pub fn text_of(bytes: Vec<u8>, name: &str) -> Result<String, FileError> {
    file::text(bytes).map_err(|error| error.path(Path::new(name)))
}

/// What is written of a case: in a file of its own, or in that of a web as its filament.
fn values_of_case(
    resources: &Resources,
    text: &str,
    name: &str,
    overrides: &[Overrides<'_>],
) -> Result<WrittenValues, Error> {
    match document::is_of_web(text) {
        true => web::filament(text, name, overrides, resources),
        false => document::read(&keys::CASE, text, name, overrides),
    }
}

/// A case of its values.
fn open_values(mut key_values: WrittenValues, files: &DataFiles) -> Result<OpenCase, Error> {
    if spinline::is_spinline_alone(&key_values) {
        let fault = Fault::new(
            "is alone in this file, so no fibre is simulated",
            "solve the spinline alone, or add [belt], [air] and [run] for the fibre that is simulated below it",
        );
        key_values.reject("[spinline]", fault.option("`spunlaid spin`"));
        return Err(key_values.problems.into());
    }
    open::open(key_values, files)
}

/// A case file with what is written of a case, and of what is set beside it, and nothing that follows from it. The
/// files that it names have full paths.
///
/// # Errors
/// If the text is no such file.
pub fn write_changed_case(text: &str, name: &str, set: Overrides<'_>) -> Result<String, Error> {
    let values = values_of_case(&Resources::default(), text, name, &[set])?;
    let full = |path: &std::path::PathBuf| std::path::absolute(path).unwrap_or_else(|_| path.clone());
    let value = |key: &Key| match values.get(key.name)?.value.clone()? {
        Value::Paths(paths) => Some(Value::Paths(paths.iter().map(full).collect())),
        value => Some(value),
    };
    let table = |table| (table, write::lines(&keys::CASE, table, value));
    let tables = keys::TABLES.into_iter().map(table).filter(|(_, lines)| !lines.is_empty());
    Ok(tables.map(|(table, lines)| format!("[{table}]\n{}\n", write::in_lines(&lines))).collect())
}

/// Writes what a point of a study repeats, a case or a web, as a file.
pub fn write_experiment(experiment: &Experiment) -> String {
    match experiment {
        Experiment::Case(case) => write_case(case),
        Experiment::Web(web) => write_web(web),
        Experiment::Spinline(spec) => write_spinline(spec),
    }
}

/// A commented case file to start from: Table 1 of the paper, with every optional key and its default.
pub const fn starter_case() -> &'static str {
    include_str!("starter.toml")
}

/// A commented case of a fibre that is fed and laid on a moving belt.
pub const fn starter_case_of_fed() -> &'static str {
    include_str!("starter_of_fed.toml")
}

/// What a file describes by its keys and tables: a study, a web, a spinline alone, or else a case. A file
/// that cannot be read counts as a case.
pub fn kind_of(path: &Path) -> FileKind {
    let Ok(text) = file::read(path, FileKind::Case) else { return FileKind::Case };
    let Ok(root) = DeTable::parse(&text) else { return FileKind::Case };
    let has = |name: &str| root.get_ref().contains_key(name);
    let is_spinline = || {
        document::read(&keys::CASE, &text, "", &[])
            .is_ok_and(|key_values| spinline::is_spinline_alone(&key_values))
    };
    if has("vary") || has("design") {
        FileKind::Study
    } else if document::is_of_web(&text) {
        FileKind::Web
    } else if is_spinline() {
        FileKind::Spinline
    } else {
        FileKind::Case
    }
}
