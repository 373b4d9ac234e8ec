//! Writes figures as SVG, CSV and PNG files. The PNG files are drawn on all threads.

use crate::Failure;
use crate::failure::undrawable;
use spunlaid_charts::{Figure, png};
use std::borrow::Borrow;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Passes the name and content of each file of the figures to `write`, in order.
pub fn write<F: Borrow<Figure> + Sync>(
    figures: &[F],
    mut write: impl FnMut(String, &[u8]) -> Result<(), Failure>,
) -> Result<(), Failure> {
    for (figure, picture) in figures.iter().map(F::borrow).zip(pictures(figures)) {
        write(format!("{}.svg", figure.name), figure.svg.as_bytes())?;
        write(format!("{}.csv", figure.name), figure.table.csv().as_bytes())?;
        write(format!("{}.png", figure.name), &picture?)?;
    }
    Ok(())
}

fn pictures<F: Borrow<Figure> + Sync>(figures: &[F]) -> Vec<Result<Vec<u8>, Failure>> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(figures.len());
    let next = AtomicUsize::new(0);
    let draw = || {
        let mut drawn = Vec::new();
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let Some(figure) = figures.get(i).map(F::borrow) else {
                return drawn;
            };
            let failed = |reason: String| undrawable(&figure.name, &reason);
            drawn.push((i, png(&figure.svg).map_err(|reason| failed(reason.to_string()))));
        }
    };
    let mut drawn: Vec<_> = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(draw)).collect();
        let own = draw();
        let others = others.into_iter().flat_map(|thread| match thread.join() {
            Ok(drawn) => drawn,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        own.into_iter().chain(others).collect()
    });
    drawn.sort_by_key(|(i, _)| *i);
    drawn.into_iter().map(|(_, picture)| picture).collect()
}
