//! Reads back what the fibres of a finished run have laid.

use crate::error::Error;
use crate::flight::LaidPoint;
use parquet::column::reader::ColumnReader;
use parquet::errors::{ParquetError, Result as Decoded};
use parquet::file::reader::{FileReader, SerializedFileReader};
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;

/// The table of laid points in the folder of a run.
pub const LAID: &str = "laid.parquet";
/// The columns that are read: number of the replicate; length fed before a point, time of its touch-down, and place on the belt.
const COLUMNS: [&str; 5] = ["replicate", "s_m", "time_s", "md_m", "cd_m"];

/// The points of each replicate, in the order of feed.
///
/// # Errors
/// If the folder has no table of laid points, or one that cannot be read.
pub fn read(folder: &Path) -> Result<Vec<Vec<LaidPoint>>, Error> {
    let not_a_run = |reason: String| Error::not_a_run(folder, &format!("{LAID}: {reason}"));
    let file = File::open(folder.join(LAID)).map_err(|error| not_a_run(error.to_string()))?;
    let curves = decode(file).map_err(|error| not_a_run(error.to_string()))?;
    Ok(curves.into_values().collect())
}

fn decode(file: File) -> Decoded<BTreeMap<u64, Vec<LaidPoint>>> {
    let reader = SerializedFileReader::new(file)?;
    let schema = reader.metadata().file_metadata().schema_descr();
    let missing = |name: &str| ParquetError::General(format!("it has no column {name} of numbers"));
    let column = |name: &str| {
        let at = schema.columns().iter().position(|column| column.name() == name);
        at.ok_or_else(|| missing(name))
    };
    let [replicate, fed, time, md, cd] = COLUMNS.map(column);
    let (replicate, fed, time, md, cd) = (replicate?, fed?, time?, md?, cd?);
    let mut curves: BTreeMap<u64, Vec<LaidPoint>> = BTreeMap::new();
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group)?;
        let rows = usize::try_from(group.metadata().num_rows()).map_err(|_| missing("rows"))?;
        let mut replicates = Vec::new();
        match group.get_column_reader(replicate)? {
            ColumnReader::Int64ColumnReader(mut reader) => {
                reader.read_records(rows, None, None, &mut replicates)?
            }
            _ => return Err(missing(COLUMNS[0])),
        };
        let numbers = |at: usize, name: &str| {
            let mut numbers = Vec::new();
            match group.get_column_reader(at)? {
                ColumnReader::DoubleColumnReader(mut reader) => {
                    reader.read_records(rows, None, None, &mut numbers)?
                }
                _ => return Err(missing(name)),
            };
            Ok(numbers)
        };
        let (fed, time) = (numbers(fed, COLUMNS[1])?, numbers(time, COLUMNS[2])?);
        let (md, cd) = (numbers(md, COLUMNS[3])?, numbers(cd, COLUMNS[4])?);
        let points = fed.into_iter().zip(time).zip(md).zip(cd);
        for (replicate, (((fed, time), md), cd)) in replicates.into_iter().zip(points) {
            curves.entry(replicate as u64).or_default().push(LaidPoint { fed, time, md, cd });
        }
    }
    Ok(curves)
}
