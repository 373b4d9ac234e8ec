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
use std::io::{self, BufReader, Cursor, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Under which rows are found again.
pub(crate) type Key = [u64; 2];

/// Bytes of a number, and of all else.
const BYTES: usize = size_of::<u64>();
/// Words before the numbers of a record, and with its checksum.
const HEAD: usize = 4;
const FRAME: usize = HEAD + 1;
/// At the beginning of a record; the second one says that what was under its key before counts no longer.
const MARKS: [u64; 2] = [u64::from_le_bytes(*b"spunlaid"), u64::from_le_bytes(*b"spunanew")];

/// Rows in a file that this process has locked, or in memory. Several threads may use them.
#[derive(Debug)]
pub struct Log {
    rows: Mutex<Rows>,
    /// The file too, to shorten it and to flush it to the disk.
    file: Option<File>,
    /// Damaged pieces that were found; what they held has to be made again.
    pub damaged: u64,
    /// Whether the last record was incomplete; it has been removed.
    pub torn: bool,
}

#[derive(Debug)]
struct Rows {
    store: Box<dyn Store>,
    /// Where the next record begins.
    end: u64,
    places: Places,
}

type Places = BTreeMap<Key, Records>;

/// The records of a key: the first one and those behind it. A key with one record, as most of a study are, has no list:
/// a small piece of memory for each would lie between the large ones of flights, which could not be used again.
#[derive(Debug)]
struct Records {
    first: RowPlace,
    more: Option<Box<More>>,
}

#[derive(Debug, Default)]
struct More(Vec<RowPlace>);

impl Records {
    fn all(&self) -> impl Iterator<Item = RowPlace> {
        let more = self.more.iter().flat_map(|more| &more.0);
        std::iter::once(self.first).chain(more.copied())
    }
}

/// What holds the bytes.
trait Store: Read + Write + Seek + std::fmt::Debug + Send {}
impl<T: Read + Write + Seek + std::fmt::Debug + Send> Store for T {}

/// Where a record begins, and how many numbers it has.
#[derive(Clone, Copy, Debug)]
struct RowPlace {
    at: u64,
    count: usize,
}

impl Log {
    /// Nothing yet, in memory.
    pub fn in_memory() -> Self {
        Self::of(Box::new(Cursor::new(Vec::new())), None)
    }

    /// Opens a file, creates it if it does not exist, and locks it until this is dropped. What belongs to another
    /// identity is removed.
    ///
    /// # Errors
    /// If another process uses it ([`ErrorKind::WouldBlock`]), or it cannot be read or written.
    pub fn open(path: &Path, identity: &str) -> io::Result<Self> {
        let mut log = Self::lock(path)?;
        let line = format!("{identity}\n");
        match log.head(line.len())? == line.as_bytes() {
            true => log.go_on(line.len() as u64)?,
            false => log.begin(&line)?,
        }
        Ok(log)
    }

    /// Opens and locks a file, to [begin](Log::begin) or to [go on](Log::go_on) with it.
    ///
    /// # Errors
    /// Those of [`Log::open`].
    pub fn lock(path: &Path) -> io::Result<Self> {
        let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)?;
        match file.try_lock() {
            Ok(()) => {}
            // Some file systems have no locks; the user must then start one process only.
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(error),
            Err(TryLockError::WouldBlock) => return Err(ErrorKind::WouldBlock.into()),
        }
        Ok(Self::of(Box::new(file.try_clone()?), Some(file)))
    }

    fn of(store: Box<dyn Store>, file: Option<File>) -> Self {
        let rows = Rows { store, end: 0, places: Places::new() };
        Self { rows: Mutex::new(rows), file, damaged: 0, torn: false }
    }

    /// The first bytes of the file, so many at most.
    ///
    /// # Errors
    /// If they cannot be read.
    pub fn head(&self, most: usize) -> io::Result<Vec<u8>> {
        let mut head = Vec::new();
        if let Some(mut file) = self.file.as_ref() {
            file.rewind()?;
            file.take(most as u64).read_to_end(&mut head)?;
        }
        Ok(head)
    }

    /// Removes everything, and writes the identity, a line, so that it survives a power cut.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn begin(&mut self, line: &str) -> io::Result<()> {
        let rows = unlocked(&mut self.rows);
        (rows.end, rows.places) = (0, Places::new());
        if let Some(file) = &self.file {
            file.set_len(0)?;
            rows.store.rewind()?;
            rows.store.write_all(line.as_bytes())?;
            rows.end = line.len() as u64;
            file.sync_all()?;
        }
        Ok(())
    }

    /// Finds the records behind the identity, and cuts off what is incomplete.
    ///
    /// * `start` – length of the identity [bytes]
    ///
    /// # Errors
    /// If the file cannot be read or shortened.
    pub fn go_on(&mut self, start: u64) -> io::Result<()> {
        if let Some(file) = &self.file {
            let rows = unlocked(&mut self.rows);
            (rows.places, rows.end, self.damaged, self.torn) = scan(file, start)?;
            file.set_len(rows.end)?;
        }
        Ok(())
    }

    /// Leaves out the keys that are none. Returns how many there were.
    pub fn retain(&mut self, is_one: impl Fn(Key) -> bool) -> u64 {
        let places = &mut unlocked(&mut self.rows).places;
        let before = places.len();
        places.retain(|key, _| is_one(*key));
        (before - places.len()) as u64
    }

    /// A second handle of the file, to flush it to the disk while rows are added.
    ///
    /// # Errors
    /// If the operating system cannot provide it.
    pub fn handle(&self) -> io::Result<Option<File>> {
        self.file.as_ref().map(File::try_clone).transpose()
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
        // Word by word: byte by byte it took longer than the disk.
        let mut words = [mark, 0, key[0], key[1]].map(u64::to_le_bytes).to_vec();
        words.extend(numbers.into_iter().map(f64::to_le_bytes));
        let count = words.len() - HEAD;
        words[1] = (count as u64).to_le_bytes();
        words.push(u64::from(crc32fast::hash(words.as_flattened())).to_le_bytes());
        let bytes = words.as_flattened();
        let mut rows = lock(&self.rows);
        let at = rows.end;
        rows.store.seek(SeekFrom::Start(at))?;
        rows.store.write_all(bytes)?;
        rows.end += bytes.len() as u64;
        enter(&mut rows.places, mark, key, RowPlace { at, count });
        Ok(())
    }

    /// How many numbers there are under a key.
    pub fn count(&self, key: Key) -> usize {
        lock(&self.rows).places.get(&key).map_or(0, |records| records.all().map(|place| place.count).sum())
    }

    /// The keys under which there is something, in their order.
    pub fn keys(&self) -> Vec<Key> {
        lock(&self.rows).places.keys().copied().collect()
    }

    /// The second parts of the keys with this first part, in their order.
    pub fn keys_of(&self, first: u64) -> Vec<u64> {
        let rows = lock(&self.rows);
        rows.places.range([first, 0]..=[first, u64::MAX]).map(|([_, second], _)| *second).collect()
    }

    /// The numbers under a key, as they were added, piece by piece.
    pub fn pieces(&self, key: Key) -> impl Iterator<Item = io::Result<Vec<f64>>> {
        let places: Vec<RowPlace> =
            lock(&self.rows).places.get(&key).into_iter().flat_map(Records::all).collect();
        places.into_iter().map(|RowPlace { at, count }| {
            let mut bytes = vec![0; (FRAME + count) * BYTES];
            let mut rows = lock(&self.rows);
            rows.store.seek(SeekFrom::Start(at))?;
            rows.store.read_exact(&mut bytes)?;
            drop(rows);
            let words = checked(&bytes).ok_or(ErrorKind::InvalidData)?.iter();
            Ok(words.map(|word| f64::from_le_bytes(*word)).collect())
        })
    }
}

