//! Work shared out to threads, results taken in order.

use std::collections::BTreeMap;
use std::sync::{Condvar, Mutex, PoisonError};

/// Results waiting for their turn, and how far the giving and the taking have come.
struct Ledger<T> {
    next_to_start: usize,
    next_to_take: usize,
    stopped: bool,
    finished: BTreeMap<usize, T>,
}

/// Does `work(0) … work(count−1)` on `threads` threads and gives the results to `take` in that order, on
/// the calling thread. No more than `4 × threads` results wait at once: memory stays flat.
///
/// # Errors
/// The first error of `take`; work not yet begun is then dropped.
pub fn in_order<T: Send, E>(
    count: usize,
    threads: usize,
    work: impl Fn(usize) -> T + Sync,
    mut take: impl FnMut(T) -> Result<(), E>,
) -> Result<(), E> {
    let threads = threads.clamp(1, count.max(1));
    let window = 4 * threads;
    let state =
        Mutex::new(Ledger { next_to_start: 0, next_to_take: 0, stopped: false, finished: BTreeMap::new() });
    let changed = Condvar::new();
    // A panic elsewhere leaves the ledger as it was between two lines of plain assignments.
    let lock = || state.lock().unwrap_or_else(PoisonError::into_inner);
    let wait = |guard| changed.wait(guard).unwrap_or_else(PoisonError::into_inner);

    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                // However the thread ends, nobody waits for it in vain.
                let _wake = OnDrop(|| {
                    if std::thread::panicking() {
                        lock().stopped = true;
                    }
                    changed.notify_all();
                });
                loop {
                    let mut ledger = lock();
                    while !ledger.stopped
                        && ledger.next_to_start < count
                        && ledger.next_to_start >= ledger.next_to_take + window
                    {
                        ledger = wait(ledger);
                    }
                    if ledger.stopped || ledger.next_to_start >= count {
                        return;
                    }
                    let item = ledger.next_to_start;
                    ledger.next_to_start += 1;
                    drop(ledger);
                    let result = work(item);
                    lock().finished.insert(item, result);
                    changed.notify_all();
                }
            });
        }
        for item in 0..count {
            let mut ledger = lock();
            let result = loop {
                if let Some(result) = ledger.finished.remove(&item) {
                    break result;
                }
                if ledger.stopped {
                    return Ok(());
                }
                ledger = wait(ledger);
            };
            ledger.next_to_take = item + 1;
            drop(ledger);
            changed.notify_all();
            if let Err(error) = take(result) {
                lock().stopped = true;
                changed.notify_all();
                return Err(error);
            }
        }
        Ok(())
    })
}

struct OnDrop<F: FnMut()>(F);

impl<F: FnMut()> Drop for OnDrop<F> {
    fn drop(&mut self) {
        (self.0)();
    }
}

#[cfg(test)]
mod tests {
    use super::in_order;

    #[test]
    fn identical_order_whatever_the_threads() {
        for threads in [1, 2, 7] {
            let mut taken = Vec::new();
            let work = |i: usize| {
                std::thread::sleep(std::time::Duration::from_micros((i * 37 % 11) as u64 * 50));
                i
            };
            let done: Result<(), ()> = in_order(100, threads, work, |i| {
                taken.push(i);
                Ok(())
            });
            assert_eq!(done, Ok(()));
            assert_eq!(taken, (0..100).collect::<Vec<_>>());
        }
    }

    #[test]
    fn an_error_ends_the_work() {
        let begun = std::sync::atomic::AtomicUsize::new(0);
        let work = |i: usize| {
            begun.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            i
        };
        let done = in_order(1_000_000, 2, work, |i| if i == 5 { Err(i) } else { Ok(()) });
        assert_eq!(done, Err(5));
        assert!(begun.into_inner() <= 5 + 1 + 2 * 8, "only what fits the window was begun");
    }
}
