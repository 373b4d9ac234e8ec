//! Curves of a curtain on the sheet.

use super::Curtain;
use crate::ground::threads::try_each;
use crate::ground::{Error, Fault};
use crate::web::map::{
    Brush, Canvas, CanvasPart, LaidWeb, Sheet, Strand, Strands, Titres, Window, WindowOnSheet,
};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// Points that are computed at once.
const BLOCK: usize = 512;
/// Most filaments that are drawn together, and groups of them for each thread.
const MOST_TOGETHER: usize = 96;
const GROUPS: usize = 8;

/// The stretch of belt that becomes the sheet, as in a [beam](crate::simulation::beam): places on the belt are counted
/// from where a filament in the middle of the slot is fed when its first point is fed, and what is laid later
/// lies farther back.
#[derive(Clone, Copy, Debug)]
pub struct Belt<'a> {
    /// The sheet.
    pub sheet: &'a Sheet,
    /// A window of the sheet, whose single fibres are kept.
    pub window: Window,
    /// Where the sheet begins, at its back [m].
    pub back: f64,
}

impl<'a> Belt<'a> {
    /// The stretch on which all filaments of a curtain lie from edge to edge, as near to their start as it can be.
    ///
    /// # Errors
    /// If the curves are too short for the sheet.
    pub fn within(curtain: &dyn Curtain, sheet: &'a Sheet, window: Window) -> Result<Self, Fault> {
        let [back_of_start, front_of_end] = curtain.reach();
        let passed = curtain.belt_ratio() * curtain.spacing() * (curtain.points() as f64 - 1.0);
        let longest = back_of_start - (front_of_end - passed);
        if sheet.length > longest {
            return Err(Fault::new(
                format!(
                    "the curves of the filaments cover {} mm of belt from edge to edge, and the sheet is {} mm long",
                    (longest.max(0.0) * 1e3).floor(),
                    (sheet.length * 1e3).ceil()
                ),
                "fly the filaments for longer, or make the sheet shorter (web.length)",
            ));
        }
        Ok(Self { sheet, window, back: back_of_start - sheet.length })
    }
}

/// Draws all filaments of a curtain on the rows of a canvas. The parts of them in the window, if it begins on
/// these rows, are returned.
///
/// * `brush` – draws a piece from point to point
///
/// # Errors
/// If it is stopped.
pub(crate) fn draw(
    curtain: &dyn Curtain,
    belt: Belt<'_>,
    brush: &Brush<'_>,
    (threads, stop): (usize, &AtomicBool),
) -> Result<Vec<Strand>, Error> {
    let count = curtain.places().len();
    // Neighbours are drawn together, because they lie on the same part of the sheet.
    let together = (count / (GROUPS * threads.max(1))).clamp(1, MOST_TOGETHER);
    let (points, window) = points_on(curtain, belt, brush.canvas.ends());
    let groups = try_each(threads, count.div_ceil(together), |group| {
        let filaments = group * together..count.min((group + 1) * together);
        draw_neighbours(curtain, (filaments, &points), (belt, &window), brush, stop)
    })?;
    Ok(groups.concat())
}

/// The points whose pieces may touch a stretch of the sheet, and the window if it begins there, which is then
/// a part of the stretch.
///
/// * `ends` – of the stretch [m]
fn points_on(
    curtain: &dyn Curtain,
    belt: Belt<'_>,
    [mut from, mut to]: [f64; 2],
) -> (Range<usize>, WindowOnSheet) {
    let window = WindowOnSheet::beginning_on(belt.window, belt.sheet, [from, to]);
    if let Some([first, last]) = window.reach() {
        (from, to) = (from.min(first), to.max(last));
    }
    let (advance, farthest) = (curtain.belt_ratio() * curtain.spacing(), curtain.farthest());
    let y = || curtain.places().iter().map(|place| place.y - belt.back);
    let [first, last] = [y().fold(f64::INFINITY, f64::min), y().fold(f64::NEG_INFINITY, f64::max)];
    // A piece more on each side, for numbers that are rounded.
    let begin = (first - farthest - to) / advance - 2.0;
    let end = (last + farthest - from) / advance + 3.0;
    (begin as usize..(end as usize).min(curtain.points()), window)
}

