//! The Parquet tables of a run: what is recorded of the fibres in flight goes to files, and from there to the
//! tables, fibre by fibre in the order of the replicates.

use super::folder::Staging;
use super::paraview::SHAPE;
use super::spill::Spill;
use super::table::parquet::Parquet;
pub(crate) use super::table::parquet::{PackedColumn, unpacked};
use super::table::{number, whole};
use crate::Failure;
use spunlaid::ensemble::{Recorder, Sample, Shapes};
use spunlaid::error::Error;
use spunlaid::flight::LaidPoint;
use std::fs::{self, File};
use std::path::PathBuf;

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

/// A number of a sample: its name, and the place where it stands.
pub type Field = (&'static str, Place);
/// Where a number stands in a sample.
pub type Place = fn(&mut Sample) -> &mut f64;

/// Everything that a sample has, apart from the time, which is the same for all fibres.
pub const FIELDS: [Field; 15] = [
    ("x_m", |s| &mut s.end.x),
    ("y_m", |s| &mut s.end.y),
    ("z_m", |s| &mut s.end.z),
    ("kinetic_j", |s| &mut s.kinetic),
    ("axial_j", |s| &mut s.axial),
    ("bending_j", |s| &mut s.bending),
    ("work_j", |s| &mut s.work),
    ("gravity_work_j", |s| &mut s.gravity_work),
    ("air_work_j", |s| &mut s.air_work),
    ("damping_work_j", |s| &mut s.damping_work),
    ("feed_work_j", |s| &mut s.feed_work),
    ("belt_work_j", |s| &mut s.belt_work),
    ("carried_j", |s| &mut s.carried),
    ("tension_dissipation_j", |s| &mut s.tension_dissipation),
    ("imbalance_j", |s| &mut s.imbalance),
];
const TIME: Field = ("time_s", |s| &mut s.time);

/// The tables of fed fibres, or of fibres of fixed length: their files and columns.
pub fn tables(fed: bool) -> Vec<(&'static str, Vec<Column>)> {
    let other = if fed { Fibres::Fixed } else { Fibres::Fed };
    let energy = ENERGY.iter().filter(|(kind, _)| *kind != other).map(|(_, column)| *column).collect();
    let end = (!fed).then(|| ("end_node.parquet", END_NODE.to_vec()));
    end.into_iter().chain([("energy.parquet", energy)]).collect()
}

/// The names of all tables of a run, in the order of [`Tables::rows`].
pub(crate) fn table_names(fed: bool) -> Vec<&'static str> {
    tables(fed).into_iter().map(|(name, _)| name).chain(fed.then_some(LAID)).collect()
}

/// For each column of the tables of samples, where it stands in a sample; `None` if it follows from others.
pub(crate) fn sample_columns(fed: bool) -> Vec<Vec<Option<Place>>> {
    let place = |(name, _): &Column| {
        let mut fields = FIELDS.iter().chain([&TIME]);
        fields.find(|(field, _)| field == name).map(|(_, place)| *place)
    };
    tables(fed).iter().map(|(_, columns)| columns.iter().map(place).collect()).collect()
}

/// The unit of a column, with which its name ends.
pub fn unit_of_column(name: &str) -> &'static str {
    const ENDINGS: [(&str, &str); 4] = [("_s", "s"), ("_m", "m"), ("_j", "J"), ("_percent", "%")];
    ENDINGS.iter().find(|(ending, _)| name.ends_with(ending)).map_or("", |(_, unit)| unit)
}

