//! Webs and the surrogate that lays them.
#![allow(clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::unwrap_used)]

mod advice;
mod assumed_values;
mod charge;
mod curtain;
mod defects;
mod few_filaments;
mod fit;
mod neighbours;
mod one_air;
mod pinned;
mod same_air;
mod surrogate;
mod two_filaments;
mod web;
mod web_errors;
mod web_statistics;
