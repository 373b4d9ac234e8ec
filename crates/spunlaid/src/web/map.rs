//! The basis weight of a web, cell by cell.

use std::borrow::Cow;
use std::ops::Range;

/// Mass in the square cells of a sheet.
///
/// Cells lie row by row: a row goes across the web, and the rows follow each other in machine direction. Their masses are whole
/// numbers of a small quantum, so sums do not depend on the order in which the fibres were laid.
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

impl Map {
    /// An empty map.
    pub(super) fn new([columns, rows]: [usize; 2], cell: f64, quantum: f64, closed: [bool; 2]) -> Self {
        Self { columns, rows, cell, quantum, closed, cells: vec![0; columns * rows] }
    }

    /// The part between two columns, whose edges in cross direction are open. The map itself if that is all of it.
    pub fn between(&self, columns: Range<usize>) -> Cow<'_, Self> {
        if columns == (0..self.columns) {
            return Cow::Borrowed(self);
        }
        let rows = self.cells.chunks_exact(self.columns);
        let cells = rows.flat_map(|row| row.get(columns.clone()).unwrap_or_default()).copied().collect();
        Cow::Owned(Self { columns: columns.len(), closed: [false, self.closed[1]], cells, ..*self })
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
