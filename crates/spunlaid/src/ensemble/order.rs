//! Distributes work over threads and takes the results in order.

use crate::threads::OnDrop;
use std::collections::BTreeMap;
use std::sync::{Condvar, Mutex, PoisonError};

/// Finished results that wait for their turn, and the next items to start and to take.
struct Queue<T> {
    next_to_start: usize,
    next_to_take: usize,
    stopped: bool,
    finished: BTreeMap<usize, T>,
}

/// Computes `work(0) … work(count−1)` on `threads` threads and passes the results in that order to `take` on
/// the calling thread. At most `4 × threads` results wait at once, so that memory does not grow.
///
/// # Errors
/// The first error of `take`. Work that has not begun is then left out.
pub fn in_order<T: Send, E>(
    count: usize,
    threads: usize,
    work: impl Fn(usize) -> T + Sync,
    mut take: impl FnMut(T) -> Result<(), E>,
) -> Result<(), E> {
    let threads = threads.clamp(1, count.max(1));
    let window = 4 * threads;
    let state =
        Mutex::new(Queue { next_to_start: 0, next_to_take: 0, stopped: false, finished: BTreeMap::new() });
    let changed = Condvar::new();
    // A panic in another thread cannot leave the queue half changed.
    let lock = || state.lock().unwrap_or_else(PoisonError::into_inner);
    let wait = |guard| changed.wait(guard).unwrap_or_else(PoisonError::into_inner);

    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                // Wakes the waiting threads, also if this thread panics.
                let _wake = OnDrop(|| {
                    if std::thread::panicking() {
                        lock().stopped = true;
                    }
                    changed.notify_all();
                });
                loop {
                    let mut queue = lock();
                    while !queue.stopped
                        && queue.next_to_start < count
                        && queue.next_to_start >= queue.next_to_take + window
                    {
                        queue = wait(queue);
                    }
                    if queue.stopped || queue.next_to_start >= count {
                        return;
                    }
                    let item = queue.next_to_start;
                    queue.next_to_start += 1;
                    drop(queue);
                    let result = work(item);
                    lock().finished.insert(item, result);
                    changed.notify_all();
                }
            });
        }
        for item in 0..count {
            let mut queue = lock();
            let result = loop {
                if let Some(result) = queue.finished.remove(&item) {
                    break result;
                }
                if queue.stopped {
                    return Ok(());
                }
                queue = wait(queue);
            };
            queue.next_to_take = item + 1;
            drop(queue);
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
        assert!(begun.into_inner() <= 5 + 1 + 2 * 8, "only work within the window has begun");
    }
}
