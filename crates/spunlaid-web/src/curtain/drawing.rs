//! Curves of a curtain on the sheet.

use super::Curtain;
use crate::map::{
    CanvasPart, DepositionGrid, Depositor, LaidWeb, NO_CORNERS, Sheet, Titres, Window, WindowCurve,
    WindowCurves, WindowOnSheet, widen,
};
use spunlaid_ground::threads::try_par_map;
use spunlaid_ground::{Error, Fault, Lanes, WIDTH, Workers};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// Pieces that are drawn at once.
const BLOCK: usize = 512;
/// Most filaments that are drawn together, and groups of them for each thread.
const MOST_TOGETHER: usize = 96;
const GROUPS: usize = 8;

/// The stretch of belt that becomes the sheet. Positions on the belt are counted from where a filament in the middle of
/// the slot is fed when its first point is fed, and what is laid later lies farther back.
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
                "simulate the filaments for longer, or make the sheet shorter (web.length)",
            ));
        }
        Ok(Self { sheet, window, back: back_of_start - sheet.length })
    }
}

/// Draws all filaments of a curtain on a canvas. The parts of them in the window are returned.
///
/// * `brush` – draws a piece from point to point
///
/// # Errors
/// If it is stopped.
pub fn draw(
    curtain: &dyn Curtain,
    belt: Belt<'_>,
    brush: &Depositor<'_>,
    workers: Workers<'_>,
) -> Result<Vec<WindowCurve>, Error> {
    let Workers { threads, stop } = workers;
    let count = curtain.places().len();
    // Neighbours are drawn together, because they lie on the same part of the sheet.
    let together = (count / (GROUPS * threads.max(1))).next_multiple_of(WIDTH).clamp(WIDTH, MOST_TOGETHER);
    let points = points_on(curtain, belt);
    let groups = try_par_map(threads, count.div_ceil(together), |group| {
        let filaments = group * together..count.min((group + 1) * together);
        draw_neighbours(&Neighbours { curtain, belt, filaments }, points.clone(), brush, stop)
    })?;
    Ok(groups.concat())
}

/// The points whose pieces may touch the sheet or be kept.
fn points_on(curtain: &dyn Curtain, belt: Belt<'_>) -> Range<usize> {
    let advance = curtain.belt_ratio() * curtain.spacing();
    let farthest = curtain.farthest();
    // A piece that begins a cell beside the window is kept.
    let beyond = farthest + 2.0 * belt.sheet.cell;
    let y = || curtain.places().iter().map(|place| place.y - belt.back);
    let [first, last] = [y().fold(f64::INFINITY, f64::min), y().fold(f64::NEG_INFINITY, f64::max)];
    // A piece more on each side, for numbers that are rounded.
    let begin = (first - beyond - belt.sheet.length) / advance - 2.0;
    let end = (last + beyond) / advance + 3.0;
    begin as usize..(end as usize).min(curtain.points())
}

/// Filaments that are drawn together, in groups of eight side by side.
struct Neighbours<'a> {
    curtain: &'a dyn Curtain,
    belt: Belt<'a>,
    filaments: Range<usize>,
}

