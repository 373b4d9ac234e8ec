//! Work that is shared among threads.

use crate::error::Error;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Time that a computation took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spent {
    /// All of it.
    pub whole: Duration,
    /// The parts that are shared among threads.
    pub in_parallel: Duration,
}

/// Does pieces of work on some threads; the results are in the order of the pieces.
///
/// * `work` – does the piece of a number
///
/// # Errors
/// The error of a piece; the pieces after it may not be done.
pub(crate) fn each<T: Send>(
    threads: usize,
    pieces: usize,
    work: impl Fn(usize) -> Result<T, Error> + Sync,
) -> Result<Vec<T>, Error> {
    let next = AtomicUsize::new(0);
    let some = || {
        let mut done = Vec::new();
        loop {
            let piece = next.fetch_add(1, Ordering::Relaxed);
            if piece >= pieces {
                return Ok(done);
            }
            done.push((piece, work(piece)?));
        }
    };
    let done: Vec<Result<_, Error>> = std::thread::scope(|scope| {
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
