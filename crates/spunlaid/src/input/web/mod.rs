//! Files of webs: reads a file to what is to be laid, and writes it back.
//!
//! ```text
//! file, and the case that it names → values of one document ┬ web/open.rs: layers, sheet, belt            
//!                                                           └ filament.rs: the case of a filament,
//!                                                             of a web, or for `spunlaid run`, `spin`, `air`
//! ```

mod check;
mod filament;
mod guessed;
mod of_case;
mod open;
mod read;
mod sheet;
mod write;

pub(super) use guessed::Guess;
pub(super) use of_case::{flies_none, is_of_case, replaces};
pub use write::write_web;
pub(super) use write::write_web_to_vary;

use super::written_values::WrittenValues;
use super::{Overrides, Resources, document, file};
use crate::fibre::Note;
use crate::fibre::case::keys;
use crate::ground::{Error, Fault, FileKind, Problem};
use crate::simulation::WebSpec;
use crate::simulation::layers::keys::WEB_FILE;
use crate::simulation::layers::web_key;
use std::path::Path;

/// The file of a web, read.
#[derive(Clone, Debug)]
pub struct WebFile {
    /// What is to be laid.
    pub spec: WebSpec,
    /// Notes and warnings about the cases that it names.
    pub notes: Vec<Note>,
    /// The file with every default written out.
    pub text: String,
}

/// Reads and checks the file of a web, and the cases that it names.
///
/// * `overrides` – keys and values that replace values of the file or add to them, `("line.belt_speed", "6 m/s")`; of a
///   file with `[[layer]]`, `layer.2.line.belt_speed` or the layer's name in place of its number. Keys of a
///   filament without a layer, `("belt.distance", "0.4 m")`, are those of all layers
///
/// # Errors
/// If the file cannot be read, or if the web cannot be laid; then with every problem found.
pub fn read_web<'a>(path: &Path, overrides: impl Into<Overrides<'a>>) -> Result<WebFile, Error> {
    parse_web(&file::read(path, FileKind::Web)?, &path.display().to_string(), overrides)
}

/// Reads and checks the text of the file of a web. Messages call the file `name`; files that it names are
/// looked for in its folder.
///
/// # Errors
/// As [`read_web`].
pub fn parse_web<'a>(text: &str, name: &str, overrides: impl Into<Overrides<'a>>) -> Result<WebFile, Error> {
    let (overrides, own) = (overrides.into(), Resources::default());
    let resources = overrides.resources.unwrap_or(&own);
    parse_set(text, name, &[overrides], resources).map(|(file, _)| file)
}

/// [`parse_web`] with what is set from several places, each of which replaces those before it; and what is
/// written of the filament of each layer.
pub(super) fn parse_set(
    text: &str,
    name: &str,
    set: &[Overrides<'_>],
    resources: &Resources,
) -> Result<(WebFile, Vec<Option<WrittenValues>>), Error> {
    let open = open::open(values(text, name, set)?, name, set, resources)?;
    let filaments = open.filaments();
    let (spec, notes) = open.spec()?;
    let text = write_web(&spec);
    Ok((WebFile { spec, notes, text }, filaments))
}

/// What is written of the filament of a web, as the values of a case.
///
/// # Errors
/// Every problem with the file before the filament is spun and flown; and if it has none, or several.
pub(super) fn filament(
    text: &str,
    name: &str,
    set: &[Overrides<'_>],
    resources: &Resources,
) -> Result<WrittenValues, Error> {
    let values = values(text, name, set)?;
    let place = values.whole();
    open::open(values, name, set, resources)?.filament()?.ok_or_else(|| {
        let fault = Fault::new(
            "flies no filament: how its fibres lie is known",
            "to lay the web, read the file as that of a web",
        );
        let what = fault.option("`spunlaid web`");
        vec![Problem { place, key: "[laydown]".to_owned(), value: None, what }].into()
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
            let (table, place) = (full.split('.').next().unwrap_or(full), written_value.place.clone());
            let fault = Fault::new(
                "belongs to a case, and the file says nothing of a web",
                "add [line] and [web], or read it as a case",
            );
            let what = fault.option("`spunlaid run`");
            Err(vec![Problem { place, key: format!("[{table}]"), value: None, what }].into())
        }
        None => Ok(values),
    }
}
