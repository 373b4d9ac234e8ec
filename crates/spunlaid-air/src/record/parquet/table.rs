//! Reads columns of numbers from Parquet.

use super::logical::{Meaning, durations};
use bytes::Bytes;
use parquet::basic::Encoding;
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl, get_column_reader};
use parquet::data_type::DataType;
use parquet::errors::{ParquetError, Result as Decoded};
use parquet::file::metadata::{ParquetMetaData, ParquetMetaDataReader};
use parquet::file::reader::{ChunkReader, Length};
use parquet::file::serialized_reader::SerializedPageReader;
use std::io::Read;
use std::sync::Arc;

/// Largest number of bytes that Snappy makes of one: a copy of 64 bytes takes three.
const EXPANSION: u64 = 22;
/// Largest number of rows of a group.
const MOST_ROWS: usize = 1 << 28;

/// A Parquet file, whose columns are read group by group.
pub(super) struct ParquetTable {
    source: Arc<PageGuard>,
    metadata: ParquetMetaData,
}

impl ParquetTable {
    pub(super) fn open(bytes: Bytes) -> Decoded<Self> {
        let metadata = ParquetMetaDataReader::new().parse_and_finish(&bytes)?;
        Ok(Self { source: Arc::new(PageGuard(bytes)), metadata })
    }

    /// Number of the groups of rows.
    pub(super) fn groups(&self) -> usize {
        self.metadata.num_row_groups()
    }

    /// The name of each column, with what it holds; the error names what is no number.
    pub(super) fn columns(&self) -> Vec<(String, Result<Meaning, String>)> {
        let about = self.metadata.file_metadata();
        let schema =
            about.key_value_metadata().and_then(|entries| entries.iter().find(|e| e.key == "ARROW:schema"));
        let durations = schema.and_then(|entry| entry.value.as_deref()).map_or_else(Vec::new, durations);
        let columns = about.schema_descr().columns().iter().map(|column| (column.path().string(), column));
        let duration =
            |name: &str| durations.iter().find(|(column, _)| column == name).map(|(_, unit)| *unit);
        columns.map(|(name, column)| (name.clone(), Meaning::of(column, duration(&name)))).collect()
    }

    /// Opens a column of a group of rows.
    ///
    /// * `meaning` – as [`ParquetTable::columns`] finds it
    pub(super) fn column(&self, group: usize, index: usize, meaning: Meaning) -> Decoded<NumberColumn> {
        NumberColumn::open(&self.source, &self.metadata, group, index, meaning)
    }
}

/// A column of a row group while it is read.
pub(super) struct NumberColumn {
    reader: ColumnReader,
    nullable: bool,
    meaning: Meaning,
    /// The numbers read last; NaN if a value is missing. Times are counted from `origin`.
    pub(super) numbers: Vec<f64>,
    /// The first time of the file, from which times count.
    pub(super) origin: Option<i64>,
}

impl NumberColumn {
    fn open(
        source: &Arc<PageGuard>,
        metadata: &ParquetMetaData,
        group: usize,
        index: usize,
        meaning: Meaning,
    ) -> Decoded<Self> {
        let group = metadata.row_group(group);
        let chunk = group.columns().get(index).ok_or_else(|| missing("a column of a row group"))?;
        let about = chunk.column_descr_ptr();
        // The decoder does not check these.
        let places =
            [chunk.data_page_offset(), chunk.dictionary_page_offset().unwrap_or(0), chunk.compressed_size()];
        if places.iter().any(|place| *place < 0) {
            return Err(missing("the place of a column"));
        }
        let rows = usize::try_from(group.num_rows()).map_err(|_| missing("a number of rows"))?;
        let pages = SerializedPageReader::new(Arc::clone(source), chunk, rows.min(MOST_ROWS), None)?;
        let nullable = about.max_def_level() > 0;
        let reader = get_column_reader(about, Box::new(Pages { pages, dictionary: false }));
        Ok(Self { reader, nullable, meaning, numbers: Vec::new(), origin: None })
    }

    /// Reads up to `rows` rows.
    pub(super) fn next(&mut self, rows: usize) -> Decoded<()> {
        let Self { reader, nullable, meaning, numbers, origin } = self;
        let (nullable, meaning) = (*nullable, *meaning);
        numbers.clear();
        // Times count from the first, because a double does not hold all digits of nanoseconds since 1970.
        let mut since = |time: i64| time.wrapping_sub(*origin.get_or_insert(time)) as f64;
        match reader {
            ColumnReader::DoubleColumnReader(reader) => read_into(reader, rows, nullable, numbers, |x| *x),
            ColumnReader::FloatColumnReader(reader) => {
                read_into(reader, rows, nullable, numbers, |x| f64::from(*x))
            }
            ColumnReader::Int32ColumnReader(reader) => read_into(reader, rows, nullable, numbers, |x| {
                if meaning.is_time() { since(i64::from(*x)) } else { meaning.whole(i64::from(*x), 32) }
            }),
            ColumnReader::Int64ColumnReader(reader) => read_into(reader, rows, nullable, numbers, |x| {
                if meaning.is_time() { since(*x) } else { meaning.whole(*x, 64) }
            }),
            ColumnReader::Int96ColumnReader(reader) => {
                read_into(reader, rows, nullable, numbers, |x| since(x.to_nanos()))
            }
            ColumnReader::ByteArrayColumnReader(reader) => {
                read_into(reader, rows, nullable, numbers, |x| meaning.bytes(x.data()))
            }
            ColumnReader::FixedLenByteArrayColumnReader(reader) => {
                read_into(reader, rows, nullable, numbers, |x| meaning.bytes(x.data()))
            }
            ColumnReader::BoolColumnReader(_) => Ok(()),
        }
    }