fn unlocked(rows: &mut Mutex<Rows>) -> &mut Rows {
    rows.get_mut().unwrap_or_else(PoisonError::into_inner)
}

fn enter(places: &mut Places, mark: u64, key: Key, place: RowPlace) {
    if mark == MARKS[1] {
        places.remove(&key);
    } else {
        let more = |records: &mut Records| records.more.get_or_insert_default().0.push(place);
        places.entry(key).and_modify(more).or_insert(Records { first: place, more: None });
    }
}

/// The numbers of a record by their bytes, if it is whole.
fn checked(bytes: &[u8]) -> Option<&[[u8; BYTES]]> {
    let (content, sum) = bytes.split_last_chunk::<BYTES>()?;
    let is_whole = u64::from_le_bytes(*sum) == u64::from(crc32fast::hash(content));
    content.as_chunks().0.get(HEAD..).filter(|_| is_whole)
}

/// Finds the records behind a place: where they are, where the last one ends, how many damaged pieces there are, and
/// whether the last one is torn off.
fn scan(file: &File, start: u64) -> io::Result<(Places, u64, u64, bool)> {
    let length = file.metadata()?.len();
    let mut reader = BufReader::with_capacity(1 << 16, file);
    reader.seek(SeekFrom::Start(start))?;
    let mut places = Places::new();
    let mut at = start;
    let mut end = start;
    let mut damaged = 0;
    let mut torn = start < length;
    let frame = (FRAME * BYTES) as u64;
    while at + frame <= length {
        let mut bytes = vec![0; HEAD * BYTES];
        reader.read_exact(&mut bytes)?;
        let word = |i: usize| u64::from_le_bytes(std::array::from_fn(|byte| bytes[i * BYTES + byte]));
        let mark = word(0);
        let count = word(1);
        let key = [word(2), word(3)];
        let room = (length - at - frame) / BYTES as u64;
        let mut back = (HEAD - 1) * BYTES;
        // A whole record that ends the file is no torn one.
        torn = if at == end { count > room } else { torn };
        if MARKS.contains(&mark) && count <= room {
            let rest = (count as usize + 1) * BYTES;
            bytes.resize(HEAD * BYTES + rest, 0);
            reader.read_exact(&mut bytes[HEAD * BYTES..])?;
            if checked(&bytes).is_some() {
                damaged += u64::from(at > end);
                enter(&mut places, mark, key, RowPlace { at, count: count as usize });
                at += bytes.len() as u64;
                end = at;
                torn = at < length;
                continue;
            }
            back += rest;
        }
        // The next mark may be anywhere behind this word.
        reader.seek_relative(-(back as i64))?;
        at += BYTES as u64;
    }
    let is_rest = end < length;
    Ok((places, end, damaged + u64::from(is_rest && !torn), is_rest && torn))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// In memory it is the same.
    #[test]
    fn rows_in_memory_come_back() {
        let mut log = Log::in_memory();
        for (key, numbers) in RECORDS {
            log.append(key, numbers.iter().copied()).unwrap();
        }
        assert_eq!(all(&log), expected(|_| true));
        assert_eq!((log.keys_of(1), log.retain(|key| key[0] != 1), log.keys_of(1)), (vec![7, 8], 2, vec![]));
    }

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
            let reported = (all(&log), log.damaged, log.torn);
            assert_eq!(reported, (expected(|i| ends[i + 1] <= torn), 0, !ends.contains(&torn)), "{torn}");
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
            // An end whose count is damaged looks like a torn one.
            let reported = (all(&log), log.damaged + u64::from(log.torn));
            assert_eq!(reported, (expected(|i| i != damaged), 1), "{flipped}");
        }
        fs::write(&path, &whole).unwrap();
        assert_eq!(all(&Log::open(&path, "other").unwrap()), []);
    }

    #[test]
    fn what_is_forgotten_stays_forgotten() {
        let desk = tempfile::tempdir().unwrap();
        let path = desk.path().join("log");
        let log = Log::open(&path, "mine").unwrap();
        [[1, 1], [1, 2]].into_iter().for_each(|key| log.append(key, [1.0, 2.0]).unwrap());
        log.forget([1, 1]).unwrap();
        log.append([1, 1], [3.0]).unwrap();
        drop(log);
        let log = Log::open(&path, "mine").unwrap();
        assert_eq!(([log.count([1, 1]), log.count([1, 2])], log.damaged), ([1, 2], 0));
    }
}
