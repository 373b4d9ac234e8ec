//! Flights that outlive the process that flies them: what a long run has flown is kept beside its folder until the run is complete.
//!
//! ```text
//! .<folder>.flown/header    version of the program, identity of the case, what is kept of a fibre
//! .<folder>.flown/lock      locked while a run uses it
//! .<folder>.flown/<n>       what was recorded and measured of replicate n; <n>.part while it flies
//!
//! a replicate    frames: tag · count · numbers, little-endian; the last one has the checksum of all others
//! ```
//!
//! Nothing here ends a run: what cannot be kept or read is flown again.

use spunlaid::case::Case;
use spunlaid::ensemble::{Keep, Recorder, Sample, Shapes, Trajectory};
use spunlaid::error::Error;
use spunlaid::flight::LaidPoint;
use spunlaid::observe::{DECLARED, Measure, Value};
use spunlaid::study::Experiment;
use spunlaid::threads::lock;
use spunlaid::vec3::Vec3;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// A run that takes no longer than this keeps nothing: flying it again takes less time than to wonder.
const GRACE: Duration = Duration::from_secs(2);
const HEADER: &str = "header";
const LOCK: &str = "lock";
const BYTES: usize = size_of::<f64>();
/// Most numbers of a frame that is read.
const LONGEST: u32 = 1 << 26;

/// What a frame holds.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Tag {
    Sample = 1,
    Laid,
    Shape,
    LaidWithShapes,
    /// Index of a measure, and its value.
    Number,
    /// Index of a measure and its places; the values follow.
    Places,
    Values,
    End,
}

impl Tag {
    const ALL: [Self; 8] = [
        Self::Sample,
        Self::Laid,
        Self::Shape,
        Self::LaidWithShapes,
        Self::Number,
        Self::Places,
        Self::Values,
        Self::End,
    ];
}

/// The flights of a run that are kept.
#[derive(Debug)]
pub struct KeptFlights {
    folder: PathBuf,
    header: String,
    keep: Keep,
    of_fed: bool,
    begun: Instant,
    /// What this process may write; nothing if another one uses the folder.
    lock: Mutex<Option<File>>,
    writing: Mutex<BTreeMap<u64, KeptFile>>,
    /// Number of replicates that an earlier process has left.
    left: u64,
}

/// A replicate on its way to the disk.
#[derive(Debug)]
struct KeptFile {
    file: BufWriter<File>,
    sum: u64,
}

impl KeptFlights {
    /// Finds what was flown for a results folder, if it is of the same case.
    pub fn open(results: &Path, case: &Case, keep: Keep) -> Self {
        let name = results.file_name().unwrap_or_default().to_string_lossy();
        let folder = results.with_file_name(format!(".{name}.flown"));
        let identity = Experiment::Case(case.clone()).checksum();
        let header =
            format!("spunlaid-flown version={} case={identity:08x} {keep:?}\n", env!("CARGO_PKG_VERSION"));
        let mut kept = Self {
            folder,
            header,
            keep,
            of_fed: case.line.is_some(),
            begun: Instant::now(),
            lock: Mutex::default(),
            writing: Mutex::default(),
            left: 0,
        };
        if kept.folder.is_dir() && kept.claim() {
            let replicates = 0..case.run.replicates;
            kept.left = replicates.filter(|replicate| kept.file(*replicate).exists()).count() as u64;
        }
        kept
    }

    /// Number of replicates that were found.
    pub const fn left(&self) -> u64 {
        self.left
    }

    /// Forgets all of it: the run is complete.
    pub fn finish(self) {
        let is_own = lock(&self.lock).take().is_some();
        if is_own {
            // What cannot be removed is found by the next run, and says nothing wrong.
            let _ = fs::remove_dir_all(&self.folder);
        }
    }

    /// Locks the folder for this process, and empties it if it is of another case.
    fn claim(&self) -> bool {
        let mut own = lock(&self.lock);
        if own.is_some() {
            return true;
        }
        let claimed = || -> io::Result<File> {
            fs::create_dir_all(&self.folder)?;
            let file =
                File::options().write(true).create(true).truncate(false).open(self.folder.join(LOCK))?;
            file.try_lock()?;
            let header = self.folder.join(HEADER);
            if fs::read_to_string(&header).ok().as_ref() != Some(&self.header) {
                for entry in fs::read_dir(&self.folder)?.flatten().filter(|entry| entry.file_name() != LOCK) {
                    fs::remove_file(entry.path())?;
                }
                fs::write(header, &self.header)?;
            }
            Ok(file)
        };
        *own = claimed().ok();
        own.is_some()
    }

    fn file(&self, replicate: u64) -> PathBuf {
        self.folder.join(replicate.to_string())
    }

    fn part(&self, replicate: u64) -> PathBuf {
        self.folder.join(format!("{replicate}.part"))
    }

