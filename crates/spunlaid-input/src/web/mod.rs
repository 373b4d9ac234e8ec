//! Files of webs: reads a file to what is to be laid, and writes it back.
//!
//! ```text
//! file, and the cases that it names → `WrittenWeb` ┬ open.rs: layers, with sheet.rs and belt.rs
//!                                                  └ filament.rs: the case of a filament,
//!                                                    of a web, or for `spunlaid run`, `spin`, `air`
//! ```

mod assumed;
mod belt;
mod check;
mod filament;
mod open;
mod read;
mod sheet;
mod write;

pub(super) use assumed::AssumedValue;
pub use write::write_web;
pub(super) use write::write_web_to_vary;

use super::overrides::no_entry;
use super::written_values::{WrittenValue, WrittenValues};
use super::{Overrides, Resources, Source, document, file};
use read::CASE;
use spunlaid_fibre::case::keys::{self, CASE as OF_CASE, Value};
use spunlaid_ground::{Diagnostic, Error, Fault, FileKind};
use spunlaid_simulation::WebSpec;
use spunlaid_simulation::layers::keys::{WEB, WEB_FILE};
use spunlaid_simulation::layers::web_key;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The file of a web, read.
#[derive(Clone, Debug)]
pub struct WebFile {
    /// What is to be laid.
    pub spec: WebSpec,
    /// Notes and warnings about the cases that it names.
    pub notes: Vec<Diagnostic>,
    /// The file with every default written out.
    pub text: String,
}

impl WebFile {
    /// The same, if it can be the file of a line.
    ///
    /// A file that somebody has is read with warnings: a study, a fit or a test may go far on purpose. This is for one
    /// that is made of numbers that somebody has typed.
    ///
    /// # Errors
    /// If a number is outside of what is usual by a factor of ten or more; it says which unit was probably meant.
    pub fn within_reason(self) -> Result<Self, Error> {
        if !self.notes.iter().any(|note| note.is_absurd) {
            return Ok(self);
        }
        // One that is less far outside may be why.
        let unusual = self.notes.into_iter().filter(|note| note.is_unusual);
        Err(unusual.map(Diagnostic::into_error).collect::<Vec<Diagnostic>>().into())
    }
}

/// Reads and checks a web, and the cases that it names.
///
/// * `overrides` – keys and values that replace values of the file or add to them, `("line.belt_speed", "6 m/s")`; of a
///   file with `[[layer]]`, `layer.2.line.belt_speed` or the layer's name in place of its number. Keys of a
///   filament without a layer, `("belt.distance", "0.4 m")`, are those of all layers
///
/// # Errors
/// If the file cannot be read, or if the web cannot be laid; then with every problem found.
pub fn read_web<'a>(source: impl Into<Source<'a>>, set: impl Into<Overrides<'a>>) -> Result<WebFile, Error> {
    let set = set.into();
    source.into().open(FileKind::Web, set, |text, name, resources| {
        WrittenWeb::open(text, name, &[set])?.read(resources).map(|(file, _)| file)
    })
}

/// What is written of a web: in its file, and in the cases that its layers name.
#[derive(Clone, Debug)]
pub(super) struct WrittenWeb {
    values: WrittenValues,
    /// Its path.
    path: PathBuf,
    /// The named cases, or why they cannot be read, by what comes before the names of the layer's keys.
    named: BTreeMap<String, NamedCase>,
}

/// The path of a case that a layer names, and what is written there.
type NamedCase = (PathBuf, Result<WrittenValues, Vec<Diagnostic>>);

