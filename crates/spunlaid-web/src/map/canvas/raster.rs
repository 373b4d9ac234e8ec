//! Draws curves into cells, eight at a time.

use super::CanvasPart;
use spunlaid_ground::{Lanes, Register, Task, WIDTH, Wide};

/// Rows of a part beyond those of a ring, on each side. A wrapped coordinate may be off by a rounding error, and
/// its piece a cell further.
pub(crate) const OUTSIDE: i64 = 2;

/// 2⁵²; the low bits of `2⁵² + integer` are the integer.
const TWO_52: f64 = 4_503_599_627_370_496.0;

/// Up to eight curves that are drawn side by side. A curve is a chain of straight pieces.
///
/// What a cell gets of a piece is the part of the piece within it, in whole quanta: the parts of a piece are
/// differences of one rounded running sum, so none is lost and none is made.
#[derive(Debug)]
pub(crate) struct LaneDepositors {
    /// Cells by which the belt moves while a piece is laid.
    pub(super) advance: f64,
    /// Parts of a piece that are drawn one by one, none longer than a cell.
    pub(super) parts: usize,
    /// Whether no piece is longer than they are.
    pub(crate) is_bounded: bool,
    /// Quanta of a piece of each curve; none of an unused one.
    pub(crate) quanta: Lanes,
    /// Column and row of the straight trace.
    pub(crate) at: [Lanes; 2],
}

/// Draws the pieces between points, [ξ₁, ξ₂] of each curve [m], and goes on along the straight traces.
pub(super) struct Draw<'a, 'b> {
    pub(super) pens: &'a mut LaneDepositors,
    pub(super) part: &'a mut CanvasPart<'b>,
    pub(super) points: &'a [[Lanes; 2]],
}

impl Task for Draw<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        let Self { pens, part, points } = self;
        let per_cell = Wide::<S>::splat(1.0 / part.canvas.cell);
        let advance = Wide::splat(pens.advance);
        let mut ink = Ink::<S>::new(part);
        let pieces = Pieces::new(Wide::load(&pens.quanta), pens.parts);
        let column = Wide::load(&pens.at[0]);
        let mut row = Wide::load(&pens.at[1]);
        for pair in points.windows(2) {
            let [from, to] = [&pair[0], &pair[1]];
            let md = Wide::load(&from[0]) * per_cell;
            let cd = Wide::load(&from[1]) * per_cell;
            let next_md = Wide::load(&to[0]) * per_cell;
            let next_cd = Wide::load(&to[1]) * per_cell;
            let at = [column + cd, row + md];
            let by = [next_cd - cd, next_md - md - advance];
            let longest = by[0].abs().max(by[1].abs());
            if !pens.is_bounded && longest.any_above(pens.parts as f64) {
                ink.draw_each(at, by, longest.store(), pens, part);
            } else {
                ink.draw(at, by, &pieces, part);
            }
            row -= advance;
        }
        ink.finish(part);
        pens.at[1] = ink.wrapped(row).store();
    }
}

/// How a piece of each curve is divided into parts.
struct Pieces<S: Register> {
    parts: usize,
    /// One over their number.
    share: Wide<S>,
    /// Quanta of a part, and of the last one, which has what is left over.
    each: Wide<S>,
    last: Wide<S>,
}

impl<S: Register> Pieces<S> {
    /// * `all` – quanta of a piece
    #[inline(always)]
    fn new(all: Wide<S>, parts: usize) -> Self {
        let share = Wide::splat(1.0 / parts as f64);
        let each = ((all + Wide::splat(0.5)) * share).floor();
        Self { parts, share, each, last: each.neg_mul_add(Wide::splat((parts - 1) as f64), all) }
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
    /// Number of rows of a ring, and one over it; none over it if no row is another one.
    rows: Wide<S>,
    per_row: Wide<S>,
    stride: Wide<S>,
    /// Index of the cell in column and row zero, with 2⁵² added.
    origin: Wide<S>,
    /// Column and row of the middle, and how far from it a part is near.
    middle: [Wide<S>; 2],
    half: [f64; 2],
    /// Index of the cell of each curve with 2⁵² added, and the quanta it has left there.
    cell: Wide<S>,
    gathered: Wide<S>,
    /// Index of a cell in the high half, quanta in the low half.
    list: [u64; LIST],
    listed: usize,
}

impl<S: Register> Ink<S> {
    #[inline(always)]
    fn new(part: &CanvasPart<'_>) -> Self {
        let ([column, row], [columns, here]) = (part.first, part.size);
        let middle = [column as f64 + 0.5 * columns as f64, row as f64 + 0.5 * here as f64];
        let rows = part.canvas.size[1] as f64;
        let is_ring = part.canvas.closed[1];
        // A part on a ring has all rows.
        let half = [0, 1].map(|i| 0.5 * part.size[i] as f64 - 1.5);
        Self {
            rows: Wide::splat(rows),
            per_row: Wide::splat(if is_ring { 1.0 / rows } else { 0.0 }),
            stride: Wide::splat(columns as f64),
            origin: Wide::splat(TWO_52 - (row * columns + column) as f64),
            middle: [Wide::splat(middle[0]), Wide::splat(middle[1])],
            half: [half[0], if is_ring && half[1] > 0.0 { f64::INFINITY } else { half[1] }],
            cell: Wide::splat(TWO_52),
            gathered: Wide::zero(),
            list: [0; LIST],
            listed: 0,
        }
    }

