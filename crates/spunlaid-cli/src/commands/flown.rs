//! Tensions at the ends of spinlines, which flights find before the rest of a file can be read.

use super::run_control;
use crate::args::Threads;
use crate::failure::Failure;
use crate::progress;
use spunlaid::error::Error;
use spunlaid::input::{FlownTension, KeptTensions, Unflown, Unread};
use std::sync::atomic::{AtomicU64, Ordering};

/// What is read of a file. Tensions that flights have to find are flown, with a bar; Ctrl-C ends it.
pub(super) fn flown<T>(mut read: Result<T, Unread<T>>, threads: Threads, quiet: bool) -> Result<T, Error> {
    loop {
        read = match read {
            Ok(read) => return Ok(read),
            Err(Unread::Faulty(error)) => return Err(error),
            Err(Unread::Unflown(unflown)) => fly(*unflown, threads, quiet, None),
        };
    }
}

/// [`flown`], with tensions that outlive this process.
///
/// * `kept` – opens them, if flights have to find some
pub(super) fn flown_and_kept<T, K: KeptTensions>(
    mut read: Result<T, Unread<T>>,
    threads: Threads,
    quiet: bool,
    kept: impl Fn() -> Result<K, Error>,
) -> Result<T, Failure> {
    loop {
        let unflown = match read {
            Ok(read) => return Ok(read),
            Err(Unread::Faulty(error)) => return Err(error.into()),
            Err(Unread::Unflown(unflown)) => unflown,
        };
        let (kept, total) = (Counted { kept: kept()?, done: AtomicU64::new(0) }, unflown.tensions() as u64);
        read = fly(*unflown, threads, quiet, Some(&kept));
        if let Err(Unread::Faulty(Error::Interrupted)) = &read {
            let done = kept.done.into_inner();
            return Err(Failure::Paused { done, total: Some(total), what: "tensions at ends of spinlines" });
        }
    }
}

fn fly<T>(
    unflown: Unflown<T>,
    threads: Threads,
    quiet: bool,
    kept: Option<&dyn KeptTensions>,
) -> Result<T, Unread<T>> {
    let (done, most) = (AtomicU64::new(0), unflown.most_steps());
    let label = match unflown.tensions() {
        1 => "flying for the tension at the end of the spinline".to_owned(),
        several => format!("flying for the tensions at the ends of {several} spinlines"),
    };
    let by = run_control(threads, &done);
    progress::follow(&done, most, &label, quiet, || match kept {
        Some(kept) => unflown.fly_and_keep(by, kept),
        None => unflown.fly(by),
    })
}

/// Tensions that are counted when they are known.
struct Counted<K> {
    kept: K,
    done: AtomicU64,
}

impl<K: KeptTensions> KeptTensions for Counted<K> {
    fn recall(&self, identity: u64) -> Option<FlownTension> {
        let found = self.kept.recall(identity);
        self.done.fetch_add(u64::from(found.is_some()), Ordering::Relaxed);
        found
    }

    fn keep(&self, identity: u64, found: FlownTension) -> Result<(), Error> {
        self.kept.keep(identity, found)?;
        self.done.fetch_add(1, Ordering::Relaxed);
        Ok(())
    }
}
