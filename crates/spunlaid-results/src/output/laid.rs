//! What fed fibres lay on the belt, on its way to `laid.parquet`.
//!
//! ```text
//! flights → Spill (a little memory and a raw file per replicate) → LaidTable, when the replicate's turn has come
//! ```

use super::folder::Staging;
use super::parquet::{Column, Holds, Parquet};
use crate::Failure;
use spunlaid::ensemble::TakeLaid;
use spunlaid::error::Error;
use spunlaid::flight::LaidPoint;
use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufReader, Read, Write};
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Name of the table.
pub const LAID: &str = "laid.parquet";
/// Points of a replicate that stay in memory before they go to its file.
const IN_MEMORY: usize = 4096;
/// Numbers of a point.
const NUMBERS: usize = 4;
/// Number of rows in a row group.
const ROWS: usize = 1 << 18;

/// Collects the laid points of the replicates in flight, in files where they become many.
#[derive(Debug)]
pub struct Spill {
    folder: PathBuf,
    /// The final path of the table, for messages.
    table: PathBuf,
    held: Mutex<Held>,
}

#[derive(Debug, Default)]
struct Held {
    /// Points of the replicates that are not in a file.
    points: BTreeMap<u64, Vec<LaidPoint>>,
    /// Why a file could not be written.
    failed: Option<io::Error>,
}

impl Spill {
    /// Collects in the staging folder, beside the new results.
    pub fn new(staging: &Staging<'_>) -> Self {
        Self { folder: staging.scratch(), table: staging.place(LAID).1, held: Mutex::default() }
    }

    /// Passes on the points of a replicate that has landed, in the order of feed, and forgets them.
    fn drain(
        &self,
        replicate: u64,
        mut to: impl FnMut(&[LaidPoint]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let last = self.held().points.remove(&replicate).unwrap_or_default();
        let path = self.file(replicate);
        if path.exists() {
            let unreadable = Failure::unwritable(&self.table);
            let file = File::open(&path).map_err(&unreadable)?;
            let mut left = file.metadata().map_err(&unreadable)?.len() as usize / (8 * NUMBERS);
            let mut reader = BufReader::new(file);
            while left > 0 {
                let mut bytes = vec![0; left.min(IN_MEMORY) * 8 * NUMBERS];
                reader.read_exact(&mut bytes).map_err(&unreadable)?;
                to(&bytes.chunks_exact(8 * NUMBERS).map(point).collect::<Vec<_>>())?;
                left -= left.min(IN_MEMORY);
            }
            drop(reader);
            fs::remove_file(&path).map_err(&unreadable)?;
        }
        to(&last)
    }

    /// The failure of a file, in place of the error that ended the flights because of it.
    pub fn failure(&self, ended: Failure) -> Failure {
        match self.held().failed.take() {
            Some(source) => Failure::unwritable(&self.table)(source),
            None => ended,
        }
    }

    fn file(&self, replicate: u64) -> PathBuf {
        self.folder.join(format!("laid_{replicate}"))
    }

    fn held(&self) -> MutexGuard<'_, Held> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn append(&self, replicate: u64, points: &[LaidPoint]) -> io::Result<()> {
        fs::create_dir_all(&self.folder)?;
        let numbers = points.iter().flat_map(|p| [p.fed, p.time, p.md, p.cd]);
        let bytes: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
        OpenOptions::new().create(true).append(true).open(self.file(replicate))?.write_all(&bytes)
    }
}

impl TakeLaid for Spill {
    fn take(&self, replicate: u64, points: &[LaidPoint]) -> Result<(), Error> {
        let full = {
            let mut held = self.held();
            let gathered = held.points.entry(replicate).or_default();
            gathered.extend_from_slice(points);
            (gathered.len() >= IN_MEMORY).then(|| std::mem::take(gathered))
        };
        // A replicate flies in one thread only, so its points stay in their order.
        full.map_or(Ok(()), |full| self.append(replicate, &full)).map_err(|why| {
            self.held().failed.get_or_insert(why);
            // The flights end; [`Spill::failure`] says why.
            Error::Interrupted
        })
    }
}