    /// Begins to keep a replicate, if the run takes long enough.
    fn begin(&self, replicate: u64) {
        self.forget(replicate);
        if self.begun.elapsed() < GRACE || self.file(replicate).exists() || !self.claim() {
            return;
        }
        if let Ok(file) = File::create(self.part(replicate)) {
            let file = KeptFile { file: BufWriter::with_capacity(1 << 16, file), sum: 0 };
            lock(&self.writing).insert(replicate, file);
        }
    }

    /// Keeps nothing of a replicate.
    pub(super) fn forget(&self, replicate: u64) {
        if lock(&self.writing).remove(&replicate).is_some() {
            let _ = fs::remove_file(self.part(replicate));
        }
    }

    fn write(&self, replicate: u64, tag: Tag, numbers: &[f64]) {
        let mut writing = lock(&self.writing);
        let Some(file) = writing.get_mut(&replicate) else { return };
        if file.write(tag, numbers).is_err() {
            writing.remove(&replicate);
        }
    }

    /// Keeps a replicate that has landed.
    pub(super) fn land(&self, trajectory: &Trajectory) {
        let replicate = trajectory.replicate;
        let Some(mut file) = lock(&self.writing).remove(&replicate) else { return };
        let mut written = || -> Result<(), Error> {
            let failed = Error::unwritable(&self.folder);
            for shape in trajectory.shapes.iter() {
                let shape = shape?;
                let position = shape.position.iter().flat_map(|p| [p.x, p.y, p.z]);
                let numbers: Vec<f64> = std::iter::once(shape.time).chain(position).collect();
                file.write(Tag::Shape, &numbers).map_err(&failed)?;
            }
            let laid: Vec<f64> = trajectory.laid.iter().flat_map(numbers_of_point).collect();
            file.write(Tag::LaidWithShapes, &laid).map_err(&failed)?;
            for (measure, value) in &trajectory.values {
                let index = measures().position(|other| other.name == measure.name);
                let index = index.unwrap_or_default() as f64;
                match value {
                    Value::Number(value) => file.write(Tag::Number, &[index, *value]),
                    Value::Curve(places, values) => {
                        let places: Vec<f64> = std::iter::once(index).chain(places.iter().copied()).collect();
                        file.write(Tag::Places, &places).and_then(|()| file.write(Tag::Values, values))
                    }
                }
                .map_err(&failed)?;
            }
            let sum = f64::from_bits(file.sum);
            file.write(Tag::End, &[sum]).and_then(|()| file.file.flush()).map_err(failed)
        };
        let moved = written().is_ok() && fs::rename(self.part(replicate), self.file(replicate)).is_ok();
        if !moved {
            let _ = fs::remove_file(self.part(replicate));
        }
    }

    /// The trajectories of replicates that fly together, if all of them are kept; what was recorded of them is passed on.
    ///
    /// # Errors
    /// Those of the recorder.
    pub(super) fn recall(
        &self,
        replicates: Range<u64>,
        recorder: &dyn Recorder,
    ) -> Result<Option<Vec<Trajectory>>, Error> {
        if self.left == 0 || !replicates.clone().all(|replicate| self.file(replicate).exists()) {
            return Ok(None);
        }
        let first = replicates.start;
        let recalled = replicates.map(|replicate| {
            let one = self.recall_one(replicate, replicate == first, recorder)?;
            if one.is_none() {
                // It is damaged, and is flown and kept again.
                let _ = fs::remove_file(self.file(replicate));
            }
            Ok(one)
        });
        recalled.collect()
    }

    fn recall_one(
        &self,
        replicate: u64,
        is_first: bool,
        recorder: &dyn Recorder,
    ) -> Result<Option<Trajectory>, Error> {
        let Ok(file) = File::open(self.file(replicate)) else { return Ok(None) };
        let mut frames = Frames { reader: BufReader::with_capacity(1 << 16, file), sum: 0 };
        recorder.begin(replicate);
        let shapes = match replicate < self.keep.shapes.replicates {
            true => recorder.shapes(replicate)?,
            false => Shapes::default(),
        };
        let mut trajectory = Trajectory { replicate, shapes, ..Trajectory::default() };
        loop {
            let sum = frames.sum;
            let Some((tag, numbers)) = frames.next() else { return Ok(None) };
            match (tag, &numbers[..]) {
                (Tag::Sample, numbers) => {
                    let Some(sample) = sample_of(numbers) else { return Ok(None) };
                    if is_first && self.keep.curves && !self.of_fed {
                        trajectory.path.push(&sample);
                    }
                    recorder.sample(replicate, &sample)?;
                }
                (Tag::Laid, numbers) => recorder.lay(replicate, &points_of(numbers))?,
                (Tag::LaidWithShapes, numbers) => trajectory.laid = points_of(numbers),
                (Tag::Shape, [time, position @ ..]) => {
                    let position: Vec<_> =
                        position.chunks_exact(3).map(|p| Vec3::new(p[0], p[1], p[2])).collect();
                    trajectory.shapes.push(*time, position.into_iter())?;
                }
                (Tag::Number, [index, value]) => {
                    let Some(measure) = measures().nth(*index as usize) else { return Ok(None) };
                    trajectory.values.push((measure, Value::Number(*value)));
                }
                (Tag::Places, [index, places @ ..]) => {
                    let Some(measure) = measures().nth(*index as usize) else { return Ok(None) };
                    let Some((Tag::Values, values)) = frames.next() else { return Ok(None) };
                    trajectory.values.push((measure, Value::Curve(places.to_vec(), values)));
                }
                (Tag::End, [kept]) => return Ok((kept.to_bits() == sum).then_some(trajectory)),
                _ => return Ok(None),
            }
        }
    }
}

