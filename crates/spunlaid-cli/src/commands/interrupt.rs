//! Ctrl-C.

use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);

/// Installs a handler for Ctrl-C and returns the flag that it sets.
pub(super) fn stop_on_ctrl_c() -> &'static AtomicBool {
    // Without the handler, Ctrl-C still ends the program but leaves its hidden folder behind.
    let _ = ctrlc::set_handler(|| STOP.store(true, Ordering::Relaxed));
    &STOP
}
