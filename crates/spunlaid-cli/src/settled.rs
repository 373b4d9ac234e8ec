//! Tensions at the ends of spinlines, which flights find before a file is settled.

use crate::args::Threads;
use crate::control::control;
use crate::progress;
use spunlaid::ground::Error;
use spunlaid::input::Resources;
use std::sync::atomic::AtomicU64;

/// What is read of a file. Tensions that it wants are flown for, with a bar; Ctrl-C ends it.
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
    resources.settle(read, |resources| {
        let (done, most) = (AtomicU64::new(0), resources.most_steps());
        let label = match resources.wanted() {
            1 => "flying for the tension at the end of the spinline".to_owned(),
            several => format!("flying for the tensions at the ends of {several} spinlines"),
        };
        progress::follow(&done, most, &label, quiet, || resources.fly(control(threads, &done)))
    })
}
