//! The case that a study varies.

use super::super::open::{self, OpenCase};
use super::super::spinline::{self, SpinFile};
use super::super::written_values::{WrittenValue, WrittenValues};
use super::super::{Overrides, Resources, values_of_case};
use super::plan::Plan;
use super::{Base, ExperimentWithNotes, advice, written_at};
use spunlaid_experiment::{Experiment, Point, Quantity, Study};
use spunlaid_fibre::case::keys::{self, VariedKey};
use spunlaid_fibre::{SpinSpec, Spinline};
use spunlaid_ground::error::Place;
use spunlaid_ground::{Diagnostic, Error, Fault, FileKind};

/// The case as it is written, with the files that it names.
pub(super) struct CaseBase {
    text: String,
    open: OpenCase,
    /// What it is: a case, or a spinline alone.
    kind: FileKind,
}

impl CaseBase {
    /// * `name` – of the file, for messages
    /// * `set` – keys that are the same at all points
    /// * `kind` – a case, or a spinline
    pub(super) fn new(
        text: String,
        name: &str,
        set: &[Overrides<'_>],
        kind: FileKind,
        resources: &Resources,
    ) -> Result<Self, Error> {
        let key_values = values_of_case(resources, &text, name, set)?;
        Ok(Self { text, open: open_as(kind, key_values, resources)?, kind })
    }
}

fn open_as(kind: FileKind, key_values: WrittenValues, resources: &Resources) -> Result<OpenCase, Error> {
    match kind {
        FileKind::Spinline => spinline::open_spinline(key_values, &resources.files),
        _ => open::open(key_values, &resources.files),
    }
}

impl Base for CaseBase {
    fn varied(&self, name: &str) -> Result<VariedKey, String> {
        let key = keys::find(name).filter(|key| key.varies).ok_or_else(|| advice(name))?;
        if self.kind == FileKind::Spinline && !spinline::TABLES.contains(&key.table()) {
            return Err(
                "a study of a spinline varies keys of [spinline], [spinline.material] and [drag]".to_owned()
            );
        }
        Ok(VariedKey::new(name, key.kind))
    }

    fn value(&self, key: &VariedKey) -> Option<f64> {
        keys::find(&key.name).and_then(|found| {
            if key.words().is_empty() {
                self.open.number(found)
            } else {
                key.number(&found.get(&self.open.case)?)
            }
        })
    }

    fn seed_and_replicates(&self) -> (u64, u64) {
        match self.kind {
            // Nothing of it is by chance.
            FileKind::Spinline => (0, 1),
            _ => (self.open.case.run.seed, self.open.case.run.replicates),
        }
    }

    fn quantities(&self) -> Vec<Quantity> {
        match self.kind {
            FileKind::Spinline => {
                let spec = SpinSpec { spinline: Spinline::UNKNOWN, drag: self.open.case.drag, air: None };
                Study::quantities_of(&[Point {
                    values: Vec::new(),
                    experiment: Experiment::Spinline(Box::new(spec)),
                }])
            }
            _ => Study::quantities_of(&[]),
        }
    }

    fn point(
        &self,
        values: &[(VariedKey, f64)],
        at: &Place,
        plan: &Plan,
        seed: Option<u64>,
        resources: &Resources,
    ) -> ExperimentWithNotes {
        let mut key_values = self.open.key_values.with(written_at(values, at)?);
        let seed = seed.unwrap_or(plan.seed);
        if self.kind == FileKind::Spinline {
            let (opened, unneeded) = self.open(key_values, values, resources);
            let opened = opened?;
            if opened.waits_for_flights() {
                return Err(no_flights(at).into());
            }
            let SpinFile { spec, mut notes, .. } = SpinFile::from_open(opened);
            notes.extend(unneeded.into_iter().map(|note| Diagnostic { place: at.clone(), ..note }));
            return Ok((Experiment::Spinline(Box::new(spec)), notes));
        }
        for (name, value) in [("run.seed", seed), ("run.replicates", plan.replicates.at_most)] {
            key_values.set(name, WrittenValue::new(at, value.to_string(), value.into()));
        }
        let (opened, unneeded) = self.open(key_values, values, resources);
        let (case, mut notes) = resources.resolve(opened?)?;
        notes.extend(unneeded.into_iter().map(|note| Diagnostic { place: at.clone(), ..note }));
        Ok((case.into(), notes))
    }

    fn written(&self, set: Vec<(String, String)>) -> (String, Vec<(String, String)>) {
        (self.text.clone(), set)
    }
}

impl CaseBase {
    /// Sets the written values. A word that varies may leave keys of the base case without a meaning, as
    /// another drag law does with the coefficient of the first; these are left out, each with a remark.
    fn open(
        &self,
        key_values: WrittenValues,
        set: &[(VariedKey, f64)],
        resources: &Resources,
    ) -> (Result<OpenCase, Error>, Vec<Diagnostic>) {
        let opened = open_as(self.kind, key_values.clone(), resources);
        let is_unneeded = |problem: &&Diagnostic| {
            problem.cause.needs.is_some() && set.iter().all(|(key, _)| key.name != problem.key)
        };
        let unneeded: Vec<Diagnostic> = match &opened {
            Err(Error::Rejected(problems)) if set.iter().any(|(key, _)| !key.words().is_empty()) => {
                let note = |problem: &Diagnostic| {
                    let needed = problem.cause.needs?;
                    let what = Diagnostic::note(format!("is left out, because it needs {needed}"));
                    let Diagnostic { place, key, value, .. } = problem.clone();
                    Some(Diagnostic { place, key, value, ..what })
                };
                problems.iter().filter(is_unneeded).filter_map(note).collect()
            }
            _ => Vec::new(),
        };
        if unneeded.is_empty() {
            return (opened, unneeded);
        }
        let mut fewer = key_values;
        unneeded.iter().for_each(|note| drop(fewer.remove(&note.key)));
        (open_as(self.kind, fewer, resources), unneeded)
    }
}

/// A study of a spinline alone flies no fibre whose tension it could take.
fn no_flights(at: &Place) -> Vec<Diagnostic> {
    let what = Fault::new(
        "needs simulated fibres, and a study of a spinline simulates none",
        "write a tension, or let the study vary the case: case = \"…\" instead of spinline = \"…\"",
    );
    let key = "spinline.end_tension".to_owned();
    let value = Some("\"simulated\"".to_owned());
    vec![Diagnostic { place: at.clone(), key, value, ..what.into() }]
}
