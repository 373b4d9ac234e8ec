//! Fields from files and from numbers: formats, gaps, refusals, and the air between the points.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

mod air;
mod blanks;
mod evenness;
mod fields;
mod files;
mod foreign;
mod lists;
mod meshes;
mod points;
mod refusals;
mod tables;
mod times;
mod vtk;