/// Passes on what is recorded, and keeps it.
#[derive(Debug)]
pub(super) struct Keeper<'a> {
    pub(super) passed_on: &'a dyn Recorder,
    pub(super) kept: &'a KeptFlights,
}

impl Recorder for Keeper<'_> {
    fn begin(&self, replicate: u64) {
        self.kept.begin(replicate);
        self.passed_on.begin(replicate);
    }

    fn sample(&self, replicate: u64, sample: &Sample) -> Result<(), Error> {
        self.kept.write(replicate, Tag::Sample, &numbers_of(sample));
        self.passed_on.sample(replicate, sample)
    }

    fn lay(&self, replicate: u64, points: &[LaidPoint]) -> Result<(), Error> {
        let numbers: Vec<f64> = points.iter().flat_map(numbers_of_point).collect();
        self.kept.write(replicate, Tag::Laid, &numbers);
        self.passed_on.lay(replicate, points)
    }

    fn shapes(&self, replicate: u64) -> Result<Shapes, Error> {
        self.passed_on.shapes(replicate)
    }
}

/// All measures. The header has the version of the program, so their order is known.
fn measures() -> impl Iterator<Item = &'static Measure> {
    DECLARED.iter().flat_map(|declaration| declaration.measures)
}

/// A checksum with some more bytes.
fn added(sum: u64, bytes: &[u8]) -> u64 {
    bytes.chunks(BYTES).fold(sum, |sum, some| {
        let mut word = [0; BYTES];
        word[..some.len()].copy_from_slice(some);
        (sum.rotate_left(5) ^ u64::from_le_bytes(word)).wrapping_mul(0x9e37_79b9_7f4a_7c15)
    })
}

impl KeptFile {
    fn write(&mut self, tag: Tag, numbers: &[f64]) -> io::Result<()> {
        let mut bytes = Vec::with_capacity(BYTES * (numbers.len() + 1));
        bytes.extend((tag as u32).to_le_bytes());
        bytes.extend((numbers.len() as u32).to_le_bytes());
        bytes.extend(numbers.iter().copied().flat_map(f64::to_le_bytes));
        self.sum = added(self.sum, &bytes);
        self.file.write_all(&bytes)
    }
}

/// The frames of a file.
struct Frames {
    reader: BufReader<File>,
    sum: u64,
}

impl Frames {
    /// The next frame; `None` if there is none that is whole.
    fn next(&mut self) -> Option<(Tag, Vec<f64>)> {
        let mut head = [0; BYTES];
        self.reader.read_exact(&mut head).ok()?;
        let ([tag, count], _) = head.as_chunks::<4>() else { return None };
        let (tag, count) = (u32::from_le_bytes(*tag), u32::from_le_bytes(*count));
        let tag = Tag::ALL.into_iter().find(|known| *known as u32 == tag)?;
        let mut bytes = vec![0; if count > LONGEST { return None } else { count as usize * BYTES }];
        self.reader.read_exact(&mut bytes).ok()?;
        self.sum = added(added(self.sum, &head), &bytes);
        let (numbers, _) = bytes.as_chunks::<BYTES>();
        Some((tag, numbers.iter().copied().map(f64::from_le_bytes).collect()))
    }
}

const fn numbers_of(s: &Sample) -> [f64; 16] {
    let Vec3 { x, y, z } = s.end;
    [
        s.time,
        x,
        y,
        z,
        s.kinetic,
        s.axial,
        s.bending,
        s.work,
        s.gravity_work,
        s.air_work,
        s.damping_work,
        s.feed_work,
        s.belt_work,
        s.carried,
        s.tension_dissipation,
        s.imbalance,
    ]
}

fn sample_of(numbers: &[f64]) -> Option<Sample> {
    let n: &[f64; 16] = numbers.try_into().ok()?;
    Some(Sample {
        time: n[0],
        end: Vec3::new(n[1], n[2], n[3]),
        kinetic: n[4],
        axial: n[5],
        bending: n[6],
        work: n[7],
        gravity_work: n[8],
        air_work: n[9],
        damping_work: n[10],
        feed_work: n[11],
        belt_work: n[12],
        carried: n[13],
        tension_dissipation: n[14],
        imbalance: n[15],
    })
}

const fn numbers_of_point(point: &LaidPoint) -> [f64; 4] {
    [point.fed, point.time, point.md, point.cd]
}

fn points_of(numbers: &[f64]) -> Vec<LaidPoint> {
    let point = |n: &[f64]| LaidPoint { fed: n[0], time: n[1], md: n[2], cd: n[3] };
    numbers.chunks_exact(4).map(point).collect()
}
