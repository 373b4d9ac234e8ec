//! Where a fibre comes down: counts on a lattice that grows with what it has to hold.

/// Cells along each side of a footprint.
const CELLS: usize = 96;

/// How often a fibre was found in each cell of a square lattice.
///
/// A point outside the lattice doubles the width of the cells, four of which become one. Widths are powers of two
/// times the first one and cells are counted from one centre, so the counts are those that the final lattice
/// would have found from the start.
#[derive(Clone, Debug, PartialEq)]
pub struct Footprint {
    /// Length of a cell's side [m].
    pub cell: f64,
    /// Position of the lattice's centre, a corner of four cells: machine and cross direction [m].
    pub centre: [f64; 2],
    /// Points in each cell, `[cross direction][machine direction]`, from the smallest coordinates on.
    counts: Vec<u64>,
}

impl Footprint {
    /// An empty lattice.
    ///
    /// * `cell` – side of its cells to begin with [m]
    /// * `centre` – its centre [m]
    pub(super) fn new(cell: f64, centre: [f64; 2]) -> Self {
        Self { cell, centre, counts: vec![0; CELLS * CELLS] }
    }

    /// Cells along each side.
    pub const fn side(&self) -> usize {
        CELLS
    }

    /// Points in each row of cells, row after row in cross direction; within a row in machine direction.
    pub fn rows(&self) -> impl Iterator<Item = &[u64]> {
        self.counts.chunks_exact(CELLS)
    }

    /// The smallest coordinates that the lattice covers: machine and cross direction [m].
    pub fn corner(&self) -> [f64; 2] {
        self.centre.map(|centre| centre - (CELLS / 2) as f64 * self.cell)
    }

    /// Counts a point; points that are not finite are left out.
    pub(super) fn add(&mut self, point: [f64; 2]) {
        let offset = [point[0] - self.centre[0], point[1] - self.centre[1]];
        if !(offset[0].is_finite() && offset[1].is_finite()) {
            return;
        }
        let place = loop {
            let index = offset.map(|offset| (offset / self.cell).floor() + (CELLS / 2) as f64);
            if index.iter().all(|index| (0.0..CELLS as f64).contains(index)) {
                break index[1] as usize * CELLS + index[0] as usize;
            }
            self.grow();
        };
        self.counts[place] += 1;
    }

    fn grow(&mut self) {
        let quarter = CELLS / 4;
        let mut coarse = vec![0; CELLS * CELLS];
        for (place, count) in self.counts.iter().enumerate() {
            let (row, column) = (place / CELLS, place % CELLS);
            coarse[(quarter + row / 2) * CELLS + quarter + column / 2] += count;
        }
        self.counts = coarse;
        self.cell *= 2.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_do_not_depend_on_when_the_lattice_grew() {
        let point = |i: u32| {
            let (a, b) = (f64::from(i * 7919 % 1009) - 500.0, f64::from(i * 104_729 % 997) - 300.0);
            [1.0 + a * 1e-3, -2.0 + b * 1e-3]
        };
        let mut grown = Footprint::new(0.001, [1.0, -2.0]);
        (0..5000).for_each(|i| grown.add(point(i)));
        // 0.697 m to one side need 48 cells of 16 mm.
        assert!((grown.cell - 0.016).abs() < 1e-15);
        let mut at_once = Footprint::new(grown.cell, [1.0, -2.0]);
        (0..5000).for_each(|i| at_once.add(point(i)));
        assert_eq!(grown, at_once);
        assert_eq!(grown.rows().flatten().sum::<u64>(), 5000);
        let corner = grown.corner();
        assert!((corner[0] - (1.0 - 48.0 * 0.016)).abs() < 1e-12 && grown.rows().count() == grown.side());
    }

    #[test]
    fn a_point_lies_in_its_cell_and_points_beyond_number_are_left_out() {
        let mut footprint = Footprint::new(1.0, [0.0, 0.0]);
        footprint.add([-0.5, 3.2]);
        footprint.add([f64::NAN, 0.0]);
        footprint.add([0.0, f64::INFINITY]);
        let found: Vec<(usize, usize)> = (footprint.rows().enumerate())
            .flat_map(|(row, counts)| counts.iter().enumerate().filter(|c| *c.1 > 0).map(move |c| (row, c.0)))
            .collect();
        assert_eq!(found, [(51, 47)]);
    }
}
