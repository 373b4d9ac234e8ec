//! Makes a checked case of every point of a study.

use super::super::data::DataFiles;
use super::super::open::{self, Open};
use super::super::written::{Said, Written};
use super::plan::{Plan, of_base};
use super::{dimension, links, numeric, varied};
use crate::case::keys::{self, Key, Value};
use crate::case::{Note, Remark};
use crate::error::{Error, Fault, Place, Problem};
use crate::study::{Point, seed_of_point};
use std::fmt;
use std::mem::{Discriminant, discriminant};

/// A remark that applies to one or more points of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyNote {
    /// The remark on the first of them.
    pub note: Note,
    /// Number of points.
    pub points: u64,
    /// Whether it applies to all points.
    pub all: bool,
}

impl StudyNote {
    /// The remarks that go with results, see [`Note::of_results`].
    pub fn of_results(notes: &[Self]) -> Vec<String> {
        notes.iter().filter(|remark| remark.note.is_of_results()).map(Self::to_string).collect()
    }
}

impl fmt::Display for StudyNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.note.fmt(f)?;
        match self.points {
            _ if self.all && matches!(self.note.place, Place::File { .. }) => Ok(()),
            1 => Ok(()),
            2 => f.write_str(" (this applies to one more point)"),
            points => write!(f, " (this applies to {} more points)", points - 1),
        }
    }
}

/// Makes the points of a plan.
pub(super) struct Resolver<'a> {
    pub(super) study: &'a str,
    /// Files that the case names.
    pub(super) files: &'a DataFiles,
    /// The base case as written.
    pub(super) base: &'a Open,
    pub(super) plan: &'a Plan,
}

impl Resolver<'_> {
    /// All points, or the problems of all of them.
    pub(super) fn points(&self) -> Result<(Vec<Point>, Vec<StudyNote>), Error> {
        let Plan { factors, design, seed, .. } = self.plan;
        let base: Vec<f64> = factors.iter().map(|factor| of_base(self.base, factor)).collect();
        let rows = design.rows(factors, &base, *seed);
        let count = rows.len() as u64;
        let (mut points, mut problems, mut notes) =
            (Vec::with_capacity(rows.len()), Vec::new(), Notes::default());
        for (index, row) in (0..).zip(rows) {
            match self.point(index, row) {
                Ok((point, remarks)) => {
                    remarks.into_iter().for_each(|note| notes.add(note));
                    points.push(point);
                }
                Err(Error::Rejected(more)) => problems.extend(more),
                Err(other) => return Err(other),
            }
        }
        if problems.is_empty() { Ok((points, notes.finish(count))) } else { Err(problems.into()) }
    }

    fn point(&self, index: u64, mut values: Vec<f64>) -> Result<(Point, Vec<Note>), Error> {
        let Plan { factors, links, order, replicates, seed, common_phases, .. } = self.plan;
        let known = |name: &str| match factors.iter().position(|factor| factor.key == name) {
            Some(i) => values.get(i).copied(),
            None => self.base.number(numeric(name)?),
        };
        let linked = links::values(links, order, &known);
        values.extend(linked);
        let names = factors.iter().map(|factor| factor.key).chain(links.iter().map(|link| link.key));
        let set: Vec<(&'static Key, f64)> = names.filter_map(varied).zip(values.iter().copied()).collect();
        let pretty = |(key, value): &(&'static Key, f64)| match value_of(key, *value) {
            Ok(value) => key.kind.pretty(&value),
            Err(_) => dimension(key).pretty(*value),
        };
        let all: Vec<String> = set.iter().map(|one| format!("{} = {}", one.0.name, pretty(one))).collect();
        let (study, number, all) = (self.study.to_owned(), index + 1, all.join(", "));
        let at = Place::Point { study, number, values: all };
        let (mut written, mut faults) = (self.base.written.clone(), Vec::new());
        for one in &set {
            let (key, value) = *one;
            let said = |value| Said { place: at.clone(), shown: Some(pretty(one)), value: Some(value) };
            match value_of(key, value) {
                Ok(value) => written.set(key.name, said(value)),
                Err(what) => faults.push(Problem {
                    place: at.clone(),
                    key: key.name.to_owned(),
                    value: Some(pretty(one)),
                    what,
                }),
            }
        }
        if !faults.is_empty() {
            return Err(faults.into());
        }
        let seed = if *common_phases { *seed } else { seed_of_point(*seed, index) };
        for (name, value) in [("run.seed", seed), ("run.replicates", replicates.at_most)] {
            if let Some(key) = keys::find(name) {
                let (shown, value) = (Some(value.to_string()), Some(Value::Whole(value)));
                written.set(key.name, Said { place: at.clone(), shown, value });
            }
        }
        let (opened, unneeded) = self.open(written, &set);
        match opened.and_then(Open::resolve) {
            Ok((case, mut notes)) => {
                notes.extend(unneeded.into_iter().map(|note| Note { place: at.clone(), ..note }));
                Ok((Point { values, case }, notes))
            }
            Err(Error::Rejected(mut problems)) => {
                problems.iter_mut().for_each(|problem| problem.place = at.clone());
                Err(problems.into())
            }
            Err(other) => Err(other),
        }
    }
}