/// A point from its bytes.
fn point(bytes: &[u8]) -> LaidPoint {
    let number = |i: usize| {
        let mut of = [0; 8];
        of.copy_from_slice(&bytes[8 * i..8 * i + 8]);
        f64::from_le_bytes(of)
    };
    LaidPoint { fed: number(0), time: number(1), md: number(2), cd: number(3) }
}

/// `laid.parquet`: a row for each laid point, replicate by replicate in the order of feed.
pub struct LaidTable<'a> {
    spill: &'a Spill,
    writer: Parquet,
}

impl<'a> LaidTable<'a> {
    /// Begins the table.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn create(staging: &Staging<'_>, spill: &'a Spill) -> Result<Self, Failure> {
        let number = |name: &str| Column { name: name.to_owned(), holds: Holds::Number };
        let mut columns = vec![Column { name: "replicate".to_owned(), holds: Holds::Whole }];
        columns.extend(["s_m", "time_s", "md_m", "cd_m"].map(number));
        Ok(Self { spill, writer: Parquet::create(staging.place(LAID), &columns, ROWS)? })
    }

    /// Adds what a replicate has laid.
    pub fn add(&mut self, replicate: u64) -> Result<(), Failure> {
        let Self { spill, writer } = self;
        spill.drain(replicate, |points| {
            writer.extend_whole(0, std::iter::repeat_n(replicate as i64 + 1, points.len()));
            let of: [fn(&LaidPoint) -> f64; NUMBERS] = [|p| p.fed, |p| p.time, |p| p.md, |p| p.cd];
            for (column, of) in of.into_iter().enumerate() {
                writer.extend(column + 1, points.iter().map(of));
            }
            writer.flush_when_full()
        })
    }

    /// Writes the remaining rows and closes the file.
    pub fn finish(self) -> Result<(), Failure> {
        self.writer.finish().map(drop)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn points(replicate: u64, from: usize, count: usize) -> Vec<LaidPoint> {
        let of = |i: usize| {
            let fed = i as f64 * 0.1;
            LaidPoint { fed, time: fed / 3.0, md: -fed, cd: (fed + replicate as f64).sin() }
        };
        (from..from + count).map(of).collect()
    }

    fn spill(folder: &tempfile::TempDir) -> Spill {
        Spill {
            folder: folder.path().join("scratch"),
            table: PathBuf::from("r").join(LAID),
            held: Mutex::default(),
        }
    }

    #[test]
    fn what_goes_through_files_comes_back_to_the_bit_and_in_order() {
        let folder = tempfile::tempdir().unwrap();
        let spill = spill(&folder);
        // Two replicates in turns, in pieces that do not fit the file's.
        let (mut given, pieces) = (0, [1, 700, IN_MEMORY - 300, 2 * IN_MEMORY, 5]);
        for piece in pieces {
            for replicate in [3, 4] {
                spill.take(replicate, &points(replicate, given, piece)).unwrap();
            }
            given += piece;
        }
        assert!(spill.file(3).exists(), "so many points do not stay in memory");
        for replicate in [3, 4, 5] {
            let mut back = Vec::new();
            spill
                .drain(replicate, |some| {
                    back.extend_from_slice(some);
                    Ok(())
                })
                .unwrap();
            let wanted = if replicate == 5 { Vec::new() } else { points(replicate, 0, given) };
            assert!(back == wanted, "{replicate}");
        }
        assert_eq!(fs::read_dir(folder.path().join("scratch")).unwrap().count(), 0);
        assert!(spill.held().points.is_empty());
    }

    #[test]
    fn a_place_that_cannot_be_written_is_told_with_the_path_of_the_table() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scratch"), "in the way").unwrap();
        let spill = spill(&folder);
        let error = spill.take(0, &points(0, 0, IN_MEMORY)).unwrap_err();
        let told = spill.failure(error.into()).to_string();
        assert!(told.starts_with("r/laid.parquet: cannot be written: "), "{told}");
        // Another error stays what it is.
        assert!(matches!(spill.failure(Error::Interrupted), Error::Interrupted));
    }
}
