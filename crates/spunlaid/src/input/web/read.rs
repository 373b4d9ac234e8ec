//! Makes the web from the written values, from what the flown cases give, and from the defaults.

use super::super::Overrides;
use super::super::lookup::Lookup;
use super::super::written_values::{WrittenValue, WrittenValues, sorted};
use crate::case::keys::{Key, Value};
use crate::case::{Note, unusual};
use crate::error::{Error, Fault, Finding};
use crate::layers::full_names::{web_key, without_numbers};
use crate::layers::keys::{NUMBERS, WEB, in_rows};
use crate::layers::{LaydownSource, LayerSpec, Method, SAME, WebKey, WebSpec};
use crate::web::{Filaments, Row};
use std::path::{Path, PathBuf};

/// The key of the only thing that all layers have in common.
pub(super) const BELT_SPEED: &str = "line.belt_speed";
/// The keys that stand in place of the speeds.
pub(super) const BASIS_WEIGHT: &str = "line.basis_weight";
pub(super) const THROUGHPUT: &str = "line.throughput";
/// Relative difference up to which two numbers agree if one is rounded to three digits and the other follows from such numbers.
pub(super) const ROUNDED: f64 = 5e-3;

/// A file while it is read.
pub(super) struct Reading<'a> {
    pub(super) key_values: WrittenValues,
    /// The folder of the file.
    pub(super) folder: PathBuf,
    /// Changes to the cases that are flown.
    pub(super) of_case: &'a [Overrides<'a>],
    /// Texts of cases that are no files.
    pub(super) cases: &'a [(PathBuf, String)],
    /// Files and tensions of the cases.
    pub(super) lookup: &'a Lookup,
    notes: Vec<Note>,
    /// The full name of the key that gives the basis weight, of one of the layers; empty if there is none.
    pub(super) basis_weight_key: String,
}

