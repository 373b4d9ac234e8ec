//! Distributes work over threads and takes the results in order.

use spunlaid_ground::OnDrop;
use spunlaid_ground::threads::lock;
use std::sync::{Condvar, Mutex, PoisonError};

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
    // One place more than may wait, for the result that is being taken.
    let places = window + 1;
    let waiting: Vec<Mutex<Option<T>>> = (0..places).map(|_| Mutex::new(None)).collect();
    let work = |item: usize| {
        let result = work(item);
        *lock(&waiting[item % places]) = Some(result);
    };
    let mut outcome = Ok(());
    let mut take = |item: usize| {
        let result = lock(&waiting[item % places]).take();
        outcome = result.map_or(Ok(()), &mut take);
        outcome.is_ok()
    };
    let queue = Queue {
        count,
        window,
        next_to_start: 0,
        next_to_take: 0,
        stopped: false,
        finished: vec![false; places],
    };
    queue.run(threads, &work, &mut take);
    outcome
}

/// The next items to start and to take, and which of those between them are finished.
struct Queue {
    count: usize,
    window: usize,
    next_to_start: usize,
    next_to_take: usize,
    stopped: bool,
    finished: Vec<bool>,
}

impl Queue {
    /// Does the items on some threads and takes them in order until `take` returns false. As it is without the type
    /// of a result, it is compiled once.
    fn run(self, threads: usize, work: &(dyn Fn(usize) + Sync), take: &mut dyn FnMut(usize) -> bool) {
        let (count, places) = (self.count, self.finished.len());
        let (state, changed) = (Mutex::new(self), Condvar::new());
        let wait = |guard| changed.wait(guard).unwrap_or_else(PoisonError::into_inner);
        let stop = || {
            lock(&state).stopped = true;
            changed.notify_all();
        };
        let start_next = || {
            let mut queue = lock(&state);
            while queue.must_wait() {
                queue = wait(queue);
            }
            let item = queue.next_to_start;
            queue.next_to_start += 1;
            (!queue.stopped && item < count).then_some(item)
        };
        let work_until_the_end = || {
            let _stop = OnDrop(|| {
                if std::thread::panicking() {
                    stop();
                }
            });
            while let Some(item) = start_next() {
                work(item);
                lock(&state).finished[item % places] = true;
                changed.notify_all();
            }
        };
        std::thread::scope(|scope| {
            // Lets the threads end, also if `take` panics.
            let _stop = OnDrop(stop);
            for _ in 0..threads {
                scope.spawn(work_until_the_end);
            }
            for item in 0..count {
                let mut queue = lock(&state);
                while !queue.finished[item % places] {
                    if queue.stopped {
                        return;
                    }
                    queue = wait(queue);
                }
                queue.finished[item % places] = false;
                queue.next_to_take = item + 1;
                drop(queue);
                changed.notify_all();
                if !take(item) {
                    return;
                }
            }
        });
    }

    /// Whether a thread that wants to start an item waits until one is taken.
    fn must_wait(&self) -> bool {
        !self.stopped
            && self.next_to_start < self.count
            && self.next_to_start >= self.next_to_take + self.window
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
        assert!(begun.into_inner() <= 5 + 1 + 2 * 8, "only work within the window has begun");
    }

    #[test]
    fn a_panic_ends_the_work_and_comes_through() {
        use std::panic::{AssertUnwindSafe, catch_unwind};
        let run = |work: fn(usize) -> usize, take: fn(usize) -> Result<(), ()>| {
            catch_unwind(AssertUnwindSafe(|| in_order(1_000, 2, work, take)))
        };
        assert!(run(|i| i, |i| if i == 5 { panic!("as a test of it") } else { Ok(()) }).is_err());
        assert!(run(|i| if i == 5 { panic!("as a test of it") } else { i }, |_| Ok(())).is_err());
        assert_eq!(run(|i| i, |_| Ok(())).ok(), Some(Ok(())));
    }
}
