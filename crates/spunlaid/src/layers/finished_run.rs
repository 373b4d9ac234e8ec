//! Reads back what the fibres of a finished run have laid.

use crate::error::Error;
use crate::flight::LaidPoint;
use crate::table::{Meaning, NumberColumn, PageGuard};
use parquet::errors::{ParquetError, Result as Decoded};
use parquet::file::metadata::ParquetMetaDataReader;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// The table of laid points in the folder of a run.
pub const LAID: &str = "laid.parquet";
/// The columns that are read: number of the replicate; length fed before a point, time of its touch-down, and place on the belt.
const COLUMNS: [&str; 5] = ["replicate", "s_m", "time_s", "md_m", "cd_m"];

/// Rows read at a time.
const ROWS: usize = 1 << 16;

/// The points of each replicate, in the order of feed.
///
/// # Errors
/// If the folder has no table of laid points, or one that cannot be read.
pub fn read(folder: &Path) -> Result<Vec<Vec<LaidPoint>>, Error> {
    let not_a_run = |reason: String| Error::not_a_run(folder, &format!("{LAID}: {reason}"));
    let bytes = std::fs::read(folder.join(LAID)).map_err(|error| not_a_run(error.to_string()))?;
    let curves = decode(bytes).map_err(|error| not_a_run(error.to_string()))?;
    Ok(curves.into_values().collect())
}

fn decode(bytes: Vec<u8>) -> Decoded<BTreeMap<u64, Vec<LaidPoint>>> {
    let source = PageGuard(bytes.into());
    let metadata = ParquetMetaDataReader::new().parse_and_finish(&source.0)?;
    let source = Arc::new(source);
    let about = metadata.file_metadata().schema_descr();
    let mut curves: BTreeMap<u64, Vec<LaidPoint>> = BTreeMap::new();
    for group in 0..metadata.num_row_groups() {
        let read = |name: &str| {
            let missing = || ParquetError::General(format!("it has no column {name} of numbers"));
            let index =
                about.columns().iter().position(|column| column.name() == name).ok_or_else(missing)?;
            let meaning = Meaning::of(&about.column(index), None).map_err(|_| missing())?;
            let mut column = NumberColumn::open(&source, &metadata, group, index, meaning)?;
            let mut numbers = Vec::new();
            loop {
                column.next(ROWS)?;
                if column.numbers.is_empty() {
                    return Ok::<_, ParquetError>(numbers);
                }
                // A missing value; it would count as replicate 0.
                if column.numbers.iter().any(|number| number.is_nan()) {
                    return Err(missing());
                }
                numbers.append(&mut column.numbers);
            }
        };
        let [replicate, fed, time, md, cd] = COLUMNS.map(read);
        let places = time?.into_iter().zip(md?).zip(cd?);
        for ((replicate, fed), ((time, md), cd)) in replicate?.into_iter().zip(fed?).zip(places) {
            curves.entry(replicate as u64).or_default().push(LaidPoint { fed, time, md, cd });
        }
    }
    Ok(curves)
}
