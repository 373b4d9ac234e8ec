//! The Parquet tables of a run, which are written trajectory by trajectory.

use super::parquet::{self, Holds, Parquet};
use crate::Failure;
use spunlaid::ensemble::{Sample, Trajectory};
use std::path::PathBuf;

/// A column of doubles: its name with the unit, and its value at an instant.
pub type Column = (&'static str, fn(&Sample) -> f64);

/// `end_node.parquet`: the free end over time.
const END_NODE: &[Column] =
    &[("time_s", |s| s.time), ("x_m", |s| s.end.x), ("y_m", |s| s.end.y), ("z_m", |s| s.end.z)];

/// Fibres that have a column.
#[derive(Clone, Copy, PartialEq)]
enum Of {
    All,
    Fixed,
    Fed,
}

/// `energy.parquet`: both ledgers over time; of a fed fibre the full balance.
const ENERGY: &[(Of, Column)] = &[
    (Of::All, ("time_s", |s| s.time)),
    (Of::All, ("kinetic_j", |s| s.kinetic)),
    (Of::All, ("axial_j", |s| s.axial)),
    (Of::All, ("bending_j", |s| s.bending)),
    (Of::Fixed, ("work_j", |s| s.work)),
    (Of::All, ("gravity_work_j", |s| s.gravity_work)),
    (Of::All, ("air_work_j", |s| s.air_work)),
    (Of::All, ("damping_work_j", |s| s.damping_work)),
    (Of::Fed, ("feed_work_j", |s| s.feed_work)),
    (Of::Fed, ("belt_work_j", |s| s.belt_work)),
    (Of::Fed, ("carried_j", |s| s.carried)),
    (Of::All, ("tension_dissipation_j", |s| s.tension_dissipation)),
    (Of::All, ("imbalance_j", |s| s.imbalance)),
    (Of::Fixed, ("work_error_percent", Sample::work_error_percent)),
    (Of::All, ("balance_error_percent", Sample::balance_error_percent)),
];

/// The tables of fed fibres, or of fibres of fixed length: their files and columns.
pub fn tables(fed: bool) -> Vec<(&'static str, Vec<Column>)> {
    let other = if fed { Of::Fixed } else { Of::Fed };
    let energy = ENERGY.iter().filter(|(of, _)| *of != other).map(|(_, column)| *column).collect();
    let end = (!fed).then(|| ("end_node.parquet", END_NODE.to_vec()));
    end.into_iter().chain([("energy.parquet", energy)]).collect()
}

/// Number of rows in a row group.
const ROWS: usize = 1 << 18;

/// A table with one row for each replicate and recorded instant: `replicate` (counted from 1), then the columns.
pub struct Table {
    writer: Parquet,
    columns: Vec<Column>,
}

impl Table {
    /// * `place` – present and final path of the table
    pub fn create(place: (PathBuf, PathBuf), columns: Vec<Column>) -> Result<Self, Failure> {
        let replicate = parquet::Column { name: "replicate".to_owned(), holds: Holds::Whole };
        let number = |(name, _): &Column| parquet::Column { name: (*name).to_owned(), holds: Holds::Number };
        let all: Vec<_> = std::iter::once(replicate).chain(columns.iter().map(number)).collect();
        Ok(Self { writer: Parquet::create(place, &all, ROWS)?, columns })
    }

    /// Adds a trajectory.
    pub fn add(&mut self, trajectory: &Trajectory) -> Result<(), Failure> {
        let samples = &trajectory.samples;
        self.writer.extend_whole(0, std::iter::repeat_n(trajectory.replicate as i64 + 1, samples.len()));
        for (index, (_, of)) in self.columns.iter().enumerate() {
            self.writer.extend(index + 1, samples.iter().map(of));
        }
        self.writer.flush_when_full()
    }

    /// Writes the remaining rows and closes the file.
    pub fn finish(self) -> Result<(), Failure> {
        self.writer.finish().map(drop)
    }
}
