//! Reads back what an earlier process has kept.

use super::record::{Kind, length, read};
use super::{LANDED, measures};
use crate::output::tables::{PackedColumn, point_of, sample_columns, table_names, unpacked};
use spunlaid::ensemble::{Keep, Recorder, Sample, Shapes, Trajectory};
use spunlaid::error::Error;
use spunlaid::flight::LaidPoint;
use spunlaid::observe::{Measure, Value};
use spunlaid::threads::lock;
use spunlaid::vec3::Vec3;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// Rows that are passed on together.
const TOGETHER: usize = 256;

/// What an earlier process has kept.
#[derive(Debug)]
pub(in super::super) struct Earlier {
    place: PathBuf,
    fed: bool,
    keep: Keep,
    fibres: BTreeMap<u64, KeptFibre>,
    tables: Vec<KeptTable>,
    /// The places of measures that are curves, by the index of the measure.
    places: BTreeMap<usize, Vec<f64>>,
}

/// Where the records of a replicate begin, and its rows in each table.
#[derive(Debug, Default)]
struct KeptFibre {
    landed: u64,
    shapes: Vec<u64>,
    laid: Option<u64>,
    rows: Vec<Range<usize>>,
}

/// The rows of a table, piece after piece without gaps.
#[derive(Debug, Default)]
struct KeptTable {
    name: &'static str,
    pieces: Vec<Piece>,
    /// The piece that was read last.
    last: Mutex<Option<(usize, Arc<Columns>)>>,
}

#[derive(Debug)]
struct Piece {
    rows: Range<usize>,
    place: Place,
}

#[derive(Debug)]
enum Place {
    /// In the table.
    Group(Vec<PackedColumn>),
    /// In a record that begins here.
    Record(u64),
}

/// Columns without that of the replicate.
type Columns = Vec<Vec<f64>>;

impl Earlier {
    pub(super) fn none(fed: bool, keep: Keep) -> Self {
        let table = |name| KeptTable { name, ..KeptTable::default() };
        let tables = table_names(fed).into_iter().map(table).collect();
        let (fibres, places) = (BTreeMap::new(), BTreeMap::new());
        Self { place: PathBuf::new(), fed, keep, fibres, tables, places }
    }

    /// Finds what there is in the folder of a process.
    pub(super) fn read(place: PathBuf, fed: bool, keep: Keep) -> Self {
        let mut found = Self { place, ..Self::none(fed, keep) };
        let Ok(file) = File::open(found.place.join(LANDED)) else { return found };
        let (mut file, mut at) = (BufReader::with_capacity(1 << 16, file), 0);
        while let Some((kind, numbers)) = read(&mut file) {
            if found.enter(kind, &numbers, at).is_none() {
                break;
            }
            at += length(numbers.len());
        }
        let tables = &found.tables;
        let is_whole = |fibre: &KeptFibre| {
            let mut rows = fibre.rows.iter().zip(tables);
            fibre.rows.len() == tables.len() && rows.all(|(rows, table)| rows.end <= table.end())
        };
        found.fibres.retain(|_, fibre| is_whole(fibre));
        found
    }

    fn enter(&mut self, kind: Kind, numbers: &[f64], at: u64) -> Option<()> {
        let (first, rest) = numbers.split_first()?;
        match kind {
            Kind::Landed => {
                let fibre = self.fibres.entry(*first as u64).or_default();
                let rows = rest.get(..2 * self.tables.len())?.chunks_exact(2);
                fibre.rows = rows.map(|r| r[0] as usize..(r[0] + r[1]) as usize).collect();
                fibre.landed = at;
            }
            Kind::Shape => self.fibres.entry(*first as u64).or_default().shapes.push(at),
            Kind::LaidWithShapes => self.fibres.entry(*first as u64).or_default().laid = Some(at),
            Kind::Places => drop(self.places.insert(*first as usize, rest.to_vec())),
            Kind::Group => {
                let (table, (rows, columns)) = (self.tables.get_mut(*first as usize)?, rest.split_first()?);
                let column =
                    |c: &[f64]| PackedColumn { start: c[0] as u64, length: c[1] as u64, sum: c[2] as u32 };
                // The first column is the replicate.
                let columns = columns.chunks_exact(3).skip(1).map(column).collect();
                table.enter_group(*rows as usize, columns);
            }
            Kind::Rows => {
                let [begin, count] = *rest.first_chunk()?;
                let table = self.tables.get_mut(*first as usize)?;
                let rows = begin as usize..(begin + count) as usize;
                (rows.start == table.end()).then_some(())?;
                table.pieces.push(Piece { rows, place: Place::Record(at) });
            }
        }
        Some(())
    }

