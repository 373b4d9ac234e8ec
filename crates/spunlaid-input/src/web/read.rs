//! Makes the web from the written values, from what the simulated cases give, and from the defaults.

use super::super::Resources;
use super::super::written_values::{WrittenValue, WrittenValues};
use super::NamedCase;
use spunlaid_fibre::case::keys::Value;
use spunlaid_fibre::case::unusual;
use spunlaid_ground::{Diagnostic, Fault};
use spunlaid_simulation::layers::full_names::{DEFECTS, ROWS, web_key, without_numbers};
use spunlaid_simulation::layers::keys::{NUMBERS, WEB, in_rows};
use spunlaid_simulation::{LaydownSource, LayerSpec, WebKey, WebSpec};
use spunlaid_web::map::Filaments;
use spunlaid_web::{Defect, Row};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The keys of a file that has the case of a layer, of the throughput of a hole, and of the belt on which all
/// layers lie.
pub(super) const CASE: &str = "laydown.case";
pub(super) const THROUGHPUT: &str = "line.throughput";
pub(super) const BELT_SPEED: &str = "line.belt_speed";

/// A file while it is read.
pub(super) struct WebParser<'a> {
    pub(super) key_values: WrittenValues,
    /// Its path.
    pub(super) path: PathBuf,
    /// The cases that the layers name.
    pub(super) named: BTreeMap<String, NamedCase>,
    /// Files and tensions of the cases.
    pub(super) resources: &'a Resources,
    pub(super) notes: Vec<Diagnostic>,
    /// What comes before the names of each layer's keys: `layer.2.`, or nothing in a file without `[[layer]]`.
    pub(super) prefixes: Vec<String>,
    /// The full name of the key that gives the basis weight, of one of the layers; empty if there is none.
    pub(super) basis_weight_key: String,
}

/// A web of one layer, which is read through the keys of a web.
pub(super) fn web_of(layer: LayerSpec) -> WebSpec {
    WebSpec { layers: vec![layer], ..WebSpec::unknown() }
}

