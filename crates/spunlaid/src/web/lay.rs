//! Lays all filaments of a web.

use super::laid_web::{HIGHEST, LaidWeb, too_full};
use super::laying::LayControl;
use super::map::Map;
use super::plan::{BLOCK, Plan, plans};
use super::strip::Strip;
use super::{Edges, Web};
use crate::error::{Error, Fault};
use crate::lanes::WIDTH;
use crate::threads::{lock, try_each, unlock};
use std::ops::Range;
use std::sync::Mutex;

/// Filaments that a thread lays before it adds them to the map.
const TOGETHER: usize = 8 * WIDTH;
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
    let sheet = &web.sheet;
    let [columns, rows] = sheet.cells();
    let mut plans = plans(web)?;
    let quantum = quantum(web, &plans).ok_or_else(|| {
        Fault::new(
            "the web has no layer or no cells, or its cells are too large for the fibre that they would hold",
            "choose smaller cells (web.cell)",
        )
    })?;
    for plan in &mut plans {
        plan.quanta = (plan.mass_of_part() / quantum).round() as u32;
    }
    let units: Vec<(&Plan<'_>, Range<usize>)> = plans
        .iter()
        .flat_map(|plan| {
            let count = plan.places.len();
            (0..count).step_by(TOGETHER).map(move |first| (plan, first..(first + TOGETHER).min(count)))
        })
        .collect();
    let closed = [sheet.edges == Edges::Periodic, true];
    let sum = Mutex::new((Map::new([columns, rows], sheet.cell, quantum, closed), 0u64, false));
    // Strips are large; a thread uses one again.
    let strips = Mutex::new(Vec::new());
    try_each(by.threads, units.len(), |unit| {
        let (plan, which) = &units[unit];
        let mut strip = lock(&strips).pop().unwrap_or_else(|| Strip::new(rows));
        plan.draw(web, which.clone(), &mut strip, by)?;
        let mut sum = lock(&sum);
        let (cut, is_full) = strip.add_to(&mut sum.0);
        sum.1 += cut;
        sum.2 |= is_full;
        lock(&strips).push(strip);
        Ok(())
    })?;
    let (map, cut, is_full) = unlock(sum);
    if is_full {
        return Err(too_full(sheet.cell).into());
    }
    Ok(LaidWeb { map, cut: cut as f64 * quantum, shared_air: None })
}

/// The quantum of mass [kg]: a part of a piece is a power of two of them, as many as the fullest cell can count.
fn quantum(web: &Web, plans: &[Plan<'_>]) -> Option<f64> {
    let part = plans.first()?.mass_of_part();
    let cell = web.sheet.cell * web.sheet.cell;
    let single = plans.iter().map(|plan| plan.mass_of_trace(&web.sheet)).sum::<f64>();
    let highest = HIGHEST * (web.basis_weight() * cell + single) / part;
    let lightest = plans.iter().map(Plan::mass_of_part).fold(f64::MAX, f64::min) / part;
    // A curve that stays in one cell for a block of pieces can be counted too.
    let pieces = plans.iter().map(|plan| plan.parts * BLOCK).max()?;
    let most = (2f64.powi(31) / pieces as f64).min(2f64.powi(20));
    let quanta = (2f64.powi(32) / highest).min(most).log2().floor().exp2();
    (quanta * lightest >= 16.0 && quanta.is_finite()).then(|| part / quanta)
}
