//! One file of rows of numbers under keys, to which is only added, so that what was written survives the process.
//!
//! ```text
//! identity   a line of text: what the numbers belong to
//! record     mark · number of numbers · key · numbers · checksum, little-endian, all of eight bytes
//! ```
//!
//! What a killed process has left half written at the end is cut off. A record that is damaged does not count; those
//! behind it do, from the next mark on.

use crate::threads::lock;
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufReader, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::Mutex;

/// Under which rows are found again.
pub type Key = [u64; 2];

/// Bytes of a number, and of all else.
const BYTES: usize = size_of::<u64>();
/// Words before the numbers of a record, and with its checksum.
const HEAD: usize = 4;
const FRAME: usize = HEAD + 1;
/// At the beginning of a record; the second one says that what was under its key before counts no longer.
const MARKS: [u64; 2] = [u64::from_le_bytes(*b"spunlaid"), u64::from_le_bytes(*b"spunanew")];

/// A file of rows that this process has locked. Several threads may use it.
#[derive(Debug)]
pub struct Log {
    rows: Mutex<Rows>,
    /// Damaged pieces that were found; what they held has to be made again.
    pub damaged: u64,
}

#[derive(Debug)]
struct Rows {
    file: File,
    /// Where the next record begins.
    end: u64,
    places: BTreeMap<Key, Vec<Place>>,
}

/// Where a record begins, and how many numbers it has.
#[derive(Clone, Copy, Debug)]
struct Place {
    at: u64,
    count: usize,
}

impl Log {
    /// Opens a file, creates it if it does not exist, and locks it until this is dropped. What belongs to another identity
    /// is removed.
    ///
    /// # Errors
    /// If another process uses it ([`ErrorKind::WouldBlock`]), or it cannot be read or written.
    pub fn open(path: &Path, identity: &str) -> io::Result<Self> {
        let mut file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)?;
        match file.try_lock() {
            Ok(()) => {}
            // Some file systems have no locks; the user must then start one process only.
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(error),
            Err(TryLockError::WouldBlock) => return Err(ErrorKind::WouldBlock.into()),
        }
        let line = format!("{identity}\n").into_bytes();
        let mut found = Vec::new();
        (&mut file).take(line.len() as u64).read_to_end(&mut found)?;
        let start = line.len() as u64;
        if found != line {
            file.set_len(0)?;
            file.rewind()?;
            file.write_all(&line)?;
            let rows = Rows { file, end: start, places: BTreeMap::new() };
            return Ok(Self { rows: Mutex::new(rows), damaged: 0 });
        }
        let (places, end, damaged) = scan(&file, start)?;
        file.set_len(end)?;
        Ok(Self { rows: Mutex::new(Rows { file, end, places }), damaged })
    }

    /// Adds numbers under a key, behind those that it has.
    ///
    /// # Errors
    /// If the file cannot be written; the next record takes the place of what was written.
    pub fn append(&self, key: Key, numbers: impl IntoIterator<Item = f64>) -> io::Result<()> {
        self.write(MARKS[0], key, numbers)
    }

    /// Forgets the numbers under a key.
    ///
    /// # Errors
    /// If the file cannot be written; another process then finds them still.
    pub fn forget(&self, key: Key) -> io::Result<()> {
        let known = lock(&self.rows).places.remove(&key);
        known.map_or(Ok(()), |_| self.write(MARKS[1], key, []))
    }

    fn write(&self, mark: u64, key: Key, numbers: impl IntoIterator<Item = f64>) -> io::Result<()> {
        let mut bytes: Vec<u8> = [mark, 0, key[0], key[1]].into_iter().flat_map(u64::to_le_bytes).collect();
        bytes.extend(numbers.into_iter().flat_map(f64::to_le_bytes));
        let count = bytes.len() / BYTES - HEAD;
        bytes[BYTES..2 * BYTES].copy_from_slice(&(count as u64).to_le_bytes());
        bytes.extend(u64::from(crc32fast::hash(&bytes)).to_le_bytes());
        let mut rows = lock(&self.rows);
        let at = rows.end;
        rows.file.seek(SeekFrom::Start(at))?;
        rows.file.write_all(&bytes)?;
        rows.end += bytes.len() as u64;
        enter(&mut rows.places, mark, key, Place { at, count });
        Ok(())
    }

    /// How many numbers there are under a key.
    pub fn count(&self, key: Key) -> usize {
        lock(&self.rows).places.get(&key).map_or(0, |places| places.iter().map(|place| place.count).sum())
    }

    /// The keys under which there is something, in their order.
    pub fn keys(&self) -> Vec<Key> {
        lock(&self.rows).places.keys().copied().collect()
    }

    /// The numbers under a key, as they were added, piece by piece.
    pub fn pieces(&self, key: Key) -> impl Iterator<Item = io::Result<Vec<f64>>> {
        let places = lock(&self.rows).places.get(&key).cloned().unwrap_or_default();
        places.into_iter().map(|Place { at, count }| {
            let mut bytes = vec![0; (FRAME + count) * BYTES];
            let mut rows = lock(&self.rows);
            rows.file.seek(SeekFrom::Start(at))?;
            rows.file.read_exact(&mut bytes)?;
            drop(rows);
            let numbers = checked(&bytes).ok_or(ErrorKind::InvalidData)?;
            Ok(numbers.iter().map(|number| f64::from_bits(*number)).collect())
        })
    }
}

fn enter(places: &mut BTreeMap<Key, Vec<Place>>, mark: u64, key: Key, place: Place) {
    if mark == MARKS[1] {
        places.remove(&key);
    } else {
        places.entry(key).or_default().push(place);
    }
}

