//! Work without the lock of the interpreter. Ctrl-C stops it, and a function of Python hears how far it is.

use crate::failure::{raised, raised_of_panic};
use pyo3::prelude::*;
use spunlaid::ground::threads::lock;
use spunlaid::ground::{Isa, RunContext};
use spunlaid::input::Resources;
use spunlaid_results::Failure;
use spunlaid_results::folders::Making;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

/// Time between two looks at signals and progress.
pub(crate) const LOOK: Duration = Duration::from_millis(50);

/// How far some work is; another thread may read it.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    /// Set to stop the work.
    pub(crate) stop: AtomicBool,
    /// Parts done, and their number.
    pub(crate) done: AtomicU64,
    pub(crate) total: AtomicU64,
}

impl Watch {
    pub(crate) fn new(parts: u64) -> Self {
        Self { total: AtomicU64::new(parts), ..Self::default() }
    }

    /// Begins another part of the work.
    pub(crate) fn begin(&self, parts: u64) {
        self.done.store(0, Ordering::Relaxed);
        self.total.store(parts, Ordering::Relaxed);
    }

    /// How work is done that is watched, on so many threads.
    pub(crate) fn control(&self, threads: Option<usize>) -> RunContext<'_> {
        RunContext { threads: self::threads(threads), isa: Isa::detect(), stop: &self.stop, done: &self.done }
    }

    /// How files are made that are watched.
    pub(crate) fn making(&self) -> Making<'_> {
        Making { threads: self::threads(None), stop: &self.stop, room: usize::MAX }
    }
}

/// Does `work` on a thread of its own, while this one lets go of the interpreter and looks every 50 ms whether Python
/// wants to stop it.
///
/// * `progress` – called with the parts done and their number, at least once at the end
///
/// # Errors
/// Those of the work, those of `progress`, and `KeyboardInterrupt`.
pub(crate) fn watched<T: Send>(
    py: Python<'_>,
    watch: &Watch,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce() -> Result<T, Failure> + Send,
) -> PyResult<T> {
    let (finished, changed) = (Mutex::new(false), Condvar::new());
    let report_progress = |py: Python<'_>| match progress {
        Some(progress) => {
            let done = watch.done.load(Ordering::Relaxed);
            let total = watch.total.load(Ordering::Relaxed);
            progress.call1(py, (done.min(total), total)).map(drop)
        }
        None => Ok(()),
    };
    let (ended, outcome) = py.detach(|| {
        std::thread::scope(|scope| {
            let worker = scope.spawn(|| {
                let outcome = catch_unwind(AssertUnwindSafe(work));
                *lock(&finished) = true;
                changed.notify_all();
                outcome
            });
            let mut ended = Ok(());
            loop {
                let guard = lock(&finished);
                let waited = changed.wait_timeout_while(guard, LOOK, |finished| !*finished);
                let (guard, _) = waited.unwrap_or_else(PoisonError::into_inner);
                if *guard {
                    break;
                }
                drop(guard);
                if ended.is_ok() {
                    ended = Python::attach(|py| py.check_signals().and_then(|()| report_progress(py)));
                    if ended.is_err() {
                        watch.stop.store(true, Ordering::Relaxed);
                    }
                }
            }
            (ended, worker.join().unwrap_or_else(Err))
        })
    });
    ended?;
    match outcome {
        Ok(Ok(done)) => report_progress(py).map(|()| done),
        Ok(Err(failure)) => Err(raised(py, failure)),
        Err(panic) => Err(raised_of_panic(py, &*panic)),
    }
}

/// Does short work without a thread of its own; a panic becomes an exception.
pub(crate) fn guarded<T: Send>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, Failure> + Send,
) -> PyResult<T> {
    match py.detach(|| catch_unwind(AssertUnwindSafe(work))) {
        Ok(Ok(done)) => Ok(done),
        Ok(Err(failure)) => Err(raised(py, failure)),
        Err(panic) => Err(raised_of_panic(py, &*panic)),
    }
}

/// What is read of a file. Tensions at ends of spinlines that it wants are simulated for, on so many threads;
/// Ctrl-C stops them.
pub(crate) fn settled<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    read: impl Fn(&Resources) -> Result<T, Failure> + Send,
) -> PyResult<T> {
    let watch = Watch::default();
    watched(py, &watch, None, || {
        let by = watch.control(threads);
        Resources::default().resolve_tension(read, |resources| resources.fly(by))
    })
}

/// Number of threads: as asked, or one for each processor.
pub(crate) fn threads(count: Option<usize>) -> usize {
    let all = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    count.unwrap_or_else(all).max(1)
}
