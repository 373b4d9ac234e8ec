//! A map on which many threads draw at once.

use super::basis_weight::Map;
use super::laid_web::{HIGHEST, LaidWeb, too_full};
use super::window::floor;
use super::{Edges, Sheet};
use crate::ground::Fault;
use crate::ground::threads::lock;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};

/// Basis weight of the thickest ropes that are reckoned with, over the mean: filaments that hang in the same
/// air come down together.
const ROPE: f64 = 64.0;
/// Most quanta of a piece.
const MOST: f64 = 1_048_576.0;
/// Fewest quanta of a piece, so that its share in each cell is accurate enough.
const FEWEST: f64 = 16.0;

/// Most cells of a part on which a thread draws alone: four megabytes.
const MOST_NEAR: i64 = 1 << 20;

/// The cells of a sheet while straight pieces are drawn on it. The masses are whole numbers of a quantum, so
/// the map does not depend on the order of the pieces. In machine direction the sheet is a stretch of the
/// belt: what lies before and behind it is not counted, unless it is closed to a ring.
#[derive(Debug)]
pub(crate) struct Canvas {
    columns: i64,
    /// Those of the sheet that are drawn on.
    rows: Range<i64>,
    cell: f64,
    quantum: f64,
    /// Whether the sheet goes on at the other edge, in cross and in machine direction.
    closed: [bool; 2],
    cells: Vec<AtomicU32>,
    cut: AtomicU64,
    is_full: AtomicBool,
    /// Held by the thread that hands whole rows over.
    turn: Mutex<()>,
}

impl Canvas {
    /// * `pieces` – mass of a piece [kg] of each layer
    /// * `basis_weight` – of all layers [kg/m²]
    ///
    /// # Errors
    /// If the cells are too large for the fibre that they would hold.
    pub(crate) fn new(sheet: &Sheet, pieces: &[f64], basis_weight: f64) -> Result<Self, Fault> {
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
            columns: columns as i64,
            rows: 0..rows as i64,
            cell: sheet.cell,
            quantum,
            closed: [sheet.edges == Edges::Periodic, false],
            cells: (0..columns * rows).map(|_| AtomicU32::new(0)).collect(),
            cut: AtomicU64::new(0),
            is_full: AtomicBool::new(false),
            turn: Mutex::new(()),
        })
    }

    /// The same sheet, closed to a ring in machine direction.
    pub(super) fn ring(self) -> Self {
        Self { closed: [self.closed[0], true], ..self }
    }

    /// Where its rows begin and end on the sheet [m].
    pub(crate) fn ends(&self) -> [f64; 2] {
        [self.rows.start, self.rows.end].map(|row| row as f64 * self.cell)
    }

    /// Quanta of a piece of this mass [kg].
    pub(crate) fn quanta(&self, piece: f64) -> u32 {
        (piece / self.quantum).round() as u32
    }

    /// Draws a straight piece.
    ///
    /// * `from`, `to` – its ends in cross and in machine direction, from the first corner of the sheet [m]
    pub(crate) fn draw(&self, from: [f64; 2], to: [f64; 2], quanta: u32) {
        cross(self.cell, [from, to], quanta, |cell, part| self.add(cell, part));
    }

    /// As [`Canvas::draw`], where no other thread draws.
    pub(crate) fn draw_alone(&mut self, from: [f64; 2], to: [f64; 2], quanta: u32) {
        cross(self.cell, [from, to], quanta, |cell, part| match self.at(cell) {
            Some(at) => {
                let sum = self.cells[at].get_mut();
                let (whole, is_full) = sum.overflowing_add(part);
                *sum = whole;
                *self.is_full.get_mut() |= is_full;
            }
            None => self.cut_off(cell, u64::from(part)),
        });
    }

    fn add(&self, cell: [i64; 2], quanta: u32) {
        match self.at(cell) {
            Some(at) => {
                if self.cells[at].fetch_add(quanta, Ordering::Relaxed).checked_add(quanta).is_none() {
                    self.is_full.store(true, Ordering::Relaxed);
                }
            }
            None => self.cut_off(cell, u64::from(quanta)),
        }
    }

    /// Adds a row of cells and empties them, while no other thread adds anything.
    fn add_row(&self, [mut column, row]: [i64; 2], mut cells: &mut [u32]) {
        while !cells.is_empty() {
            // As far as the next edge of the sheet.
            let to_edge = (self.columns - column.rem_euclid(self.columns)) as usize;
            let (now, later) = cells.split_at_mut(cells.len().min(to_edge));
            let count = now.len();
            if let Some(at) = self.at([column, row]) {
                let mut is_full = false;
                for (sum, cell) in self.cells[at..][..count].iter().zip(now) {
                    let (whole, beyond) = sum.load(Ordering::Relaxed).overflowing_add(std::mem::take(cell));
                    sum.store(whole, Ordering::Relaxed);
                    is_full |= beyond;
                }
                if is_full {
                    self.is_full.store(true, Ordering::Relaxed);
                }
            } else {
                self.cut_off([column, row], now.iter_mut().map(|cell| u64::from(std::mem::take(cell))).sum());
            }
            (column, cells) = (column + count as i64, later);
        }
    }

    /// The number of a cell; None of one that is not on the sheet.
    #[inline(always)]
    fn at(&self, [column, row]: [i64; 2]) -> Option<usize> {
        let [is_across, is_along] = [(0..self.columns).contains(&column), self.rows.contains(&row)];
        let column = if is_across || !self.closed[0] { column } else { column.rem_euclid(self.columns) };
        let row = if is_along || !self.closed[1] { row } else { row.rem_euclid(self.rows.end) };
        let is_on = (is_along || self.closed[1]) && (is_across || self.closed[0]);
        is_on.then(|| (row * self.columns + column) as usize)
    }

    /// Counts what lies beyond an edge. What lies before and behind the rows is not counted.
    fn cut_off(&self, [_, row]: [i64; 2], quanta: u64) {
        if self.closed[1] || self.rows.contains(&row) {
            self.cut.fetch_add(quanta, Ordering::Relaxed);
        }
    }

    /// What has been laid.
    ///
    /// # Errors
    /// If a cell holds more than can be counted.
    pub(crate) fn finish(self) -> Result<LaidWeb, Fault> {
        if self.is_full.into_inner() {
            return Err(too_full(self.cell));
        }
        let cells = self.cells.into_iter().map(AtomicU32::into_inner).collect();
        let map = Map {
            columns: self.columns as usize,
            rows: self.rows.end as usize,
            cell: self.cell,
            quantum: self.quantum,
            closed: self.closed,
            cells,
        };
        let cut = self.cut.into_inner() as f64 * self.quantum;
        Ok(LaidWeb { map, cut, shared_air: None })
    }
}

