//! How work is done: on which threads, and that Ctrl-C ends it.

use crate::args::Threads;
use spunlaid::ground::Isa;
use spunlaid::simulation::RunControl;
use spunlaid::web::LayControl;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Installs a handler for Ctrl-C and returns the flag that it sets.
pub(crate) fn stop_on_ctrl_c() -> &'static AtomicBool {
    static STOP: AtomicBool = AtomicBool::new(false);
    // Without the handler, Ctrl-C still ends the program but leaves its hidden folder behind.
    let _ = ctrlc::set_handler(|| STOP.store(true, Ordering::Relaxed));
    &STOP
}

/// How fibres are flown; Ctrl-C ends it.
pub(crate) fn run_control(threads: Threads, fibre_steps: &AtomicU64) -> RunControl<'_> {
    let (threads, isa, stop) = (threads.number(), Isa::detect(), stop_on_ctrl_c());
    RunControl { threads, isa, stop, fibre_steps, recorder: None }
}

/// How a web is laid; Ctrl-C ends it.
pub(crate) fn lay_control(threads: Threads, laid: &AtomicU64) -> LayControl<'_> {
    LayControl { threads: threads.number(), isa: Isa::detect(), stop: stop_on_ctrl_c(), laid }
}
