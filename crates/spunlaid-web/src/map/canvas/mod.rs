//! A map on which many threads draw at once.

mod raster;

use super::basis_weight::Map;
use super::laid_web::{HIGHEST, LaidWeb, too_full};
use super::window::floor;
use super::{Edges, Sheet};
use raster::Draw;
pub(crate) use raster::LaneDepositors;
pub(super) use raster::OUTSIDE;
use spunlaid_ground::threads::lock;
use spunlaid_ground::{Fault, Isa, Lanes, WIDTH};
use std::sync::{Mutex, PoisonError};

/// Basis weight of the thickest ropes that are reckoned with, over the mean: filaments that hang in the same
/// air come down together.
const ROPE: f64 = 64.0;
/// Most quanta of a piece.
const MOST: f64 = 1_048_576.0;
/// Fewest quanta of a piece, so that its share in each cell is accurate enough.
const FEWEST: f64 = 16.0;

/// Most cells of a part on which a thread draws alone: four megabytes.
const MOST_NEAR: i64 = 1 << 20;
/// Cells of it that can be handed over in the time in which a piece is drawn elsewhere.
const WORTH: usize = 64;
/// Most shares of pieces elsewhere that wait, and most pieces of a curve that are looked at together.
const MOST_FAR: usize = 1 << 16;
const MOST_ALIKE: usize = 4096;

/// The cells of a sheet while straight pieces are drawn on it. The masses are whole numbers of a quantum, so
/// the map does not depend on the order of the pieces. In machine direction the sheet is a stretch of the
/// belt: what lies before and behind it is not counted, unless it is closed to a ring.
#[derive(Debug)]
pub struct DepositionGrid {
    /// Columns and rows.
    pub(super) size: [i64; 2],
    pub(super) cell: f64,
    quantum: f64,
    /// Whether the sheet goes on at the other edge, in cross and in machine direction.
    pub(super) closed: [bool; 2],
    isa: Isa,
    sums: Mutex<CellSums>,
}

/// What has been drawn.
#[derive(Debug)]
struct CellSums {
    cells: Vec<u32>,
    cut: u64,
    is_full: bool,
}

impl DepositionGrid {
    /// * `pieces` – mass of a piece [kg] of each layer
    /// * `basis_weight` – of all layers [kg/m²]
    ///
    /// # Errors
    /// If the cells are too large for the fibre that they would hold.
    pub fn new(sheet: &Sheet, pieces: &[f64], basis_weight: f64) -> Result<Self, Fault> {
        let [columns, rows] = sheet.cells();
        let heaviest = pieces.iter().copied().fold(0.0, f64::max);
        let lightest = pieces.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = HIGHEST + ROPE * basis_weight * sheet.cell * sheet.cell / heaviest;
        let quanta = (2f64.powi(32) / highest).min(MOST).log2().floor().exp2();
        let quantum = heaviest / quanta;
        // Written so that a NaN is refused.
        if !(lightest / quantum >= FEWEST && quantum.is_normal()) {
            return Err(too_full(sheet.cell));
        }
        Ok(Self {
            size: [columns as i64, rows as i64],
            cell: sheet.cell,
            quantum,
            closed: [sheet.edges == Edges::Periodic, false],
            isa: Isa::detect(),
            sums: Mutex::new(CellSums { cells: vec![0; columns * rows], cut: 0, is_full: false }),
        })
    }

    /// The same sheet, closed to a ring in machine direction.
    pub(super) fn ring(self, isa: Isa) -> Self {
        Self { closed: [self.closed[0], true], isa, ..self }
    }

    /// Quanta of a piece of this mass [kg].
    pub(crate) fn quanta(&self, piece: f64) -> u32 {
        (piece / self.quantum).round() as u32
    }

    /// What draws up to eight curves.
    ///
    /// * `at` – where their straight traces are, in cross and in machine direction [m]
    /// * `advance` – of the belt while a piece is laid [m]
    /// * `longest` – piece, but for rare exceptions [m]
    pub(crate) fn pens(&self, at: [Lanes; 2], advance: f64, longest: f64) -> LaneDepositors {
        let at = at.map(|at| Lanes(at.0.map(|at| at / self.cell)));
        let (advance, parts) = (advance / self.cell, self.parts(longest));
        LaneDepositors { advance, parts, is_bounded: false, quanta: Lanes::ZERO, at }
    }

