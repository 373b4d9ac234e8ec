//! The part of a map on which a thread draws some filaments.

use super::map::Map;

/// Columns and rows outside on each side. A wrapped coordinate may be off by a rounding error, and its piece
/// a cell further.
pub(super) const OUTSIDE: [usize; 2] = [1, 2];

/// Columns of a map that a thread has to itself. Columns are counted as if the sheet went on for ever in
/// cross direction.
#[derive(Debug)]
pub(super) struct Strip {
    /// Column of the map that its first one stands for, not counting those outside.
    pub(super) first: i64,
    pub(super) columns: usize,
    rows: usize,
    pub(super) cells: Vec<u32>,
    /// What lies beyond the columns: column of the map, row of the strip, quanta.
    strays: Vec<(i64, i64, u32)>,
    /// Whether a cell holds more than can be counted.
    pub(super) is_full: bool,
}

impl Strip {
    pub(super) const fn new(rows: usize) -> Self {
        Self { first: 0, columns: 0, rows, cells: Vec::new(), strays: Vec::new(), is_full: false }
    }

    /// Takes other columns, all of them empty.
    pub(super) fn take(&mut self, first: i64, columns: usize) {
        (self.first, self.columns) = (first, columns);
        self.cells.clear();
        self.cells.resize((columns + 2 * OUTSIDE[0]) * (self.rows + 2 * OUTSIDE[1]), 0);
    }

    /// Cells from one row to the next.
    pub(super) const fn stride(&self) -> usize {
        self.columns + 2 * OUTSIDE[0]
    }

    pub(super) const fn rows(&self) -> usize {
        self.rows
    }

    /// Adds to a cell that may lie beyond the columns. Columns and rows count from the first ones outside.
    pub(super) fn add(&mut self, column: i64, row: i64, quanta: u32) {
        if quanta == 0 {
            return;
        }
        let stride = self.stride() as i64;
        if !(0..stride).contains(&column) {
            self.strays.push((self.first + column - OUTSIDE[0] as i64, row, quanta));
        } else if let Some(cell) = self.cells.get_mut((row * stride + column) as usize) {
            let (sum, beyond) = cell.overflowing_add(quanta);
            *cell = sum;
            self.is_full |= beyond;
        }
    }

    /// Adds everything to the map. Returns what lies beyond edges that cut, and whether the map could count it all.
    pub(super) fn add_to(&mut self, map: &mut Map) -> (u64, bool) {
        let mut sums = Sums { map, cut: 0, is_full: self.is_full };
        let first = self.first - OUTSIDE[0] as i64;
        for (row, cells) in self.cells.chunks_exact(self.stride()).enumerate() {
            sums.add(first, row as i64, cells);
        }
        for (column, row, quanta) in self.strays.drain(..) {
            sums.add(column, row, &[quanta]);
        }
        (sums.cut, sums.is_full)
    }
}

/// The map that strips are added to.
struct Sums<'a> {
    map: &'a mut Map,
    cut: u64,
    is_full: bool,
}

impl Sums<'_> {
    /// Adds cells of a row of a strip, from a column of the endless sheet on.
    fn add(&mut self, column: i64, row: i64, mut cells: &[u32]) {
        let map = &mut *self.map;
        let row = (row - OUTSIDE[1] as i64).rem_euclid(map.rows as i64) as usize;
        let into = &mut map.cells[row * map.columns..][..map.columns];
        let mut column = column;
        while !cells.is_empty() {
            // As far as the next edge of the sheet.
            let turn = column.div_euclid(map.columns as i64);
            let at = column.rem_euclid(map.columns as i64) as usize;
            let (now, later) = cells.split_at(cells.len().min(map.columns - at));
            if map.closed[0] || turn == 0 {
                for (cell, quanta) in into[at..].iter_mut().zip(now) {
                    let (sum, beyond) = cell.overflowing_add(*quanta);
                    *cell = sum;
                    self.is_full |= beyond;
                }
            } else {
                self.cut += now.iter().map(|quanta| u64::from(*quanta)).sum::<u64>();
            }
            column += now.len() as i64;
            cells = later;
        }
    }
}
