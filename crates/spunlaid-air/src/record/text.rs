//! Reads records from text tables.

use super::columns::{Column, roles};
use super::rows::Rows;
use super::{Layout, Record};
use spunlaid_ground::units::excerpt;
use spunlaid_ground::{FORMS, Fault, FileError, FileKind, Stamp, Table};
use std::io::Read;

/// Reads a record from text; messages call it `name`.
///
/// # Errors
/// When the text is not an evenly sampled velocity record; the message says where and why.
pub fn parse_csv(source: impl Read, name: &str, layout: &Layout) -> Result<Record, FileError> {
    let mut source = ChecksumReader { source, sum: crc32fast::Hasher::new() };
    let mut record = read(&mut source, layout).map_err(|error| error.file(name))?;
    name.clone_into(&mut record.file);
    record.reading.checksum = source.sum.finalize();
    Ok(record)
}

fn read(source: impl Read, layout: &Layout) -> Result<Record, FileError> {
    let mut table = Table::open(source, FileKind::Record, layout.skip_lines)?;
    let roles = roles(table.heads(), table.named(), &table.first_row(), layout)?;
    let time = roles.time.as_ref().map(|column| (column.index, column.stamped));
    let mut clock = Clock::default();
    let components: Vec<usize> = roles.components.iter().map(|column: &Column| column.index).collect();
    let mut rows = Rows::new(roles, layout);
    let mut values = vec![f64::NAN; components.len()];
    while table.next_row()? {
        // Without a column of time an empty line is a missing sample.
        let missing = if time.is_none() { table.blank_lines() } else { 0 };
        for _ in 0..missing {
            rows.push(table.place(), f64::NAN, f64::NAN, &[])?;
        }
        let (time, unit) = match time {
            Some((column, true)) => clock.read(&mut table, column)?,
            Some((column, false)) => (table.number(column)?, table.last_place(column)),
            None => (f64::NAN, f64::INFINITY),
        };
        for (value, column) in values.iter_mut().zip(&components) {
            *value = table.number(*column)?;
        }
        rows.push(table.place(), time, unit, &values)?;
    }
    rows.finish()
}

/// The time since the first of the stamps of a column.
#[derive(Default)]
struct Clock {
    last: Option<Stamp>,
    elapsed: f64,
}

impl Clock {
    /// Time of a row and unit of its last digit [s]; NaN if it is missing.
    fn read<R: Read>(&mut self, table: &mut Table<R>, column: usize) -> Result<(f64, f64), FileError> {
        if let Some(stamp) = table.stamp(column) {
            self.elapsed += self.last.map_or(0.0, |last| stamp.since(last));
            self.last = Some(stamp);
            return Ok((self.elapsed, stamp.last_place));
        }
        if table.number(column).is_ok_and(f64::is_nan) {
            return Ok((f64::NAN, f64::INFINITY));
        }
        let message =
            format!("\"{}\" is not a time stamp as in the rows above", excerpt(table.text(column), 40));
        let remedy = format!("write it as {FORMS}");
        Err(table.blame(column, Fault::new(message, remedy)))
    }
}

/// Computes the checksum of what is read.
struct ChecksumReader<R> {
    source: R,
    sum: crc32fast::Hasher,
}

impl<R: Read> Read for ChecksumReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let read = self.source.read(buffer)?;
        self.sum.update(buffer.get(..read).unwrap_or_default());
        Ok(read)
    }
}
