//! The filaments of a layer as a curtain that drives the air.

use super::WebSpec;
use crate::ensemble::Curtain;
use crate::web::inlets;

impl WebSpec {
    /// The filaments of a layer per metre of width, and where they are fed; None if there is no such layer.
    pub fn curtain(&self, layer: usize) -> Option<Curtain> {
        let filaments = &self.layers.get(layer)?.filaments;
        let places = inlets(&self.sheet, self.seed, layer, filaments);
        let mut inlets: Vec<f64> = places.into_iter().map(|[_, md]| md).collect();
        inlets.sort_unstable_by(f64::total_cmp);
        Some(Curtain { filaments_per_metre: filaments.count(&self.sheet) as f64 / self.sheet.width, inlets })
    }
}
