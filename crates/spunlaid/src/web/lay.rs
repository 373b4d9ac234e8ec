//! Lays all filaments of a web.

use super::Web;
use super::canvas::{Canvas, CanvasPart};
use super::laid_web::LaidWeb;
use super::plan::{Plan, plans};
use crate::error::Error;
use crate::lanes::{Isa, WIDTH};
use crate::threads::{lock, try_each};
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::Duration;

/// Most filaments that a thread lays before it adds them to the map, and times that a thread does so at least.
const MOST_TOGETHER: usize = 64 * WIDTH;
const TIMES: usize = 8;

/// Threads and instruction set of the computation, its progress and its stop flag.
#[derive(Clone, Copy, Debug)]
pub struct LayControl<'a> {
    /// Number of threads. The map does not depend on it.
    pub threads: usize,
    /// Instruction set. The map does not depend on it.
    pub isa: Isa,
    /// Ends the laying when it is set.
    pub stop: &'a AtomicBool,
    /// Grows by the pieces of filaments that have been laid; [`pieces`] says how many there are.
    pub laid: &'a AtomicU64,
}

/// Time that a computation took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TimeSpent {
    /// All of it.
    pub whole: Duration,
    /// The parts that are shared among threads.
    pub in_parallel: Duration,
}

/// Number of pieces that [`lay`] lays.
///
/// # Errors
/// As [`lay`].
pub fn pieces(web: &Web) -> Result<u64, Error> {
    Ok(plans(web)?.iter().map(|plan| (plan.pieces * plan.places.len()) as u64).sum())
}

/// Lays all filaments of a web.
///
/// Each filament lays as much fibre as the belt takes along on its way through the sheet, so the basis weight
/// is on average exactly line density × filaments × feed speed / belt speed / width. Several layers share a
/// quantum of mass, which rounds the mass of a layer by less than 1e-5.
///
/// # Errors
/// If the web cannot be laid, or if it is stopped.
pub fn lay(web: &Web, by: LayControl<'_>) -> Result<LaidWeb, Error> {
    let mut plans = plans(web)?;
    let parts: Vec<f64> = plans.iter().map(Plan::mass_of_part).collect();
    // No cell of a trace alone has more than four times its mean; a canvas reckons with ropes of 64 times.
    let traces = plans.iter().map(|plan| plan.weight_of_trace(&web.sheet)).sum::<f64>() / 16.0;
    let canvas = Canvas::new(&web.sheet, &parts, web.basis_weight() + traces)?.ring();
    for (plan, part) in plans.iter_mut().zip(parts) {
        plan.quanta = canvas.quanta(part);
    }
    let mut units: Vec<(&Plan<'_>, Range<usize>)> = Vec::new();
    for plan in &plans {
        let count = plan.places.len();
        let together = (count / (TIMES * by.threads.max(1))).next_multiple_of(2 * WIDTH);
        let together = together.clamp(2 * WIDTH, MOST_TOGETHER);
        units.extend((0..count).step_by(together).map(|first| (plan, first..(first + together).min(count))));
    }
    // Parts are large; a thread uses one again.
    let parts = Mutex::new(Vec::new());
    try_each(by.threads, units.len(), |unit| {
        let (plan, which) = &units[unit];
        let mut part = lock(&parts).pop().unwrap_or_else(|| CanvasPart::new(&canvas));
        plan.draw(web, which.clone(), &mut part, by)?;
        lock(&parts).push(part);
        Ok(())
    })?;
    drop(parts);
    Ok(canvas.finish()?)
}
