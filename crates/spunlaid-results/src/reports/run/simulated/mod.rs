//! What flights record, of which the tables of a run are made, and a file from which a run goes on that was
//! interrupted.
//!
//! ```text
//! flights → FlightRecords (memory; beyond its room, the file) → Tables and the file, when the turn of a fibre has come
//!
//! .<folder>-<case>.simulated   the file, from where the first fibre has landed until the results are complete
//! ```

use super::tables::{Column, LAID, POINT, SAMPLE, point_of, tables};
use crate::Failure;
use crate::files::folder::Staging;
use crate::files::paraview::SHAPE;
use crate::files::table::parquet::Parquet;
use crate::files::table::{number, whole};
use spunlaid_experiment::Experiment;
use spunlaid_fibre::{Case, LaidPoint};
use spunlaid_ground::threads::lock;
use spunlaid_ground::{Error, Log, Value, Vec3};
use spunlaid_simulation::ensemble::Sample;
use spunlaid_simulation::{DECLARED, FibreMeasure, Recorded, Recorder, Shapes, Trajectory};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::fs::File;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// A run that fails leaves nothing if it has simulated fewer steps of elements: flying them again takes seconds.
/// They are counted, since the time would be another one on a busy machine.
const FEW: f64 = 1e9;
/// Bytes of all fibres that stay in memory until their turn. Beyond them a fibre with the rows of a record puts what it
/// has into the file, from which it is read back: that takes longer.
pub(super) const ROOM: usize = 1 << 24;
/// Most rows of a record. Small ones take the system twice the time.
const RECORD: usize = 1 << 10;
/// Number of rows in a row group, which is held in memory.
const ROWS: usize = 1 << 15;

/// What the file has of a replicate: its samples and its laid points, as they were recorded.
const SAMPLES: u64 = 0;
const POINTS: u64 = 1;
/// When it has landed, its shapes and the points that are kept with them.
const SHAPES: u64 = 2;
const KEPT_POINTS: u64 = 3;
/// And last, how many numbers these four have, and its measures: of each its index, the number of places of a curve,
/// these and the values there; or 0 and a number.
const LANDED: u64 = 4;

/// What is recorded of the fibres in flight, for `Tables`. Their shapes are in files of their own.
#[derive(Debug)]
pub struct FlightRecords {
    log: Log,
    /// Where the file lies before a fibre has landed, and from then on; whether it has been moved.
    places: [PathBuf; 2],
    is_kept: AtomicBool,
    /// The final path of the first table, and of the shapes, for messages.
    later: [PathBuf; 2],
    fed: bool,
    keep: Recorded<'static>,
    /// Replicates that an earlier process has simulated.
    earlier: BTreeSet<u64>,
    /// What has been recorded of the others and is not in the file, and its bytes.
    held: Mutex<(BTreeMap<u64, Held>, usize)>,
    /// Steps of elements of a replicate, and how many have landed.
    steps_of_each: f64,
    landed: AtomicU64,
    /// Whether the run was interrupted, so that another process goes on.
    pub interrupted: AtomicBool,
}

/// The rows of a fibre that are in memory only, as records.
#[derive(Debug, Default)]
struct Held {
    samples: Vec<Vec<Sample>>,
    points: Vec<Vec<LaidPoint>>,
}

/// Adds rows to records, which are full but for the last one. One long list would be copied as it grows, and would
/// leave gaps in memory.
fn add_to<R: Copy>(records: &mut Vec<Vec<R>>, mut rows: &[R]) {
    while !rows.is_empty() {
        let room = records.last().map_or(0, |last| RECORD - last.len());
        if room == 0 {
            records.push(Vec::new());
        }
        let (now, later) = rows.split_at(rows.len().min(if room == 0 { RECORD } else { room }));
        records.last_mut().into_iter().for_each(|last| last.extend_from_slice(now));
        rows = later;
    }
}

/// Bytes of the rows of records.
fn bytes_of<R>(records: &[Vec<R>]) -> usize {
    records.iter().map(|record| size_of_val(&record[..])).sum()
}