impl WebParser<'_> {
    /// Warnings about written values that are most likely slips.
    pub(super) fn unusual(&self) -> Vec<Diagnostic> {
        let entry = |(full, written_value): (&str, &WrittenValue)| {
            let key = web_key(full)?;
            let (dimension, usual) = (key.kind.dimension()?, key.usual?);
            let values = match written_value.value.as_ref()? {
                Value::Number(value) => std::slice::from_ref(value),
                Value::Numbers(values) => values.as_slice(),
                _ => return None,
            };
            let what = values.iter().find_map(|value| unusual(dimension, usual, *value))?;
            let place = written_value.place.clone();
            Some(Diagnostic { place, ..what.with_key(full, written_value.shown.clone()) })
        };
        self.key_values.all().filter_map(entry).collect()
    }

    /// Keeps the notes about a case, each once.
    pub(super) fn note(&mut self, notes: Vec<Diagnostic>) {
        for note in notes {
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
        }
    }

    /// Records a problem with a value, which may be a default.
    pub(super) fn refuse(&mut self, key: &str, value: String, what: Fault) {
        let problem = Diagnostic::from(what).with_key(key, Some(value));
        self.key_values.problems.push(self.key_values.placed(problem));
    }

    /// Whether a key is written, with a value that can be read or not.
    pub(super) fn is_written(&self, full: &str) -> bool {
        self.written(full).is_some()
    }

    /// Whether a key is written, or missing only because of another problem.
    pub(super) fn is_given(&self, full: &str) -> bool {
        self.is_written(full) || self.key_values.is_excused(full)
    }

    /// What is written of a key: of that of a layer, or of one that all layers have in common.
    fn written(&self, full: &str) -> Option<&WrittenValue> {
        let common = || {
            let (number, rest) = full.strip_prefix("layer.")?.split_once('.')?;
            let is_common = WEB.find(rest).is_some_and(|key| WEB.is_common(key.table()));
            let own =
                || self.key_values.all().filter_map(|(name, _)| name.strip_prefix("layer.")?.split_once('.'));
            let own: Vec<&str> = own().filter(|(of, _)| *of == number).map(|(_, name)| name).collect();
            let is_replaced = WEB.replaced_by(&own).contains(&rest);
            self.key_values.get(rest).filter(|_| is_common && !is_replaced)
        };
        self.key_values.get(full).or_else(common)
    }

    /// The full names of a key of a layer, or of one of all layers in each of them.
    pub(super) fn places_of(&self, key: &WebKey, prefix: &str) -> Vec<String> {
        match key.relations.of_all_layers {
            Some(_) => self.prefixes.iter().map(|prefix| format!("{prefix}{}", key.name)).collect(),
            None => vec![format!("{prefix}{}", key.name)],
        }
    }

    /// Sets the keys of a table: what is written, or else the default. What is missing is noted.
    ///
    /// * `before` – what comes before the names of its keys, `layer.2.line.`
    /// * `by_case` – whether a case gives what it has too
    pub(super) fn fill(&mut self, web: &mut WebSpec, table: &str, before: &str, by_case: bool) {
        for key in WEB.keys_of_table(table).filter(|key| !(by_case && key.key_of_case().is_some())) {
            let full = format!("{before}{}", key.short());
            let is_there = |name: &str| {
                let (_, short) = name.rsplit_once('.').unwrap_or(("", name));
                self.is_written(&format!("{before}{short}"))
            };
            let written = self.written(&full).map(|written_value| written_value.value.clone());
            let missing = |_: &WebSpec| Fault::missing(&without_numbers(before), &key.example());
            let missing = |web: &WebSpec| key.relations.of_all_layers.is_none().then(|| missing(web));
            if let Err(fault) = WEB.fill(key, &mut *web, written, is_there, missing)
                && (self.is_written(&full) || !self.key_values.is_excused(&full))
            {
                self.key_values.reject(&full, fault);
            }
        }
    }

    /// The rows of holes; it is noted if there are neither rows nor filaments at random.
    ///
    /// * `before` – what comes before the names of the table's keys: `line.`
    pub(super) fn rows(&mut self, before: &str) -> Vec<Row> {
        let [at_random, rows, depth] =
            ["filaments_per_metre", "rows", "slot_gap"].map(|name| format!("{before}{name}"));
        if self.is_written(&depth) && self.is_written(&rows) {
            self.key_values.reject(&depth, in_rows());
        }
        let is_written = self.is_written(&at_random) || self.is_written(&rows);
        if !is_written && !self.key_values.is_excused(&at_random) {
            let add = format!("add filaments_per_metre = 5000 to [{}]", without_numbers(before));
            let rows = "rows = [{ offset = \"0 mm\", pitch = \"0.2 mm\", filaments = 5000 }]";
            self.key_values.reject(&at_random, Fault::new("is missing", format!("{add}, or {rows}")));
        }
        let unknown = Filaments::Rows(vec![Row::new(f64::NAN, f64::NAN, 0)]);
        let layers = self.entries(before, ROWS, |layer| layer.filaments = unknown.clone());
        let row = |layer: LayerSpec| match layer.filaments {
            Filaments::Rows(rows) => rows.first().copied(),
            Filaments::AtRandom { .. } | Filaments::Slot { .. } => None,
        };
        layers.into_iter().filter_map(row).collect()
    }

    /// The defects of a layer.
    ///
    /// * `before` – what comes before the names of the table's keys: `line.`
    pub(super) fn defects(&mut self, before: &str) -> Vec<Defect> {
        let layers = self.entries(before, DEFECTS, |layer| layer.defects = vec![Defect::USUAL]);
        layers.into_iter().flat_map(|layer| layer.defects).collect()
    }

    /// The entries of a list, each in a layer of its own.
    ///
    /// * `unknown` – gives a layer an entry whose keys are set one after another
    fn entries(&mut self, before: &str, list: &str, unknown: impl Fn(&mut LayerSpec)) -> Vec<LayerSpec> {
        let full = format!("{before}{}", list.trim_start_matches("line."));
        let count = self.key_values.number(&full).unwrap_or(0.0) as u64;
        let entry = |number| {
            let mut layer = LayerSpec::unknown(LaydownSource::UNKNOWN);
            unknown(&mut layer);
            let mut web = web_of(layer);
            web.sheet.width = self.key_values.number("web.width").unwrap_or(f64::NAN);
            self.fill(&mut web, list, &format!("{full}.{number}."), false);
            web.layers
        };
        (1..=count).flat_map(entry).collect()
    }

    /// Whether a layer gives the numbers of a surrogate.
    pub(super) fn has_numbers(&self, prefix: &str) -> bool {
        NUMBERS.iter().any(|name| self.is_written(&format!("{prefix}{name}")))
    }
}
