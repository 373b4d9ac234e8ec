//! Keeps what has landed.

use super::record::{Kind, append};
use super::{Home, LANDED, measures};
use crate::output::tables::Tables;
use spunlaid::ensemble::Trajectory;
use spunlaid::observe::Value;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// So often at most, what has landed is written, with the rows that are in no group of their table yet; on a
/// slow disk so many times more seldom than it takes, and when so many bytes have gathered. Then few rows are
/// written twice.
const PAUSE: Duration = Duration::from_millis(500);
const TIMES: u32 = 50;
const GATHERED: usize = 1 << 22;
/// Bytes of shapes that are held in memory.
const HELD: usize = 1 << 18;

/// Writes what a later process goes on with.
#[derive(Debug)]
pub(in super::super) struct Keeping {
    home: Home,
    place: PathBuf,
    tables: Vec<KeptTable>,
    file: Option<File>,
    /// Number of replicates that have landed.
    landed: u64,
    /// Whether it did not work.
    given_up: bool,
    gathered: Vec<u8>,
    /// Bytes since all that has landed was written.
    unsettled: usize,
    /// The places of each measure that is a curve, as the first replicate has them.
    places: BTreeMap<usize, Vec<f64>>,
    /// When it is written next.
    next: Option<Instant>,
}

/// A table, and what is kept of it.
#[derive(Debug)]
struct KeptTable {
    name: &'static str,
    written: PathBuf,
    groups: usize,
    rows: usize,
}

impl Keeping {
    /// * `place` – the folder of this process
    /// * `tables` – the tables that the run writes, with their present paths
    pub(super) fn new(home: Home, place: PathBuf, tables: Vec<(&'static str, PathBuf)>) -> Self {
        let tables = tables.into_iter();
        let tables = tables.map(|(name, written)| KeptTable { name, written, groups: 0, rows: 0 }).collect();
        let (gathered, places) = (Vec::new(), BTreeMap::new());
        Self {
            home,
            place,
            tables,
            file: None,
            landed: 0,
            given_up: false,
            gathered,
            unsettled: 0,
            places,
            next: None,
        }
    }

    pub(super) const fn landed(&self) -> u64 {
        self.landed
    }

    /// Keeps a replicate that has landed and is in the tables.
    ///
    /// * `before` – number of rows of the tables before
    pub(in super::super) fn land(&mut self, trajectory: &Trajectory, before: &[usize], tables: &Tables<'_>) {
        if self.given_up {
            return;
        }
        let replicate = trajectory.replicate as f64;
        for shape in trajectory.shapes.iter() {
            let Ok(shape) = shape else { return };
            let position = shape.position.iter().flat_map(|p| [p.x, p.y, p.z]);
            append(&mut self.gathered, Kind::Shape, [replicate, shape.time].into_iter().chain(position));
            // A fibre whose shapes are there and nothing else does not count.
            if self.gathered.len() > HELD && self.append().is_err() {
                return self.forget();
            }
        }
        let before_it = self.gathered.len();
        let file = &mut self.gathered;
        if !trajectory.laid.is_empty() {
            let laid = trajectory.laid.iter().flat_map(|p| [p.fed, p.time, p.md, p.cd]);
            append(file, Kind::LaidWithShapes, std::iter::once(replicate).chain(laid));
        }
        let mut numbers = vec![replicate];
        let rows = before.iter().zip(tables.rows());
        numbers.extend(rows.flat_map(|(before, after)| [*before as f64, (after - before) as f64]));
        let mut declared = measures().enumerate();
        for (measure, value) in &trajectory.values {
            // They come in the order of the declarations.
            let Some((index, _)) = declared.find(|(_, other)| other.name == measure.name) else { return };
            numbers.push(index as f64);
            match value {
                Value::Curve(places, values) => {
                    let count = (places.len() + 1) as f64;
                    let known = self.places.entry(index).or_insert_with(|| {
                        append(
                            file,
                            Kind::Places,
                            std::iter::once(index as f64).chain(places.iter().copied()),
                        );
                        places.clone()
                    });
                    if same_bits(places, known) {
                        numbers.push(-count);
                    } else {
                        numbers.push(count);
                        numbers.extend(places);
                    }
                    numbers.extend(values);
                }
                number => numbers.extend([0.0, number.number()]),
            }
        }
        append(file, Kind::Landed, numbers);
        self.landed += 1;
        self.unsettled += self.gathered.len() - before_it;
        if self.unsettled > GATHERED || self.next.is_none_or(|next| Instant::now() > next) {
            self.settle(tables);
        }
    }

    /// Writes all that has landed.
    pub(in super::super) fn settle(&mut self, tables: &Tables<'_>) {
        if std::mem::take(&mut self.unsettled) == 0 {
            return;
        }
        for (number, (kept, table)) in self.tables.iter_mut().zip(tables.written()).enumerate() {
            for group in &table.groups()[kept.groups..] {
                let head = [number as f64, group.rows as f64];
                let columns = group.columns.iter();
                let columns = columns.flat_map(|c| [c.start as f64, c.length as f64, f64::from(c.sum)]);
                append(&mut self.gathered, Kind::Group, head.into_iter().chain(columns));
            }
            kept.groups = table.groups().len();
            kept.rows = kept.rows.max(table.grouped());
            let (end, known) = (table.rows(), kept.rows - table.grouped());
            if kept.rows < end {
                let head = [number as f64, kept.rows as f64, (end - kept.rows) as f64];
                // The first column is the replicate.
                let columns = (1..table.width()).flat_map(|column| &table.pending(column)[known..]);
                append(&mut self.gathered, Kind::Rows, head.into_iter().chain(columns.copied()));
                kept.rows = end;
            }
        }
        let started = Instant::now();
        if self.append().is_err() {
            self.forget();
        }
        self.next = Some(Instant::now() + PAUSE.max(TIMES * started.elapsed()));
    }

    fn append(&mut self) -> io::Result<()> {
        let file = match &mut self.file {
            Some(file) => file,
            none => {
                if !self.home.claim() {
                    return Err(io::ErrorKind::ResourceBusy.into());
                }
                fs::create_dir_all(&self.place)?;
                for KeptTable { name, written, .. } in &self.tables {
                    fs::hard_link(written, self.place.join(name))?;
                }
                none.insert(File::create(self.place.join(LANDED))?)
            }
        };
        file.write_all(&self.gathered)?;
        // What it took is given back: rows of a group take more than what is gathered in between.
        self.gathered = Vec::new();
        Ok(())
    }

    /// Forgets all of it, what an earlier process has left included.
    pub(super) fn forget(&mut self) {
        (self.given_up, self.gathered, self.file) = (true, Vec::new(), None);
        self.home.remove();
    }
}

fn same_bits(one: &[f64], other: &[f64]) -> bool {
    one.len() == other.len() && one.iter().zip(other).all(|(one, other)| one.to_bits() == other.to_bits())
}