/// What is recorded at an instant, or of a laid point.
trait Row: Copy {
    const KIND: u64;

    fn held(held: &mut Held) -> &mut Vec<Vec<Self>>;

    /// A record of some.
    fn numbers(rows: &[Self]) -> Vec<f64>;

    fn of(numbers: &[f64]) -> Vec<Self>;
}

impl Row for Sample {
    const KIND: u64 = SAMPLES;

    fn held(held: &mut Held) -> &mut Vec<Vec<Self>> {
        &mut held.samples
    }

    fn numbers(rows: &[Self]) -> Vec<f64> {
        let row = |sample: &Self| {
            let (mut sample, mut row) = (*sample, [0.0; SAMPLE.len()]);
            row.iter_mut().zip(SAMPLE).for_each(|(number, (_, place))| *number = *place(&mut sample));
            row
        };
        rows.iter().map(row).collect::<Vec<_>>().into_flattened()
    }

    fn of(numbers: &[f64]) -> Vec<Self> {
        let sample = |numbers: &[f64; SAMPLE.len()]| {
            let mut sample = Self::default();
            SAMPLE.iter().zip(numbers).for_each(|((_, place), number)| *place(&mut sample) = *number);
            sample
        };
        numbers.as_chunks().0.iter().map(sample).collect()
    }
}

impl Row for LaidPoint {
    const KIND: u64 = POINTS;

    fn held(held: &mut Held) -> &mut Vec<Vec<Self>> {
        &mut held.points
    }

    fn numbers(rows: &[Self]) -> Vec<f64> {
        rows.iter().map(|point| POINT.map(|(_, value)| value(point))).collect::<Vec<_>>().into_flattened()
    }

    fn of(numbers: &[f64]) -> Vec<Self> {
        numbers.as_chunks().0.iter().copied().map(point_of).collect()
    }
}

impl FlightRecords {
    /// Opens the file. What was simulated of the same case for the same folder is in it.
    ///
    /// * `keep` – what is kept of a fibre; none of flights that have landed before, which no process goes on with
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn open(
        staging: &Staging<'_>,
        case: &Case,
        keep: Option<Recorded<'static>>,
    ) -> Result<Self, Failure> {
        let (results, scratch) = (staging.folder(), staging.scratch());
        let name = results.file_name().unwrap_or_default().to_string_lossy();
        let later = [staging.place("energy.parquet").1, staging.place(SHAPE).1];
        let version = env!("CARGO_PKG_VERSION");
        let sum = Experiment::from(case.clone()).checksum();
        let identity = format!("spunlaid-simulated version={version} case={sum:08x} {keep:?}");
        // Flights another case stay until that case goes on.
        let own = (identity.bytes()).fold(0_u32, |own, byte| own.wrapping_mul(31).wrapping_add(byte.into()));
        let places =
            [scratch.join("simulated"), results.with_file_name(format!(".{name}-{own:08x}.simulated"))];
        // What another process uses stays its own.
        let earlier = keep.filter(|_| places[1].exists()).and_then(|_| Log::open(&places[1], &identity).ok());
        let is_kept = AtomicBool::new(earlier.is_some());
        let new = || fs::create_dir_all(&scratch).and_then(|()| Log::open(&places[0], &identity));
        let log = earlier.map_or_else(new, Ok).map_err(Failure::unwritable(&later[0]))?;
        let mut flights = Self {
            log,
            places,
            is_kept,
            later,
            fed: case.line.is_some(),
            keep: keep.unwrap_or(Recorded::NUMBERS),
            earlier: BTreeSet::new(),
            held: Mutex::default(),
            steps_of_each: case.run.steps as f64 * case.fibre.elements as f64,
            landed: AtomicU64::new(0),
            interrupted: AtomicBool::new(false),
        };
        let landed = flights.log.keys().into_iter().filter(|key| key[0] == LANDED).map(|key| key[1]);
        flights.earlier = landed.filter(|replicate| flights.is_whole(*replicate).is_some()).collect();
        Ok(flights)
    }