/// `laid.parquet`: what fed fibres have laid, in the order of feed.
pub const LAID: &str = "laid.parquet";
/// A column of it.
type PointColumn = (&'static str, fn(&LaidPoint) -> f64);
/// Its columns.
const POINT: [PointColumn; 4] =
    [("s_m", |p| p.fed), ("time_s", |p| p.time), ("md_m", |p| p.md), ("cd_m", |p| p.cd)];

/// A laid point from its columns.
pub(crate) const fn point_of([fed, time, md, cd]: [f64; POINT.len()]) -> LaidPoint {
    LaidPoint { fed, time, md, cd }
}

/// Number of rows in a row group, which is held in memory.
const ROWS: usize = 1 << 15;

/// Takes what is recorded of the fibres in flight, for [`Tables`], and keeps their shapes in files.
#[derive(Debug)]
pub struct TableRecorder {
    samples: Vec<(Vec<Column>, Spill)>,
    laid: Option<Spill>,
    /// Folder of the shapes, and its final path for messages.
    shapes: (PathBuf, PathBuf),
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
            shapes: (staging.scratch(), staging.place(SHAPE).1),
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

    fn samples(&self, replicate: u64, samples: &[Sample]) -> Result<(), Error> {
        self.samples.iter().try_for_each(|(columns, spill)| {
            let row = |sample| columns.iter().map(move |(_, value)| value(sample));
            spill.push(replicate, samples.iter().flat_map(row))
        })
    }

    fn lay(&self, replicate: u64, points: &[LaidPoint]) -> Result<(), Error> {
        self.laid.as_ref().map_or(Ok(()), |spill| {
            spill.push(replicate, points.iter().flat_map(|point| POINT.map(|(_, value)| value(point))))
        })
    }

    fn shapes(&self, replicate: u64) -> Result<Shapes, Error> {
        let (folder, later) = &self.shapes;
        fs::create_dir_all(folder)
            .and_then(|()| {
                let file = folder.join(format!("{SHAPE}_{replicate}"));
                File::options().read(true).write(true).create(true).truncate(true).open(file)
            })
            .map(|file| Shapes::in_file(file, later))
            .map_err(Error::unwritable(later))
    }
}

/// The tables of a run. Each has a row for each replicate and recorded instant, or laid point: `replicate`
/// (counted from 1), then its columns.
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
            let all: Vec<_> =
                std::iter::once(whole("replicate")).chain(columns.into_iter().map(number)).collect();
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
            spill.drain(replicate, |mut rows| {
                // Groups of the same size, however the rows come: their bytes are then those of any other run.
                while !rows.is_empty() {
                    let (some, others) = rows.split_at(rows.len().min(writer.room() * width));
                    writer.extend_whole(0, std::iter::repeat_n(replicate as i64 + 1, some.len() / width));
                    for column in 0..width {
                        writer.extend(column + 1, some.iter().skip(column).step_by(width).copied());
                    }
                    writer.flush_when_full()?;
                    rows = others;
                }
                Ok(())
            })
        })
    }

    /// Number of rows of each table.
    pub(crate) fn rows(&self) -> Vec<usize> {
        self.writers.iter().map(Parquet::rows).collect()
    }

    /// The tables as they are written.
    pub(crate) fn written(&self) -> &[Parquet] {
        &self.writers
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::output::folder::ENTRIES;
    use std::sync::atomic::AtomicBool;

    static STOP: AtomicBool = AtomicBool::new(false);

    fn sample(replicate: u64, instant: usize) -> Sample {
        let time = instant as f64 * 1e-3;
        Sample { time, kinetic: (time + replicate as f64).sin(), gravity_work: time, ..Sample::default() }
    }

    /// The tables of fibres that land one after the other, or that all fly at once, so that few of their rows
    /// stay in memory.
    #[test]
    fn identical_tables_whatever_stays_in_memory() {
        const FIBRES: u64 = 400;
        const INSTANTS: usize = 1001;
        let written = |at_once: bool| {
            let desk = tempfile::tempdir().unwrap();
            let staging = Staging::new(&desk.path().join("r"), ENTRIES, false, &STOP).unwrap();
            let recorder = TableRecorder::new(&staging, false);
            let mut tables = Tables::create(&staging, &recorder).unwrap();
            let record = |replicate, instants: std::ops::Range<usize>| {
                let samples: Vec<_> = instants.map(|instant| sample(replicate, instant)).collect();
                recorder.samples(replicate, &samples).unwrap();
            };
            if at_once {
                for first in (0..INSTANTS).step_by(77) {
                    (0..FIBRES).for_each(|replicate| record(replicate, first..INSTANTS.min(first + 77)));
                }
                assert!(fs::read_dir(staging.scratch()).unwrap().count() > 100, "many have gone to files");
            }
            for replicate in 0..FIBRES {
                if !at_once {
                    record(replicate, 0..INSTANTS);
                }
                tables.add(replicate).unwrap();
            }
            assert_eq!(tables.rows(), [FIBRES as usize * INSTANTS; 2]);
            assert!(
                tables.written().iter().all(|table| table.groups().iter().all(|group| group.rows == ROWS))
            );
            tables.finish().unwrap();
            table_names(false)
                .into_iter()
                .map(|name| fs::read(staging.place(name).0).unwrap())
                .collect::<Vec<_>>()
        };
        assert!(written(true) == written(false));
    }
}
