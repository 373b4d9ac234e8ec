//! The filament of a layer that is to be simulated: the values of its case. They stand in the file of the web, in
//! that of a case which the layer names, or in both; what the file of the web says takes the place of what
//! the other one says.

use super::super::open_values;
use super::super::written_values::{WrittenValue, WrittenValues};
use super::read::{CASE, THROUGHPUT, WebParser};
use spunlaid_fibre::case::keys::{self, Value};
use spunlaid_fibre::{Case, FedFilament, FilamentFeed};
use spunlaid_ground::{Diagnostic, Dimension, Error, Fault};
use spunlaid_simulation::WebKey;
use spunlaid_simulation::layers::full_names::layer_and_name;
use spunlaid_simulation::layers::keys::{EITHER, WEB, WEB_FILE};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Relative difference up to which two numbers agree if one is rounded to three digits and the other follows
/// from such numbers.
const ROUNDED: f64 = 5e-3;

/// The filament of a layer, as it is written.
pub(super) struct Filament {
    /// The values of its case.
    pub(super) values: WrittenValues,
    /// The file that describes it, for messages.
    pub(super) path: PathBuf,
    /// The numbers of that file, by their keys.
    own: Vec<(String, f64)>,
}

impl Filament {
    /// Sets a number that follows from a key of the web.
    pub(super) fn derive(
        &mut self,
        name: &'static str,
        dimension: Dimension,
        number: f64,
        key: &str,
        written: &WrittenValue,
    ) {
        let shown = format!("{} (from {})", dimension.pretty(number), key);
        self.values.set(name, WrittenValue::new(&written.place, shown, number.into()));
    }

    /// Its size and how it is fed, as far as they are known before it is spun.
    pub(super) fn size_and_feed(&self) -> FedFilament {
        let mut case = Case::unset();
        // The titre gives the diameter with the density.
        for name in ["fibre.density", "fibre.diameter", "fibre.linear_density"] {
            let value = self.values.get(name).and_then(|written_value| written_value.value.as_ref());
            if let (Some(key), Some(value)) = (keys::find(name), value) {
                // A value that has no meaning is reported with the case.
                drop(key.apply(&mut case, value));
            }
        }
        let number = |name| self.values.number(name).unwrap_or(f64::NAN);
        let feed = if self.is_spun() {
            FilamentFeed::Throughput(number("spinline.throughput"))
        } else {
            FilamentFeed::Speed(number("feed.speed"))
        };
        FedFilament { feed, ..case.filament() }
    }

    /// Whether it comes from a die.
    fn is_spun(&self) -> bool {
        self.values.has_table("spinline")
    }

    /// Whether another filament has the same values.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        self.values.has_values_of(&other.values)
    }
}