    /// Whether nothing of a replicate that has landed is damaged.
    fn is_whole(&self, replicate: u64) -> Option<()> {
        let landed = self.log.pieces([LANDED, replicate]).next()?.ok()?;
        let counts = (SAMPLES..LANDED).map(|kind| self.log.count([kind, replicate]) as f64);
        (landed.get(..LANDED as usize)?.iter().copied().eq(counts)).then_some(())
    }

    /// Number of replicates that an earlier process has simulated.
    pub fn earlier(&self) -> u64 {
        self.earlier.len() as u64
    }

    /// Keeps a replicate that has landed, so that a later process need not fly it again. What cannot be kept is
    /// simulated again.
    pub fn land(&self, trajectory: &Trajectory) {
        let replicate = trajectory.replicate;
        if self.earlier.contains(&replicate) || self.try_to_land(trajectory).is_none() {
            return;
        }
        self.landed.fetch_add(1, Ordering::Relaxed);
        let [from, to] = &self.places;
        if !self.is_kept.load(Ordering::Relaxed) && !to.exists() {
            self.is_kept.store(fs::rename(from, to).is_ok(), Ordering::Relaxed);
        }
    }

    fn try_to_land(&self, trajectory: &Trajectory) -> Option<()> {
        let replicate = trajectory.replicate;
        for shape in trajectory.shapes.iter() {
            let shape = shape.ok()?;
            let position = shape.position.iter().flat_map(|p| [p.x, p.y, p.z]);
            self.log.append([SHAPES, replicate], [shape.time].into_iter().chain(position)).ok()?;
        }
        self.log.append([KEPT_POINTS, replicate], LaidPoint::numbers(&trajectory.laid)).ok()?;
        let counts = (SAMPLES..LANDED).map(|kind| self.log.count([kind, replicate]) as f64);
        let mut numbers: Vec<f64> = counts.collect();
        for (measure, value) in &trajectory.values {
            numbers.push(measures().position(|other| other.name == measure.name)? as f64);
            match value {
                Value::Curve(places, values) => {
                    numbers.push(places.len() as f64);
                    numbers.extend(places.iter().chain(values));
                }
                number => numbers.extend([0.0, number.number()]),
            }
        }
        self.log.append([LANDED, replicate], numbers).ok()
    }

    /// The trajectories of replicates that fly together, if all of them are kept; what was recorded of them
    /// is passed on.
    ///
    /// # Errors
    /// Those of the recorder, or the file cannot be read.
    pub fn recall(
        &self,
        replicates: Range<u64>,
        recorder: &dyn Recorder,
    ) -> Result<Option<Vec<Trajectory>>, Error> {
        if !replicates.clone().all(|replicate| self.earlier.contains(&replicate)) {
            return Ok(None);
        }
        let first = replicates.start;
        replicates
            .map(|replicate| self.recall_one(replicate, replicate == first, recorder).map(Some))
            .collect()
    }

    fn recall_one(
        &self,
        replicate: u64,
        is_first: bool,
        recorder: &dyn Recorder,
    ) -> Result<Trajectory, Error> {
        recorder.begin(replicate);
        let mut trajectory = Trajectory { replicate, ..Trajectory::default() };
        if replicate < self.keep.shapes.replicates {
            trajectory.shapes = recorder.shapes(replicate)?;
        }
        for shape in self.pieces(SHAPES, replicate) {
            let shape = shape?;
            let (time, position) = shape.split_first().unwrap_or((&0.0, &[]));
            let position: Vec<_> = position.chunks_exact(3).map(|p| Vec3::new(p[0], p[1], p[2])).collect();
            trajectory.shapes.push(*time, position.into_iter())?;
        }
        for points in self.pieces(KEPT_POINTS, replicate) {
            trajectory.laid.extend(LaidPoint::of(&points?));
        }
        for landed in self.pieces(LANDED, replicate) {
            trajectory.values = values(landed?.get(LANDED as usize..).unwrap_or_default());
        }
        for samples in self.in_file::<Sample>(replicate) {
            let samples = samples?;
            if is_first && self.keep.curves && !self.fed {
                samples.iter().for_each(|sample| trajectory.path.push(sample));
            }
            recorder.samples(replicate, &samples)?;
        }
        Ok(trajectory)
    }

