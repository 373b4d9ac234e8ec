//! Filaments that carry charge: how much, and the field that they make of themselves.
//!
//! ```text
//! places of all filaments → Sheets: charge at each height, over y → SheetField → the force on every node
//!        └─────────────────────── some time later, and again ──────────────────────────┘
//! ```
//!
//! At each height the filaments are sheets across the web, so the field has a component along the machine
//! direction only, and is known from the shares of charge on either side.       theory.md (83i) to (83l)

mod field;
mod sheets;

pub(crate) use field::SheetField;
pub use sheets::SheetHeight;
pub(crate) use sheets::{ChargedNode, Curtain, Sheets};

/// Permittivity of the vacuum `ε₀` [F/m], which is that of air within a thousandth.
pub const PERMITTIVITY: f64 = 8.854_187_812_8e-12;
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

/// What charge does to a curtain, estimated before it is flown.
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
