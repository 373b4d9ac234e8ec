//! Data from elsewhere: fields of air, velocity records, scans of webs.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

#[path = "../../../spunlaid-field/tests/field/air.rs"]
mod air;
#[path = "../../../spunlaid-field/tests/field/meshes.rs"]
mod meshes;
#[path = "../common/normal.rs"]
mod normal;
#[path = "../common/scans.rs"]
mod scans;
#[path = "../../../spunlaid-field/tests/field/vtk.rs"]
mod vtk;

mod field_cases;
mod field_names;
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
mod scan_streaks;
mod scan_tags;
mod scan_transparency;
