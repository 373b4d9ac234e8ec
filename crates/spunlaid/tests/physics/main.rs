//! The physics of air and fibres: forces, drag, schemes, turbulence, what is laid on a belt.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

#[path = "../common/cases.rs"]
mod cases;
#[path = "../common/mod.rs"]
mod common;
#[path = "../../../spunlaid-field/tests/field/meshes.rs"]
mod meshes;

mod air_flows;
mod air_signals;
mod coiling;
mod coiling_flights;
mod drag_laws;
mod eddies;
mod flights;
mod forces;
mod friction;
mod laydown;
mod laydown_statistics;
mod load;
mod melt_blowing;
mod schemes;
mod slack;
mod spinline;
mod spinline_following;
mod spinline_published;
mod spinline_trends;
mod statics;
mod turbulence;
mod vibrations;
mod widening;
