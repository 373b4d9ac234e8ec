//! The field of charged sheets, over the height and the machine direction.

/// Steps from inlet to belt.
pub(super) const HEIGHTS: usize = 32;
/// Cells in machine direction, half of them on either side of the middle.
pub(super) const CELLS: usize = 512;

/// The field along the machine direction, `E_y` [V/m], at places between inlet and belt.
#[derive(Clone, Debug, Default)]
pub(crate) struct SheetField {
    /// Distance from inlet to belt [m].
    pub(super) distance: f64,
    /// Cells per length, in machine direction [1/m].
    pub(super) per_length: f64,
    /// Half the distance of the grounded plates [m]; infinite without plates.
    pub(super) walls: f64,
    /// At the points of all cells of each height, from the inlet down.
    pub(super) values: Vec<f64>,
}

impl SheetField {
    /// At a place: `x` below the inlet and `y` from the middle of the slot [m]. There is none on the belt,
    /// which is earthed, and none behind the plates.
    #[inline]
    pub(crate) fn at(&self, x: f64, y: f64) -> f64 {
        if self.values.is_empty() || !(x >= 0.0 && x < self.distance && y.abs() < self.walls) {
            return 0.0;
        }
        let row = x / self.distance * HEIGHTS as f64;
        let above = (row as usize).min(HEIGHTS - 1);
        let column = (y * self.per_length + (CELLS / 2) as f64).clamp(0.0, CELLS as f64);
        let left = (column as usize).min(CELLS - 1);
        let share = column - left as f64;
        let [upper, lower] = [above, above + 1].map(|height| {
            let values = &self.values[height * (CELLS + 1) + left..][..2];
            values[0] + share * (values[1] - values[0])
        });
        upper + (row - above as f64) * (lower - upper)
    }

    /// The strongest field beside the curtain, at any height [V/m].
    pub(crate) fn edge(&self) -> f64 {
        let heights = self.values.chunks_exact(CELLS + 1);
        heights
            .flat_map(|values| [values[0], values[CELLS]])
            .fold(0.0, |most: f64, edge| most.max(edge.abs()))
    }
}
