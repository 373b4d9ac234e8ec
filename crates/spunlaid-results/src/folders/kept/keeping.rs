//! Keeps what has landed.

use super::record::{Kind, append};
use super::{Home, LANDED, measures};
use crate::output::tables::Tables;
use spunlaid::ensemble::Trajectory;
use spunlaid::observe::Value;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// So often, what has landed is written, with the rows that are in no group of their table yet; and when so many bytes have
/// gathered. Then few rows are written twice.
const PAUSE: Duration = Duration::from_millis(500);
const GATHERED: usize = 1 << 22;

/// Writes what a later process goes on with.
#[derive(Debug)]
pub(in super::super) struct Keeping {
    home: Home,
    place: PathBuf,
    tables: Vec<KeptTable>,
    file: Option<File>,
    /// Whether it did not work.
    given_up: bool,
    gathered: Vec<u8>,
    /// When it was written last.
    last: Option<Instant>,
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
        Self { home, place, tables, file: None, given_up: false, gathered: Vec::new(), last: None }
    }

    /// Keeps a replicate that has landed and is in the tables.
    ///
    /// * `before` – number of rows of the tables before
    pub(in super::super) fn land(&mut self, trajectory: &Trajectory, before: &[usize], tables: &Tables<'_>) {
        if self.given_up {
            return;
        }
        let (file, replicate) = (&mut self.gathered, trajectory.replicate as f64);
        for shape in trajectory.shapes.iter() {
            let Ok(shape) = shape else { return };
            let position = shape.position.iter().flat_map(|p| [p.x, p.y, p.z]);
            append(file, Kind::Shape, [replicate, shape.time].into_iter().chain(position));
        }
        if !trajectory.laid.is_empty() {
            let laid = trajectory.laid.iter().flat_map(|p| [p.fed, p.time, p.md, p.cd]);
            append(file, Kind::LaidWithShapes, std::iter::once(replicate).chain(laid));
        }
        let mut numbers = vec![replicate];
        let rows = before.iter().zip(tables.rows());
        numbers.extend(rows.flat_map(|(before, after)| [*before as f64, (after - before) as f64]));
        for (measure, value) in &trajectory.values {
            let index = measures().position(|other| other.name == measure.name);
            numbers.push(index.unwrap_or_default() as f64);
            match value {
                Value::Number(value) => numbers.extend([0.0, *value]),
                Value::Curve(places, values) => {
                    numbers.push((places.len() + 1) as f64);
                    numbers.extend(places.iter().chain(values));
                }
            }
        }
        append(file, Kind::Landed, numbers);
        if self.gathered.len() > GATHERED || self.last.is_none_or(|last| last.elapsed() > PAUSE) {
            self.settle(tables);
        }
    }

    /// Writes all that has landed.
    pub(in super::super) fn settle(&mut self, tables: &Tables<'_>) {
        if self.gathered.is_empty() {
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
        if self.append().is_err() {
            self.forget();
        }
        self.last = Some(Instant::now());
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
        self.gathered.clear();
        Ok(())
    }

    /// Forgets all of it, what an earlier process has left included.
    pub(super) fn forget(&mut self) {
        (self.given_up, self.gathered, self.file) = (true, Vec::new(), None);
        self.home.remove();
    }
}
