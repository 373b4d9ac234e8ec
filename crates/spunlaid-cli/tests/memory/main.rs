//! The memory that the program takes. The tests look at it every 2 ms, so they are kept apart from tests that fly long.
#![cfg(target_os = "linux")]
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;
#[path = "../desk/mod.rs"]
mod desk;

use std::sync::{Mutex, MutexGuard, PoisonError};

/// One test at a time: a program that waits for the disk of another one holds more, and a look that comes
/// late misses the moment.
fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

mod check_memory;
mod sweep_memory;