impl Neighbours<'_> {
    /// The filament of a lane. Lanes left over repeat the last one.
    fn of_lane(&self, eight: usize, lane: usize) -> usize {
        (self.filaments.start + eight * WIDTH + lane).min(self.filaments.end - 1)
    }

    /// How far the belt moves from point to point [m].
    fn advance(&self) -> f64 {
        self.curtain.belt_ratio() * self.curtain.spacing()
    }

    /// Length of the longest piece on the belt, but for rare exceptions [m].
    fn longest(&self) -> f64 {
        self.curtain.spacing() + self.advance()
    }

    /// Where the straight trace of a filament is when a point is laid, in cross and in machine direction [m].
    fn trace(&self, filament: usize, point: usize) -> [f64; 2] {
        let place = self.curtain.places()[filament];
        [place.z, place.y - self.advance() * point as f64 - self.belt.back]
    }

    /// Fills `points` with some deviations of all filaments, eight filaments after the other. Returns the corners of
    /// what they cover [m].
    fn read(&self, which: Range<usize>, points: &mut Vec<[Lanes; 2]>) -> [[f64; 2]; 2] {
        let (count, advance) = (which.len(), self.advance());
        let mut corners = NO_CORNERS;
        let [mut md, mut cd] = [[0.0; BLOCK + 1]; 2];
        points.resize(count * self.filaments.len().div_ceil(WIDTH), [Lanes::ZERO; 2]);
        for (eight, points) in points.chunks_exact_mut(count).enumerate() {
            for lane in 0..WIDTH {
                let filament = self.of_lane(eight, lane);
                self.curtain.curve(filament, which.start, [&mut md[..count], &mut cd[..count]]);
                let [cross, mut along] = self.trace(filament, which.start);
                for (point, (md, cd)) in points.iter_mut().zip(md.iter().zip(&cd)) {
                    let [md, cd] = [f64::from(*md), f64::from(*cd)];
                    (point[0].0[lane], point[1].0[lane]) = (md, cd);
                    widen(&mut corners, [cross + cd, along + md]);
                    along -= advance;
                }
            }
        }
        corners
    }

    /// Draws the pieces of eight filaments, from the number `first` on.
    ///
    /// * `eight` – number of the group
    fn draw(
        &self,
        eight: usize,
        first: usize,
        points: &[[Lanes; 2]],
        brush: &Depositor<'_>,
        part: &mut CanvasPart<'_>,
    ) {
        let count = WIDTH.min(self.filaments.len() - eight * WIDTH);
        let at = [0, 1].map(|axis| Lanes::from_fn(|lane| self.trace(self.of_lane(eight, lane), first)[axis]));
        let mut pens = brush.canvas.pens(at, self.advance(), self.longest());
        let titre = |lane| brush.titres.of(self.of_lane(eight, lane));
        if (0..count).all(|lane| titre(lane).is_none()) {
            pens.quanta = Lanes::from_fn(|lane| if lane < count { f64::from(brush.quanta) } else { 0.0 });
            return part.draw(&mut pens, points);
        }
        for (pair, point) in points.windows(2).zip(first + 1..) {
            pens.quanta = Lanes::from_fn(|lane| {
                let md = self.trace(self.of_lane(eight, lane), point)[1] + pair[1][0].0[lane];
                if lane < count { f64::from(brush.quanta_at(titre(lane), md).0) } else { 0.0 }
            });
            part.draw(&mut pens, pair);
        }
    }
}

fn draw_neighbours(
    of: &Neighbours<'_>,
    points_on: Range<usize>,
    brush: &Depositor<'_>,
    stop: &AtomicBool,
) -> Result<Vec<WindowCurve>, Error> {
    let window = WindowOnSheet::new(of.belt.window, of.belt.sheet);
    let mut strands: Vec<WindowCurves> = of.filaments.clone().map(|_| WindowCurves::default()).collect();
    let (mut part, mut points) = (CanvasPart::new(brush.canvas), Vec::new());
    let last = points_on.end.saturating_sub(1);
    for first in (points_on.start..last).step_by(BLOCK) {
        if stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted);
        }
        let which = first..(first + BLOCK).min(last) + 1;
        let corners = of.read(which.clone(), &mut points);
        part.move_to(corners, of.longest(), points.len() * WIDTH);
        for (eight, points) in points.chunks_exact(which.len()).enumerate() {
            of.draw(eight, first, points, brush, &mut part);
        }
        if window.is_beside(corners[0][1], corners[1][1]) {
            for (number, strands) in strands.iter_mut().enumerate() {
                let filament = of.filaments.start + number;
                let points = &points[number / WIDTH * which.len()..][..which.len()];
                let at = |i: usize| {
                    let [md, cd] = [0, 1].map(|axis: usize| points[i][axis].0[number % WIDTH]);
                    let [cross, along] = of.trace(filament, first + i);
                    [cross + cd, along + md]
                };
                for i in 1..which.len() {
                    let (from, to) = (at(i - 1), at(i));
                    let (_, titre) = brush.quanta_at(brush.titres.of(filament), to[1]);
                    strands.keep(filament, [from, to], titre, &window);
                }
            }
        }
    }
    part.pass_on();
    Ok(strands.into_iter().flat_map(WindowCurves::into_parts).collect())
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
    workers: Workers<'_>,
) -> Result<(LaidWeb, Vec<WindowCurve>), Error> {
    lay_with(curtain, belt, element, Titres::default(), workers)
}

