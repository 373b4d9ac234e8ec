//! The files of a web's results folder.

pub(crate) mod effects;
pub(crate) mod fabric;
pub(crate) mod map;
pub(crate) mod picture;
pub(crate) mod pieces;
pub(crate) mod sheet;
pub(crate) mod summary;

/// Most cells that are written as a table and as a picture; the array holds all.
pub const MOST_CELLS: usize = 20_000_000;
