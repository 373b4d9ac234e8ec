//! Reads back what the fibres of a finished run have laid.

use crate::error::Error;
use crate::flight::LaidPoint;
use crate::table::ParquetTable;
use parquet::errors::Result as Decoded;
use std::collections::BTreeMap;
use std::path::Path;

/// The table of laid points in the folder of a run.
pub const LAID: &str = "laid.parquet";
/// The columns that are read: number of the replicate; length fed before a point, time of its touch-down, and
/// place on the belt.
const COLUMNS: [&str; 5] = ["replicate", "s_m", "time_s", "md_m", "cd_m"];

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
    let table = ParquetTable::open(bytes.into())?;
    let [replicate, fed, time, md, cd] = COLUMNS.map(|name| table.numbers(name));
    let places = time?.into_iter().zip(md?).zip(cd?);
    let mut curves: BTreeMap<u64, Vec<LaidPoint>> = BTreeMap::new();
    for ((replicate, fed), ((time, md), cd)) in replicate?.into_iter().zip(fed?).zip(places) {
        curves.entry(replicate as u64).or_default().push(LaidPoint { fed, time, md, cd });
    }
    Ok(curves)
}