    /// Parts of a piece of this length [m], none longer than a cell.
    fn parts(&self, length: f64) -> usize {
        (length / self.cell).ceil().max(1.0) as usize
    }

    /// Draws a curve.
    ///
    /// * `curve` – its points in cross and in machine direction, from the first corner of the sheet [m]
    /// * `longest` – piece, but for rare exceptions [m]
    /// * `quanta` – of a piece, by its last point
    pub fn draw(&self, curve: &[[f64; 2]], longest: f64, quanta: impl Fn([f64; 2]) -> u32) {
        let mut part = CanvasPart::new(self);
        part.draw_curve(curve, longest, quanta, true);
        part.pass_on();
    }

    /// Draws a curve when nobody else draws.
    pub(crate) fn draw_alone(&mut self, curve: &[[f64; 2]], longest: f64, quanta: u32) {
        let cells = std::mem::take(&mut lock(&self.sums).cells);
        let mut part = CanvasPart { size: self.size, cells, ..CanvasPart::new(self) };
        part.draw_curve(curve, longest, |_| quanta, false);
        let CanvasPart { cells, mut far, is_full, .. } = part;
        let mut sums = lock(&self.sums);
        sums.cells = cells;
        sums.is_full |= is_full;
        far.drain(..).for_each(|(cell, quanta)| self.add(&mut sums, cell, &mut [quanta]));
    }

    /// Adds cells of a row from a column on, and empties them.
    fn add(&self, sums: &mut CellSums, [mut column, row]: [i64; 2], mut cells: &mut [u32]) {
        let [columns, rows] = self.size;
        let row_on_ring = if self.closed[1] { row.rem_euclid(rows) } else { row };
        // What lies before and behind the sheet is not counted.
        if !(0..rows).contains(&row_on_ring) {
            cells.fill(0);
            return;
        }
        while !cells.is_empty() {
            // As far as the next edge of the sheet.
            let in_turn = column.rem_euclid(columns);
            let (now, later) = cells.split_at_mut(cells.len().min((columns - in_turn) as usize));
            let count = now.len();
            let drawn = now.iter_mut().map(std::mem::take);
            if self.closed[0] || in_turn == column {
                let at = (row_on_ring * columns + in_turn) as usize;
                for (sum, drawn) in sums.cells[at..].iter_mut().zip(drawn) {
                    let (whole, beyond) = sum.overflowing_add(drawn);
                    *sum = whole;
                    sums.is_full |= beyond;
                }
            } else {
                sums.cut += drawn.map(u64::from).sum::<u64>();
            }
            (column, cells) = (column + count as i64, later);
        }
    }

    /// What has been laid.
    ///
    /// # Errors
    /// If a cell holds more than can be counted.
    pub fn finish(self) -> Result<LaidWeb, Fault> {
        let CellSums { cells, cut, is_full } = self.sums.into_inner().unwrap_or_else(PoisonError::into_inner);
        if is_full {
            return Err(too_full(self.cell));
        }
        let [columns, rows] = self.size.map(|size| size as usize);
        let (quantum, closed) = (self.quantum, self.closed);
        let map = Map { columns, rows, cell: self.cell, quantum, closed, cells };
        Ok(LaidWeb { map, cut: cut as f64 * quantum, simulated: Vec::new() })
    }
}

/// Corners of a rectangle without points.
pub const NO_CORNERS: [[f64; 2]; 2] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];

/// Makes a rectangle so large that it holds a point.
#[inline(always)]
pub fn widen([first, last]: &mut [[f64; 2]; 2], point: [f64; 2]) {
    for (axis, at) in point.into_iter().enumerate() {
        first[axis] = first[axis].min(at);
        last[axis] = last[axis].max(at);
    }
}

/// A part of a canvas on which one thread draws for a while, near to itself and without waiting for others.
/// What it has drawn goes to the canvas when it moves to another part, and at the end.
#[derive(Debug)]
pub struct CanvasPart<'a> {
    pub(super) canvas: &'a DepositionGrid,
    /// First column and row, and number of columns and rows.
    pub(super) first: [i64; 2],
    pub(super) size: [i64; 2],
    pub(super) cells: Vec<u32>,
    /// What was drawn elsewhere.
    far: Vec<([i64; 2], u32)>,
    pub(super) is_full: bool,
}

impl<'a> CanvasPart<'a> {
    /// On which nothing can be drawn near yet.
    pub(crate) fn new(canvas: &'a DepositionGrid) -> Self {
        Self { canvas, first: [0; 2], size: [0; 2], cells: Vec::new(), far: Vec::new(), is_full: false }
    }