    /// The row on a ring.
    #[inline(always)]
    fn wrapped(&self, row: Wide<S>) -> Wide<S> {
        (row * self.per_row).floor().neg_mul_add(self.rows, row)
    }

    /// Draws pieces one by one, each in as many parts as it needs.
    #[inline(always)]
    fn draw_each(
        &mut self,
        at: [Wide<S>; 2],
        by: [Wide<S>; 2],
        longest: Lanes,
        pens: &LaneDepositors,
        part: &mut CanvasPart<'_>,
    ) {
        for i in (0..WIDTH).filter(|i| pens.quanta.0[*i] > 0.0) {
            let quanta = Lanes::from_fn(|lane| if lane == i { pens.quanta.0[i] } else { 0.0 });
            self.finish(part);
            let parts = pens.parts.max(longest.0[i].ceil() as usize);
            self.draw(at, by, &Pieces::new(Wide::load(&quanta), parts), part);
        }
        self.finish(part);
    }

    /// Draws a piece of each curve.
    #[inline(always)]
    fn draw(&mut self, mut at: [Wide<S>; 2], by: [Wide<S>; 2], of: &Pieces<S>, part: &mut CanvasPart<'_>) {
        let by = [by[0] * of.share, by[1] * of.share];
        // Nothing that starts so far inside ends outside.
        let parts = of.parts as f64;
        // Without a closure, which would not be compiled for the instruction set.
        let is_far = (at[0] - self.middle[0]).abs().any_above(self.half[0] - parts)
            || (at[1] - self.middle[1]).abs().any_above(self.half[1] - parts);
        if is_far {
            self.finish(part);
        }
        for i in 1..=of.parts {
            let quanta = if i < of.parts { of.each } else { of.last };
            let from = [at[0], self.wrapped(at[1])];
            self.draw_part(from, by, quanta, is_far, part);
            at = [at[0] + by[0], at[1] + by[1]];
        }
    }

    /// Draws a part. It crosses at most one edge of a cell each way.
    #[inline(always)]
    fn draw_part(
        &mut self,
        at: [Wide<S>; 2],
        by: [Wide<S>; 2],
        all: Wide<S>,
        is_far: bool,
        part: &mut CanvasPart<'_>,
    ) {
        let zero = Wide::<S>::zero();
        let one = Wide::<S>::splat(1.0);
        let shift = Wide::<S>::splat(TWO_52);
        let cell = [at[0].floor(), at[1].floor()];
        let x = Crossing::place(at[0], cell[0], by[0]);
        let y = Crossing::place(at[1], cell[1], by[1]);
        let first = Wide::select_less(x.share, y.share, x.share, y.share);
        let last = Wide::select_less(x.share, y.share, y.share, x.share);
        // Rounded to whole quanta.
        let until_first = first.mul_add(all, shift) - shift;
        let until_last = last.mul_add(all, shift) - shift;
        if is_far {
            let to = [cell[0].store(), cell[1].store(), x.to.store(), y.to.store()];
            let shares = [x.share.store(), y.share.store()];
            anywhere(to, shares, [until_first.store(), until_last.store(), all.store()], part);
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
        self.gathered = Wide::select_less(last, one, zero, sum) + (all - until_last);
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
        part.is_full |= is_full;
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
    [columns, rows, to_column, to_row]: [Lanes; 4],
    [share, share_row]: [Lanes; 2],
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
