//! Draws curves into cells, eight at a time.

use super::canvas::CanvasPart;
use crate::ground::{Lanes, Register, Task, WIDTH, Wide};

/// Columns and rows of a part beyond what is drawn on, on each side. A wrapped coordinate may be off by a rounding
/// error, and its piece a cell further.
pub(super) const OUTSIDE: [i64; 2] = [1, 2];

/// 2⁵²; the low bits of `2⁵² + integer` are the integer.
const TWO_52: f64 = 4_503_599_627_370_496.0;

/// Up to eight curves that are drawn side by side. A curve is a chain of straight pieces of equal mass.
///
/// What a cell gets of a piece is the part of the piece within it, in whole quanta: the parts of a piece are
/// differences of one rounded running sum, so none is lost and none is made.
#[derive(Debug)]
pub(super) struct Pens {
    /// Number of curves.
    pub(super) curves: usize,
    /// One over the side of a cell [1/m].
    pub(super) per_cell: f64,
    /// Cells by which the belt moves while a piece is laid.
    pub(super) advance: f64,
    /// Parts of a piece that are drawn one by one, none longer than a cell.
    pub(super) parts: usize,
    /// Quanta of a part of each curve; none of an unused one.
    pub(super) quanta: Lanes,
    /// Column and row of the straight trace.
    pub(super) at: [Lanes; 2],
}

impl Pens {
    /// Parts of a piece that are short enough.
    ///
    /// * `longest` – longest piece on the belt [cells]
    pub(super) fn parts_of(longest: f64) -> usize {
        (longest.ceil().max(1.0)) as usize
    }
}

/// Draws the pieces between points, [ξ₁, ξ₂] of each curve [m], and goes on along the straight traces.
pub(super) struct Draw<'a, 'b> {
    pub(super) pens: &'a mut Pens,
    /// A part with all rows of a ring, and [`OUTSIDE`] around it.
    pub(super) part: &'a mut CanvasPart<'b>,
    pub(super) points: &'a [[Lanes; 2]],
}

impl Task for Draw<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        let Self { pens, part, points } = self;
        let splat = Wide::<S>::splat;
        let per_cell = splat(pens.per_cell);
        let advance = splat(pens.advance);
        let share = splat(1.0 / pens.parts as f64);
        let rows = (part.size[1] - 2 * OUTSIDE[1]) as f64;
        let (rows, per_row) = (splat(rows), splat(1.0 / rows));
        let mut ink = Ink::<S>::new(pens, part);
        let column = Wide::load(&pens.at[0]);
        let mut row = Wide::load(&pens.at[1]);
        for pair in points.windows(2) {
            let [from, to] = [&pair[0], &pair[1]];
            let (md, cd) = (Wide::load(&from[0]) * per_cell, Wide::load(&from[1]) * per_cell);
            let (next_md, next_cd) = (Wide::load(&to[0]) * per_cell, Wide::load(&to[1]) * per_cell);
            let by = [(next_cd - cd) * share, (next_md - md - advance) * share];
            let mut at = [column + cd, row + md];
            for _ in 0..pens.parts {
                let turns = (at[1] * per_row).floor();
                let wrapped = turns.neg_mul_add(rows, at[1]);
                ink.draw([at[0], wrapped], by, part);
                at = [at[0] + by[0], at[1] + by[1]];
            }
            row -= advance;
        }
        ink.finish(part);
        pens.at[1] = (row * per_row).floor().neg_mul_add(rows, row).store();
    }
}

/// Where a part crosses an edge of its cell in one direction.
struct Crossing<S: Register> {
    /// Share of the part before the edge, 1 if it does not reach it.
    share: Wide<S>,
    /// The cell at the end: −1, 0 or 1 from the first.
    to: Wide<S>,
}

impl<S: Register> Crossing<S> {
    #[inline(always)]
    fn place(at: Wide<S>, cell: Wide<S>, by: Wide<S>) -> Self {
        let (zero, one) = (Wide::<S>::zero(), Wide::<S>::splat(1.0));
        let within = at - cell;
        let way = Wide::select_less(by, zero, within, one - within);
        let share = way.over(by.abs());
        Self {
            share: Wide::select_less(share, one, share, one),
            to: Wide::select_less(share, one, Wide::select_less(by, zero, zero - one, one), zero),
        }
    }
}

/// Entries of the list of an [`Ink`], a power of two.
const LIST: usize = 256;

/// What eight curves leave in the cells. Each gathers what it leaves in its cell until it goes on to the
/// next; these sums go to a list first, because adding to memory at once would wait for the sum before.
struct Ink<S: Register> {
    stride: Wide<S>,
    /// Index of the cell in column and row zero, with 2⁵² added.
    origin: Wide<S>,
    middle: Wide<S>,
    half: f64,
    /// Quanta of a part; none of an unused curve.
    all: Wide<S>,
    /// Index of the cell of each curve with 2⁵² added, and the quanta it has left there.
    cell: Wide<S>,
    gathered: Wide<S>,
    /// Index of a cell in the high half, quanta in the low half.
    list: [u64; LIST],
    listed: usize,
}

