//! Rows of numbers of fibres in flight, on their way to a table.
//!
//! ```text
//! flights → Spill (a little memory and a raw file for each fibre) → table, when the fibre's turn has come
//! ```

use super::folder::Staging;
use crate::Failure;
use spunlaid::error::Error;
use spunlaid::threads::lock;
use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufReader, Read, Write};
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard};

/// Numbers of a fibre that stay in memory before they go to its file.
const IN_MEMORY: usize = 1 << 12;
/// Bytes of a number.
const BYTES: usize = size_of::<f64>();

/// Collects the rows of a table from the fibres in flight, in files where they become many.
#[derive(Debug)]
pub(super) struct Spill {
    folder: PathBuf,
    /// Name of the table, and its final path for messages.
    name: &'static str,
    table: PathBuf,
    /// Numbers in a row.
    width: usize,
    waiting: Mutex<PendingRows>,
}

#[derive(Debug, Default)]
struct PendingRows {
    /// Rows that are not in a file, by replicate.
    rows: BTreeMap<u64, Vec<f64>>,
    /// Why a file could not be written.
    failed: Option<io::Error>,
}

impl Spill {
    /// Collects in the staging folder, beside the new results.
    pub(super) fn new(staging: &Staging<'_>, name: &'static str, width: usize) -> Self {
        let (folder, table) = (staging.scratch(), staging.place(name).1);
        Self { folder, name, table, width, waiting: Mutex::default() }
    }

    /// Number of columns.
    pub(super) const fn width(&self) -> usize {
        self.width
    }

    /// Name of the table.
    pub(super) const fn name(&self) -> &'static str {
        self.name
    }

    /// Takes the next row of a replicate. Another thread may do the same for another replicate.
    ///
    /// # Errors
    /// If its file cannot be written, an error that ends the flights; [`Spill::failure`] says why.
    pub(super) fn push(&self, replicate: u64, row: impl IntoIterator<Item = f64>) -> Result<(), Error> {
        let full = {
            let mut waiting = self.lock_pending();
            let rows = waiting.rows.entry(replicate).or_default();
            rows.extend(row);
            (rows.len() + self.width > IN_MEMORY).then(|| std::mem::take(rows))
        };
        // A replicate flies in one thread only, so its rows stay in their order.
        full.map_or(Ok(()), |full| self.append(replicate, &full)).map_err(|why| {
            self.lock_pending().failed.get_or_insert(why);
            Error::Interrupted
        })
    }

    /// Forgets the rows of a replicate.
    pub(super) fn forget(&self, replicate: u64) {
        self.lock_pending().rows.remove(&replicate);
        // There is usually no file.
        let _ = fs::remove_file(self.file(replicate));
    }

    /// Passes on the rows of a replicate that has landed, in their order, and forgets them.
    pub(super) fn drain(
        &self,
        replicate: u64,
        mut to: impl FnMut(&[f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let last = self.lock_pending().rows.remove(&replicate).unwrap_or_default();
        let path = self.file(replicate);
        if path.exists() {
            let unreadable = Failure::unwritable(&self.table);
            let file = File::open(&path).map_err(&unreadable)?;
            let mut left = file.metadata().map_err(&unreadable)?.len() as usize / BYTES;
            let mut reader = BufReader::new(file);
            while left > 0 {
                let some = left.min(IN_MEMORY / self.width * self.width);
                let mut bytes = vec![0; some * BYTES];
                reader.read_exact(&mut bytes).map_err(&unreadable)?;
                to(&bytes.chunks_exact(BYTES).map(number).collect::<Vec<_>>())?;
                left -= some;
            }
            drop(reader);
            fs::remove_file(&path).map_err(&unreadable)?;
        }
        to(&last)
    }

    /// The failure of a file, if there was one.
    pub(super) fn failure(&self) -> Option<Failure> {
        let source = self.lock_pending().failed.take()?;
        Some(Failure::unwritable(&self.table)(source))
    }

    fn file(&self, replicate: u64) -> PathBuf {
        self.folder.join(format!("{}_{replicate}", self.name))
    }

    fn lock_pending(&self) -> MutexGuard<'_, PendingRows> {
        lock(&self.waiting)
    }

    fn append(&self, replicate: u64, numbers: &[f64]) -> io::Result<()> {
        fs::create_dir_all(&self.folder)?;
        let bytes: Vec<u8> = numbers.iter().copied().flat_map(f64::to_le_bytes).collect();
        OpenOptions::new().create(true).append(true).open(self.file(replicate))?.write_all(&bytes)
    }
}

/// A number from its bytes.
fn number(bytes: &[u8]) -> f64 {
    let mut number = [0; BYTES];
    number.copy_from_slice(bytes);
    f64::from_le_bytes(number)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const WIDTH: usize = 5;

    fn row(replicate: u64, i: usize) -> [f64; WIDTH] {
        let fed = i as f64 * 0.1;
        [fed, fed / 3.0, -fed, (fed + replicate as f64).sin(), if i == 7 { f64::NAN } else { 1.0 }]
    }

    fn spill(folder: &tempfile::TempDir) -> Spill {
        Spill {
            folder: folder.path().join("scratch"),
            name: "laid.parquet",
            table: PathBuf::from("r").join("laid.parquet"),
            width: WIDTH,
            waiting: Mutex::default(),
        }
    }

    fn drained(spill: &Spill, replicate: u64) -> Vec<u64> {
        let mut back = Vec::new();
        spill
            .drain(replicate, |some| {
                assert!(some.len().is_multiple_of(WIDTH) && some.len() <= IN_MEMORY);
                back.extend(some.iter().map(|number| number.to_bits()));
                Ok(())
            })
            .unwrap();
        back
    }

    #[test]
    fn what_goes_through_files_comes_back_to_the_bit_and_in_order() {
        let folder = tempfile::tempdir().unwrap();
        let spill = spill(&folder);
        let count = 3 * IN_MEMORY / WIDTH + 17;
        for i in 0..count {
            for replicate in [3, 4] {
                spill.push(replicate, row(replicate, i)).unwrap();
            }
        }
        assert!(spill.file(3).exists(), "so many rows do not stay in memory");
        assert!(spill.lock_pending().rows.values().all(|rows| rows.len() <= IN_MEMORY));
        for replicate in [3, 4, 5] {
            let rows = (0..if replicate == 5 { 0 } else { count }).flat_map(|i| row(replicate, i));
            assert!(drained(&spill, replicate) == rows.map(f64::to_bits).collect::<Vec<_>>(), "{replicate}");
        }
        assert_eq!(fs::read_dir(folder.path().join("scratch")).unwrap().count(), 0);
        assert!(spill.lock_pending().rows.is_empty());
    }

    #[test]
    fn what_is_forgotten_does_not_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let spill = spill(&folder);
        (0..IN_MEMORY).for_each(|i| spill.push(0, row(0, i)).unwrap());
        spill.forget(0);
        assert!(!spill.file(0).exists());
        spill.push(0, row(0, 1)).unwrap();
        assert_eq!(drained(&spill, 0), row(0, 1).map(f64::to_bits));
    }

    #[test]
    fn a_place_that_cannot_be_written_is_told_with_the_path_of_the_table() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scratch"), "in the way").unwrap();
        let spill = spill(&folder);
        let error = (0..IN_MEMORY).find_map(|i| spill.push(0, row(0, i)).err());
        assert!(matches!(error, Some(Error::Interrupted)), "{error:?}");
        let message = spill.failure().unwrap().to_string();
        assert!(message.starts_with("r/laid.parquet: cannot be written: "), "{message}");
        // It is reported once.
        assert!(spill.failure().is_none());
    }
}
