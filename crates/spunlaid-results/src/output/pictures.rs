//! Writes figures as SVG, CSV and PNG files. The PNG files are drawn on all threads.

use crate::Failure;
use crate::failure::undrawable;
use spunlaid::threads::each;
use spunlaid_charts::{Figure, png};
use std::borrow::Borrow;
use std::thread::available_parallelism;

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
    let threads = available_parallelism().map_or(1, usize::from);
    each(threads, figures.len(), |i| {
        let figure = figures[i].borrow();
        png(&figure.svg).map_err(|reason| undrawable(&figure.name, &reason.to_string()))
    })
}