    fn pieces(&self, kind: u64, replicate: u64) -> impl Iterator<Item = Result<Vec<f64>, Error>> {
        let unreadable = |source| Error::unwritable(&self.later[0])(source);
        self.log.pieces([kind, replicate]).map(move |piece| piece.map_err(unreadable))
    }

    fn in_file<R: Row>(&self, replicate: u64) -> impl Iterator<Item = Result<Vec<R>, Error>> {
        self.pieces(R::KIND, replicate).map(|piece| piece.map(|numbers| R::of(&numbers)))
    }

    /// Takes the next rows of a replicate, not many at a time.
    fn push<R: Row>(&self, replicate: u64, some: &[R]) -> Result<(), Error> {
        if self.earlier.contains(&replicate) {
            return Ok(());
        }
        let full = {
            let (held, bytes) = &mut *lock(&self.held);
            let records = R::held(held.entry(replicate).or_default());
            add_to(records, some);
            *bytes += size_of_val(some);
            let is_full = *bytes > ROOM && records.first().is_some_and(|record| record.len() == RECORD);
            let full = if is_full { std::mem::take(records) } else { Vec::new() };
            *bytes -= bytes_of(&full);
            full
        };
        // A replicate flies in one thread only, so its rows stay in their order.
        self.add(replicate, &full)
    }

    fn add<R: Row>(&self, replicate: u64, records: &[Vec<R>]) -> Result<(), Error> {
        let add = |rows: &Vec<R>| self.log.append([R::KIND, replicate], R::numbers(rows));
        records.iter().try_for_each(add).map_err(Error::unwritable(&self.later[0]))
    }

    /// Shows all that was recorded of a replicate, and puts into the file what memory has of it.
    fn write_in_order<R: Row>(
        &self,
        replicate: u64,
        held: &[Vec<R>],
        mut show: impl FnMut(&[R]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        self.in_file(replicate).try_for_each(|rows| show(&rows?))?;
        held.iter().try_for_each(|rows| show(rows))?;
        self.add(replicate, held)
    }

    /// Hands over what memory has of a replicate.
    fn take(&self, replicate: u64) -> Held {
        let (held, bytes) = &mut *lock(&self.held);
        let taken = held.remove(&replicate).unwrap_or_default();
        *bytes -= bytes_of(&taken.samples) + bytes_of(&taken.points);
        taken
    }

    /// Forgets what was recorded of a replicate.
    pub fn leave_out(&self, replicate: u64) {
        self.take(replicate);
        if !self.earlier.contains(&replicate) {
            // What cannot be forgotten does not count, because its numbers are others.
            (SAMPLES..=LANDED).for_each(|kind| drop(self.log.forget([kind, replicate])));
        }
    }

    /// Removes the file: the run is complete.
    pub fn finish(&self) {
        if self.is_kept.swap(false, Ordering::Relaxed) {
            // What cannot be removed is found by the next run, and says nothing wrong.
            let _ = fs::remove_file(&self.places[1]);
        }
    }
}

impl Drop for FlightRecords {
    fn drop(&mut self) {
        let steps = self.steps_of_each * self.landed.load(Ordering::Relaxed) as f64;
        if !self.interrupted.load(Ordering::Relaxed) && self.earlier.is_empty() && steps < FEW {
            self.finish();
        }
    }
}

impl Recorder for FlightRecords {
    fn begin(&self, replicate: u64) {
        self.leave_out(replicate);
    }

    fn samples(&self, replicate: u64, samples: &[Sample]) -> Result<(), Error> {
        self.push(replicate, samples)
    }

    fn lay(&self, replicate: u64, points: &[LaidPoint]) -> Result<(), Error> {
        self.push(replicate, points)
    }