/// Passes each cell that a straight piece crosses to `add`. Each gets what lies in it, as the difference of
/// two rounded sums, so that none of the piece is lost.
#[inline(always)]
fn cross(side: f64, ends: [[f64; 2]; 2], quanta: u32, mut add: impl FnMut([i64; 2], u32)) {
    let [from, to] = ends.map(|end| end.map(|at| at / side));
    let mut cell = from.map(floor);
    let mut step = [0, 0];
    // Shares of the piece up to the next edge of a cell each way, and from edge to edge.
    let (mut next, mut apart) = ([f64::INFINITY; 2], [0.0; 2]);
    for i in 0..2 {
        let by = to[i] - from[i];
        let within = from[i] - cell[i] as f64;
        if by != 0.0 {
            step[i] = if by > 0.0 { 1 } else { -1 };
            next[i] = if by > 0.0 { (1.0 - within) / by } else { -within / by };
            apart[i] = 1.0 / by.abs();
        }
    }
    let mut drawn = 0;
    loop {
        let way = usize::from(next[1] < next[0]);
        let last = next[way] >= 1.0 || next[way].is_nan();
        // Rounded, without a call.
        let until = if last { quanta } else { (next[way] * f64::from(quanta) + 0.5) as u32 };
        if until > drawn {
            add(cell, until - drawn);
        }
        if last {
            return;
        }
        drawn = until;
        cell[way] += step[way];
        next[way] += apart[way];
    }
}

/// A part of a canvas on which one thread draws for a while, near to itself and without waiting for others.
/// What it has drawn goes to the canvas when it moves to another part, and at the end.
#[derive(Debug)]
pub(crate) struct CanvasPart<'a> {
    canvas: &'a Canvas,
    /// First column and row, and number of columns and rows.
    pub(super) first: [i64; 2],
    pub(super) size: [i64; 2],
    pub(super) cells: Vec<u32>,
    /// What was drawn elsewhere, if it waits for its turn too.
    far: Option<Vec<([i64; 2], u32)>>,
}

impl<'a> CanvasPart<'a> {
    /// On which nothing can be drawn near yet.
    pub(crate) fn new(canvas: &'a Canvas) -> Self {
        Self { canvas, first: [0; 2], size: [0; 2], cells: Vec::new(), far: None }
    }

    /// One of a canvas on which all threads draw on such parts: they hand over whole rows, one after the other.
    pub(super) fn in_turn(canvas: &'a Canvas) -> Self {
        Self { far: Some(Vec::new()), ..Self::new(canvas) }
    }

