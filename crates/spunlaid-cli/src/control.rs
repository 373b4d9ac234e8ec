//! How work is done: on which threads, and that Ctrl-C ends it.

use crate::args::Threads;
use spunlaid::ground::{Control, Isa};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Installs a handler for Ctrl-C and returns the flag that it sets.
pub(crate) fn stop_on_ctrl_c() -> &'static AtomicBool {
    static STOP: AtomicBool = AtomicBool::new(false);
    // Without the handler, Ctrl-C still ends the program but leaves its hidden folder behind.
    let _ = ctrlc::set_handler(|| STOP.store(true, Ordering::Relaxed));
    &STOP
}

/// How work is done; Ctrl-C ends it.
pub(crate) fn control(threads: Threads, done: &AtomicU64) -> Control<'_> {
    Control { threads: threads.number(), isa: Isa::detect(), stop: stop_on_ctrl_c(), done }
}
