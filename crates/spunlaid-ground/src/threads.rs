//! Work that is shared among threads.

use crate::error::Error;
use crate::lanes::Isa;
use std::cell::RefCell;
use std::convert::Infallible;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread::{Scope, ScopedJoinHandle};
use std::time::Duration;

/// How work is done. None of it changes a bit of the results.
#[derive(Clone, Copy, Debug)]
pub struct RunContext<'a> {
    /// Number of threads.
    pub threads: usize,
    /// Instruction set.
    pub isa: Isa,
    /// Set from elsewhere to stop early.
    pub stop: &'a AtomicBool,
    /// Grows by what is done, for a display of progress: steps of fibres that fly, pieces of filaments that are laid.
    pub done: &'a AtomicU64,
}

/// Threads that do work until it is stopped.
#[derive(Clone, Copy, Debug)]
pub struct Workers<'a> {
    /// Number of threads.
    pub threads: usize,
    /// Set from elsewhere to stop early.
    pub stop: &'a AtomicBool,
}

impl<'a> RunContext<'a> {
    /// The threads, without the rest.
    pub const fn workers(self) -> Workers<'a> {
        Workers { threads: self.threads, stop: self.stop }
    }
}

/// Does pieces of work on some threads; the results are in the order of the pieces.
///
/// * `work` – does the piece of a number
pub fn par_map<T: Send>(threads: usize, pieces: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let name = std::any::type_name_of_val(&work);
    let Ok(done) = share(name, threads, pieces, |piece| Ok::<_, Infallible>(work(piece)));
    done
}

/// As [`par_map`], with work that may fail.
///
/// # Errors
/// The error of a piece; the pieces after it may not be done.
pub fn try_par_map<T: Send>(
    threads: usize,
    pieces: usize,
    work: impl Fn(usize) -> Result<T, Error> + Sync,
) -> Result<Vec<T>, Error> {
    share(std::any::type_name_of_val(&work), threads, pieces, work)
}

/// As [`try_par_map`], with pieces that share their own work among threads again: a thread that has no piece any more
/// helps in those that are not finished, so that never more than `threads` work and hardly fewer.
///
/// * `concurrent` – most pieces that are begun before another one is finished
///
/// # Errors
/// As of [`try_par_map`].
pub fn try_together<T: Send>(
    threads: usize,
    concurrent: usize,
    pieces: usize,
    work: impl Fn(usize) -> Result<T, Error> + Sync,
) -> Result<Vec<T>, Error> {
    let around = FREE.with_borrow(Clone::clone);
    // Within other such work the threads are those of all of it.
    let new = || Arc::new(AtomicUsize::new(threads.saturating_sub(1)));
    FREE.set(Some(around.clone().unwrap_or_else(new)));
    let _end = OnDrop(|| FREE.set(around.clone()));
    share(std::any::type_name_of_val(&work), concurrent.min(threads), pieces, work)
}

thread_local! {
    /// Threads that may still begin in the work of which this thread does a part; None without a limit.
    static FREE: RefCell<Option<Arc<AtomicUsize>>> = const { RefCell::new(None) };
}

/// Threads that help in some work, of those that are free.
struct Helpers {
    free: Option<Arc<AtomicUsize>>,
    count: usize,
}

impl Helpers {
    /// Takes as many as are free, and no more than are wanted.
    fn take(wanted: usize) -> Self {
        let free = FREE.with_borrow(Clone::clone);
        let taken = |free: &AtomicUsize| {
            let rest = |free: usize| Some(free.saturating_sub(wanted));
            let before = free.fetch_update(Ordering::Relaxed, Ordering::Relaxed, rest);
            before.unwrap_or_else(|before| before).min(wanted)
        };
        let count = free.as_deref().map_or(wanted, taken);
        Self { free, count }
    }

    /// Does the work of one of them, whose thread is free again afterwards.
    fn help(&self, work: &dyn Fn()) {
        FREE.set(self.free.clone());
        let _end = OnDrop(|| {
            if let Some(free) = &self.free {
                free.fetch_add(1, Ordering::Relaxed);
            }
        });
        work();
    }
}

/// Some pieces of work that threads share.
#[derive(Clone, Copy)]
pub struct Shared<'a> {
    /// What they do: the path of a function of this library.
    pub name: &'static str,
    /// Most threads that do them.
    pub threads: usize,
    /// Their number.
    pub pieces: usize,
    /// Does the piece of a number; a thread ends when it returns false.
    pub work: &'a (dyn Fn(usize) -> bool + Sync),
}