impl Resolver<'_> {
    /// Sets the written values. A word that varies may leave keys of the base case without a meaning, as
    /// another drag law does with the coefficient of the first; these are left out, each with a remark.
    fn open(&self, written: Written, set: &[(&'static Key, f64)]) -> (Result<Open, Error>, Vec<Note>) {
        let opened = open::open(written.clone(), self.files);
        let is_unneeded = |problem: &&Problem| {
            problem.what.needs.is_some() && set.iter().all(|(key, _)| key.name != problem.key)
        };
        let unneeded: Vec<Note> = match &opened {
            Err(Error::Rejected(problems)) if self.plan.factors.iter().any(|of| !of.words.is_empty()) => {
                let note = |problem: &Problem| {
                    let what = Remark::Unneeded { needed: problem.what.needs? };
                    let Problem { place, key, value, .. } = problem.clone();
                    Some(Note { place, key, value, what })
                };
                problems.iter().filter(is_unneeded).filter_map(note).collect()
            }
            _ => Vec::new(),
        };
        if unneeded.is_empty() {
            return (opened, unneeded);
        }
        let mut fewer = written;
        unneeded.iter().for_each(|note| drop(fewer.remove(&note.key)));
        (open::open(fewer, self.files), unneeded)
    }
}

/// A number as the value of a key: a quantity, a whole number, or the place of a word among the words of the key.
fn value_of(key: &Key, value: f64) -> Result<Value, Fault> {
    if let Some(word) = key.kind.words().get(value as usize) {
        return Ok((*word).into());
    }
    if !key.is_whole() {
        return key.kind.accept(Value::Number(value));
    }
    if (1.0..1e15).contains(&value) {
        Ok(Value::Whole(value as u64))
    } else {
        Err(Fault::out_of_range(1, 1_000_000_000_000_000))
    }
}

/// The remarks on all points; remarks of the same kind on the same key are merged.
#[derive(Default)]
pub(super) struct Notes(Vec<(Discriminant<Remark>, StudyNote)>);

impl Notes {
    pub(super) fn add(&mut self, note: Note) {
        let kind = discriminant(&note.what);
        let same =
            |(of, told): &&mut (Discriminant<Remark>, StudyNote)| *of == kind && told.note.key == note.key;
        match self.0.iter_mut().find(same) {
            Some((_, told)) => told.points += 1,
            None => self.0.push((kind, StudyNote { note, points: 1, all: false })),
        }
    }

    pub(super) fn finish(self, points: u64) -> Vec<StudyNote> {
        let told = |(_, note): (_, StudyNote)| StudyNote { all: note.points == points, ..note };
        self.0.into_iter().map(told).collect()
    }
}