impl WrittenWeb {
    /// * `set` – what is set from several places, each of which replaces those before it
    ///
    /// # Errors
    /// If the text is no such file, or if a case cannot be read for another reason than what is in it.
    pub(super) fn open(text: &str, name: &str, set: &[Overrides<'_>]) -> Result<Self, Error> {
        let mut web =
            Self { values: values(text, name, set)?, path: PathBuf::from(name), named: BTreeMap::new() };
        for prefix in open::prefixes(&web.values) {
            let Some(path) = web.path_of_case(&prefix) else { continue };
            let read = |text: String| document::read(&OF_CASE, &text, &path.display().to_string(), &[]);
            let case = match file::read(&path, FileKind::Case).and_then(read) {
                Ok(case) => Ok(case),
                Err(Error::Rejected(problems)) => Err(problems),
                Err(Error::File(error)) => {
                    Err(vec![web.values.problem(&format!("{prefix}{CASE}"), error.into())])
                }
                Err(other) => return Err(other),
            };
            web.named.insert(prefix, (path, case));
        }
        Ok(web)
    }

    /// The path of the case that a layer names, relative to the folder of the file.
    fn path_of_case(&self, prefix: &str) -> Option<PathBuf> {
        let written_value = self.values.get(&format!("{prefix}{CASE}"))?;
        let Some(Value::Text(named)) = &written_value.value else { return None };
        let folder = self.path.parent().filter(|_| !written_value.is_set());
        Some(folder.map_or_else(|| PathBuf::from(named), |folder| folder.join(named)))
    }

    /// The same web with other values of keys.
    pub(super) fn with(&self, changes: &[(String, WrittenValue)]) -> Self {
        Self { values: self.values.with(changes.iter().cloned()), ..self.clone() }
    }

    /// Whether its file has a list of layers, whose numbers stand in the names of their keys.
    pub(super) fn is_layered(&self) -> bool {
        self.values.get("layer").is_some()
    }

    /// The full names of the keys that stand in it.
    pub(super) fn keys(&self) -> impl Iterator<Item = &str> {
        self.values.all().map(|(key, _)| key)
    }

    /// What is wrong with the full name of a key of a layer that is not there.
    pub(super) fn no_layer(&self, full: &str) -> Option<Fault> {
        let (number, _) = full.strip_prefix("layer.")?.split_once('.')?;
        let count = self.values.number("layer").map_or(0, |count| count as u64);
        let is_there = number.parse().is_ok_and(|number: u64| (1..=count).contains(&number));
        WEB.list("layer").filter(|_| !is_there).map(|list| no_entry("layer", count, list))
    }

    /// The web; and what is written of the filament of each layer.
    ///
    /// # Errors
    /// Every problem with it.
    pub(super) fn read(self, resources: &Resources) -> Result<(WebFile, Vec<Option<WrittenValues>>), Error> {
        let open = open::open(self, resources);
        let filaments = open.filaments();
        let (spec, notes) = open.spec()?;
        let text = write_web(&spec);
        Ok((WebFile { spec, notes, text }, filaments))
    }
}

/// Whether a key is one of the cases. Both have some: where a case is simulated, it says them.
pub(super) fn is_of_case(name: &str, flies: bool) -> bool {
    keys::find(name).is_some() && (flies || WEB.find(name).is_none())
}

/// Why a key of a filament cannot be set or varied, in words.
pub(super) fn flies_none() -> String {
    "is a key of a simulated filament, and this web simulates none".to_owned()
}

/// What is written of the filament of a web, as the values of a case.
///
/// # Errors
/// Every problem with the file before the filament is spun and simulated; and if it has none, or several.
pub(super) fn filament(
    text: &str,
    name: &str,
    set: &[Overrides<'_>],
    resources: &Resources,
) -> Result<WrittenValues, Error> {
    let web = WrittenWeb::open(text, name, set)?;
    let place = web.values.whole();
    open::open(web, resources).filament()?.ok_or_else(|| {
        let fault = Fault::new(
            "simulates no filament: how its fibres lie is known",
            "to lay the web, read the file as that of a web",
        );
        let what = fault.option("`spunlaid web`");
        vec![Diagnostic { place, key: "[laydown]".to_owned(), ..what.into() }].into()
    })
}

/// The values of a file, by the keys of the web and of the case of its filament.
fn values(text: &str, name: &str, set: &[Overrides<'_>]) -> Result<WrittenValues, Error> {
    let values = document::read(&WEB_FILE, text, name, set)?;
    let is_of_web = |full: &str| web_key(full).is_some_and(|key| keys::find(key.name).is_none());
    let is_case_alone =
        values.problems.is_empty() && !values.all().any(|(full, _)| full == "layer" || is_of_web(full));
    let first = values.all().min_by(|a, b| a.1.place.cmp(&b.1.place));
    match first.filter(|_| is_case_alone) {
        Some((full, written_value)) => {
            let table = full.split('.').next().unwrap_or(full);
            let place = written_value.place.clone();
            let fault = Fault::new(
                "belongs to a case, and the file does not describe a web",
                "add [line] and [web], or read it as a case",
            );
            let what = fault.option("`spunlaid run`");
            Err(vec![Diagnostic { place, key: format!("[{table}]"), ..what.into() }].into())
        }
        None => Ok(values),
    }
}
