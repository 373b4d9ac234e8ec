//! The files of a web's results folder.

mod advice;
mod map;
mod pieces;
mod strands;
mod summary;

pub(crate) use advice::HOUR;
pub use map::light_table;
pub use pieces::{MapFile, Pictures};
pub use summary::{Layer, Performance, Summary};

use super::folder::Staging;
use super::origin::ORIGIN;
use super::spinline::STATIONS;
use crate::Failure;
use spunlaid::web::{Map, Strand};

/// The contents of the folder. The last entry marks it as complete.
pub const ENTRIES: &[&str] = &[
    ORIGIN,
    "web.toml",
    "map.npy",
    "map.png",
    "map.parquet",
    "fibres.vtp",
    STATIONS,
    "figures",
    "report.html",
    "summary.json",
];

/// Most cells that are written as a table and as a picture; the array holds all.
pub const MOST_CELLS: usize = 20_000_000;

/// Writes the map as array, table and picture, each on a thread.
pub fn write_map(staging: &Staging<'_>, map: &Map) -> Result<(), Failure> {
    map::write(staging, map)
}

/// Writes the fibres of the window.
pub fn write_strands(staging: &Staging<'_>, strands: &[Strand]) -> Result<(), Failure> {
    strands::write(staging, strands)
}

/// Writes the map of a scan, as an array only.
pub fn write_scan(staging: &Staging<'_>, map: &Map) -> Result<(), Failure> {
    map::write_array(staging, map)
}
