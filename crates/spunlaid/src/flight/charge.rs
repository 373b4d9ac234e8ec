//! The charge of the fibres of a flight, and the field that all fibres of their curtain make.

use super::Flight;
use crate::chain::charged::Charged;
use crate::charge::{ChargedNode, SheetField};
use crate::lanes::Lanes;
use std::sync::Arc;

impl Flight {
    /// Gives all fibres a charge, and the field around them from now on.
    ///
    /// * `per_mass` – the charge [C/kg]
    pub(crate) fn charge(&mut self, per_mass: f64, field: &Arc<SheetField>) {
        let inlets = Lanes::from_fn(|lane| self.entries.get(lane).map_or(0.0, |entry| entry.place.y));
        match &mut self.chain.charged {
            Some(charged) => charged.field = Arc::clone(field),
            none => *none = Some(Charged::new(Arc::clone(field), per_mass, inlets)),
        }
    }

    /// The nodes of a charged fibre that are above the belt.
    ///
    /// * `weight` – of the fibre among all
    pub(crate) fn charged_nodes(&self, lane: usize, weight: u64) -> impl Iterator<Item = ChargedNode> {
        let inlet = self.chain.charged.as_ref().map_or(0.0, |charged| charged.inlets.0[lane]);
        let nodes = self.chain.position.iter().take(self.chain.nodes()[lane]);
        nodes.map(move |at| ChargedNode { x: at.x.0[lane], y: at.y.0[lane] + inlet, weight })
    }
}