/// A filament while it is drawn.
#[derive(Default)]
struct Pen {
    strands: Strands,
    last: Option<[f64; 2]>,
}

fn draw_neighbours(
    curtain: &dyn Curtain,
    (filaments, points_on): (Range<usize>, &Range<usize>),
    (belt, window): (Belt<'_>, &WindowOnSheet),
    brush: &Brush<'_>,
    stop: &AtomicBool,
) -> Result<Vec<Strand>, Error> {
    let advance = curtain.belt_ratio() * curtain.spacing();
    let mut pens: Vec<Pen> = filaments.clone().map(|_| Pen::default()).collect();
    let mut part = CanvasPart::new(brush.canvas);
    let (mut values, mut points) = ([[0.0; BLOCK]; 2], Vec::new());
    for first in points_on.clone().step_by(BLOCK) {
        if stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted);
        }
        let count = BLOCK.min(points_on.end - first);
        points.clear();
        let mut corners = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for filament in filaments.clone() {
            let place = curtain.places()[filament];
            curtain.curve(filament, first, values.each_mut().map(|values| &mut values[..count]));
            for (i, (md, cd)) in values[0][..count].iter().zip(&values[1]).enumerate() {
                let md = place.y + f64::from(*md) - advance * (first + i) as f64 - belt.back;
                let point = [place.z + f64::from(*cd), md];
                for axis in 0..2 {
                    corners[0][axis] = corners[0][axis].min(point[axis]);
                    corners[1][axis] = corners[1][axis].max(point[axis]);
                }
                points.push(point);
            }
        }
        part.move_to(corners, points.len());
        for ((filament, pen), points) in filaments.clone().zip(&mut pens).zip(points.chunks_exact(count)) {
            let titre = brush.titres.of(filament);
            for to in points {
                if let Some(from) = pen.last.replace(*to) {
                    let (quanta, titre) = brush.quanta_at(titre, to[1]);
                    part.draw(from, *to, quanta);
                    pen.strands.keep(filament, ([from, *to], titre), window);
                }
            }
        }
    }
    part.pass_on();
    Ok(pens.into_iter().flat_map(|pen| pen.strands.into_parts()).collect())
}

/// Lays all filaments of a curtain on a sheet; the parts of them in the window are returned too.
///
/// * `element` – mass of a piece from point to point [kg]
///
/// # Errors
/// If a cell would hold more fibre than can be counted, or if it is stopped.
pub fn lay(
    curtain: &dyn Curtain,
    belt: Belt<'_>,
    element: f64,
    by: (usize, &AtomicBool),
) -> Result<(LaidWeb, Vec<Strand>), Error> {
    let per_length = element / curtain.spacing() * curtain.places().len() as f64;
    let basis_weight = per_length / curtain.belt_ratio() / belt.sheet.width;
    let canvas = Canvas::new(belt.sheet, &[element], basis_weight)?;
    let strands = draw(curtain, belt, &Brush::new(&canvas, element, Titres::default()), by)?;
    Ok((canvas.finish()?, strands))
}

#[cfg(test)]
mod tests {
    use super::super::FlownCurves;
    use super::super::synthetic::{BELT_RATIO, Field, SPACING, row};
    use super::*;
    use crate::ground::place::Place;

    const CELL: f64 = 1e-3;
    const ELEMENT: f64 = 1e-9;

    fn laid(curtain: &dyn Curtain, belt: Belt<'_>, threads: usize) -> (LaidWeb, Vec<Strand>) {
        lay(curtain, belt, ELEMENT, (threads, &AtomicBool::new(false))).unwrap()
    }

