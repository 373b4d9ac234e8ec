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
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard};

/// Numbers of a fibre that stay in memory before they go to its file: of each fibre, and where there is room.
const IN_MEMORY: usize = 1 << 12;
const WITH_ROOM: usize = 1 << 14;
/// Numbers of all fibres for which there is room.
const ROOM: usize = 1 << 21;
/// Bytes of a number.
const BYTES: usize = size_of::<f64>();
/// Fibres that fly at the same time wait for one another only if they share a drawer.
const DRAWERS: usize = 64;

/// Collects the rows of a table from the fibres in flight, in files where they become many.
#[derive(Debug)]
pub(super) struct Spill {
    folder: PathBuf,
    /// Name of the table, and its final path for messages.
    name: &'static str,
    table: PathBuf,
    /// Numbers in a row.
    width: usize,
    /// The rows of each replicate.
    waiting: [Mutex<BTreeMap<u64, PendingRows>>; DRAWERS],
    /// Numbers that are in memory.
    held: AtomicUsize,
    /// Why a file could not be written.
    failed: Mutex<Option<io::Error>>,
}

/// What has been recorded of a replicate.
#[derive(Debug, Default)]
struct PendingRows {
    /// Rows that are not in its file.
    rows: Vec<f64>,
    /// Whether there is a file.
    filed: bool,
}

impl Spill {
    /// Collects in the staging folder, beside the new results.
    pub(super) fn new(staging: &Staging<'_>, name: &'static str, width: usize) -> Self {
        Self::in_folder(staging.scratch(), name, staging.place(name).1, width)
    }

    fn in_folder(folder: PathBuf, name: &'static str, table: PathBuf, width: usize) -> Self {
        let waiting = std::array::from_fn(|_| Mutex::default());
        Self { folder, name, table, width, waiting, held: AtomicUsize::new(0), failed: Mutex::default() }
    }

    /// Number of columns.
    pub(super) const fn width(&self) -> usize {
        self.width
    }