    /// Moves to where pieces will be drawn; those that leave it are drawn too.
    ///
    /// * `corners` – of the pieces, in cross and in machine direction, the first and the last one [m]
    /// * `longest` – of them, but for rare exceptions [m]
    /// * `pieces` – their number. A few in a wide room are not worth the while.
    pub(crate) fn move_to(&mut self, corners: [[f64; 2]; 2], longest: f64, pieces: usize) {
        let [first, last] = corners.map(|corner| corner.map(|at| floor(at / self.canvas.cell)));
        let margin = self.canvas.parts(longest) as i64 + 2;
        let first = first.map(|first| first.saturating_sub(margin));
        let size = [0, 1].map(|i| last[i].saturating_sub(first[i]).saturating_add(1 + margin));
        let cells = size[0].saturating_mul(size[1]);
        let is_worth =
            size.iter().all(|size| *size > 0) && cells < MOST_NEAR && cells as usize <= WORTH * pieces;
        self.cover(first, if is_worth { size } else { [0; 2] });
    }

    /// Draws a curve, see [`DepositionGrid::draw`].
    ///
    /// * `moves` – whether the part moves with it
    fn draw_curve(
        &mut self,
        mut curve: &[[f64; 2]],
        longest: f64,
        quanta: impl Fn([f64; 2]) -> u32,
        moves: bool,
    ) {
        let mut pens = self.canvas.pens([Lanes::ZERO; 2], 0.0, longest);
        while let [_, second, ..] = curve {
            let of = quanta(*second);
            let same = curve[1..].iter().take(MOST_ALIKE).take_while(|point| quanta(**point) == of).count();
            // Side by side, as many as there are: stretches of equal length.
            let (pieces, stretches) = if same < WIDTH { (1, same) } else { (same / WIDTH, WIDTH) };
            let start = |lane: usize| lane.min(stretches - 1) * pieces;
            let point =
                |i: usize| [1, 0].map(|axis: usize| Lanes::from_fn(|lane| curve[start(lane) + i][axis]));
            pens.quanta = Lanes::from_fn(|lane| if lane < stretches { f64::from(of) } else { 0.0 });
            let points: Vec<_> = (0..=pieces).map(point).collect();
            if moves {
                let mut corners = NO_CORNERS;
                curve[..=pieces * stretches].iter().for_each(|point| widen(&mut corners, *point));
                self.move_to(corners, longest, pieces * stretches);
                self.draw(&mut pens, &points);
            } else {
                self.canvas.isa.run(Draw { pens: &mut pens, part: self, points: &points });
            }
            curve = &curve[pieces * stretches..];
        }
    }

    /// Moves to a rectangle of cells.
    pub(super) fn cover(&mut self, first: [i64; 2], size: [i64; 2]) {
        self.pass_on();
        (self.first, self.size) = (first, size);
        self.cells.resize((size[0] * size[1]) as usize, 0);
    }

    /// Draws the pieces between points, and goes on along the straight traces.
    ///
    /// * `points` – [ξ₁, ξ₂] of each curve, seen from its straight trace [m]
    pub(crate) fn draw(&mut self, pens: &mut LaneDepositors, points: &[[Lanes; 2]]) {
        self.canvas.isa.run(Draw { pens, part: self, points });
        if self.far.len() > MOST_FAR {
            self.pass_on();
        }
    }

    /// Adds to a cell, near or far.
    pub(super) fn add(&mut self, cell: [i64; 2], quanta: u32) {
        let [column, row] = [cell[0] - self.first[0], cell[1] - self.first[1]];
        let is_near = (0..self.size[0]).contains(&column) && (0..self.size[1]).contains(&row);
        if is_near {
            let cell = &mut self.cells[(row * self.size[0] + column) as usize];
            let (sum, beyond) = cell.overflowing_add(quanta);
            *cell = sum;
            self.is_full |= beyond;
        } else if quanta > 0 && (self.canvas.closed[1] || (0..self.canvas.size[1]).contains(&cell[1])) {
            self.far.push((cell, quanta));
        }
    }