    /// Filaments that come down at one place lie in straight lines, each with its mass in every cell of its column.
    #[test]
    fn analytic_straight_lines() {
        let (width, points) = (12e-3, 2000);
        let places: Vec<Place> =
            (0..4).map(|i| Place { y: 1e-3 * f64::from(i), z: 3e-3 * f64::from(i) + 0.5e-3 }).collect();
        // The last one is laid beyond the edge and comes in at the other side.
        let curve = |i: usize| vec![[0.0, if i == 3 { 3e-3 } else { 0.0 }]; points];
        let curves: Vec<_> = (0..4).map(curve).collect();
        let flown = FlownCurves::new(places, Some(width), (SPACING, BELT_RATIO), &curves).unwrap();
        let sheet = Sheet::new(width, 0.1, CELL);
        let window = Window { corner: [2e-3, 50e-3], sides: [6e-3, 4e-3] };
        let belt = Belt::within(&flown, &sheet, window).unwrap();
        let (laid, strands) = laid(&flown, belt, 2);
        let of_cell = ELEMENT * CELL / (SPACING * BELT_RATIO) / (CELL * CELL);
        for row in 0..laid.map.rows {
            for (column, quanta) in laid.map.row(row).iter().enumerate() {
                let weight = f64::from(*quanta) * laid.map.weight_of_quantum() / of_cell;
                let expected = match column {
                    0 => 2.0,
                    3 | 6 => 1.0,
                    _ => 0.0,
                };
                assert!((weight - expected).abs() < 1e-4, "{row} {column}: {weight}");
            }
        }
        let filaments: Vec<usize> = strands.iter().map(|strand| strand.filament).collect();
        assert_eq!(filaments, [1, 2]);
        for strand in &strands {
            let pieces = (strand.points.len() - 1) as f64;
            // From edge to edge of the window, with less than a piece beyond each.
            let cover = pieces * SPACING * BELT_RATIO;
            let most = 4e-3 + 2.0 * SPACING * BELT_RATIO;
            assert!((4e-3 - 1e-9..most).contains(&cover), "{cover}");
            let across = 3e-3 * strand.filament as f64 + 0.5e-3 - window.corner[0];
            assert!(strand.points.iter().all(|point| (point[0] - across).abs() < 1e-6));
        }
    }

    #[test]
    fn invariant_all_fibre_that_passes_lies_on_a_periodic_sheet() {
        let field = Field { memory: 0.98, ..Field::default() };
        let flown = field.flown(row(field.turn, 16));
        let filling = flown.fill(row(field.turn, 100), 2);
        let sheet = Sheet::new(field.turn, 0.5, CELL);
        let window = Window { corner: [0.0; 2], sides: [20e-3; 2] };
        let belt = Belt::within(&filling, &sheet, window).unwrap();
        let one = laid(&filling, belt, 1);
        let expected = ELEMENT * 100.0 * sheet.length / (SPACING * BELT_RATIO);
        let mass = one.0.map.basis_weight() * sheet.width * sheet.length;
        // The ends of the sheet cut the curves.
        assert!((mass / expected - 1.0).abs() < 0.02 && one.0.cut == 0.0, "{mass} {expected}");
        for threads in [2, 7] {
            let other = laid(&filling, belt, threads);
            assert!(other.0.map.cells == one.0.map.cells && other.1 == one.1);
        }
    }

    #[test]
    fn rejects_curves_that_are_too_short_and_stops() {
        let field = Field { points: 100, ..Field::default() };
        let flown = field.flown(row(field.turn, 4));
        let sheet = Sheet::new(field.turn, 0.5, CELL);
        let window = Window { corner: [0.0; 2], sides: [20e-3; 2] };
        let fault = Belt::within(&flown, &sheet, window).unwrap_err().to_string();
        assert!(fault.contains("the sheet is 500 mm long"), "{fault}");
        let belt = Belt { sheet: &sheet, window, back: 0.0 };
        assert!(matches!(lay(&flown, belt, ELEMENT, (1, &AtomicBool::new(true))), Err(Error::Interrupted)));
    }
}
