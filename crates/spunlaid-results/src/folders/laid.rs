//! Reads back what the fibres of a finished run have laid.

use crate::Failure;
use crate::output::laid::LAID;
use parquet::column::reader::ColumnReader;
use parquet::errors::{ParquetError, Result as Decoded};
use parquet::file::reader::{FileReader, SerializedFileReader};
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;

/// The columns that are read: number of the replicate, and place on the belt.
const COLUMNS: [&str; 3] = ["replicate", "md_m", "cd_m"];

/// The points [md, cd] of each replicate [m], in the order of feed.
///
/// # Errors
/// If the folder has no table of laid points, or one that cannot be read.
pub(super) fn read(folder: &Path) -> Result<Vec<Vec<[f64; 2]>>, Failure> {
    let not_a_run =
        |reason: String| Failure::NotARun { folder: folder.to_owned(), reason: format!("{LAID}: {reason}") };
    let file = File::open(folder.join(LAID)).map_err(|error| not_a_run(error.to_string()))?;
    let curves = decode(file).map_err(|error| not_a_run(error.to_string()))?;
    Ok(curves.into_values().collect())
}

fn decode(file: File) -> Decoded<BTreeMap<i64, Vec<[f64; 2]>>> {
    let reader = SerializedFileReader::new(file)?;
    let schema = reader.metadata().file_metadata().schema_descr();
    let missing = |name: &str| ParquetError::General(format!("it has no column {name} of numbers"));
    let column = |name: &str| {
        let at = schema.columns().iter().position(|column| column.name() == name);
        at.ok_or_else(|| missing(name))
    };
    let [replicate, md, cd] = COLUMNS.map(column);
    let (replicate, md, cd) = (replicate?, md?, cd?);
    let mut curves: BTreeMap<i64, Vec<[f64; 2]>> = BTreeMap::new();
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group)?;
        let rows = usize::try_from(group.metadata().num_rows()).map_err(|_| missing("rows"))?;
        let mut replicates = Vec::new();
        match group.get_column_reader(replicate)? {
            ColumnReader::Int64ColumnReader(mut of) => of.read_records(rows, None, None, &mut replicates)?,
            _ => return Err(missing(COLUMNS[0])),
        };
        let numbers = |at: usize, name: &str| {
            let mut numbers = Vec::new();
            match group.get_column_reader(at)? {
                ColumnReader::DoubleColumnReader(mut of) => {
                    of.read_records(rows, None, None, &mut numbers)?
                }
                _ => return Err(missing(name)),
            };
            Ok(numbers)
        };
        let (md, cd) = (numbers(md, COLUMNS[1])?, numbers(cd, COLUMNS[2])?);
        for ((replicate, md), cd) in replicates.into_iter().zip(md).zip(cd) {
            curves.entry(replicate).or_default().push([md, cd]);
        }
    }
    Ok(curves)
}