    /// Number of replicates that were found.
    pub(in super::super) fn fibres(&self) -> usize {
        self.fibres.len()
    }

    pub(super) fn is_at(&self, place: &Path) -> bool {
        self.place == place
    }

    /// The trajectories of replicates that fly together, if all of them are kept; what was recorded of them
    /// is passed on.
    ///
    /// # Errors
    /// Those of the recorder.
    pub(in super::super) fn recall(
        &self,
        replicates: Range<u64>,
        recorder: &dyn Recorder,
    ) -> Result<Option<Vec<Trajectory>>, Error> {
        let kept: Option<Vec<_>> =
            replicates.clone().map(|replicate| Some((replicate, self.fibres.get(&replicate)?))).collect();
        let Some(kept) = kept else { return Ok(None) };
        let one =
            |(replicate, fibre)| self.recall_one(replicate, fibre, replicate == replicates.start, recorder);
        kept.into_iter().map(one).collect()
    }

    fn recall_one(
        &self,
        replicate: u64,
        fibre: &KeptFibre,
        is_first: bool,
        recorder: &dyn Recorder,
    ) -> Result<Option<Trajectory>, Error> {
        recorder.begin(replicate);
        let shapes = match replicate < self.keep.shapes.replicates {
            true => recorder.shapes(replicate)?,
            false => Shapes::default(),
        };
        let mut trajectory = Trajectory { replicate, shapes, ..Trajectory::default() };
        for at in &fibre.shapes {
            let Some((Kind::Shape, numbers)) = self.record(*at) else { return Ok(None) };
            let [_, time, position @ ..] = &numbers[..] else { return Ok(None) };
            let position: Vec<_> = position.chunks_exact(3).map(|p| Vec3::new(p[0], p[1], p[2])).collect();
            trajectory.shapes.push(*time, position.into_iter())?;
        }
        if let Some(at) = fibre.laid {
            let Some((Kind::LaidWithShapes, numbers)) = self.record(at) else { return Ok(None) };
            trajectory.laid =
                numbers[1..].chunks_exact(4).map(|p| point_of([p[0], p[1], p[2], p[3]])).collect();
        }
        let Some(values) = self.values(fibre) else { return Ok(None) };
        trajectory.values = values;
        let fields = sample_columns(self.fed);
        let (of_samples, of_points) = self.tables.split_at(fields.len());
        let mut rows = fibre.rows.first().cloned().unwrap_or_default();
        while !rows.is_empty() {
            let pieces: Option<Vec<_>> = of_samples.iter().map(|t| t.read(&self.place, rows.start)).collect();
            let Some(pieces) = pieces else { return Ok(None) };
            let end = pieces.iter().map(|(piece, _)| piece.end).min().unwrap_or(0).min(rows.end);
            let mut samples = vec![Sample::default(); end - rows.start];
            for ((piece, columns), fields) in pieces.iter().zip(&fields) {
                for (field, column) in fields.iter().zip(columns.iter()) {
                    let Some(field) = field else { continue };
                    let Some(numbers) = column.get(rows.start - piece.start..end - piece.start) else {
                        return Ok(None);
                    };
                    samples.iter_mut().zip(numbers).for_each(|(sample, number)| *field(sample) = *number);
                }
            }
            if is_first && self.keep.curves && !self.fed {
                samples.iter().for_each(|sample| trajectory.path.push(sample));
            }
            samples.chunks(TOGETHER).try_for_each(|some| recorder.samples(replicate, some))?;
            rows.start = end;
        }
        for (table, rows) in of_points.iter().zip(&fibre.rows[fields.len()..]) {
            let mut rows = rows.clone();
            while !rows.is_empty() {
                let Some((piece, columns)) = table.read(&self.place, rows.start) else { return Ok(None) };
                let end = piece.end.min(rows.end);
                let [fed, time, md, cd] = &columns[..] else { return Ok(None) };
                let point =
                    |row: usize| point_of([fed, time, md, cd].map(|column| column[row - piece.start]));
                let points: Vec<LaidPoint> = (rows.start..end).map(point).collect();
                points.chunks(TOGETHER).try_for_each(|some| recorder.lay(replicate, some))?;
                rows.start = end;
            }
        }
        Ok(Some(trajectory))
    }

