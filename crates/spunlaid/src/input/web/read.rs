//! Makes the web from the written values, with the defaults.

use super::super::Overrides;
use super::super::written::{WrittenValue, WrittenValues, sorted};
use super::document::WebDocument;
use crate::case::keys::{LeftOut, Value};
use crate::case::{Note, unusual};
use crate::error::{Error, Fault, Finding};
use crate::layers::keys::{self, ALL_METHODS, METHODS, diameter, in_rows};
use crate::layers::{LaydownSource, LayerSpec, Method, WebKey, WebSpec};
use crate::units::Dimension;
use crate::web::{Filaments, Row};
use std::path::{Path, PathBuf};

/// The limit of memory if the file gives none [B].
const MEMORY_LIMIT: f64 = 4e9;
/// Relative difference up to which two written numbers are the same.
pub(super) const SAME: f64 = 1e-9;

/// A file while it is read.
pub(super) struct Reading<'a> {
    pub(super) written: WrittenValues,
    /// The folder of the file.
    pub(super) folder: PathBuf,
    /// Changes to the cases that are flown.
    pub(super) of_case: Overrides<'a>,
    /// Texts of cases that are no files.
    pub(super) cases: &'a [(PathBuf, String)],
    notes: Vec<Note>,
}

/// The web that is written, and notes about its cases.
///
/// # Errors
/// Every problem with any key.
pub(super) fn spec(
    document: WebDocument,
    name: &str,
    (of_case, cases): (Overrides<'_>, &[(PathBuf, String)]),
) -> Result<(WebSpec, Vec<Note>), Error> {
    let WebDocument { written, layers: prefixes } = document;
    let folder = Path::new(name).parent().unwrap_or(Path::new("")).to_owned();
    let mut reading = Reading { written, folder, of_case, cases, notes: Vec::new() };
    let mut layers = Vec::new();
    for prefix in &prefixes {
        layers.push(reading.layer(prefix)?);
    }
    reading.check_names(&prefixes);
    let sheet = reading.sheet();
    let method = reading.method(&prefixes, &layers);
    let seed = reading.whole("web.seed").unwrap_or_default();
    let window = sheet.as_ref().and_then(|sheet| reading.window(sheet));
    let memory_limit = reading.number_or("web.memory_limit", "web", Ok(MEMORY_LIMIT));
    reading.check_belts(&prefixes, &layers);
    if let Some(sheet) = &sheet {
        for (prefix, layer) in prefixes.iter().zip(&layers) {
            layer.iter().for_each(|layer| reading.check_layer(prefix, layer, sheet));
        }
    }
    let unusual = reading.unusual();
    reading.note(unusual.clone());
    let Reading { mut written, notes, .. } = reading;
    if !written.problems.is_empty() {
        // They may be why the web cannot be laid.
        for note in unusual {
            if !written.problems.iter().any(|problem| problem.key == note.key) {
                written.problems.push(note.into());
            }
        }
    }
    match (sheet, layers.into_iter().collect::<Option<Vec<_>>>(), window, memory_limit) {
        (Some(sheet), Some(layers), Some(window), Some(memory_limit)) if written.problems.is_empty() => {
            let spec = WebSpec { sheet, layers, seed, method, window, memory_limit };
            spec.check_air().map_err(|problem| Error::from(vec![written.placed(problem)]))?;
            Ok((spec, sorted(notes)))
        }
        _ => Err(sorted(written.problems).into()),
    }
}

impl Reading<'_> {
    /// Warnings about written values that are most likely slips.
    fn unusual(&self) -> Vec<Note> {
        let of = |(full, said): (&str, &WrittenValue)| {
            let key = keys::of_full(full)?;
            let (dimension, usual) = (key.kind.dimension()?, key.usual_range()?);
            let values = match said.value.as_ref()? {
                Value::Number(value) => std::slice::from_ref(value),
                Value::Numbers(values) => values.as_slice(),
                _ => return None,
            };
            let what = values.iter().find_map(|value| unusual(dimension, usual, *value))?;
            Some(Note { place: said.place.clone(), key: full.to_owned(), value: said.shown.clone(), what })
        };
        self.written.all().filter_map(of).collect()
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
        let finding = Finding { place: self.written.whole(), key: key.to_owned(), value: Some(value), what };
        let problem = self.written.placed(finding);
        self.written.problems.push(problem);
    }

    /// The number of a required key; none if there is a problem with it, which is noted.
    pub(super) fn number(&mut self, prefix: &str, name: &str) -> Option<f64> {
        self.number_or(&format!("{prefix}{name}"), table_of(prefix, name), Err(&example(name)))
    }

    /// The number of a key, or else another one; a line to write in its table if there is none.
    pub(super) fn number_or(
        &mut self,
        full: &str,
        table: &'static str,
        otherwise: Result<f64, &str>,
    ) -> Option<f64> {
        if self.written.get(full).is_some() {
            return self.written.number(full);
        }
        if let Err(line) = otherwise
            && !self.written.is_excused(full)
        {
            self.written.reject(full, Fault::missing(table, line));
        }
        otherwise.ok()
    }

    /// The whole number of a key, or its default.
    pub(super) fn whole(&self, full: &str) -> Option<u64> {
        match self.written.get(full) {
            Some(said) => match said.value {
                Some(Value::Whole(number)) => Some(number),
                _ => None,
            },
            None => match keys::find(full)?.left_out {
                LeftOut::Value(text) => text.parse().ok(),
                _ => None,
            },
        }
    }

    /// A layer; none if there is a problem with it, which is noted.
    fn layer(&mut self, prefix: &str) -> Result<Option<LayerSpec>, Error> {
        let source = self.laydown(prefix)?;
        let by_case = ["case", "results"]
            .iter()
            .any(|way| self.written.get(&format!("{prefix}laydown.{way}")).is_some());
        if source.is_none() && (by_case || self.written.is_excused(&format!("{prefix}laydown."))) {
            // The case would give them.
            for name in ["fibre.diameter", "fibre.density", "line.feed_speed", "line.belt_speed"] {
                self.written.excuse(format!("{prefix}{name}"));
            }
        }
        let flown = source.as_ref().and_then(FlownSource::of);
        let density = self.as_flown(prefix, "fibre.density", flown.as_ref());
        let diameter = self.diameter(prefix, density, flown.as_ref());
        let feed_speed = self.as_flown(prefix, "line.feed_speed", flown.as_ref());
        let belt_speed = self.as_flown(prefix, "line.belt_speed", flown.as_ref());
        let filaments = self.filaments(prefix);
        let name = self.written.text(&format!("{prefix}name"));
        if let (Some(feed), Some(belt)) = (feed_speed, belt_speed)
            && belt > feed
        {
            let value = Dimension::Velocity.pretty(belt);
            let feed = Dimension::Velocity.pretty(feed);
            let fault = Fault::new(
                format!("is more than line.feed_speed = {feed}, which would tear the fibre"),
                "slow the belt, or feed faster",
            );
            self.refuse(&format!("{prefix}line.belt_speed"), value, fault);
        }
        let all = (density, diameter, source, feed_speed, belt_speed, filaments);
        let (
            Some(density),
            Some(diameter),
            Some(source),
            Some(feed_speed),
            Some(belt_speed),
            Some(filaments),
        ) = all
        else {
            return Ok(None);
        };
        Ok(Some(LayerSpec { name, diameter, density, source, feed_speed, belt_speed, filaments }))
    }

    /// A number that the case of the flown fibres gives if there is one, and that must not be another then.
    fn as_flown(&mut self, prefix: &str, name: &'static str, flown: Option<&FlownSource>) -> Option<f64> {
        let there = flown.and_then(|flown| flown.value(name));
        let (full, line) = (format!("{prefix}{name}"), example(name));
        let otherwise = there.map(|(_, value)| value).ok_or(&*line);
        let number = self.number_or(&full, table_of(prefix, name), otherwise)?;
        self.must_be(&full, number, there, flown)
    }

    /// The value with which the fibres are flown, if there is one, or else the number of the file.
    fn must_be(
        &mut self,
        key: &str,
        number: f64,
        there: Option<(&'static str, f64)>,
        flown: Option<&FlownSource>,
    ) -> Option<f64> {
        let (Some((of_case, value)), Some(flown)) = (there, flown) else { return Some(number) };
        if (number / value - 1.0).abs() > SAME {
            let shown = crate::case::keys::find(of_case).and_then(|key| key.dimension());
            let value = shown.unwrap_or(Dimension::Ratio).pretty(value);
            let case = &flown.path;
            let fault = Fault::new(
                format!(
                    "differs from {of_case} = {value} of {case}, with which the fibres are flown, and they would lie otherwise"
                ),
                "leave it out here, and set it in the case",
            );
            self.written.reject(key, fault);
        }
        Some(value)
    }

    /// The diameter, as it is written or from the linear density.
    fn diameter(&mut self, prefix: &str, density: Option<f64>, flown: Option<&FlownSource>) -> Option<f64> {
        const NAME: &str = "fibre.diameter";
        let linear = format!("{prefix}fibre.linear_density");
        if self.written.get(&linear).is_none() {
            return self.as_flown(prefix, NAME, flown);
        }
        if self.written.get(&format!("{prefix}{NAME}")).is_some() {
            let remedy = "either gives the other; write one of the two";
            self.written.reject(&linear, Fault::excludes(NAME, remedy));
            return None;
        }
        let diameter = diameter(self.written.number(&linear)?, density?);
        self.must_be(&linear, diameter, flown.and_then(|flown| flown.value(NAME)), flown)
    }

    fn filaments(&mut self, prefix: &str) -> Option<Filaments> {
        let [at_random, rows, depth] =
            ["filaments_per_metre", "rows", "depth"].map(|name| format!("{prefix}line.{name}"));
        let in_slot = self.written.get(&depth).is_some();
        if in_slot && self.written.get(&rows).is_some() {
            self.written.reject(&depth, in_rows());
            return None;
        }
        match (self.written.get(&at_random).is_some(), self.whole(&rows)) {
            (true, Some(_)) => {
                let remedy = "filaments come down at random places or in rows; keep one";
                self.written.reject(&at_random, Fault::excludes("line.rows", remedy));
                None
            }
            (true, None) => {
                let per_metre = self.whole(&at_random)? as f64;
                Some(match in_slot {
                    true => Filaments::Slot { per_metre, depth: self.written.number(&depth)? },
                    false => Filaments::AtRandom { per_metre },
                })
            }
            (false, Some(count)) => {
                let rows: Vec<Option<Row>> =
                    (1..=count).map(|number| self.row(&format!("{rows}.{number}."))).collect();
                rows.into_iter().collect::<Option<_>>().map(Filaments::Rows)
            }
            (false, None) => {
                if !self.written.is_excused(&at_random) {
                    let table = table_of(prefix, "line.");
                    let fault = Fault::new(
                        "is missing",
                        format!(
                            "add filaments_per_metre = 5000 to [{table}], or rows = [{{ offset = \"0 mm\", pitch = \"0.2 mm\", \
                             filaments = 5000 }}]"
                        ),
                    );
                    self.written.reject(&at_random, fault);
                }
                None
            }
        }
    }

    /// A row of nozzles.
    ///
    /// * `before` – what comes before the names of its keys: `line.rows.1.`
    fn row(&mut self, before: &str) -> Option<Row> {
        const TABLE: &str = "line.rows";
        let [offset, pitch, filaments, md] =
            ["offset", "pitch", "filaments", "md"].map(|name| format!("{before}{name}"));
        let [offset, md] = [offset, md].map(|name| self.number_or(&name, TABLE, Ok(0.0)));
        let pitch = self.number_or(&pitch, TABLE, Err(&example("line.rows.pitch")));
        let count = self.number_or(&filaments, TABLE, Err(&example("line.rows.filaments")));
        let (offset, md, pitch, _) = (offset?, md?, pitch?, count?);
        Some(Row { offset, pitch, filaments: self.whole(&filaments)?, md })
    }

    fn method(&mut self, prefixes: &[String], layers: &[Option<LayerSpec>]) -> Method {
        let written = self.written.text("web.method");
        let method = ALL_METHODS.into_iter().find(|one| written.as_deref() == Some(METHODS[*one as usize]));
        match method {
            Some(Method::Dynamics) => self.check_flown(prefixes, layers),
            Some(Method::SharedAir) => self.check_shared_air(prefixes, layers),
            _ => {}
        }
        method.unwrap_or(Method::Surrogate)
    }

    /// Refuses the curves of fibres that have not been flown.
    fn check_flown(&mut self, prefixes: &[String], layers: &[Option<LayerSpec>]) {
        let numbers = |layer: &Option<LayerSpec>| {
            layer.as_ref().is_some_and(|layer| matches!(layer.source, LaydownSource::Surrogate(_)))
        };
        if let Some((prefix, _)) = prefixes.iter().zip(layers).find(|(_, layer)| numbers(layer)) {
            let laydown = format!("{prefix}laydown");
            let fault = Fault::new(
                format!("lays the curves of flown fibres, and {laydown} gives numbers"),
                "write method = \"surrogate\", or name a case or results there",
            );
            self.written.reject("web.method", fault);
        }
    }
}

/// A line that would be valid for a key.
fn example(name: &str) -> String {
    keys::find(name).map_or_else(String::new, WebKey::example)
}

/// The table in which a key of a layer stands, as it is written in the file.
pub(super) fn table_of(prefix: &str, name: &str) -> &'static str {
    match (prefix.is_empty(), name.split_once('.').map_or(name, |(table, _)| table)) {
        (_, "web") => "web",
        (true, "fibre") => "fibre",
        (true, "laydown") => "laydown",
        (true, _) => "line",
        (false, "fibre") => "layer.fibre",
        (false, "laydown") => "layer.laydown",
        (false, _) => "layer.line",
    }
}

/// What is known of flown fibres.
struct FlownSource {
    /// Path of their case, for messages.
    path: String,
    /// Keys of the web and of the case, and the value there.
    values: [(&'static str, &'static str, f64); 4],
}

impl FlownSource {
    fn of(source: &LaydownSource) -> Option<Self> {
        let path = match source {
            LaydownSource::Case { path, .. } => path.display(),
            LaydownSource::Results { folder, .. } => folder.display(),
            LaydownSource::Surrogate(_) => return None,
        };
        let (case, path) = (source.case()?, path.to_string());
        let line = case.line?;
        let values = [
            ("fibre.diameter", "fibre.diameter", case.fibre.diameter),
            ("fibre.density", "fibre.density", case.fibre.density),
            ("line.feed_speed", "feed.speed", line.feed_speed),
            ("line.belt_speed", "belt.speed", line.belt_speed),
        ];
        Some(Self { path, values })
    }

    /// The key of the case and its value, by the key of the web.
    fn value(&self, name: &str) -> Option<(&'static str, f64)> {
        self.values.iter().find(|(key, ..)| *key == name).map(|(_, of_case, value)| (*of_case, *value))
    }
}
