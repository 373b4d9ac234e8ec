//! The Parquet tables of a run, which are written trajectory by trajectory.

use super::parquet::{self, Holds, Parquet};
use crate::failure::Failure;
use spunlaid::ensemble::{Sample, Trajectory};
use std::path::PathBuf;

/// A column of doubles: its name with the unit, and its value at an instant.
type Column = (&'static str, fn(&Sample) -> f64);

/// `end_node.parquet`: the free end over time.
pub(crate) const END_NODE: &[Column] =
    &[("time_s", |s| s.time), ("x_m", |s| s.end.x), ("y_m", |s| s.end.y), ("z_m", |s| s.end.z)];

/// `energy.parquet`: both ledgers over time.
pub(crate) const ENERGY: &[Column] = &[
    ("time_s", |s| s.time),
    ("kinetic_j", |s| s.kinetic),
    ("axial_j", |s| s.axial),
    ("bending_j", |s| s.bending),
    ("work_j", |s| s.work),
    ("gravity_work_j", |s| s.gravity_work),
    ("air_work_j", |s| s.air_work),
    ("damping_work_j", |s| s.damping_work),
    ("tension_dissipation_j", |s| s.tension_dissipation),
    ("imbalance_j", |s| s.imbalance),
    ("work_error_percent", Sample::work_error_percent),
    ("balance_error_percent", Sample::balance_error_percent),
];

/// `energy.parquet` of a fed fibre: the full balance over time.
pub(crate) const ENERGY_OF_FED: &[Column] = &[
    ("time_s", |s| s.time),
    ("kinetic_j", |s| s.kinetic),
    ("axial_j", |s| s.axial),
    ("bending_j", |s| s.bending),
    ("gravity_work_j", |s| s.gravity_work),
    ("air_work_j", |s| s.air_work),
    ("damping_work_j", |s| s.damping_work),
    ("feed_work_j", |s| s.feed_work),
    ("belt_work_j", |s| s.belt_work),
    ("carried_j", |s| s.carried),
    ("tension_dissipation_j", |s| s.tension_dissipation),
    ("imbalance_j", |s| s.imbalance),
    ("balance_error_percent", Sample::balance_error_percent),
];

/// Number of rows in a row group.
const ROWS: usize = 1 << 18;

/// A table with one row for each replicate and recorded instant: `replicate` (counted from 1), then the columns.
pub(crate) struct Table {
    writer: Parquet,
    columns: &'static [Column],
}

impl Table {
    /// * `place` – present and final path of the table
    pub(crate) fn create(place: (PathBuf, PathBuf), columns: &'static [Column]) -> Result<Self, Failure> {
        let replicate = parquet::Column { name: "replicate".to_owned(), holds: Holds::Whole };
        let number = |(name, _): &Column| parquet::Column { name: (*name).to_owned(), holds: Holds::Number };
        let all: Vec<_> = std::iter::once(replicate).chain(columns.iter().map(number)).collect();
        Ok(Self { writer: Parquet::create(place, &all, ROWS)?, columns })
    }

    /// Adds a trajectory.
    pub(crate) fn add(&mut self, trajectory: &Trajectory) -> Result<(), Failure> {
        let samples = &trajectory.samples;
        self.writer.extend_whole(0, std::iter::repeat_n(trajectory.replicate as i64 + 1, samples.len()));
        for (index, (_, of)) in self.columns.iter().enumerate() {
            self.writer.extend(index + 1, samples.iter().map(of));
        }
        self.writer.flush_when_full()
    }

    /// Writes the remaining rows and closes the file.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        self.writer.finish().map(drop)
    }
}
