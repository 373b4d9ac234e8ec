//! How work is done: on which threads, and that Ctrl-C ends it; what flies before a file is settled.

use crate::args::Threads;
use crate::progress;
use spunlaid::ground::{Error, Isa, RunContext};
use spunlaid::input::Resources;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Installs a handler for Ctrl-C and returns the flag that it sets.
pub(crate) fn stop_on_ctrl_c() -> &'static AtomicBool {
    static STOP: AtomicBool = AtomicBool::new(false);
    // Without the handler, Ctrl-C still ends the program but leaves its hidden folder behind.
    let _ = ctrlc::set_handler(|| STOP.store(true, Ordering::Relaxed));
    &STOP
}

/// How work is done; Ctrl-C ends it.
pub(crate) fn control(threads: Threads, done: &AtomicU64) -> RunContext<'_> {
    RunContext { threads: threads.number(), isa: Isa::detect(), stop: stop_on_ctrl_c(), done }
}

/// What is read of a file. Tensions that it wants are simulated for, with a bar; Ctrl-C ends it.
pub(crate) fn settled<T>(
    threads: Threads,
    quiet: bool,
    read: impl Fn(&Resources) -> Result<T, Error>,
) -> Result<T, Error> {
    settled_with(&mut Resources::default(), threads, quiet, read)
}

/// [`settled`] with what is known from readings before.
pub(crate) fn settled_with<T>(
    resources: &mut Resources,
    threads: Threads,
    quiet: bool,
    read: impl Fn(&Resources) -> Result<T, Error>,
) -> Result<T, Error> {
    resources.resolve_tension(read, |resources| {
        let (done, most) = (AtomicU64::new(0), resources.most_steps());
        let label = match resources.wanted() {
            1 => "simulating the tension at the end of the spinline".to_owned(),
            several => format!("simulating the tensions at the ends of {several} spinlines"),
        };
        progress::follow(&done, most, &label, quiet, || resources.fly(control(threads, &done)))
    })
}
