//! The basis weight of a web, cell by cell.

use std::borrow::Cow;
use std::ops::Range;

/// Mass in the square cells of a sheet.
///
/// Cells lie row by row: a row goes across the web, and the rows follow each other in machine direction.
/// Their masses are whole numbers of a small quantum, so sums do not depend on the order in which the fibres
/// were laid.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Number of cells in cross direction.
    pub columns: usize,
    /// Number of cells in machine direction.
    pub rows: usize,
    /// Side of a cell [m].
    pub cell: f64,
    /// Mass of a quantum [kg].
    pub quantum: f64,
    /// Whether the sheet goes on at the other edge, in cross and in machine direction.
    pub closed: [bool; 2],
    /// Quanta in each cell.
    pub cells: Vec<u32>,
}

/// Mean quanta of a cell whose mass is no whole number of the old quanta.
const QUANTA: f64 = 1e6;

/// The new cells in which an old one lies, with its shares, cell by cell.
///
/// * `ratio` – side of a new cell over that of an old one
/// * `most` – number of new cells
fn overlaps(old: usize, ratio: f64, most: usize) -> Vec<Vec<(usize, f64)>> {
    let shares = |at: usize| {
        let [from, to] = [at as f64 / ratio, (at + 1) as f64 / ratio];
        let into = from as usize..(to.ceil() as usize).min(most);
        let share = |new: usize| (to.min(new as f64 + 1.0) - from.max(new as f64)) * ratio;
        into.map(|new| (new, share(new))).filter(|(_, share)| *share > 1e-9).collect()
    };
    (0..old).map(shares).collect()
}

