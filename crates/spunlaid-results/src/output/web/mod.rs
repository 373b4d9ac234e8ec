//! The files of a web's results folder.

mod map;
mod strands;
mod summary;

pub use map::light_table;
pub use summary::{Layer, Performance, Summary};

use super::folder::Staging;
use super::origin::ORIGIN;
use super::spinline::STATIONS;
use crate::Failure;
use spunlaid::web::{Findings, Map, Strand};

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

/// Writes the map and the fibres of the window.
pub fn write(staging: &Staging<'_>, findings: &Findings, strands: &[Strand]) -> Result<(), Failure> {
    map::write(staging, &findings.laid.map)?;
    strands::write(staging, strands)
}

/// Writes the map of a scan, as an array only.
pub fn write_scan(staging: &Staging<'_>, map: &Map) -> Result<(), Failure> {
    map::write_array(staging, map)
}