impl WebParser<'_> {
    /// The filament of a layer; none if the file that it names cannot be read, which is noted.
    pub(super) fn filament(&mut self, prefix: &str) -> Option<Filament> {
        let (mut values, path) = if self.is_written(&format!("{prefix}{CASE}")) {
            let (path, named) = self.named.remove(prefix)?;
            let mut values = named.map_err(|problems| self.key_values.problems.extend(problems)).ok()?;
            self.key_values.problems.append(&mut values.problems);
            for full in &self.key_values.taken_out {
                values.remove(full.strip_prefix(prefix).unwrap_or(full));
            }
            (values, path)
        } else {
            (WrittenValues::new(self.key_values.whole()), self.path.clone())
        };
        let number = |(name, written): (&str, &WrittenValue)| {
            Some((name.to_owned(), written.value.as_ref().and_then(Value::number)?))
        };
        let own = values.all().filter_map(number).collect();
        // What all layers have in common stands above them.
        for level in if prefix.is_empty() { vec![""] } else { vec!["", prefix] } {
            let part = self.key_values.part(level, |name| keys::find(name).is_some());
            values = values.with(part.all().map(|(name, value)| (name.to_owned(), value.clone())));
            values.excuse_as(&part);
        }
        let mut filament = Filament { values, path, own };
        for key in WEB.rows.iter().filter(|key| !key.relations.gives_case.is_empty()) {
            self.give(&mut filament, prefix, key);
        }
        complete_for_one_air(&mut filament);
        Some(filament)
    }

    /// Takes what a key of the web gives of the case, which the same file must not say too.
    fn give(&mut self, filament: &mut Filament, prefix: &str, key: &'static WebKey) {
        let places = self.places_of(key, prefix);
        let Some(full) = places.into_iter().find(|full| self.is_given(full)) else { return };
        let Some(written_value) = self.key_values.get(&full).cloned() else {
            // It is missing because of another problem.
            key.relations.gives_case.iter().for_each(|name| filament.values.suppress_missing(*name));
            return;
        };
        for of_case in key.relations.gives_case {
            let here = [format!("{prefix}{of_case}"), (*of_case).to_owned()];
            let here = if key.relations.of_all_layers.is_some() { &here[..] } else { &here[..1] };
            if here.iter().any(|name| self.is_written(name)) {
                self.key_values.reject(&full, Fault::excludes(of_case, EITHER));
                return;
            }
            filament.values.remove(of_case);
        }
        let same = key.key_of_case().map(|same| same.name);
        let number = written_value.value.as_ref().and_then(Value::number);
        match (same, number) {
            (Some(same), _) => filament.values.set(same, written_value),
            (None, Some(throughput)) if key.relations.of_all_layers.is_none() => {
                if filament.is_spun() {
                    filament.values.set("spinline.throughput", written_value);
                } else {
                    let feed = FilamentFeed::Throughput(throughput);
                    let speed = FedFilament { feed, ..filament.size_and_feed() }.feed_speed();
                    filament.derive("feed.speed", Dimension::Velocity, speed, &full, &written_value);
                }
            }
            // The belt follows when all layers are known.
            (None, _) => filament.values.suppress_missing("belt.speed"),
        }
    }

    /// The case of a filament, checked; none if there is a problem with it, which is noted.
    ///
    /// # Errors
    /// A case that cannot be read for another reason than what is in it.
    pub(super) fn fly(&mut self, prefix: &str, filament: Filament) -> Result<Option<Arc<Case>>, Error> {
        let Filament { values, path, own } = filament;
        if values.all().any(|(_, written_value)| written_value.value.is_none()) {
            return Ok(None);
        }
        let opened = open_values(values, &self.resources.files);
        let read = opened.and_then(|open| self.resources.resolve(open));
        // What the web has from a case, it has from one with another tension.
        read.iter().for_each(|(case, _)| self.resources.doubt(case));
        let read = read.map_err(|error| self.by_full_names(prefix, error));
        let named = format!("{prefix}{CASE}");
        let throughput = format!("{prefix}{THROUGHPUT}");
        if matches!(read, Err(Error::Rejected(_))) && self.is_written(&named) && self.is_written(&throughput)
        {
            let message =
                format!("cannot be simulated with {} (the message about that file says why)", path.display());
            let fault = Fault::new(message, "write another throughput, or change the case");
            self.key_values.reject(&throughput, fault);
        }
        let case = self.fed_case(&named, read)?;
        if let Some(case) = &case {
            own.iter().for_each(|(name, number)| self.note_replaced(prefix, name, *number, case, &path));
        }
        Ok(case)
    }

    /// Problems with a case, where it stands among several layers by the full names of its keys.
    fn by_full_names(&self, prefix: &str, error: Error) -> Error {
        let full = |problem: Diagnostic| {
            let full = format!("{prefix}{}", problem.key);
            let is_there = |written_value: &WrittenValue| written_value.place == problem.place;
            let key = if self.key_values.get(&full).is_some_and(is_there) { full } else { problem.key };
            Diagnostic { key, ..problem }
        };
        match error {
            Error::Rejected(problems) => problems.into_iter().map(full).collect::<Vec<_>>().into(),
            other => other,
        }
    }

    /// Notes that a case is simulated with another number than its file says, because the file of the web says it,
    /// unless the two differ by rounding.
    fn note_replaced(&mut self, prefix: &str, name: &str, own: f64, case: &Case, path: &Path) {
        let (Some(key), Some(by)) = (keys::find(name), self.says(prefix, name)) else { return };
        let (Some(used), Some(dimension)) =
            (key.value_in(case).and_then(|value| value.number()), key.dimension())
        else {
            return;
        };
        // Whoever sets a key of the case wants another number.
        let is_known = keys::find(&layer_and_name(&by).1).is_some()
            && self.key_values.get(&by).is_some_and(WrittenValue::is_set);
        if (own / used - 1.0).abs() > ROUNDED && !is_known {
            let [used, own] = [used, own].map(|value| dimension.pretty(value));
            let (case, of_case) = (path.display(), key.name);
            let what =
                Diagnostic::note(format!("is laid with {of_case} = {used} instead of the {own} of {case}"));
            let note = Diagnostic { place: self.key_values.whole(), key: by, ..what };
            self.note(vec![self.key_values.placed(note)]);
        }
    }

    /// The key of the file of the web that says a value of the case of a layer, of the layer itself before one of all.
    pub(super) fn says(&self, prefix: &str, name: &str) -> Option<String> {
        let is_it = |full: &&str| {
            let (layer, said) = layer_and_name(full);
            let Some(key) = WEB_FILE.find(&said) else { return false };
            let gives = said == name || key.relations.gives_case.contains(&name);
            (layer.is_empty() || layer == prefix || key.relations.of_all_layers.is_some())
                && (gives || WEB_FILE.are_alternatives(&said, name))
        };
        let all = self.key_values.all().map(|(full, _)| full).filter(is_it);
        all.max_by_key(|full| full.starts_with(prefix)).map(ToOwned::to_owned)
    }

    /// A case whose fibres are laid down on a moving belt.
    pub(super) fn fed_case(
        &mut self,
        key: &str,
        read: Result<(Case, Vec<Diagnostic>), Error>,
    ) -> Result<Option<Arc<Case>>, Error> {
        let (mut case, notes) = match read {
            Ok(read) => read,
            Err(Error::File(error)) => {
                self.key_values.reject(key, error.into());
                return Ok(None);
            }
            Err(Error::Rejected(problems)) => {
                for problem in problems {
                    if !self.key_values.problems.contains(&problem) {
                        self.key_values.problems.push(problem);
                    }
                }
                return Ok(None);
            }
            Err(other) => return Err(other),
        };
        // The case stands in this file where none is named.
        let is_named = self.is_written(key);
        let [of_feed, of_belt, of_air] =
            ["[feed]", "belt.speed", "air.profile"].map(|here| if is_named { key } else { here });
        let (key, fault) = match case.line {
            None if is_named => {
                let message = "is the case of a fibre of fixed length, which lays nothing";
                (of_feed, Fault::new(message, "name a case with [feed] and [belt]"))
            }
            None => {
                let message = "is missing, and a fibre of fixed length lays nothing";
                (of_feed, Fault::new(message, "add [feed] and [belt]"))
            }
            Some(line) if line.belt_speed <= 0.0 => {
                let message = "has a belt that does not move (belt.speed = 0 m/s), on which no web is laid";
                (of_belt, Fault::new(message, "give the belt of the case a speed"))
            }
            Some(_) => {
                self.note(notes);
                if let Some(what) = case.slows_only() {
                    let (place, key) = (self.key_values.whole(), of_air.to_owned());
                    self.note(vec![self.key_values.placed(Diagnostic { place, key, ..what })]);
                }
                // What is simulated is what is written and reported.
                case.air.lateral = case.air.lateral.in_one_air();
                return Ok(Some(Arc::new(case)));
            }
        };
        self.key_values.reject(key, fault);
        Ok(None)
    }
}

/// Adds what a filament in one air has anyway, and must say for the keys that are set from outside.
fn complete_for_one_air(filament: &mut Filament) {
    let needed = |(name, written): (&str, &WrittenValue)| {
        let (needed, value) = keys::find(name)?.relations.with_in_one_air?;
        let is_needed = written.is_set() && filament.values.get(needed).is_none();
        is_needed.then(|| (needed, WrittenValue::new(&written.place, None, value.into())))
    };
    let needed: Vec<_> = filament.values.all().filter_map(needed).collect();
    needed.into_iter().for_each(|(name, written_value)| filament.values.set(name, written_value));
}
