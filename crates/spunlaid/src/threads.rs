//! Work that is shared among threads.

use crate::error::Error;
use std::convert::Infallible;
use std::sync::atomic::{AtomicUsize, Ordering};

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
