//! The files of a web's results folder.

mod clouds;
mod effects;
mod fabric;
mod map;
mod pieces;
mod sheet;
mod summary;

pub use clouds::with_clouds;
pub(crate) use effects::HOUR;
pub use fabric::{fabric_rows, known_text};
pub use map::{light_table, write as write_map, write_array as write_scan};
pub use pieces::{MapFile, Pictures};
pub use sheet::specification_sheet;
pub use summary::{Layer, summary_of_scan, summary_of_web};

/// Most cells that are written as a table and as a picture; the array holds all.
pub const MOST_CELLS: usize = 20_000_000;
