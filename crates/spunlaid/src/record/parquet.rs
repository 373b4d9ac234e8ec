//! Reads records in Parquet: plain columns of numbers, and of times.

use super::columns::{Column, roles};
use super::rows::Rows;
use super::{Layout, Record};
use crate::error::{Fault, FileError, Position};
use crate::table::{FirstCell, Head, Meaning, NumberColumn, PageGuard, durations};
use crate::units::excerpt;
use bytes::Bytes;
use parquet::errors::ParquetError;
use parquet::file::metadata::{ParquetMetaData, ParquetMetaDataReader};
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
    let meanings = meanings(&metadata);
    let first: Vec<FirstCell> = meanings.iter().map(first_cell).collect();
    let mut roles = roles(&heads, true, &first, layout)?;
    let meaning_of = |column: &Column| {
        meanings[column.index].clone().and_then(|meaning| match meaning {
            Meaning::Time(_) if !column.stamped => Err("times".to_owned()),
            meaning => Ok(meaning),
        })
    };
    if let Some(time) = &mut roles.time
        && let Ok(Meaning::Time(unit)) = meanings[time.index]
    {
        time.factor = unit;
    }
    let used: Vec<Column> = roles.time.iter().chain(&roles.components).cloned().collect();
    let timed = roles.time.is_some();
    let mut rows = Rows::new(roles, layout);
    let source = Arc::new(PageGuard(source));
    let (mut row, mut origin) = (0, None);
    for group in 0..metadata.num_row_groups() {
        let mut columns = Vec::new();
        for column in &used {
            let refused = |found: String| {
                let remedy = "a plain column of floating-point, whole or decimal numbers is needed, or of times where it gives the time";
                FileError::from(Fault::new(format!("holds {found}"), remedy)).column(&column.header)
            };
            let meaning = meaning_of(column).map_err(refused)?;
            let mut values = NumberColumn::open(&source, &metadata, group, column.index, meaning)
                .map_err(|error| undecodable(error).column(&column.header))?;
            values.origin = origin.filter(|_| column.stamped);
            columns.push(values);
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
            if timed {
                origin = columns[0].origin;
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

/// What each column holds; the error names what is no number.
fn meanings(metadata: &ParquetMetaData) -> Vec<Result<Meaning, String>> {
    let about = metadata.file_metadata();
    let schema =
        about.key_value_metadata().and_then(|entries| entries.iter().find(|e| e.key == "ARROW:schema"));
    let durations = schema.and_then(|entry| entry.value.as_deref()).map_or_else(Vec::new, durations);
    let duration = |name: &str| durations.iter().find(|(column, _)| column == name).map(|(_, unit)| *unit);
    let columns = about.schema_descr().columns().iter();
    columns.map(|column| Meaning::of(column, duration(&column.path().string()))).collect()
}

fn first_cell(meaning: &Result<Meaning, String>) -> FirstCell {
    match meaning {
        Ok(Meaning::Time(_)) => FirstCell::Stamp,
        _ => FirstCell::Number,
    }
}

/// The fault of a file that cannot be decoded.
fn unreadable(message: &str) -> Fault {
    Fault::new(
        format!("is not a readable Parquet file: {message}"),
        "write it with Snappy compression or without compression",
    )
}
