//! Single fibres of a web, as curves.

use super::Web;
use super::lay::LayControl;
use super::plan::{Plan, plans};
use super::window::{Strand, Strands, Window, WindowOnSheet};
use crate::error::Error;
use crate::lanes::{Lanes, WIDTH};
use crate::threads::try_each;

/// The fibres in a window: those that [`lay`](super::lay) lays there, point by point.
///
/// # Errors
/// As [`lay`](super::lay).
pub fn strands(web: &Web, window: Window, by: LayControl<'_>) -> Result<Vec<Strand>, Error> {
    let plans = plans(web)?;
    let sets = |(layer, plan): (usize, &Plan<'_>)| {
        (0..plan.places.len()).step_by(WIDTH).map(move |first| (layer, first)).collect::<Vec<_>>()
    };
    let mut sets: Vec<(usize, usize)> = plans.iter().enumerate().flat_map(sets).collect();
    sets.retain(|&(layer, first)| {
        let places = plans[layer].places[first..].iter().take(WIDTH);
        places.copied().any(|place| nears(web, &plans[layer], place, window))
    });
    let of_sets = try_each(by.threads, sets.len(), |i| {
        let (layer, first) = sets[i];
        strands_of(web, window, (layer, &plans[layer]), first, by)
    })?;
    Ok(of_sets.concat())
}

/// The strands of up to eight filaments of a layer.
fn strands_of(
    web: &Web,
    window: Window,
    (layer, plan): (usize, &Plan<'_>),
    first: usize,
    by: LayControl<'_>,
) -> Result<Vec<Strand>, Error> {
    let count = WIDTH.min(plan.places.len() - first);
    let [places, mut along] = plan.start(web, first, count);
    let (on, advance) = (WindowOnSheet::on_ring(window, &web.sheet), plan.layer.belt_ratio() * plan.piece);
    let mut kept: Vec<Strands> = (0..count).map(|_| Strands::default()).collect();
    plan.walk(web, first, count, by, |points| {
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
                    kept.keep(first + lane, (ends, titre), &on);
                }
            }
        }
        along = Lanes(along.0.map(|at| at - advance * (points.len() - 1) as f64));
    })?;
    let strands = kept.into_iter().flat_map(Strands::into_parts);
    Ok(strands.map(|strand| Strand { layer, ..strand }).collect())
}

/// Whether a filament that comes down at a place may lay fibre in the window.
fn nears(web: &Web, plan: &Plan<'_>, place: f64, window: Window) -> bool {
    let on = WindowOnSheet::on_ring(window, &web.sheet);
    on.nears([place, window.corner[1]], plan.layer.fibres.reach())
}
