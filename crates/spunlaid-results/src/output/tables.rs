//! The Parquet tables of a run: what is recorded of the fibres in flight goes to files, and from there to the tables, fibre
//! by fibre in the order of the replicates.

use super::folder::Staging;
use super::parquet::{self, ColumnValues, Parquet};
use super::spill::Spill;
use crate::Failure;
use spunlaid::ensemble::{Recorder, Sample};
use spunlaid::error::Error;
use spunlaid::flight::LaidPoint;

/// A column of doubles: its name with the unit, and its value at an instant.
pub type Column = (&'static str, fn(&Sample) -> f64);

/// `end_node.parquet`: the free end over time.
const END_NODE: &[Column] =
    &[("time_s", |s| s.time), ("x_m", |s| s.end.x), ("y_m", |s| s.end.y), ("z_m", |s| s.end.z)];

/// Fibres that have a column.
#[derive(Clone, Copy, PartialEq)]
enum Fibres {
    All,
    Fixed,
    Fed,
}

/// `energy.parquet`: both ledgers over time; of a fed fibre the full balance.
const ENERGY: &[(Fibres, Column)] = &[
    (Fibres::All, ("time_s", |s| s.time)),
    (Fibres::All, ("kinetic_j", |s| s.kinetic)),
    (Fibres::All, ("axial_j", |s| s.axial)),
    (Fibres::All, ("bending_j", |s| s.bending)),
    (Fibres::Fixed, ("work_j", |s| s.work)),
    (Fibres::All, ("gravity_work_j", |s| s.gravity_work)),
    (Fibres::All, ("air_work_j", |s| s.air_work)),
    (Fibres::All, ("damping_work_j", |s| s.damping_work)),
    (Fibres::Fed, ("feed_work_j", |s| s.feed_work)),
    (Fibres::Fed, ("belt_work_j", |s| s.belt_work)),
    (Fibres::Fed, ("carried_j", |s| s.carried)),
    (Fibres::All, ("tension_dissipation_j", |s| s.tension_dissipation)),
    (Fibres::All, ("imbalance_j", |s| s.imbalance)),
    (Fibres::Fixed, ("work_error_percent", Sample::work_error_percent)),
    (Fibres::All, ("balance_error_percent", Sample::balance_error_percent)),
];

/// The tables of fed fibres, or of fibres of fixed length: their files and columns.
pub fn tables(fed: bool) -> Vec<(&'static str, Vec<Column>)> {
    let other = if fed { Fibres::Fixed } else { Fibres::Fed };
    let energy = ENERGY.iter().filter(|(kind, _)| *kind != other).map(|(_, column)| *column).collect();
    let end = (!fed).then(|| ("end_node.parquet", END_NODE.to_vec()));
    end.into_iter().chain([("energy.parquet", energy)]).collect()
}

/// `laid.parquet`: what fed fibres have laid, in the order of feed.
pub use spunlaid::layers::LAID;
/// A column of it.
type PointColumn = (&'static str, fn(&LaidPoint) -> f64);
/// Its columns.
const POINT: [PointColumn; 4] =
    [("s_m", |p| p.fed), ("time_s", |p| p.time), ("md_m", |p| p.md), ("cd_m", |p| p.cd)];

/// Number of rows in a row group, which is held in memory.
const ROWS: usize = 1 << 15;

/// Takes what is recorded of the fibres in flight, for [`Tables`].
#[derive(Debug)]
pub struct TableRecorder {
    samples: Vec<(Vec<Column>, Spill)>,
    laid: Option<Spill>,
}

impl TableRecorder {
    /// * `fed` – whether the fibres are fed
    pub fn new(staging: &Staging<'_>, fed: bool) -> Self {
        let spill = |(name, columns): (_, Vec<Column>)| {
            let spill = Spill::new(staging, name, columns.len());
            (columns, spill)
        };
        Self {
            samples: tables(fed).into_iter().map(spill).collect(),
            laid: fed.then(|| Spill::new(staging, LAID, POINT.len())),
        }
    }

    /// The failure of a file, in place of the error that ended the flights because of it.
    pub fn failure(&self, ended: Failure) -> Failure {
        self.spills().find_map(Spill::failure).unwrap_or(ended)
    }

    fn spills(&self) -> impl Iterator<Item = &Spill> {
        self.samples.iter().map(|(_, spill)| spill).chain(&self.laid)
    }
}

impl Recorder for TableRecorder {
    fn begin(&self, replicate: u64) {
        self.spills().for_each(|spill| spill.forget(replicate));
    }

    fn sample(&self, replicate: u64, sample: &Sample) -> Result<(), Error> {
        self.samples.iter().try_for_each(|(columns, spill)| {
            spill.push(replicate, columns.iter().map(|(_, value)| value(sample)))
        })
    }

    fn lay(&self, replicate: u64, points: &[LaidPoint]) -> Result<(), Error> {
        self.laid.as_ref().map_or(Ok(()), |spill| {
            points.iter().try_for_each(|point| spill.push(replicate, POINT.map(|(_, value)| value(point))))
        })
    }
}

/// The tables of a run. Each has a row for each replicate and recorded instant, or laid point: `replicate` (counted from 1),
/// then its columns.
pub struct Tables<'a> {
    recorder: &'a TableRecorder,
    writers: Vec<Parquet>,
}

impl<'a> Tables<'a> {
    /// Begins the tables.
    ///
    /// # Errors
    /// If one cannot be written.
    pub fn create(staging: &Staging<'_>, recorder: &'a TableRecorder) -> Result<Self, Failure> {
        let samples =
            recorder.samples.iter().map(|(columns, _)| columns.iter().map(|(name, _)| *name).collect());
        let laid = recorder.laid.iter().map(|_| POINT.iter().map(|(name, _)| *name).collect());
        let create = |(columns, spill): (Vec<&str>, &Spill)| {
            let replicate = parquet::Column { name: "replicate".to_owned(), holds: ColumnValues::Whole };
            let number =
                |name: &&str| parquet::Column { name: (*name).to_owned(), holds: ColumnValues::Number };
            let all: Vec<_> = std::iter::once(replicate).chain(columns.iter().map(number)).collect();
            Parquet::create(staging.place(spill.name()), &all, ROWS)
        };
        let writers = samples.chain(laid).zip(recorder.spills()).map(create).collect::<Result<_, _>>()?;
        Ok(Self { recorder, writers })
    }

    /// Adds what was recorded of a replicate.
    ///
    /// # Errors
    /// If it cannot be read back or written.
    pub fn add(&mut self, replicate: u64) -> Result<(), Failure> {
        self.writers.iter_mut().zip(self.recorder.spills()).try_for_each(|(writer, spill)| {
            let width = spill.width();
            spill.drain(replicate, |rows| {
                writer.extend_whole(0, std::iter::repeat_n(replicate as i64 + 1, rows.len() / width));
                for column in 0..width {
                    writer.extend(column + 1, rows.iter().skip(column).step_by(width).copied());
                }
                writer.flush_when_full()
            })
        })
    }

    /// Leaves out what was recorded of a replicate.
    pub fn leave_out(&self, replicate: u64) {
        self.recorder.spills().for_each(|spill| spill.forget(replicate));
    }

    /// Writes the remaining rows and closes the files.
    ///
    /// # Errors
    /// If one cannot be written.
    pub fn finish(self) -> Result<(), Failure> {
        self.writers.into_iter().try_for_each(|writer| writer.finish().map(drop))
    }
}
