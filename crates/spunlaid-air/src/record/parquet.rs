//! Reads records in Parquet: plain columns of numbers, and of times.

mod logical;
mod table;

use super::columns::{Column, roles};
use super::rows::Rows;
use super::{Layout, Record};
use bytes::Bytes;
use logical::Meaning;
use parquet::errors::ParquetError;
use spunlaid_ground::units::excerpt;
use spunlaid_ground::{Fault, FileError, FirstCell, Head, Position};
use table::ParquetTable;

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
    let table = ParquetTable::open(source).map_err(undecodable)?;
    let (names, meanings): (Vec<String>, Vec<Result<Meaning, String>>) = table.columns().into_iter().unzip();
    let heads: Vec<Head> = names.iter().map(|name| Head::new(name)).collect();
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
    let (mut row, mut origin) = (0, None);
    for group in 0..table.groups() {
        let mut columns = Vec::new();
        for column in &used {
            let refused = |found: String| {
                let remedy = "a plain column of floating-point, whole or decimal numbers is needed, or of \
                    times where it gives the time";
                FileError::from(Fault::new(format!("holds {found}"), remedy)).column(&column.header)
            };
            let meaning = meaning_of(column).map_err(refused)?;
            let mut values = table
                .column(group, column.index, meaning)
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
                let (time, unit) =
                    if timed { (number(0), columns[0].last_place(number(0))) } else { (f64::NAN, 0.0) };
                let mut values = [f64::NAN; 3];
                for (value, column) in values.iter_mut().zip(usize::from(timed)..used.len()) {
                    *value = number(column);
                }
                rows.push(place, time, unit, &values)?;
            }
        }
    }
    if row == 0 {
        return Err(Fault::no_rows().into());
    }
    rows.finish()
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
