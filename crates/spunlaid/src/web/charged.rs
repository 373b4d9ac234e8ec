//! What charge has made of the filaments of a web in one air.

use crate::charge::SheetHeight;

/// The charged filaments of a layer, as they hung at the end of their flight.
#[derive(Clone, Debug, PartialEq)]
pub struct ChargedCurtain {
    /// Index of the layer.
    pub layer: usize,
    /// The strongest field beside them, at any height [V/m].
    pub edge_field: f64,
    /// Where they hung, from the inlet to the belt.
    pub heights: Vec<SheetHeight>,
}