/// The web that is written, and notes about its cases.
///
/// # Errors
/// Every problem with any key.
pub(super) fn spec(
    key_values: WrittenValues,
    name: &str,
    (of_case, cases): (&[Overrides<'_>], &[(PathBuf, String)]),
    lookup: &Lookup,
) -> Result<(WebSpec, Vec<Note>), Error> {
    let folder = Path::new(name).parent().unwrap_or(Path::new("")).to_owned();
    let (notes, basis_weight_key) = (Vec::new(), String::new());
    let mut reading = Reading { key_values, folder, of_case, cases, lookup, notes, basis_weight_key };
    let (mut web, prefixes) = (WebSpec::unknown(), reading.prefixes());
    reading.leave_to_case(&prefixes);
    for prefix in &prefixes {
        let layer = reading.layer(prefix)?;
        web.layers.push(layer);
    }
    reading.fill(&mut web, "web", "web.");
    reading.fill(&mut web, "fabric", "fabric.");
    if !reading.is_written("web.method") {
        web.method = Method::default_for(&web.layers);
    }
    reading.check_names(&prefixes);
    reading.complete_sheet(&mut web);
    reading.check_method(&prefixes, &web);
    reading.check_guessed(&web);
    reading.settle_belt(&prefixes, &mut web);
    for (number, prefix) in prefixes.iter().enumerate() {
        reading.check_layer(prefix, &web.alone(number));
    }
    let unusual = reading.unusual();
    reading.note(unusual.clone());
    let Reading { mut key_values, notes, .. } = reading;
    if key_values.problems.is_empty() {
        if let Some(problem) = web.air_beyond_memory() {
            return Err(vec![key_values.placed(problem)].into());
        }
        return Ok((web, sorted(notes)));
    }
    // Unusual values may be why the web cannot be laid.
    for note in unusual {
        if !key_values.problems.iter().any(|problem| problem.key == note.key) {
            key_values.problems.push(note.into());
        }
    }
    Err(sorted(key_values.problems).into())
}

/// Changes a layer through the keys, which are those of a web.
fn as_web(layer: &mut LayerSpec, change: impl FnOnce(&mut WebSpec)) {
    let mut web = WebSpec { layers: vec![layer.clone()], ..WebSpec::unknown() };
    change(&mut web);
    web.layers.into_iter().for_each(|changed| *layer = changed);
}

impl Reading<'_> {
    /// What comes before the names of each layer's keys: `layer.2.`, or nothing in a file without `[[layer]]`.
    fn prefixes(&self) -> Vec<String> {
        match self.key_values.get("layer") {
            None => vec![String::new()],
            Some(_) => {
                let layers = self.key_values.number("layer").unwrap_or(0.0) as usize;
                (1..=layers).map(|number| format!("layer.{number}.")).collect()
            }
        }
    }

    /// Warnings about written values that are most likely slips.
    fn unusual(&self) -> Vec<Note> {
        let entry = |(full, written_value): (&str, &WrittenValue)| {
            let key = web_key(full)?;
            let (dimension, usual) = (key.kind.dimension()?, key.usual_range()?);
            let values = match written_value.value.as_ref()? {
                Value::Number(value) => std::slice::from_ref(value),
                Value::Numbers(values) => values.as_slice(),
                _ => return None,
            };
            let what = values.iter().find_map(|value| unusual(dimension, usual, *value))?;
            Some(Note {
                place: written_value.place.clone(),
                key: full.to_owned(),
                value: written_value.shown.clone(),
                what,
            })
        };
        self.key_values.all().filter_map(entry).collect()
    }

    /// Keeps the notes about a case, each once.
    pub(super) fn note(&mut self, notes: Vec<Note>) {
        for note in notes {
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
        }
    }

    /// Records a problem with a value, which may be a default.
    pub(super) fn refuse(&mut self, key: &str, value: String, what: Fault) {
        let finding =
            Finding { place: self.key_values.whole(), key: key.to_owned(), value: Some(value), what };
        let problem = self.key_values.placed(finding);
        self.key_values.problems.push(problem);
    }

    /// Whether a key is written, with a value that can be read or not.
    pub(super) fn is_written(&self, full: &str) -> bool {
        self.key_values.get(full).is_some()
    }

    /// Sets the keys of a table: what is written, or else the default. What is missing is noted, unless a flown case gives it.
    ///
    /// * `before` – what comes before the names of its keys, `layer.2.line.`
    fn fill(&mut self, web: &mut WebSpec, table: &str, before: &str) {
        for key in WEB.keys_of_table(table) {
            let full = format!("{before}{}", key.short());
            let is_there = |name: &str| {
                let (_, short) = name.rsplit_once('.').unwrap_or(("", name));
                self.is_written(&format!("{before}{short}"))
            };
            let is_given = || {
                let is_common = key.relations.of_all_layers;
                is_common || flown(web, key).is_some() || WEB.is_given(key.name, is_there)
            };
            let written = self.key_values.get(&full).map(|written_value| written_value.value.clone());
            let set = match (written, key.default_in(web)) {
                (Some(None), _) => Ok(()),
                // They are settled when all else is known.
                (Some(Some(_)), _) if key.read_last => Ok(()),
                (Some(Some(value)), _) => match key.beside_alternative(is_there) {
                    Some(fault) => Err(fault),
                    None => key.apply(web, &value),
                },
                (None, Some(text)) => key.set(web, text).map_err(|problem| problem.what),
                (None, None) if !key.is_needed(web) || is_given() => Ok(()),
                (None, None) => Err(Fault::missing(&without_numbers(before), &key.example())),
            };
            if let Err(fault) = set
                && (self.is_written(&full) || !self.key_values.is_excused(&full))
            {
                self.key_values.reject(&full, fault);
            }
        }
    }

    /// A layer. Its values are NaN where there is a problem with them, which is noted.
    fn layer(&mut self, prefix: &str) -> Result<LayerSpec, Error> {
        let source = self.laydown(prefix)?;
        let by_case =
            ["case", "results"].iter().any(|way| self.is_written(&format!("{prefix}laydown.{way}")));
        if source.is_none() && (by_case || self.key_values.is_excused(&format!("{prefix}laydown."))) {
            // The case would give them.
            for key in WEB.rows.iter().filter(|key| key.key_of_case().is_some()) {
                self.key_values.excuse(format!("{prefix}{}", key.name));
            }
        }
        let numbers = matches!(source, Some(LaydownSource::Surrogate(_)));
        let mut layer = LayerSpec::unknown(source.unwrap_or(LaydownSource::UNKNOWN));
        as_web(&mut layer, |web| {
            self.fill(web, "layer", prefix);
            for table in ["fibre", "laydown", "line"].iter().filter(|table| **table != "laydown" || numbers) {
                self.fill(web, table, &format!("{prefix}{table}."));
            }
            self.take_flown(web, prefix);
            self.settle_throughput(web, prefix);
        });
        let rows = self.rows(&format!("{prefix}line."));
        if !rows.is_empty() {
            layer.filaments = Filaments::Rows(rows);
        }
        Ok(layer)
    }

    /// Takes the values with which the fibres of a layer are flown, and refuses others.
    fn take_flown(&mut self, web: &mut WebSpec, prefix: &str) {
        for key in WEB.rows {
            let Some((of_case, value)) = flown(web, key) else { continue };
            let numbers = (key.get(web).and_then(|here| here.number()), value.number());
            // A titre is rounded more often than the diameter for which it stands.
            let apart = if key.relations.alternative_to.is_empty() { SAME } else { ROUNDED };
            if let (Some(here), Some(there)) = numbers
                && (here / there - 1.0).abs() > apart
            {
                let path = web.layers.first().map_or(Path::new(""), |layer| layer.source.path()).display();
                let message = format!(
                    "differs from {} = {} of {path}, with which the fibres are flown, and they would lie otherwise",
                    of_case.name,
                    of_case.kind.pretty(&value)
                );
                let remedy = "leave it out here, and set it in the case";
                self.key_values.reject(&format!("{prefix}{}", key.name), Fault::new(message, remedy));
            }
        }
        for key in WEB.rows.iter().filter(|key| key.relations.alternative_to.is_empty()) {
            if let Some((_, value)) = flown(web, key) {
                // The kinds of both keys are the same.
                drop(key.apply(web, &value));
            }
        }
    }

    /// The rows of nozzles; it is noted if there are neither rows nor filaments at random.
    ///
    /// * `before` – what comes before the names of the table's keys: `line.`
    fn rows(&mut self, before: &str) -> Vec<Row> {
        let [at_random, rows, depth] =
            ["filaments_per_metre", "rows", "depth"].map(|name| format!("{before}{name}"));
        if self.is_written(&depth) && self.is_written(&rows) {
            self.key_values.reject(&depth, in_rows());
        }
        let is_written = self.is_written(&at_random) || self.is_written(&rows);
        if !is_written && !self.key_values.is_excused(&at_random) {
            let add = format!("add filaments_per_metre = 5000 to [{}]", without_numbers(before));
            let rows = "rows = [{ offset = \"0 mm\", pitch = \"0.2 mm\", filaments = 5000 }]";
            self.key_values.reject(&at_random, Fault::new("is missing", format!("{add}, or {rows}")));
        }
        let count = self.key_values.number(&rows).unwrap_or(0.0) as u64;
        let row = |number| {
            let row = Row::new(f64::NAN, f64::NAN, 0);
            let mut layer = LayerSpec {
                filaments: Filaments::Rows(vec![row]),
                ..LayerSpec::unknown(LaydownSource::UNKNOWN)
            };
            as_web(&mut layer, |web| {
                web.sheet.width = self.key_values.number("web.width").unwrap_or(f64::NAN);
                self.fill(web, "line.rows", &format!("{rows}.{number}."));
            });
            match layer.filaments {
                Filaments::Rows(rows) => rows.first().copied(),
                Filaments::AtRandom { .. } | Filaments::Slot { .. } => None,
            }
        };
        (1..=count).filter_map(row).collect()
    }

    /// Whether a layer gives the numbers of a surrogate.
    pub(super) fn has_numbers(&self, prefix: &str) -> bool {
        NUMBERS.iter().any(|name| self.is_written(&format!("{prefix}{name}")))
    }

    /// Refuses a method of laying that needs flights where there are none.
    fn check_method(&mut self, prefixes: &[String], web: &WebSpec) {
        if web.method != Method::SharedAir && self.is_written("web.flown") {
            let fault = Fault::needs("web.method = \"shared-air\"", "leave it out");
            self.key_values.reject("web.flown", fault);
        }
        match web.method {
            Method::SharedAir => self.check_shared_air(prefixes, &web.layers),
            Method::Dynamics => {
                if let Some(prefix) = prefixes.iter().find(|prefix| self.has_numbers(prefix)) {
                    let fault = Fault::new(
                        format!("lays the curves of flown fibres, and {prefix}laydown gives numbers"),
                        "write method = \"surrogate\", or name a case or results there",
                    );
                    self.key_values.reject("web.method", fault);
                }
            }
            Method::Surrogate => {}
        }
    }
}

/// What the case of a layer's flown fibres gives for a key of the web: the key of the case, and its value.
fn flown(web: &WebSpec, key: &WebKey) -> Option<(&'static Key, Value)> {
    let (of_case, case) = (key.key_of_case()?, web.layers.first()?.source.case()?);
    Some((of_case, of_case.value_in(case)?))
}
