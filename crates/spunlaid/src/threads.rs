//! Work that is shared among threads.

use crate::error::Error;
use std::convert::Infallible;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

/// Does pieces of work on some threads; the results are in the order of the pieces.
///
/// * `work` – does the piece of a number
pub fn each<T: Send>(threads: usize, pieces: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let Ok(done) = share(threads, pieces, |piece| Ok::<_, Infallible>(work(piece)));
    done
}

/// As [`each`], with work that may fail.
///
/// # Errors
/// The error of a piece; the pieces after it may not be done.
pub(crate) fn try_each<T: Send>(
    threads: usize,
    pieces: usize,
    work: impl Fn(usize) -> Result<T, Error> + Sync,
) -> Result<Vec<T>, Error> {
    share(threads, pieces, work)
}

fn share<T: Send, E: Send>(
    threads: usize,
    pieces: usize,
    work: impl Fn(usize) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let next = AtomicUsize::new(0);
    let some = || {
        let mut done = Vec::new();
        loop {
            let piece = next.fetch_add(1, Ordering::Relaxed);
            if piece >= pieces {
                return Ok::<_, E>(done);
            }
            done.push((piece, work(piece)?));
        }
    };
    let done: Vec<Result<_, E>> = std::thread::scope(|scope| {
        let helpers: Vec<_> = (1..threads.min(pieces)).map(|_| scope.spawn(some)).collect();
        let own = some();
        let helpers = helpers.into_iter().map(|helper| helper.join());
        let others = helpers.map(|done| done.unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        std::iter::once(own).chain(others).collect()
    });
    let mut all = Vec::new();
    for some in done {
        all.extend(some?);
    }
    all.sort_by_key(|(piece, _)| *piece);
    Ok(all.into_iter().map(|(_, result)| result).collect())
}

/// Does `work` while another thread looks at it: at once, after each `interval`, and once more when the work has ended, also
/// if it panics.
pub fn look_while<T>(interval: Duration, mut look: impl FnMut() + Send, work: impl FnOnce() -> T) -> T {
    let finished = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let looking = scope.spawn(|| {
            loop {
                let last = finished.load(Ordering::Acquire);
                look();
                if last {
                    return;
                }
                std::thread::park_timeout(interval);
            }
        });
        // Without it the scope would wait for that thread for ever if the work panics.
        let _end = OnDrop(|| {
            finished.store(true, Ordering::Release);
            looking.thread().unpark();
        });
        work()
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
