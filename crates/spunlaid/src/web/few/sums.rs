//! Sums of patches from sums over the corners of a map.

use crate::web::Map;

/// Sums of a map over all cells before a corner.
pub(super) struct CornerSums {
    pub(super) columns: usize,
    rows: usize,
    sums: Vec<u64>,
}

impl CornerSums {
    pub(super) fn over(map: &Map) -> Self {
        Self::around(map, 0, map.columns)
    }

    /// Over some columns of a map that goes on at its edges across, from a first one on.
    pub(super) fn around(map: &Map, first: i64, columns: usize) -> Self {
        let width = columns + 1;
        let first = first.rem_euclid(map.columns as i64) as usize;
        let mut sums = vec![0; width * (map.rows + 1)];
        for row in 0..map.rows {
            let mut of_row = 0;
            let cells = map.row(row).iter().cycle().skip(first).take(columns);
            for (column, cell) in cells.enumerate() {
                of_row += u64::from(*cell);
                sums[(row + 1) * width + column + 1] = sums[row * width + column + 1] + of_row;
            }
        }
        Self { columns, rows: map.rows, sums }
    }

    /// One in each cell.
    pub(super) fn even(columns: usize, rows: usize) -> Self {
        let corner = |i: usize| (i / (columns + 1) * (i % (columns + 1))) as u64;
        Self { columns, rows, sums: (0..(columns + 1) * (rows + 1)).map(corner).collect() }
    }

    /// Sum over the places of a patch of its products on this map and on another one of the same size.
    ///
    /// * `side` – of the patch [cells]; places are half of it apart
    pub(super) fn product(&self, other: &Self, side: usize) -> f64 {
        let (width, step) = (self.columns + 1, (side / 2).max(1));
        let mut sum = 0.0;
        for row in (0..=self.rows - side).step_by(step) {
            let [above, below] = [row, row + side].map(|row| row * width);
            for column in (0..=self.columns - side).step_by(step) {
                let patch = |sums: &[u64]| {
                    let [left, right] = [column, column + side];
                    (sums[below + right] + sums[above + left] - sums[below + left] - sums[above + right])
                        as f64
                };
                sum += patch(&self.sums) * patch(&other.sums);
            }
        }
        let [rows, taken] = [self.rows - side + 1, (self.rows - side) / step + 1];
        sum * step as f64 * rows as f64 / taken as f64
    }
}