    /// Hands what has been drawn over to the canvas.
    pub(crate) fn pass_on(&mut self) {
        let Self { canvas, first, size, cells, far, is_full } = self;
        let mut sums = lock(&canvas.sums);
        for (row, cells) in (first[1]..).zip(cells.chunks_exact_mut(size[0].max(1) as usize)) {
            canvas.add(&mut sums, [first[0], row], cells);
        }
        far.drain(..).for_each(|(cell, quanta)| canvas.add(&mut sums, cell, &mut [quanta]));
        sums.is_full |= *is_full;
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const CELL: f64 = 1e-3;

    fn canvas(edges: Edges) -> DepositionGrid {
        let sheet = Sheet { edges, ..Sheet::new(10e-3, 20e-3, CELL) };
        DepositionGrid::new(&sheet, &[1e-9], 1e-3).unwrap()
    }

    /// A piece across cells leaves in each the part that lies in it.
    #[test]
    fn analytic_a_slanting_piece_in_the_cells_that_it_crosses() {
        let canvas = canvas(Edges::Cut);
        let quanta = canvas.quanta(1e-9);
        // From (0.5, 0.5) to (3.5, 2.5) cells: edges at 1/6, 1/2, 5/6 across and at 1/4, 3/4 along.
        canvas.draw(&[[0.5e-3, 0.5e-3], [3.5e-3, 2.5e-3]], 3e-3, |_| quanta);
        let map = canvas.finish().unwrap().map;
        let part = |column: usize, row: usize| f64::from(map.row(row)[column]) / f64::from(quanta);
        let expected = [
            (0, 0, 1.0 / 6.0),
            (1, 0, 1.0 / 12.0),
            (1, 1, 0.25),
            (2, 1, 0.25),
            (2, 2, 1.0 / 12.0),
            (3, 2, 1.0 / 6.0),
        ];
        for (column, row, share) in expected {
            // Two sums rounded to whole quanta, a millionth of the piece each.
            assert!((part(column, row) - share).abs() < 2e-6, "{column} {row}: {}", part(column, row));
        }
        assert_eq!(map.total(), u64::from(quanta));
    }

    #[test]
    fn invariant_the_mass_of_pieces_that_leave_the_sheet() {
        for edges in [Edges::Periodic, Edges::Cut] {
            let canvas = canvas(edges);
            let quanta = canvas.quanta(1e-9);
            // Half of the first is beyond the left edge, half of the second lies before the stretch of belt.
            canvas.draw(&[[1e-3, 5.5e-3], [-1e-3, 5.5e-3]], 2e-3, |_| quanta);
            canvas.draw(&[[4.5e-3, 1e-3], [4.5e-3, -1e-3]], 2e-3, |_| quanta);
            let laid = canvas.finish().unwrap();
            let on = laid.map.total();
            let cut = (laid.cut / laid.map.quantum).round() as u64;
            let beyond = if edges == Edges::Periodic { [3, 0] } else { [2, 1] };
            assert_eq!([on, cut], beyond.map(|halves| halves * u64::from(quanta) / 2), "{edges:?}");
        }
    }

    /// A spiral that leaves the sheet on all sides, with pieces of up to four cells where one is the longest.
    #[test]
    fn identical_maps_of_a_curve_that_is_drawn_alone() {
        let turn = |i: u32| f64::from(i) * 0.2;
        let curve: Vec<[f64; 2]> = (0..100)
            .map(|i| [5e-3 + 4e-4 * turn(i) * turn(i).cos(), 10e-3 + 6e-4 * turn(i) * turn(i).sin()])
            .collect();
        for edges in [Edges::Periodic, Edges::Cut] {
            let (one, mut other) = (canvas(edges), canvas(edges));
            let quanta = one.quanta(1e-9);
            one.draw(&curve, CELL, |_| quanta);
            other.draw_alone(&curve, CELL, quanta);
            let (one, other) = (one.finish().unwrap(), other.finish().unwrap());
            assert!(one.map.total() > 0 && (one.cut > 0.0) == (edges == Edges::Cut));
            assert_eq!((one.map.cells, one.cut), (other.map.cells, other.cut), "{edges:?}");
        }
    }

    #[test]
    fn rejects_cells_that_cannot_count_the_fibre() {
        let sheet = Sheet { edges: Edges::Cut, ..Sheet::new(10.0, 10.0, 1.0) };
        assert!(DepositionGrid::new(&sheet, &[1e-12], 1.0).is_err());
        assert!(DepositionGrid::new(&sheet, &[f64::NAN], 1.0).is_err());
        assert!(DepositionGrid::new(&sheet, &[], 1.0).is_err());
    }
}
