//! The web that a study varies, with the cases that it flies.

use super::super::web::{WebFile, WrittenWeb, flies_none, is_of_case, write_web_to_vary};
use super::super::written_values::{WrittenValue, WrittenValues};
use super::super::{Overrides, Resources};
use super::plan::Plan;
use super::{Base, ExperimentWithNotes, TAKE_A_NUMBER, written_at};
use spunlaid_experiment::{Experiment, Point, Quantity, Study};
use spunlaid_fibre::case::keys::{self, Value, VariedKey};
use spunlaid_ground::error::{Place, nearest_word};
use spunlaid_ground::{Diagnostic, Error};
use spunlaid_simulation::layers::full_names::{full_name, replaced_by, value, web_key, without_numbers};
use spunlaid_simulation::{SAME, WEB_KEYS, WebSpec};

/// The web of a study before its keys vary.
pub(super) struct WebBase {
    /// The path of its file.
    path: String,
    /// What is written, with what is the same at all points.
    written: WrittenWeb,
    /// The web before its keys vary.
    pub(super) file: WebFile,
    /// What is written of the filament of each layer.
    filaments: Vec<Option<WrittenValues>>,
}

impl WebBase {
    /// * `path` – of the file
    /// * `set` – keys that are the same at all points: those of the study file, and those that replace them
    pub(super) fn new(
        text: &str,
        path: String,
        set: &[Overrides<'_>],
        resources: &Resources,
    ) -> Result<Self, Error> {
        let written = WrittenWeb::open(text, &path, set)?;
        let (file, filaments) = written.clone().read(resources)?;
        Ok(Self { path, written, file, filaments })
    }

    /// The web with these values of keys, and with a seed of its own if there is one.
    pub(super) fn with(
        &self,
        values: &[(VariedKey, f64)],
        seed: Option<u64>,
        resources: &Resources,
    ) -> Result<WebFile, Error> {
        let at = Place::Override("point".to_owned());
        let seed =
            seed.map(|seed| ("web.seed".to_owned(), WrittenValue::new(&at, seed.to_string(), seed.into())));
        let mut changes: Vec<_> = written_at(values, &at)?.into_iter().chain(seed).collect();
        changes.iter_mut().for_each(|(name, _)| *name = self.short_name(name).to_owned());
        let no_layer = |(name, value): &(String, WrittenValue)| {
            let what = self.written.no_layer(name)?;
            Some(Diagnostic {
                place: at.clone(),
                key: name.clone(),
                value: value.shown.clone(),
                ..what.into()
            })
        };
        match changes.iter().find_map(no_layer) {
            Some(problem) => Err(vec![problem].into()),
            None => Ok(self.written.with(&changes).read(resources)?.0),
        }
    }

    /// The same, if it can be the file of a line.
    ///
    /// # Errors
    /// As [`WebFile::within_reason`].
    pub(super) fn within_reason(self) -> Result<Self, Error> {
        Ok(Self { file: self.file.within_reason()?, ..self })
    }

    /// The web before its keys vary.
    pub(super) const fn spec(&self) -> &WebSpec {
        &self.file.spec
    }

    /// The path of its file.
    pub(super) fn path(&self) -> &str {
        &self.path
    }

    /// Whether its file has a list of layers.
    pub(super) fn is_layered(&self) -> bool {
        self.written.is_layered()
    }

    /// The keys of its file whose place these take, if they are set.
    pub(super) fn replaced_by(&self, set: &[&str]) -> Vec<&str> {
        let is_displaced = replaced_by(set, self.is_layered());
        self.written.keys().filter(|name| is_displaced(name)).collect()
    }

    /// The name of a key in its file, which has no number of a layer where the file has no list of them.
    pub(super) fn short_name<'n>(&self, full: &'n str) -> &'n str {
        full.strip_prefix("layer.1.").filter(|_| !self.is_layered()).unwrap_or(full)
    }

    /// The number of a key of the cases, if all that are simulated have the same.
    pub(super) fn number_of_cases(&self, name: &str) -> Option<f64> {
        let key = keys::find(name)?;
        let mut numbers = self.spec().cases().filter_map(|case| Some(key.value_in(case)?.number()));
        let first = numbers.next()??;
        let is_same =
            |other: Option<f64>| other.is_some_and(|other| (other - first).abs() <= SAME * first.abs());
        numbers.all(is_same).then_some(first)
    }

    /// The case that it flies, the first of several.
    fn case_value(&self, name: &str) -> Option<Value> {
        keys::find(name)?.value_in(self.spec().cases().next()?)
    }
}

impl Base for WebBase {
    fn varied(&self, name: &str) -> Result<VariedKey, String> {
        if let Some(key) = keys::find(name).filter(|_| is_of_case(name, self.spec().flies())) {
            return match (self.spec().flies(), key.varies) {
                (false, _) => Err(format!("it {}", flies_none())),
                (true, false) => {
                    Err("the simulations of all points share it; write it under [set]".to_owned())
                }
                (true, true) => Ok(VariedKey::new(name, key.kind)),
            };
        }
        let full = full_name(self.spec(), name)?;
        match web_key(&full) {
            Some(key) if key.varies => Ok(VariedKey::new(full, key.kind)),
            Some(_) => Err(TAKE_A_NUMBER.to_owned()),
            None => {
                let of_layer = without_numbers(&full);
                let plain = of_layer.strip_prefix("layer.").unwrap_or(&of_layer);
                Err(match nearest_word(plain, WEB_KEYS.iter().map(|key| key.name)) {
                    Some(near) => format!("did you mean {near}?"),
                    None => format!("{TAKE_A_NUMBER}, of the web or of its case"),
                })
            }
        }
    }

    fn value(&self, key: &VariedKey) -> Option<f64> {
        let found = if is_of_case(&key.name, self.spec().flies()) {
            self.case_value(&key.name)
        } else {
            value(self.spec(), &key.name)
        };
        found.and_then(|value| key.number(&value)).filter(|value| !value.is_nan())
    }

    fn seed_and_replicates(&self) -> (u64, u64) {
        (self.spec().seed, 1)
    }

    fn quantities(&self) -> Vec<Quantity> {
        let experiment = Experiment::from(self.spec().clone());
        Study::quantities_of(&[Point { values: Vec::new(), experiment }])
    }

    fn point(
        &self,
        values: &[(VariedKey, f64)],
        _: &Place,
        _: &Plan,
        seed: Option<u64>,
        resources: &Resources,
    ) -> ExperimentWithNotes {
        let WebFile { spec, notes, .. } = self.with(values, seed, resources)?;
        Ok((spec.into(), notes))
    }

    fn written(&self, _: Vec<(String, String)>) -> (String, Vec<(String, String)>) {
        // What is set is in the web already.
        (write_web_to_vary(self.spec(), &self.filaments), Vec::new())
    }
}
