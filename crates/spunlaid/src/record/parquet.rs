//! Reads records in Parquet: plain columns of doubles, floats or integers.

use super::columns::{Column, roles};
use super::rows::Rows;
use super::{Layout, Record};
use crate::error::{Fault, FileError, Position};
use crate::table::{Head, NumberColumn, PageGuard};
use crate::units::excerpt;
use bytes::Bytes;
use parquet::errors::ParquetError;
use parquet::file::metadata::ParquetMetaDataReader;
use std::sync::Arc;

/// First bytes of a Parquet file.
pub(super) const MAGIC: &[u8] = b"PAR1";
/// Rows read at a time.
const ROWS: usize = 1 << 13;

/// Reads a record; messages call it `name`.
pub(super) fn parse(bytes: Bytes, name: &str, layout: &Layout) -> Result<Record, FileError> {
    let checksum = crc32fast::hash(&bytes);
    let mut record = read(bytes, layout).map_err(|error| error.file(name))?;
    name.clone_into(&mut record.file);
    record.reading.checksum = checksum;
    Ok(record)
}

fn read(source: Bytes, layout: &Layout) -> Result<Record, FileError> {
    let undecodable = |error: ParquetError| FileError::from(unreadable(&excerpt(&error.to_string(), 200)));
    let metadata = ParquetMetaDataReader::new().parse_and_finish(&source).map_err(undecodable)?;
    let schema = metadata.file_metadata().schema_descr();
    let heads: Vec<Head> = schema.columns().iter().map(|column| Head::new(&column.path().string())).collect();
    let roles = roles(&heads, true, &[], layout)?;
    let used: Vec<Column> = roles.time.iter().chain(&roles.components).cloned().collect();
    let timed = roles.time.is_some();
    let mut rows = Rows::new(roles, layout);
    let source = Arc::new(PageGuard(source));
    let mut row = 0;
    for group in 0..metadata.num_row_groups() {
        let mut columns = Vec::new();
        for column in &used {
            let values = NumberColumn::open(&source, &metadata, group, column.index)
                .map_err(undecodable)
                .and_then(|values| {
                    values.map_err(|found| {
                        Fault::new(
                            format!("holds {found}"),
                            "a plain column of doubles, floats or integers is needed",
                        )
                        .into()
                    })
                });
            columns.push(values.map_err(|error| error.column(&column.header))?);
        }
        loop {
            let place = Position::Row(row + 1);
            for (values, column) in columns.iter_mut().zip(&used) {
                values.next(ROWS).map_err(|error| undecodable(error).at(place).column(&column.header))?;
            }
            let count = columns.first().map_or(0, |values| values.numbers.len());
            if let Some(short) = columns.iter().position(|values| values.numbers.len() != count) {
                let error = FileError::from(unreadable("its columns differ in length")).at(place);
                return Err(error.column(&used[short].header));
            }
            if count == 0 {
                break;
            }
            for i in 0..count {
                row += 1;
                let place = Position::Row(row);
                let number = |column: usize| columns[column].numbers[i];
                if let Some(infinite) = (0..used.len()).find(|&column| number(column).is_infinite()) {
                    let fault = Fault::infinite(&number(infinite).to_string());
                    return Err(FileError::from(fault).at(place).column(&used[infinite].header));
                }
                let time =
                    if timed { (number(0), columns[0].last_place(number(0))) } else { (f64::NAN, 0.0) };
                let mut values = [f64::NAN; 3];
                for (value, column) in values.iter_mut().zip(usize::from(timed)..used.len()) {
                    *value = number(column);
                }
                rows.push(place, time, &values)?;
            }
        }
    }
    if row == 0 {
        return Err(Fault::no_rows().into());
    }
    rows.finish()
}

/// The fault of a file that cannot be decoded.
fn unreadable(message: &str) -> Fault {
    Fault::new(
        format!("is not a readable Parquet file: {message}"),
        "write it with Snappy compression or without compression",
    )
}