    fn shapes(&self, replicate: u64) -> Result<Shapes, Error> {
        let file = self.places[0].with_file_name(format!("{SHAPE}_{replicate}"));
        file.parent()
            .map_or(Ok(()), fs::create_dir_all)
            .and_then(|()| File::options().read(true).write(true).create(true).truncate(true).open(&file))
            .map(|file| Shapes::in_file(file, &self.later[1]))
            .map_err(Error::unwritable(&self.later[1]))
    }
}

/// All measures. The identity has the version of the program, so their order is known.
fn measures() -> impl Iterator<Item = &'static FibreMeasure> {
    DECLARED.iter().flat_map(|declaration| declaration.measures)
}

/// The measures of a replicate from their numbers.
fn values(mut rest: &[f64]) -> Vec<(&'static FibreMeasure, Value)> {
    let mut values = Vec::new();
    while let [index, count, others @ ..] = rest {
        let (own, others) = others.split_at(others.len().min((2 * *count as usize).max(1)));
        let value = match own {
            [number] => Value::Number(*number),
            curve => {
                let (places, values) = curve.split_at(curve.len() / 2);
                Value::Curve(places.to_vec(), values.to_vec())
            }
        };
        values.extend(measures().nth(*index as usize).map(|measure| (measure, value)));
        rest = others;
    }
    values
}

/// The tables of a run. Each has a row for each replicate and recorded instant, or laid point: `replicate`
/// (counted from 1), then its columns.
pub struct Tables<'a> {
    flights: &'a FlightRecords,
    samples: Vec<(Vec<Column>, Parquet)>,
    laid: Option<Parquet>,
}

impl<'a> Tables<'a> {
    /// Begins the tables.
    ///
    /// # Errors
    /// If one cannot be written.
    pub fn create(staging: &Staging<'_>, flights: &'a FlightRecords) -> Result<Self, Failure> {
        let create = |name: &str, columns: Vec<&str>| {
            let all = [whole("replicate")].into_iter().chain(columns.into_iter().map(number));
            let (now, later) = staging.place(name);
            Parquet::create(now, later, &all.collect::<Vec<_>>(), ROWS)
        };
        let samples = tables(flights.fed).into_iter().map(|(name, columns)| {
            let table = create(name, columns.iter().map(|(name, _)| *name).collect())?;
            Ok((columns, table))
        });
        let laid = flights.fed.then(|| create(LAID, POINT.map(|(name, _)| name).to_vec())).transpose()?;
        Ok(Self { flights, samples: samples.collect::<Result<_, Failure>>()?, laid })
    }

    /// Adds what was recorded of a replicate, and puts it into the file.
    ///
    /// # Errors
    /// If it cannot be read back or written.
    pub fn add(&mut self, replicate: u64) -> Result<(), Failure> {
        let (flights, held) = (self.flights, self.flights.take(replicate));
        flights.write_in_order(replicate, &held.samples, |samples| {
            let mut tables = self.samples.iter_mut();
            tables.try_for_each(|(columns, table)| add_rows(table, replicate, samples, columns))
        })?;
        let laid = self.laid.as_mut();
        laid.map_or(Ok(()), |table| {
            flights
                .write_in_order(replicate, &held.points, |points| add_rows(table, replicate, points, &POINT))
        })
    }

    /// Writes the remaining rows and closes the files.
    ///
    /// # Errors
    /// If one cannot be written.
    pub fn finish(self) -> Result<(), Failure> {
        let all = self.samples.into_iter().map(|(_, table)| table).chain(self.laid);
        all.into_iter().try_for_each(|table| table.finish().map(drop))
    }
}

/// A column of rows: its name, and its value in a row.
type NamedColumn<T> = (&'static str, fn(&T) -> f64);

/// Adds rows in groups of the same size, however they come: their bytes are then those of any other run.
fn add_rows<T>(
    table: &mut Parquet,
    replicate: u64,
    mut rows: &[T],
    columns: &[NamedColumn<T>],
) -> Result<(), Failure> {
    while !rows.is_empty() {
        let (some, others) = rows.split_at(rows.len().min(table.room()));
        table.extend_whole(0, std::iter::repeat_n(replicate as i64 + 1, some.len()));
        for (column, (_, value)) in (1..).zip(columns) {
            table.extend(column, some.iter().map(value));
        }
        table.flush_when_full()?;
        rows = others;
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