impl<S: Register> Ink<S> {
    #[inline(always)]
    fn new(pens: &Pens, part: &CanvasPart<'_>) -> Self {
        let ([column, row], [columns, _]) = (part.first, part.size);
        Self {
            stride: Wide::splat(columns as f64),
            origin: Wide::splat(TWO_52 - (row * columns + column) as f64),
            // Nothing that starts so far inside ends outside.
            middle: Wide::splat(column as f64 + 0.5 * columns as f64),
            half: 0.5 * columns as f64 - (OUTSIDE[0] as f64 + 0.5),
            all: Wide::load(&pens.quanta),
            cell: Wide::splat(TWO_52),
            gathered: Wide::zero(),
            list: [0; LIST],
            listed: 0,
        }
    }

    /// Draws a part. It crosses at most one edge of a cell each way.
    #[inline(always)]
    fn draw(&mut self, at: [Wide<S>; 2], by: [Wide<S>; 2], part: &mut CanvasPart<'_>) {
        let (zero, one, shift) = (Wide::<S>::zero(), Wide::<S>::splat(1.0), Wide::<S>::splat(TWO_52));
        let cell = [at[0].floor(), at[1].floor()];
        let x = Crossing::place(at[0], cell[0], by[0]);
        let y = Crossing::place(at[1], cell[1], by[1]);
        let first = Wide::select_less(x.share, y.share, x.share, y.share);
        let last = Wide::select_less(x.share, y.share, y.share, x.share);
        // Rounded to whole quanta.
        let until_first = first.mul_add(self.all, shift) - shift;
        let until_last = last.mul_add(self.all, shift) - shift;
        if (at[0] - self.middle).abs().any_above(self.half) {
            self.finish(part);
            let lanes = [cell[0], cell[1], x.to, y.to, x.share, y.share];
            anywhere(lanes.map(Wide::store), [until_first, until_last, self.all].map(Wide::store), part);
            return;
        }
        let down = y.to * self.stride;
        let start = cell[1].mul_add(self.stride, cell[0]) + self.origin;
        let between = start + Wide::select_less(x.share, y.share, x.to, down);
        self.cell = start + (x.to + down);
        let sum = self.gathered + until_first;
        let entries = entry(start, sum + shift);
        let sum = Wide::select_less(first, one, zero, sum) + (until_last - until_first);
        let next_entries = entry(between, sum + shift);
        self.gathered = Wide::select_less(last, one, zero, sum) + (self.all - until_last);
        for (entries, share) in [(entries, first), (next_entries, last)] {
            if let Some(free) = self.list.get_mut(self.listed..).and_then(<[u64]>::first_chunk_mut) {
                self.listed += entries.store_less(share, one, free);
            }
        }
        if self.listed > LIST - 2 * WIDTH {
            self.add(part);
        }
    }

    /// Adds the list to the cells.
    #[inline(always)]
    fn add(&mut self, part: &mut CanvasPart<'_>) {
        let mut is_full = false;
        for entry in &self.list[..self.listed.min(LIST)] {
            if let Some(cell) = part.cells.get_mut((entry >> 32) as usize) {
                let (sum, beyond) = cell.overflowing_add(*entry as u32);
                *cell = sum;
                is_full |= beyond;
            }
        }
        if is_full {
            part.fill();
        }
        self.listed = 0;
    }

    /// Adds everything that has been gathered to the cells.
    #[inline(always)]
    fn finish(&mut self, part: &mut CanvasPart<'_>) {
        self.add(part);
        let entries = entry(self.cell, self.gathered + Wide::splat(TWO_52)).store();
        for (slot, entry) in self.list.iter_mut().zip(entries.0) {
            *slot = entry.to_bits();
        }
        (self.listed, self.gathered) = (WIDTH, Wide::zero());
        self.add(part);
    }
}

/// An entry of the list, from two whole numbers in low bits.
#[inline(always)]
fn entry<S: Register>(index: Wide<S>, quanta: Wide<S>) -> Wide<S> {
    Wide(index.0.shift_left::<32>().add_as_integers(quanta.0.and_bits(0xffff_ffff)))
}

/// Adds parts of which some may lie beyond the part: column, row, steps to the next ones, and shares before them.
#[cold]
#[inline(never)]
fn anywhere(
    [columns, rows, to_column, to_row, share, share_row]: [Lanes; 6],
    [first, last, all]: [Lanes; 3],
    part: &mut CanvasPart<'_>,
) {
    for i in 0..WIDTH {
        let [column, row, right, down] = [columns, rows, to_column, to_row].map(|lanes| lanes.0[i] as i64);
        let between = if share.0[i] < share_row.0[i] { [column + right, row] } else { [column, row + down] };
        part.add([column, row], first.0[i] as u32);
        part.add(between, (last.0[i] - first.0[i]) as u32);
        part.add([column + right, row + down], (all.0[i] - last.0[i]) as u32);
    }
}
