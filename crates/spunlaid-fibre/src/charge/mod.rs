//! Filaments that carry charge: how much, and the field that they make of themselves.
//!
//! ```text
//! places of all filaments → Sheets: charge at each height, over y → SheetField → the force on every node
//!        └─────────────────────── some time later, and again ──────────────────────────┘
//! ```
//!
//! At each height the filaments are sheets across the web, so the field has a component along the machine
//! direction only, and is known from the shares of charge on either side.       theory.md (83i) to (83l)

mod sheets;

pub use sheets::SheetHeight;
pub use sheets::{ChargedNode, CurtainScale, Sheets};

/// Permittivity of the vacuum `ε₀` [F/m], which is that of air within a thousandth.
pub(crate) const PERMITTIVITY: f64 = 8.854_187_812_8e-12;
/// Field in which air breaks down [V/m]: sparks take the charge away before filaments carry so much.
pub const BREAKDOWN: f64 = 3e6;
/// Field from which a flight is warned of [V/m]: at sharp edges of metal air breaks down long before.
pub const STRONG: f64 = 1e6;

/// The charge of filaments, and what is around them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Charge {
    /// Charge per mass of filament `q` [C/kg].
    pub per_mass: f64,
    /// Distance of grounded plates from the middle of the slot, on both sides [m]; None without plates.
    pub walls: Option<f64>,
}

/// What charge does to a curtain, estimated before it is simulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChargeEstimate {
    /// Field at the edge of the curtain [V/m].
    pub edge_field: f64,
    /// The force on a filament at the edge, over its weight [-].
    pub over_weight: f64,
}

impl Charge {
    /// What it does at the edge of a curtain.                                                     theory.md (83i)
    ///
    /// * `mass` – of all filaments in an area of the curtain, across the web and down [kg/m²]
    /// * `gravity` – acceleration of gravity [m/s²]
    pub fn estimate(&self, mass: f64, gravity: f64) -> ChargeEstimate {
        let edge_field = 0.5 * (self.per_mass * mass).abs() / PERMITTIVITY;
        ChargeEstimate { edge_field, over_weight: self.per_mass.abs() * edge_field / gravity.abs() }
    }
}

/// Steps from inlet to belt.
const HEIGHTS: usize = 32;
/// Cells in machine direction, half of them on either side of the middle.
const CELLS: usize = 512;

/// The field along the machine direction, `E_y` [V/m], at places between inlet and belt.
#[derive(Clone, Debug, Default)]
pub struct SheetField {
    /// Distance from inlet to belt [m].
    distance: f64,
    /// Cells per length, in machine direction [1/m].
    per_length: f64,
    /// Half the distance of the grounded plates [m]; infinite without plates.
    walls: f64,
    /// At the points of all cells of each height, from the inlet down.
    values: Vec<f64>,
}

impl SheetField {
    /// At a place: `x` below the inlet and `y` from the middle of the slot [m]. There is none on the belt,
    /// which is earthed, and none behind the plates.
    #[inline]
    pub fn at(&self, x: f64, y: f64) -> f64 {
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
    pub fn edge(&self) -> f64 {
        let heights = self.values.chunks_exact(CELLS + 1);
        heights
            .flat_map(|values| [values[0], values[CELLS]])
            .fold(0.0, |most: f64, edge| most.max(edge.abs()))
    }
}
