//! Single fibres of a web, as curves.

use super::laying::LayControl;
use super::plan::{Plan, plans};
use super::window::{Strand, Window};
use super::{Edges, Web};
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
    let mut strands = Vec::new();
    let [places, mut along] = plan.start(web, first, count);
    let advance = plan.layer.belt_ratio() * plan.piece;
    let mut open: [Option<Strand>; WIDTH] = Default::default();
    plan.walk(web, first, count, by, |points| {
        for (lane, open) in open.iter_mut().enumerate().take(count) {
            let at = |i: usize| {
                let [md, cd] = points[i].each_ref().map(|coordinate: &Lanes| coordinate.0[lane]);
                [places.0[lane] + cd, along.0[lane] + md - advance * i as f64]
            };
            let mut last = at(0);
            let mut before = within(web, window, last);
            // A block may begin elsewhere than the last one ended.
            let ended = open.as_ref().and_then(|strand: &Strand| strand.points.last().copied());
            if ended.is_some_and(|end| window.distance(end, before) > 1e-6) {
                strands.extend(open.take());
            }
            let longest = (points.len() - 1) as f64 * (plan.piece + advance);
            let is_fed = plan.titre_at(first + lane, along.0[lane], web) > 0.0;
            if !(is_fed && window.nears(before, longest)) {
                strands.extend(open.take());
                continue;
            }
            for i in 1..points.len() {
                let next = at(i);
                let by = [next[0] - last[0], next[1] - last[1]];
                let point = [before[0] + by[0], before[1] + by[1]];
                let strand = |from| Strand { layer, filament: first + lane, points: vec![from] };
                if window.holds(before) || window.holds(point) {
                    open.get_or_insert_with(|| strand(before)).points.push(point);
                } else {
                    strands.extend(open.take());
                }
                last = next;
                before = within(web, window, next);
                if window.distance(before, point) > 1e-6 {
                    // The piece goes over the seam of the ring and comes in at the other end.
                    strands.extend(open.take());
                    if window.holds(before) {
                        let mut strand = strand([before[0] - by[0], before[1] - by[1]]);
                        strand.points.push(before);
                        *open = Some(strand);
                    }
                }
            }
        }
        let pieces = (points.len() - 1) as f64;
        along = Lanes(along.0.map(|at| at - advance * pieces));
    })?;
    strands.extend(open.into_iter().flatten());
    Ok(strands)
}

/// Whether a filament that comes down at a place may lay fibre in the window.
fn nears(web: &Web, plan: &Plan<'_>, place: f64, window: Window) -> bool {
    let reach = plan.layer.fibres.reach();
    let from_middle = (place - window.corner[0] - 0.5 * window.sides[0]).abs();
    let distance = match web.sheet.edges {
        Edges::Cut => from_middle,
        Edges::Periodic => {
            let turned = from_middle % web.sheet.width;
            turned.min(web.sheet.width - turned)
        }
    };
    distance <= reach + 0.5 * window.sides[0]
}

/// A place on the ring as seen from the corner of the window, as near to its middle as it can be.
fn within(web: &Web, window: Window, [cd, md]: [f64; 2]) -> [f64; 2] {
    let near = |at: f64, side: f64, around: f64| at - ((at - 0.5 * side) / around).round() * around;
    let (across, along) = (cd - window.corner[0], md - window.corner[1]);
    let across = match web.sheet.edges {
        Edges::Periodic => near(across, window.sides[0], web.sheet.width),
        Edges::Cut => across,
    };
    [across, near(along, window.sides[1], web.sheet.length)]
}