impl Map {
    /// The part between two columns, whose edges in cross direction are open. The map itself if that is all of it.
    pub fn between(&self, columns: Range<usize>) -> Cow<'_, Self> {
        if columns == (0..self.columns) {
            return Cow::Borrowed(self);
        }
        let rows = self.cells.chunks_exact(self.columns);
        let cells = rows.flat_map(|row| row.get(columns.clone()).unwrap_or_default()).copied().collect();
        Cow::Owned(Self { columns: columns.len(), closed: [false, self.closed[1]], cells, ..*self })
    }

    /// A rectangle of its cells, whose edges are open.
    ///
    /// * `corner` – its first column and row
    /// * `sides` – its columns and rows
    pub fn part(&self, corner: [usize; 2], sides: [usize; 2]) -> Self {
        let row = |row: usize| self.row(corner[1] + row).get(corner[0]..corner[0] + sides[0]);
        let cells = (0..sides[1]).flat_map(|i| row(i).unwrap_or_default()).copied().collect();
        Self { columns: sides[0], rows: sides[1], closed: [false; 2], cells, ..*self }
    }

    /// The same web in larger cells, whose edges are open. Each gets of the old cells what lies in it, so
    /// that patches of whole new cells have the same mass. What is less than a cell at the far edges is left
    /// out.
    pub fn in_cells(&self, cell: f64) -> Self {
        let ratio = cell / self.cell;
        let [columns, rows] =
            [self.columns, self.rows].map(|cells| (cells as f64 / ratio * (1.0 + 1e-9)) as usize);
        let across = overlaps(self.columns, ratio, columns);
        let along = overlaps(self.rows, ratio, rows);
        let mut sums = vec![0.0; columns * rows];
        for (row, shares) in along.iter().enumerate() {
            let mut row_sums = vec![0.0; columns];
            for (quanta, shares) in self.row(row).iter().zip(&across) {
                shares.iter().for_each(|(column, share)| row_sums[*column] += share * f64::from(*quanta));
            }
            for (into, share) in shares {
                let into = &mut sums[into * columns..][..columns];
                into.iter_mut().zip(&row_sums).for_each(|(into, sum)| *into += share * sum);
            }
        }
        let mean = sums.iter().sum::<f64>() / sums.len() as f64;
        let scale = if mean > 0.0 { QUANTA / mean } else { 1.0 };
        let cells = sums.into_iter().map(|sum| (sum * scale).round() as u32).collect();
        Self { columns, rows, cell, quantum: self.quantum / scale, closed: [false; 2], cells }
    }

    /// Quanta in squares of so many cells, side by side: how many squares there are across and along, and the sums of
    /// each, row after row. What is less than a square at the far edges is left out.
    pub fn squares(&self, side: usize) -> ([usize; 2], Vec<u64>) {
        let [columns, rows] = [self.columns / side, self.rows / side];
        let mut sums = vec![0; columns * rows];
        for row in 0..rows * side {
            let into = &mut sums[row / side * columns..][..columns];
            for (sum, cells) in into.iter_mut().zip(self.row(row).chunks_exact(side)) {
                *sum += cells.iter().map(|quanta| u64::from(*quanta)).sum::<u64>();
            }
        }
        ([columns, rows], sums)
    }

    /// The quanta of a row.
    pub fn row(&self, row: usize) -> &[u32] {
        &self.cells[row * self.columns..][..self.columns]
    }

    /// Basis weight that a quantum gives its cell [kg/m²].
    pub fn weight_of_quantum(&self) -> f64 {
        self.quantum / (self.cell * self.cell)
    }

    /// Quanta in all cells.
    pub fn total(&self) -> u64 {
        self.cells.iter().map(|cell| u64::from(*cell)).sum()
    }

    /// Mean basis weight [kg/m²].
    pub fn basis_weight(&self) -> f64 {
        self.total() as f64 / self.cells.len() as f64 * self.weight_of_quantum()
    }

    /// Mean basis weight of each column, across the web [kg/m²].
    pub fn profile_cd(&self) -> Vec<f64> {
        let mut sums = vec![0u64; self.columns];
        for row in self.cells.chunks_exact(self.columns) {
            for (sum, cell) in sums.iter_mut().zip(row) {
                *sum += u64::from(*cell);
            }
        }
        self.means(&sums, self.rows)
    }

    /// Mean basis weight of each row, in machine direction [kg/m²].
    pub fn profile_md(&self) -> Vec<f64> {
        let rows = self.cells.chunks_exact(self.columns);
        let sums: Vec<u64> = rows.map(|row| row.iter().map(|cell| u64::from(*cell)).sum()).collect();
        self.means(&sums, self.columns)
    }

    fn means(&self, sums: &[u64], count: usize) -> Vec<f64> {
        sums.iter().map(|sum| *sum as f64 / count as f64 * self.weight_of_quantum()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn larger_cells_hold_the_same_mass_and_a_part_is_a_part() {
        let cells = (0..12 * 8).map(|i| 1000 + (i * i) % 97).collect();
        let map = Map { columns: 12, rows: 8, cell: 0.5, quantum: 1.0, closed: [true; 2], cells };
        for (cell, columns, rows) in [(2.0, 6, 4), (1.5, 8, 5), (1.0, 12, 8)] {
            let large = map.in_cells(0.5 * cell);
            assert_eq!([large.columns, large.rows], [columns, rows], "{cell}");
            assert!((large.total() as f64 / (columns * rows) as f64 / QUANTA - 1.0).abs() < 1e-6);
            let mass = |map: &Map, columns: usize, rows: usize| {
                let row =
                    |row: usize| map.row(row)[..columns].iter().map(|cell| u64::from(*cell)).sum::<u64>();
                (0..rows).map(row).sum::<u64>() as f64 * map.quantum
            };
            // Three metres each way are whole cells of both.
            let whole = (6.0 / cell) as usize;
            let found = mass(&large, whole, whole) / mass(&map, 6, 6);
            assert!((found - 1.0).abs() < 1e-6, "{cell}: {found}");
        }
        let part = map.part([3, 2], [4, 5]);
        assert_eq!(part.row(1), &map.row(3)[3..7]);
        assert_eq!((part.columns, part.rows, part.closed), (4, 5, [false; 2]));
        let middle = map.between(3..7);
        assert_eq!((middle.columns, middle.rows, middle.closed), (4, 8, [false, true]));
        assert_eq!(middle.row(2), &map.row(2)[3..7]);
        assert!(matches!(map.between(0..12), Cow::Borrowed(_)));
        let empty = Map { cells: vec![0; 96], ..map }.in_cells(1.0);
        assert_eq!((empty.total(), empty.quantum), (0, 1.0));
    }

    #[test]
    fn analytic_sums_and_profiles_are_those_of_the_cells() {
        let cells: Vec<u32> = (0..12 * 8).map(|i| 1000 + (i * i) % 97).collect();
        let map = Map { columns: 12, rows: 8, cell: 2.0, quantum: 3.0, closed: [false; 2], cells };
        let mean = |columns: Range<usize>, rows: Range<usize>| {
            let count = (columns.len() * rows.len()) as f64;
            let cells = rows.flat_map(|row| map.row(row)[columns.clone()].to_vec());
            cells.map(f64::from).sum::<f64>() / count * 0.75
        };
        let are_same = |found: &[f64], wanted: &[f64]| {
            found.len() == wanted.len() && found.iter().zip(wanted).all(|(a, b)| (a / b - 1.0).abs() < 1e-12)
        };
        let across: Vec<f64> = (0..12).map(|i| mean(i..i + 1, 0..8)).collect();
        let along: Vec<f64> = (0..8).map(|i| mean(0..12, i..i + 1)).collect();
        assert!(are_same(&map.profile_cd(), &across) && are_same(&map.profile_md(), &along));
        assert!(are_same(&[map.basis_weight()], &[mean(0..12, 0..8)]));
        let (sides, sums) = map.squares(3);
        assert_eq!(sides, [4, 2]);
        for (number, sum) in sums.iter().enumerate() {
            let (column, row) = (3 * (number % 4), 3 * (number / 4));
            assert!(
                are_same(&[*sum as f64 / 9.0 * 0.75], &[mean(column..column + 3, row..row + 3)]),
                "{number}"
            );
        }
    }
}