    /// Name of the table.
    pub(super) const fn name(&self) -> &'static str {
        self.name
    }

    /// Takes the next rows of a replicate, not many at a time. Another thread may do the same for another replicate.
    ///
    /// # Errors
    /// If its file cannot be written, an error that ends the flights; [`Spill::failure`] says why.
    pub(super) fn push(&self, replicate: u64, numbers: impl IntoIterator<Item = f64>) -> Result<(), Error> {
        let (full, filed) = {
            let mut drawer = self.drawer(replicate);
            let PendingRows { rows, filed } = drawer.entry(replicate).or_default();
            let before = rows.len();
            rows.extend(numbers);
            let more = rows.len() - before;
            let held = self.held.fetch_add(more, Ordering::Relaxed) + more;
            let most = if held > ROOM { IN_MEMORY } else { WITH_ROOM };
            if rows.len() + self.width <= most {
                return Ok(());
            }
            self.held.fetch_sub(rows.len(), Ordering::Relaxed);
            (std::mem::take(rows), std::mem::replace(filed, true))
        };
        // A replicate flies in one thread only, so its rows stay in their order.
        self.append(replicate, &full, filed).map_err(|why| {
            lock(&self.failed).get_or_insert(why);
            Error::Interrupted
        })
    }

    /// Forgets the rows of a replicate.
    pub(super) fn forget(&self, replicate: u64) {
        if self.take(replicate).filed {
            // What cannot be removed is written over, or removed with the folder.
            let _ = fs::remove_file(self.file(replicate));
        }
    }

    /// Passes on the rows of a replicate that has landed, in their order, and forgets them.
    pub(super) fn drain(
        &self,
        replicate: u64,
        mut to: impl FnMut(&[f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let PendingRows { rows, filed } = self.take(replicate);
        if filed {
            let path = self.file(replicate);
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
        to(&rows)
    }

    /// The failure of a file, if there was one.
    pub(super) fn failure(&self) -> Option<Failure> {
        let source = lock(&self.failed).take()?;
        Some(Failure::unwritable(&self.table)(source))
    }

    fn file(&self, replicate: u64) -> PathBuf {
        self.folder.join(format!("{}_{replicate}", self.name))
    }

    fn drawer(&self, replicate: u64) -> MutexGuard<'_, BTreeMap<u64, PendingRows>> {
        lock(&self.waiting[(replicate % DRAWERS as u64) as usize])
    }

    fn take(&self, replicate: u64) -> PendingRows {
        let pending = self.drawer(replicate).remove(&replicate).unwrap_or_default();
        self.held.fetch_sub(pending.rows.len(), Ordering::Relaxed);
        pending
    }

    /// Adds numbers to the file of a replicate. The first ones begin it.
    fn append(&self, replicate: u64, numbers: &[f64], filed: bool) -> io::Result<()> {
        fs::create_dir_all(&self.folder)?;
        let bytes: Vec<u8> = numbers.iter().copied().flat_map(f64::to_le_bytes).collect();
        let mut options = OpenOptions::new();
        options.create(true).write(true).append(filed).truncate(!filed);
        options.open(self.file(replicate))?.write_all(&bytes)
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
        let table = PathBuf::from("r").join("laid.parquet");
        Spill::in_folder(folder.path().join("scratch"), "laid.parquet", table, WIDTH)
    }

    fn held(spill: &Spill) -> usize {
        let each =
            spill.waiting.iter().map(|drawer| lock(drawer).values().map(|p| p.rows.len()).sum::<usize>());
        let held = each.sum();
        assert_eq!(held, spill.held.load(Ordering::Relaxed));
        held
    }

    fn drained(spill: &Spill, replicate: u64) -> Vec<u64> {
        let mut back = Vec::new();
        spill
            .drain(replicate, |some| {
                assert!(some.len().is_multiple_of(WIDTH) && some.len() <= WITH_ROOM);
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
        let count = 3 * WITH_ROOM / WIDTH + 17;
        for i in 0..count {
            for replicate in [3, 4] {
                spill.push(replicate, row(replicate, i)).unwrap();
            }
        }
        assert!(spill.file(3).exists(), "so many rows do not stay in memory");
        assert!(held(&spill) <= 2 * WITH_ROOM);
        for replicate in [3, 4, 5] {
            let rows = (0..if replicate == 5 { 0 } else { count }).flat_map(|i| row(replicate, i));
            assert!(drained(&spill, replicate) == rows.map(f64::to_bits).collect::<Vec<_>>(), "{replicate}");
        }
        assert_eq!(fs::read_dir(folder.path().join("scratch")).unwrap().count(), 0);
        assert_eq!(held(&spill), 0);
    }

    #[test]
    fn many_fibres_hold_no_more_than_there_is_room_for() {
        let folder = tempfile::tempdir().unwrap();
        let spill = spill(&folder);
        let fibres = 4 * (ROOM / WITH_ROOM) as u64;
        for i in 0..WITH_ROOM / WIDTH - 1 {
            (0..fibres).for_each(|replicate| spill.push(replicate, row(replicate, i)).unwrap());
            // A fibre gives its rows to its file when the next one is there.
            assert!(held(&spill) <= ROOM + fibres as usize * WIDTH);
        }
        assert!(spill.file(7).exists());
    }

    #[test]
    fn what_is_forgotten_does_not_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let spill = spill(&folder);
        (0..WITH_ROOM).for_each(|i| spill.push(0, row(0, i)).unwrap());
        assert!(spill.file(0).exists());
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
        let error = (0..WITH_ROOM).find_map(|i| spill.push(0, row(0, i)).err());
        assert!(matches!(error, Some(Error::Interrupted)), "{error:?}");
        let message = spill.failure().unwrap().to_string();
        assert!(message.starts_with("r/laid.parquet: cannot be written: "), "{message}");
        // It is reported once.
        assert!(spill.failure().is_none());
    }
}