    /// The unit of the last digit of a number of this column.
    pub(super) fn last_place(&self, number: f64) -> f64 {
        match &self.reader {
            ColumnReader::DoubleColumnReader(_) => number.abs() * f64::EPSILON,
            ColumnReader::FloatColumnReader(_) => number.abs() * f64::from(f32::EPSILON),
            _ => self.meaning.last_place(number),
        }
    }
}

fn read_into<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    rows: usize,
    nullable: bool,
    numbers: &mut Vec<f64>,
    mut number: impl FnMut(&T::T) -> f64,
) -> Decoded<()> {
    let (mut levels, mut values) = (Vec::new(), Vec::new());
    let (read, _, _) = reader.read_records(rows, nullable.then_some(&mut levels), None, &mut values)?;
    if !nullable {
        numbers.extend(values.iter().map(&mut number));
        return if numbers.len() == read { Ok(()) } else { Err(missing("a value")) };
    }
    let mut present = values.iter();
    for level in &levels {
        let value =
            if *level > 0 { number(present.next().ok_or_else(|| missing("a value"))?) } else { f64::NAN };
        numbers.push(value);
    }
    Ok(())
}

/// Checks the pages before they reach the decoder.
struct Pages {
    pages: SerializedPageReader<PageGuard>,
    /// Whether a dictionary has been read.
    dictionary: bool,
}

impl PageReader for Pages {
    fn get_next_page(&mut self) -> Decoded<Option<Page>> {
        let page = self.pages.get_next_page()?;
        if let Some(page) = &page {
            self.dictionary |= page.is_dictionary_page();
            let by_dictionary =
                matches!(page.encoding(), Encoding::RLE_DICTIONARY | Encoding::PLAIN_DICTIONARY);
            if by_dictionary && !self.dictionary {
                return Err(missing("a dictionary"));
            }
        }
        Ok(page)
    }

    fn peek_next_page(&mut self) -> Decoded<Option<PageMetadata>> {
        self.pages.peek_next_page()
    }

    fn skip_next_page(&mut self) -> Decoded<()> {
        self.pages.skip_next_page()
    }
}

impl Iterator for Pages {
    type Item = Decoded<Page>;

    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}

fn missing(what: &str) -> ParquetError {
    ParquetError::EOF(format!("{what} is missing"))
}

/// Refuses pages that state an impossible size, because the decoder allocates the memory that a header states before
/// it reads the page.
struct PageGuard(Bytes);

impl Length for PageGuard {
    fn len(&self) -> u64 {
        self.0.len() as u64
    }
}

impl ChunkReader for PageGuard {
    type T = std::io::Chain<std::io::Cursor<Vec<u8>>, <Bytes as ChunkReader>::T>;

    /// Called where a page's header begins.
    fn get_read(&self, start: u64) -> Decoded<Self::T> {
        let mut source = self.0.get_read(start)?;
        let mut head = Vec::new();
        source.by_ref().take(24).read_to_end(&mut head)?;
        let (uncompressed, compressed) = page_sizes(&head).ok_or_else(|| missing("a page’s header"))?;
        if uncompressed > compressed.saturating_mul(EXPANSION).saturating_add(64) {
            return Err(ParquetError::General(format!(
                "a page of {compressed} bytes states that it holds {uncompressed}, which is more than Snappy \
                can compress into it"
            )));
        }
        Ok(std::io::Cursor::new(head).chain(source))
    }

    fn get_bytes(&self, start: u64, length: usize) -> Decoded<Bytes> {
        let end = start.checked_add(length as u64).filter(|end| *end <= self.len());
        end.ok_or_else(|| missing("the end of a page"))?;
        self.0.get_bytes(start, length)
    }
}

/// Reads the uncompressed and the compressed size from the start of a page's header. It begins with fields 1 to 3 in
/// Thrift's compact form, each a byte 0x15 and a zigzag number of 32 bits.
fn page_sizes(head: &[u8]) -> Option<(u64, u64)> {
    let mut bytes = head.iter().copied();
    let mut field = || {
        (bytes.next()? == 0x15).then_some(())?;
        let mut value = 0u64;
        for shift in (0..35).step_by(7) {
            let byte = bytes.next()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return (value & 1 == 0).then_some(value >> 1);
            }
        }
        None
    };
    let _kind = field()?;
    let uncompressed = field()?;
    let compressed = field()?;
    Some((uncompressed, compressed))
}

#[cfg(test)]
mod tests {
    use super::page_sizes;

    #[test]
    fn sizes_stand_at_the_start_of_a_header() {
        // Kind 0, 300 bytes from 150.
        assert_eq!(page_sizes(&[0x15, 0, 0x15, 0xd8, 0x04, 0x15, 0xac, 0x02, 0x2c]), Some((300, 150)));
        assert_eq!(page_sizes(&[0x15, 0, 0x15, 0xd8]), None);
        // Negative.
        assert_eq!(page_sizes(&[0x15, 0, 0x15, 1, 0x15, 2]), None);
        assert_eq!(page_sizes(&[]), None);
    }
}
