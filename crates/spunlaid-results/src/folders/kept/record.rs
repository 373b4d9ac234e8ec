//! Records of a file that grows: kind, count, numbers, checksum, all little-endian. A record that is torn off
//! ends the file.

use std::io::Read;

/// Bytes of a number, of the head of a record and of its checksum.
const BYTES: usize = size_of::<f64>();

/// What a record holds. Rows and columns are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A replicate, its first row and number of rows in each table, and its measures. Of each its index, and
    /// then: 0 and the value of a number; or one more than the number of places of a curve, the places and
    /// the values; or the negative of this and the values, where the places are those of a record of places.
    Landed = 1,
    /// A replicate, time and positions of one of its shapes.
    Shape,
    /// A replicate, and the laid points that are kept with its shapes.
    LaidWithShapes,
    /// A table and the rows of a group of it; of each column where it begins in the file, its length and its checksum.
    Group,
    /// A table, first row and number of rows, and the columns of these, one after another.
    Rows,
    /// The index of a measure that is a curve, and its places in most replicates.
    Places,
}

impl Kind {
    const ALL: [Self; 6] =
        [Self::Landed, Self::Shape, Self::LaidWithShapes, Self::Group, Self::Rows, Self::Places];
}

/// Adds a record.
pub(super) fn append(file: &mut Vec<u8>, kind: Kind, numbers: impl IntoIterator<Item = f64>) {
    let start = file.len();
    file.extend((kind as u64).to_le_bytes());
    file.extend([0; BYTES]);
    let first = file.len();
    numbers.into_iter().for_each(|number| file.extend(number.to_le_bytes()));
    let count = (file.len() - first) / BYTES;
    file[start + BYTES..first].copy_from_slice(&(count as u64).to_le_bytes());
    let sum = u64::from(crc32fast::hash(&file[start..]));
    file.extend(sum.to_le_bytes());
}

/// The next record; `None` if there is none that is whole.
pub(super) fn read(file: &mut impl Read) -> Option<(Kind, Vec<f64>)> {
    let mut bytes = Vec::new();
    let mut more = |bytes: &mut Vec<u8>, count: u64| {
        // A count that is damaged takes no more memory than the file is long.
        let read = file.by_ref().take(count).read_to_end(bytes).ok()? as u64;
        (read == count).then_some(())
    };
    more(&mut bytes, 2 * BYTES as u64)?;
    let [kind, count] = [word(&bytes, 0)?, word(&bytes, 1)?];
    more(&mut bytes, count.checked_add(1)?.checked_mul(BYTES as u64)?)?;
    let (content, _) = bytes.split_at_checked(bytes.len() - BYTES)?;
    if word(&bytes, count as usize + 2)? != u64::from(crc32fast::hash(content)) {
        return None;
    }
    let kind = Kind::ALL.into_iter().find(|known| *known as u64 == kind)?;
    let (words, _) = content[2 * BYTES..].as_chunks::<BYTES>();
    Some((kind, words.iter().copied().map(f64::from_le_bytes).collect()))
}

/// Bytes of a record with so many numbers.
pub(super) const fn length(numbers: usize) -> u64 {
    ((numbers + 3) * BYTES) as u64
}

fn word(bytes: &[u8], index: usize) -> Option<u64> {
    bytes.as_chunks::<BYTES>().0.get(index).copied().map(u64::from_le_bytes)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn identical_records_come_back_up_to_where_the_file_is_torn_or_damaged() {
        let all = [
            (Kind::Landed, vec![3.0, -0.0, 1e-300]),
            (Kind::Rows, Vec::new()),
            (Kind::Group, vec![f64::INFINITY; 700]),
        ];
        let (mut file, mut ends) = (Vec::new(), Vec::new());
        for (kind, numbers) in &all {
            append(&mut file, *kind, numbers.iter().copied());
            ends.push(file.len());
        }
        assert_eq!(ends[0] as u64, length(3));
        let back = |file: &[u8]| {
            let mut rest = file;
            std::iter::from_fn(|| read(&mut rest)).collect::<Vec<_>>()
        };
        assert_eq!(back(&file), all);
        for torn in 0..file.len() {
            let whole = ends.iter().filter(|end| **end <= torn).count();
            assert_eq!(back(&file[..torn]), all[..whole], "{torn}");
        }
        for damaged in 0..file.len() {
            let mut file = file.clone();
            file[damaged] ^= 0x10;
            let whole = ends.iter().filter(|end| **end <= damaged).count();
            assert_eq!(back(&file), all[..whole], "{damaged}");
        }
    }
}