    /// Moves to a rectangle; pieces that leave it are drawn too.
    ///
    /// * `corners` – in cross and in machine direction, the first and the last one [m]
    /// * `pieces` – that will be drawn. A few of them are not worth the while.
    pub(crate) fn move_to(&mut self, corners: [[f64; 2]; 2], pieces: usize) {
        let [first, last] = corners.map(|corner| corner.map(|at| floor(at / self.canvas.cell)));
        let size = [0, 1].map(|i| last[i].saturating_sub(first[i]).saturating_add(1));
        let cells = size[0].saturating_mul(size[1]);
        let is_worth = size.iter().all(|size| *size > 0) && cells < MOST_NEAR && cells as usize <= 4 * pieces;
        self.cover(first, if is_worth { size } else { [0; 2] });
    }

    /// Moves to a rectangle of cells.
    pub(super) fn cover(&mut self, first: [i64; 2], size: [i64; 2]) {
        self.pass_on();
        (self.first, self.size) = (first, size);
        self.cells.resize((size[0] * size[1]) as usize, 0);
    }

    /// As [`Canvas::draw`].
    pub(crate) fn draw(&mut self, from: [f64; 2], to: [f64; 2], quanta: u32) {
        cross(self.canvas.cell, [from, to], quanta, |cell, part| self.add(cell, part));
    }

    /// Adds to a cell, near or far.
    #[inline(always)]
    pub(super) fn add(&mut self, cell: [i64; 2], quanta: u32) {
        let [column, row] = [cell[0] - self.first[0], cell[1] - self.first[1]];
        let is_near = (0..self.size[0]).contains(&column) && (0..self.size[1]).contains(&row);
        match self.cells.get_mut((row * self.size[0] + column) as usize).filter(|_| is_near) {
            Some(sum) => {
                let (whole, is_full) = sum.overflowing_add(quanta);
                *sum = whole;
                if is_full {
                    self.fill();
                }
            }
            None => match &mut self.far {
                Some(far) => far.push((cell, quanta)),
                None => self.canvas.add(cell, quanta),
            },
        }
    }

    /// Notes that a cell holds more than can be counted.
    #[cold]
    pub(super) fn fill(&self) {
        self.canvas.is_full.store(true, Ordering::Relaxed);
    }

    /// Hands what has been drawn over to the canvas.
    pub(crate) fn pass_on(&mut self) {
        let Self { canvas, first, size, cells, far } = self;
        let rows = (first[1]..).zip(cells.chunks_exact_mut(size[0].max(1) as usize));
        if let Some(far) = far {
            let _turn = lock(&canvas.turn);
            rows.for_each(|(row, cells)| canvas.add_row([first[0], row], cells));
            far.drain(..).for_each(|(cell, quanta)| canvas.add(cell, quanta));
        } else {
            for (row, cells) in rows {
                for (column, sum) in (first[0]..).zip(cells).filter(|(_, sum)| **sum > 0) {
                    canvas.add([column, row], std::mem::take(sum));
                }
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const CELL: f64 = 1e-3;

    fn canvas(edges: Edges) -> Canvas {
        let sheet = Sheet { edges, ..Sheet::new(10e-3, 20e-3, CELL) };
        Canvas::new(&sheet, &[1e-9], 1e-3).unwrap()
    }

    /// A piece across cells leaves in each the part that lies in it.
    #[test]
    fn analytic_a_slanting_piece_in_the_cells_that_it_crosses() {
        let canvas = canvas(Edges::Cut);
        let quanta = canvas.quanta(1e-9);
        // From (0.5, 0.5) to (3.5, 2.5) cells: edges at 1/6, 1/2, 5/6 across and at 1/4, 3/4 along.
        canvas.draw([0.5e-3, 0.5e-3], [3.5e-3, 2.5e-3], quanta);
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
            canvas.draw([1e-3, 5.5e-3], [-1e-3, 5.5e-3], quanta);
            canvas.draw([4.5e-3, 1e-3], [4.5e-3, -1e-3], quanta);
            let laid = canvas.finish().unwrap();
            let (on, cut) = (laid.map.total(), (laid.cut / laid.map.quantum).round() as u64);
            let beyond = if edges == Edges::Periodic { [3, 0] } else { [2, 1] };
            assert_eq!([on, cut], beyond.map(|halves| halves * u64::from(quanta) / 2), "{edges:?}");
        }
    }

    #[test]
    fn rejects_cells_that_cannot_count_the_fibre() {
        let sheet = Sheet { edges: Edges::Cut, ..Sheet::new(10.0, 10.0, 1.0) };
        assert!(Canvas::new(&sheet, &[1e-12], 1.0).is_err());
        assert!(Canvas::new(&sheet, &[f64::NAN], 1.0).is_err());
        assert!(Canvas::new(&sheet, &[], 1.0).is_err());
    }
}