/// [`lay`] of filaments of which some have defects.
pub fn lay_with(
    curtain: &dyn Curtain,
    belt: Belt<'_>,
    element: f64,
    titres: Titres,
    workers: Workers<'_>,
) -> Result<(LaidWeb, Vec<WindowCurve>), Error> {
    let per_length = element / curtain.spacing() * curtain.places().len() as f64;
    let basis_weight = per_length / curtain.belt_ratio() / belt.sheet.width;
    let canvas = DepositionGrid::new(belt.sheet, &[element], basis_weight)?;
    let strands = draw(curtain, belt, &Depositor::new(&canvas, element, titres), workers)?;
    Ok((canvas.finish()?, strands))
}

#[cfg(test)]
mod tests {
    use super::super::FlownCurves;
    use super::super::synthetic::{BELT_RATIO, Field, SPACING, row};
    use super::*;
    use spunlaid_ground::place::Inlet;

    const CELL: f64 = 1e-3;
    const ELEMENT: f64 = 1e-9;

    fn laid(curtain: &dyn Curtain, belt: Belt<'_>, threads: usize) -> (LaidWeb, Vec<WindowCurve>) {
        lay(curtain, belt, ELEMENT, Workers { threads, stop: &AtomicBool::new(false) }).unwrap()
    }

    /// Filaments that come down at one place lie in straight lines, each with its mass in every cell of its column.
    #[test]
    fn analytic_straight_lines() {
        let (width, points) = (12e-3, 2000);
        let places: Vec<Inlet> =
            (0..4).map(|i| Inlet { y: 1e-3 * f64::from(i), z: 3e-3 * f64::from(i) + 0.5e-3 }).collect();
        // The last one is laid beyond the edge and comes in at the other side.
        let curve = |i: usize| vec![[0.0, if i == 3 { 3e-3 } else { 0.0 }]; points];
        let curves: Vec<_> = (0..4).map(curve).collect();
        let simulated = FlownCurves::new(places, Some(width), SPACING, BELT_RATIO, &curves).unwrap();
        let sheet = Sheet::new(width, 0.1, CELL);
        let window = Window { corner: [2e-3, 50e-3], sides: [6e-3, 4e-3] };
        let belt = Belt::within(&simulated, &sheet, window).unwrap();
        let (laid, strands) = laid(&simulated, belt, 2);
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
        let simulated = field.simulated(row(field.turn, 16));
        let filling = simulated.fill(row(field.turn, 100), 2);
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
        let simulated = field.simulated(row(field.turn, 4));
        let sheet = Sheet::new(field.turn, 0.5, CELL);
        let window = Window { corner: [0.0; 2], sides: [20e-3; 2] };
        let fault = Belt::within(&simulated, &sheet, window).unwrap_err().to_string();
        assert!(fault.contains("the sheet is 500 mm long"), "{fault}");
        let belt = Belt { sheet: &sheet, window, back: 0.0 };
        let stopped = lay(&simulated, belt, ELEMENT, Workers { threads: 1, stop: &AtomicBool::new(true) });
        assert!(matches!(stopped, Err(Error::Interrupted)));
    }
}
