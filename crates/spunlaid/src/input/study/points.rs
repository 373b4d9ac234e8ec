//! Every point of a study as a case of its own, checked.

use super::super::data::DataFiles;
use super::super::resolve::Base;
use super::read::Plan;
use super::{Numeric, links};
use crate::case::{Note, Remark};
use crate::error::{Error, Fault, Place, Problem};
use crate::study::{Point, seed_of_point};
use std::fmt;
use std::mem::{Discriminant, discriminant};

/// A remark on points of a study, told once for all of them.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyNote {
    /// The remark on the first of them.
    pub note: Note,
    /// Number of points.
    pub points: u64,
    /// Whether these are all points.
    pub all: bool,
}

impl fmt::Display for StudyNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.note.fmt(f)?;
        match self.points {
            _ if self.all && matches!(self.note.place, Place::File { .. }) => Ok(()),
            1 => Ok(()),
            2 => f.write_str(" (and so for another point)"),
            points => write!(f, " (and so for {} other points)", points - 1),
        }
    }
}

/// Makes points of a plan.
pub(super) struct Resolver<'a> {
    pub(super) study: &'a str,
    /// Text and name of the base case.
    pub(super) case: (&'a str, &'a str),
    /// Files that the case names.
    pub(super) files: &'a DataFiles,
    pub(super) base: &'a Base,
    pub(super) plan: &'a Plan,
}

impl Resolver<'_> {
    /// All points, or everything wrong with any of them.
    pub(super) fn points(&self) -> Result<(Vec<Point>, Vec<StudyNote>), Error> {
        let Plan { factors, design, seed, .. } = self.plan;
        let base: Vec<f64> = factors
            .iter()
            .map(|factor| self.base.values.get(factor.key).copied().flatten().unwrap_or(f64::NAN))
            .collect();
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
            None => self.base.values.get(name).copied().flatten(),
        };
        let linked = links::values(links, order, &known);
        values.extend(linked);
        let keys = factors.iter().map(|factor| factor.key).chain(links.iter().map(|link| link.key));
        let set: Vec<(Numeric, f64)> = keys.filter_map(Numeric::of).zip(values.iter().copied()).collect();
        let at = || Place::Point {
            study: self.study.to_owned(),
            number: index + 1,
            values: set
                .iter()
                .map(|(n, v)| format!("{} = {}", n.key, n.dimension.pretty(*v)))
                .collect::<Vec<_>>()
                .join(", "),
        };
        // A number that is none cannot be written into a case.
        let faults: Vec<Problem> = (set.iter())
            .filter_map(|(numeric, value)| {
                let fault = match numeric.quantity {
                    Some(quantity) => quantity.fault(*value)?,
                    None if *value >= 1.0 && *value < 1e15 => return None,
                    None => Fault::OutOfRange { least: 1, most: 1_000_000_000_000_000 },
                };
                let value = Some(numeric.dimension.pretty(*value));
                Some(Problem { place: at(), key: numeric.key.to_owned(), value, what: fault })
            })
            .collect();
        if !faults.is_empty() {
            return Err(faults.into());
        }
        let seed = if *common_phases { *seed } else { seed_of_point(*seed, index) };
        let own = [("run.seed", seed), ("run.replicates", replicates.at_most)];
        let changes: Vec<(String, String)> = (set.iter())
            .map(|(numeric, value)| (numeric.key.to_owned(), numeric.exact(*value)))
            .chain(own.map(|(key, value)| (key.to_owned(), value.to_string())))
            .collect();
        match super::super::parse_with(self.files, self.case.0, self.case.1, &changes) {
            Ok((case, mut notes)) => {
                for note in notes.iter_mut().filter(|note| note.place == Place::Override) {
                    note.place = at();
                    note.value = shown(&note.key, &set).or_else(|| note.value.take());
                }
                Ok((Point { values, case }, notes))
            }
            Err(Error::Rejected(mut problems)) => {
                for problem in &mut problems {
                    problem.place = at();
                    problem.value = shown(&problem.key, &set).or_else(|| problem.value.take());
                }
                Err(problems.into())
            }
            Err(other) => Err(other),
        }
    }
}

/// The value of a key that the study sets, as people read it.
fn shown(key: &str, set: &[(Numeric, f64)]) -> Option<String> {
    set.iter()
        .find(|(numeric, _)| numeric.key == key)
        .map(|(numeric, value)| numeric.dimension.pretty(*value))
}

/// The remarks on all points, those of one kind on one key together.
#[derive(Default)]
struct Notes(Vec<(Discriminant<Remark>, StudyNote)>);

impl Notes {
    fn add(&mut self, note: Note) {
        let kind = discriminant(&note.what);
        let same =
            |(of, told): &&mut (Discriminant<Remark>, StudyNote)| *of == kind && told.note.key == note.key;
        match self.0.iter_mut().find(same) {
            Some((_, told)) => told.points += 1,
            None => self.0.push((kind, StudyNote { note, points: 1, all: false })),
        }
    }

    fn finish(self, points: u64) -> Vec<StudyNote> {
        let told = |(_, note): (_, StudyNote)| StudyNote { all: note.points == points, ..note };
        self.0.into_iter().map(told).collect()
    }
}
