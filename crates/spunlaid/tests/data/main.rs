//! Data from elsewhere: fields of air, velocity records, scans of webs.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

#[path = "../common/air.rs"]
mod air;
#[path = "../common/meshes.rs"]
mod meshes;
#[path = "../common/normal.rs"]
mod normal;
#[path = "../common/scans.rs"]
mod scans;
#[path = "../common/vtk.rs"]
mod vtk;

mod field_blanks;
mod field_cases;
mod field_files;
mod field_foreign;
mod field_lists;
mod field_names;
mod field_points;
mod field_refusals;
mod field_times;
mod fields;
mod record_artefacts;
mod record_dialects;
mod record_files;
mod record_short;
mod record_statistics;
mod scan;
mod scan_edges;
mod scan_files;
mod scan_lamps;
mod scan_maps;
mod scan_refusals;
mod scan_scales;
mod scan_tags;
mod scan_transparency;
