//! Lays all filaments of a web.

use super::Web;
use super::canvas::{CanvasPart, DepositionGrid};
use super::laid_web::LaidWeb;
use super::plan::{Plan, plans};
use super::window::{Window, WindowCurve, WindowCurves, WindowOnSheet};
use spunlaid_ground::threads::{lock, try_par_map};
use spunlaid_ground::{Error, Lanes, RunContext, WIDTH};
use std::ops::Range;
use std::sync::Mutex;

/// Most filaments that a thread lays before it adds them to the map, and times that a thread does so at least.
const MOST_TOGETHER: usize = 64 * WIDTH;
const TIMES: usize = 4;

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
pub fn lay(web: &Web, by: RunContext<'_>) -> Result<LaidWeb, Error> {
    let plans = plans(web)?;
    let pieces: Vec<f64> = plans.iter().map(Plan::mass_of_piece).collect();
    // No cell of a trace alone has more than four times its mean; a canvas reckons with ropes of 64 times.
    let traces = plans.iter().map(|plan| plan.weight_of_trace(&web.sheet)).sum::<f64>() / 16.0;
    let canvas = DepositionGrid::new(&web.sheet, &pieces, web.basis_weight() + traces)?.ring(by.isa);
    let mut units: Vec<(&Plan<'_>, Range<usize>)> = Vec::new();
    for plan in &plans {
        let count = plan.places.len();
        let together = (count / (TIMES * by.threads.max(1))).next_multiple_of(2 * WIDTH);
        let together = together.clamp(2 * WIDTH, MOST_TOGETHER);
        units.extend((0..count).step_by(together).map(|first| (plan, first..(first + together).min(count))));
    }
    // Parts are large; a thread uses one again.
    let parts = Mutex::new(Vec::new());
    try_par_map(by.threads, units.len(), |unit| {
        let (plan, which) = &units[unit];
        let mut part = lock(&parts).pop().unwrap_or_else(|| CanvasPart::new(&canvas));
        plan.draw(web, which.clone(), canvas.quanta(plan.mass_of_piece()), &mut part, by)?;
        lock(&parts).push(part);
        Ok(())
    })?;
    drop(parts);
    Ok(canvas.finish()?)
}

/// The fibres in a window: those that [`lay`](super::lay) lays there, point by point.
///
/// # Errors
/// As [`lay`](super::lay).
pub fn strands(web: &Web, window: Window, by: RunContext<'_>) -> Result<Vec<WindowCurve>, Error> {
    let plans = plans(web)?;
    let sets = |(layer, plan): (usize, &Plan<'_>)| {
        (0..plan.places.len()).step_by(WIDTH).map(move |first| (layer, first)).collect::<Vec<_>>()
    };
    let mut sets: Vec<(usize, usize)> = plans.iter().enumerate().flat_map(sets).collect();
    let on = WindowOnSheet::on_ring(window, &web.sheet);
    // Whether a filament that comes down at a place may lay fibre in the window.
    let nears = |plan: &Plan<'_>, place| on.nears([place, window.corner[1]], plan.layer.fibres.reach());
    sets.retain(|&(layer, first)| {
        plans[layer].places[first..].iter().take(WIDTH).any(|place| nears(&plans[layer], *place))
    });
    let of_sets = try_par_map(by.threads, sets.len(), |i| {
        let (layer, first) = sets[i];
        strands_of(web, &on, layer, &plans[layer], first, by)
    })?;
    Ok(of_sets.concat())
}

/// The strands of up to eight filaments of a layer.
fn strands_of(
    web: &Web,
    on: &WindowOnSheet,
    layer: usize,
    plan: &Plan<'_>,
    first: usize,
    by: RunContext<'_>,
) -> Result<Vec<WindowCurve>, Error> {
    let count = WIDTH.min(plan.places.len() - first);
    let [places, mut along] = plan.start(web, first, count);
    let advance = plan.layer.belt_ratio() * plan.piece;
    let mut kept: Vec<WindowCurves> = (0..count).map(|_| WindowCurves::default()).collect();
    plan.walk(web, &[(first, count)], by, |_, points| {
        let longest = (points.len() - 1) as f64 * (plan.piece + advance);
        for (lane, kept) in kept.iter_mut().enumerate() {
            let at = |(i, point): (usize, &[Lanes; 2])| {
                let [md, cd] = point.each_ref().map(|coordinate| coordinate.0[lane]);
                [places.0[lane] + cd, along.0[lane] + md - advance * i as f64]
            };
            if on.nears(at((0, &points[0])), longest) {
                let titre = plan.titre_at(first + lane, along.0[lane], web);
                for (i, ends) in points.windows(2).enumerate() {
                    let ends = [at((i, &ends[0])), at((i + 1, &ends[1]))];
                    kept.keep(first + lane, ends, titre, on);
                }
            }
        }
        along = Lanes(along.0.map(|at| at - advance * (points.len() - 1) as f64));
    })?;
    let strands = kept.into_iter().flat_map(WindowCurves::into_parts);
    Ok(strands.map(|strand| WindowCurve { layer, ..strand }).collect())
}
