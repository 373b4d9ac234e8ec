//! The program, as it is called in a shell: what each command writes, says and refuses.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;
#[path = "../desk/mod.rs"]
mod desk;

mod air;
mod assumed_values;
mod cases;
mod commands;
mod compare;
mod compared_webs;
mod errors_of_webs;
mod field_axes;
mod figures;
mod fit;
mod flown_tension;
mod gusts;
mod keys;
mod lost;
mod new;
mod pasted;
mod points;
mod records;
mod refusals;
mod reported;
mod results;
mod scan;
mod shell;
mod signals;
mod sources;
mod spin;
mod sweep;
mod sweep_again;
mod sweep_killed;
#[cfg(unix)]
mod transcripts;
mod web;
mod web_advice;
mod web_in_one_air;
mod web_study;