static SHARER: OnceLock<fn(Shared<'_>)> = OnceLock::new();

/// Lets something else than the threads of this room do all pieces of work from now on, as a trace that counts them.
pub fn share_by(sharer: fn(Shared<'_>)) {
    let _ = SHARER.set(sharer);
}

fn share<T: Send, E: Send>(
    name: &'static str,
    threads: usize,
    pieces: usize,
    work: impl Fn(usize) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let results: Vec<Mutex<Option<Result<T, E>>>> = (0..pieces).map(|_| Mutex::new(None)).collect();
    let work = |piece: usize| {
        let result = work(piece);
        let goes_on = result.is_ok();
        *lock(&results[piece]) = Some(result);
        goes_on
    };
    let sharer = SHARER.get().copied().unwrap_or(distribute);
    sharer(Shared { name, threads, pieces, work: &work });
    // Pieces begin in order, so that those without a result come after one that failed.
    results.into_iter().map_while(unlock).collect()
}

/// Does pieces of work on some threads. As it is independent of the type of a result, it is compiled once.
fn distribute(Shared { threads, pieces, work, .. }: Shared<'_>) {
    let next = AtomicUsize::new(0);
    let some = || {
        loop {
            let piece = next.fetch_add(1, Ordering::Relaxed);
            if piece >= pieces || !work(piece) {
                return;
            }
        }
    };
    let free = Helpers::take(threads.min(pieces).saturating_sub(1));
    std::thread::scope(|scope| {
        let helpers: Vec<_> = (0..free.count).map(|_| scope.spawn(|| free.help(&some))).collect();
        some();
        for helper in helpers {
            helper.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
    });
}

/// What a mutex holds, also if a thread panicked while it held the lock. For what such a thread cannot leave
/// half changed.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// As [`lock`], when no thread uses the mutex any more.
pub fn unlock<T>(mutex: Mutex<T>) -> T {
    mutex.into_inner().unwrap_or_else(PoisonError::into_inner)
}

/// Does `work` while another thread looks at it: at once, after each `interval`, and once more when the work
/// has ended, also if it panics.
pub fn look_while<T>(interval: Duration, mut look: impl FnMut() + Send, work: impl FnOnce() -> T) -> T {
    let finished = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let looking = look_until(&finished, interval, &mut look, scope);
        // Without it the scope would wait for that thread for ever if the work panics.
        let _end = OnDrop(|| {
            finished.store(true, Ordering::Release);
            looking.thread().unpark();
        });
        work()
    })
}

/// A thread that looks until the work has ended, and then once more.
fn look_until<'scope>(
    finished: &'scope AtomicBool,
    interval: Duration,
    look: &'scope mut (dyn FnMut() + Send),
    scope: &'scope Scope<'scope, '_>,
) -> ScopedJoinHandle<'scope, ()> {
    scope.spawn(move || {
        loop {
            let last = finished.load(Ordering::Acquire);
            look();
            if last {
                return;
            }
            std::thread::park_timeout(interval);
        }
    })
}

/// Does something when it goes out of scope, also if that is by a panic.
pub struct OnDrop<F: FnMut()>(pub F);

impl<F: FnMut()> Drop for OnDrop<F> {
    fn drop(&mut self) {
        (self.0)();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::{AssertUnwindSafe, catch_unwind};

    /// Two pieces that share their work among four threads each have four in all, and so has the last one alone.
    #[test]
    fn pieces_that_share_threads_have_no_more_than_all_of_them_and_no_fewer() {
        for rounds in [[20, 20], [20, 0]] {
            let (working, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
            let piece = |piece| {
                working.fetch_add(1, Ordering::Relaxed);
                most.fetch_max(working.load(Ordering::Relaxed), Ordering::Relaxed);
                std::thread::sleep(Duration::from_millis(2));
                working.fetch_sub(1, Ordering::Relaxed);
                piece
            };
            let done = try_together(4, 2, 2, |number| {
                let round = |_| assert_eq!(par_map(4, 8, piece), [0, 1, 2, 3, 4, 5, 6, 7]);
                (0..rounds[number]).for_each(round);
                Ok(number)
            });
            assert_eq!((done.ok(), most.into_inner()), (Some(vec![0, 1]), 4), "{rounds:?}");
        }
    }

    #[test]
    fn the_thread_that_looks_ends_with_the_work_also_if_it_panics() {
        let looks = AtomicUsize::new(0);
        let look = |work: fn() -> i32| {
            let count = || {
                looks.fetch_add(1, Ordering::Relaxed);
            };
            look_while(Duration::from_secs(3600), count, work)
        };
        assert_eq!(look(|| 7), 7);
        assert!((1..=2).contains(&looks.swap(0, Ordering::Relaxed)));
        assert!(catch_unwind(AssertUnwindSafe(|| look(|| panic!("as a test of it")))).is_err());
        assert!((1..=2).contains(&looks.load(Ordering::Relaxed)));
    }
}