    /// The measures of a replicate.
    fn values(&self, fibre: &KeptFibre) -> Option<Vec<(&'static Measure, Value)>> {
        let (Kind::Landed, numbers) = self.record(fibre.landed)? else { return None };
        let mut rest = numbers.get(1 + 2 * self.tables.len()..)?;
        let mut values = Vec::new();
        while let [index, count, others @ ..] = rest {
            let index = *index as usize;
            let value;
            (value, rest) = if *count == 0.0 {
                let (number, others) = others.split_first()?;
                (Value::Number(*number), others)
            } else {
                let more = count.abs() as usize - 1;
                let (places, others) = match *count > 0.0 {
                    true => others.split_at_checked(more)?,
                    false => (&self.places.get(&index).filter(|places| places.len() == more)?[..], others),
                };
                let (values, others) = others.split_at_checked(more)?;
                (Value::Curve(places.to_vec(), values.to_vec()), others)
            };
            values.push((measures().nth(index)?, value));
        }
        rest.is_empty().then_some(values)
    }

    fn record(&self, at: u64) -> Option<(Kind, Vec<f64>)> {
        record(&self.place, at)
    }
}

fn record(place: &Path, at: u64) -> Option<(Kind, Vec<f64>)> {
    let mut file = File::open(place.join(LANDED)).ok()?;
    file.seek(SeekFrom::Start(at)).ok()?;
    read(&mut BufReader::with_capacity(1 << 16, file))
}

impl KeptTable {
    /// Number of rows from the first on that are kept.
    fn end(&self) -> usize {
        self.pieces.last().map_or(0, |piece| piece.rows.end)
    }

    /// A group takes the place of those of its rows that were kept before it was written.
    fn enter_group(&mut self, rows: usize, columns: Vec<PackedColumn>) {
        while self.pieces.pop_if(|piece| matches!(piece.place, Place::Record(_))).is_some() {}
        let start = self.end();
        self.pieces.push(Piece { rows: start..start + rows, place: Place::Group(columns) });
    }

    /// The piece that has a row: its rows and columns; `None` if it cannot be read.
    fn read(&self, folder: &Path, row: usize) -> Option<(Range<usize>, Arc<Columns>)> {
        let index = self.pieces.partition_point(|piece| piece.rows.end <= row);
        let Piece { rows, place } = self.pieces.get(index)?;
        let mut last = lock(&self.last);
        if let Some((_, columns)) = last.as_ref().filter(|(known, _)| *known == index) {
            return Some((rows.clone(), Arc::clone(columns)));
        }
        let columns: Columns = match place {
            Place::Group(columns) => {
                let mut file = File::open(folder.join(self.name)).ok()?;
                let mut column = |column: &PackedColumn| {
                    file.seek(SeekFrom::Start(column.start)).ok()?;
                    let mut bytes = Vec::new();
                    file.by_ref().take(column.length).read_to_end(&mut bytes).ok()?;
                    unpacked(bytes, *column, rows.len())
                };
                columns.iter().map(&mut column).collect::<Option<_>>()?
            }
            Place::Record(at) => {
                let (_, numbers) = record(folder, *at)?;
                numbers.get(3..)?.chunks_exact(rows.len().max(1)).map(<[f64]>::to_vec).collect()
            }
        };
        let columns = Arc::new(columns);
        *last = Some((index, Arc::clone(&columns)));
        Some((rows.clone(), columns))
    }
}
