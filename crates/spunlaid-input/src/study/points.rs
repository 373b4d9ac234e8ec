//! Makes a checked experiment of every point of a study.

use super::super::Resources;
use super::plan::Plan;
use super::{Base, links, values_before};
use spunlaid_experiment::Point;
use spunlaid_experiment::study::seed_of_point;
use spunlaid_fibre::case::keys::VariedKey;
use spunlaid_ground::error::Place;
use spunlaid_ground::{Diagnostic, Error, Severity};
use std::fmt;

/// A remark that applies to one or more points of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyNote {
    /// The remark on the first of them.
    pub note: Diagnostic,
    /// Number of points.
    pub points: u64,
    /// Whether it applies to all points.
    pub all: bool,
}

impl StudyNote {
    /// The notes that go with results, see [`Diagnostic::notes_of_results`].
    pub fn notes_of_results(notes: &[Self]) -> Vec<String> {
        notes.iter().filter(|note| note.note.severity > Severity::Choice).map(Self::to_string).collect()
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
    pub(super) base: &'a dyn Base,
    pub(super) plan: &'a Plan,
    pub(super) resources: &'a Resources,
}

impl Resolver<'_> {
    /// All points, or the problems of all of them.
    pub(super) fn points(&self) -> Result<(Vec<Point>, Vec<StudyNote>), Error> {
        let Plan { factors, design, seed, .. } = self.plan;
        let base = values_before(self.base, factors);
        let rows = design.rows(factors, &base, *seed);
        let count = rows.len() as u64;
        let mut points = Vec::with_capacity(rows.len());
        let mut problems = Vec::new();
        let mut notes = Notes::default();
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

    fn point(&self, index: u64, mut values: Vec<f64>) -> Result<(Point, Vec<Diagnostic>), Error> {
        let Plan { factors, links, order, seed, common_phases, .. } = self.plan;
        let known = |name: &str| match factors.iter().position(|factor| factor.key.name == name) {
            Some(i) => values.get(i).copied(),
            None => self.base.value(&self.base.numeric(name).ok()?),
        };
        let linked = links::values(self.base, links, order, &known);
        values.extend(linked);
        let keys = factors.iter().map(|factor| &factor.key).chain(links.iter().map(|link| &link.key));
        let set: Vec<(VariedKey, f64)> = keys.cloned().zip(values.iter().copied()).collect();
        let shown = |(key, value): &(VariedKey, f64)| format!("{} = {}", key.name, key.shown(*value));
        let (study, number) = (self.study.to_owned(), index + 1);
        let at = Place::Point { study, number, values: set.iter().map(shown).collect::<Vec<_>>().join(", ") };
        let seed = (!*common_phases).then(|| seed_of_point(*seed, index));
        match self.base.point(&set, &at, self.plan, seed, self.resources) {
            Ok((experiment, notes)) => Ok((Point { values, experiment }, notes)),
            Err(Error::Rejected(mut problems)) => {
                problems.iter_mut().for_each(|problem| problem.place = at.clone());
                Err(problems.into())
            }
            Err(other) => Err(other),
        }
    }
}

/// The remarks on all points; remarks of the same kind on the same key are merged.
#[derive(Default)]
pub(super) struct Notes(Vec<StudyNote>);

impl Notes {
    pub(super) fn add(&mut self, note: Diagnostic) {
        let same = |other: &&mut StudyNote| other.note.is_like(&note);
        match self.0.iter_mut().find(same) {
            Some(other) => other.points += 1,
            None => self.0.push(StudyNote { note, points: 1, all: false }),
        }
    }

    pub(super) fn finish(self, points: u64) -> Vec<StudyNote> {
        self.0.into_iter().map(|note| StudyNote { all: note.points == points, ..note }).collect()
    }
}