/// The numbers of a record by their bits, if it is whole.
fn checked(bytes: &[u8]) -> Option<Vec<u64>> {
    let (content, sum) = bytes.split_last_chunk::<BYTES>()?;
    let words = || content.as_chunks::<BYTES>().0.iter().copied().map(u64::from_le_bytes);
    let is_whole = u64::from_le_bytes(*sum) == u64::from(crc32fast::hash(content));
    is_whole.then(|| words().skip(HEAD).collect())
}

/// Finds the records behind a place: where they are, where the last one ends, and how many pieces between them are damaged.
fn scan(file: &File, start: u64) -> io::Result<(BTreeMap<Key, Vec<Place>>, u64, u64)> {
    let length = file.metadata()?.len();
    let mut reader = BufReader::with_capacity(1 << 16, file);
    reader.seek(SeekFrom::Start(start))?;
    let (mut places, mut at, mut end, mut damaged) = (BTreeMap::new(), start, start, 0);
    let frame = (FRAME * BYTES) as u64;
    while at + frame <= length {
        let mut bytes = vec![0; HEAD * BYTES];
        reader.read_exact(&mut bytes)?;
        let word = |i: usize| u64::from_le_bytes(std::array::from_fn(|byte| bytes[i * BYTES + byte]));
        let (mark, count, key) = (word(0), word(1), [word(2), word(3)]);
        let room = (length - at - frame) / BYTES as u64;
        let mut back = (HEAD - 1) * BYTES;
        if MARKS.contains(&mark) && count <= room {
            let rest = (count as usize + 1) * BYTES;
            bytes.resize(HEAD * BYTES + rest, 0);
            reader.read_exact(&mut bytes[HEAD * BYTES..])?;
            if checked(&bytes).is_some() {
                damaged += u64::from(at > end);
                enter(&mut places, mark, key, Place { at, count: count as usize });
                at += bytes.len() as u64;
                end = at;
                continue;
            }
            back += rest;
        }
        // The next mark may be anywhere behind this word.
        reader.seek_relative(-(back as i64))?;
        at += BYTES as u64;
    }
    Ok((places, end, damaged))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    const RECORDS: [(Key, &[f64]); 4] =
        [([1, 7], &[3.0, -0.0, 1e-300]), ([1, 8], &[]), ([2, 7], &[f64::INFINITY; 40]), ([1, 7], &[5.0])];

    fn all(log: &Log) -> Vec<(Key, Vec<u64>)> {
        let bits = |piece: io::Result<Vec<f64>>| piece.unwrap().into_iter().map(f64::to_bits);
        log.keys().into_iter().map(|key| (key, log.pieces(key).flat_map(bits).collect())).collect()
    }

    /// What is found of records of which some are whole.
    fn expected(is_whole: impl Fn(usize) -> bool) -> Vec<(Key, Vec<u64>)> {
        let mut found: BTreeMap<Key, Vec<u64>> = BTreeMap::new();
        for (_, (key, numbers)) in RECORDS.iter().enumerate().filter(|(i, _)| is_whole(*i)) {
            found.entry(*key).or_default().extend(numbers.iter().map(|number| number.to_bits()));
        }
        found.into_iter().collect()
    }

    #[test]
    fn identical_rows_come_back_however_the_file_is_torn_or_damaged() {
        let desk = tempfile::tempdir().unwrap();
        let path = desk.path().join("log");
        let mut ends = vec![6];
        let log = Log::open(&path, "mine").unwrap();
        assert_eq!(Log::open(&path, "mine").unwrap_err().kind(), ErrorKind::WouldBlock);
        for (key, numbers) in RECORDS {
            log.append(key, numbers.iter().copied()).unwrap();
            ends.push(fs::metadata(&path).unwrap().len() as usize);
        }
        ends[0] = "mine\n".len();
        assert_eq!(all(&log), expected(|_| true));
        drop(log);
        let whole = fs::read(&path).unwrap();
        for torn in ends[0]..whole.len() {
            fs::write(&path, &whole[..torn]).unwrap();
            let log = Log::open(&path, "mine").unwrap();
            assert_eq!((all(&log), log.damaged), (expected(|i| ends[i + 1] <= torn), 0), "{torn}");
            // What comes now stands behind what is whole.
            log.append([9, 9], [1.5]).unwrap();
            drop(log);
            assert_eq!(Log::open(&path, "mine").unwrap().count([9, 9]), 1);
        }
        for flipped in ends[0]..whole.len() {
            let mut bytes = whole.clone();
            bytes[flipped] ^= 0x10;
            fs::write(&path, &bytes).unwrap();
            let log = Log::open(&path, "mine").unwrap();
            let damaged = ends.iter().filter(|end| **end <= flipped).count() - 1;
            let is_last = damaged + 1 == RECORDS.len();
            // A damaged end looks like a torn one.
            let told = (all(&log), log.damaged);
            assert_eq!(told, (expected(|i| i != damaged), u64::from(!is_last)), "{flipped}");
        }
        fs::write(&path, &whole).unwrap();
        assert_eq!(all(&Log::open(&path, "other").unwrap()), []);
    }

    #[test]
    fn what_is_forgotten_stays_forgotten() {
        let desk = tempfile::tempdir().unwrap();
        let path = desk.path().join("log");
        let log = Log::open(&path, "mine").unwrap();
        [[1, 1], [1, 2]].map(|key| log.append(key, [1.0, 2.0]).unwrap());
        log.forget([1, 1]).unwrap();
        log.append([1, 1], [3.0]).unwrap();
        drop(log);
        let log = Log::open(&path, "mine").unwrap();
        assert_eq!(([log.count([1, 1]), log.count([1, 2])], log.damaged), ([1, 2], 0));
    }
}
