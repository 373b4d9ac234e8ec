//! The memory that the program takes. The tests look at it every 2 ms, so they are kept apart from tests that fly long.
#![cfg(target_os = "linux")]
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;
#[path = "../desk/mod.rs"]
mod desk;

mod check_memory;
mod sweep_memory;
