//! Checks the charge of the filaments.

use super::read::Reading;
use crate::case::{Note, Remark};
use crate::charge::{BREAKDOWN, STRONG};
use crate::error::{Fault, Place};
use crate::layers::{LayerSpec, WebSpec};
use crate::units::Dimension;

impl Reading<'_> {
    /// Checks the charge of each layer.
    pub(super) fn check_charge(&mut self, prefixes: &[String], web: &WebSpec) {
        for (prefix, layer) in prefixes.iter().zip(&web.layers) {
            self.check_charge_of(prefix, web, layer);
        }
    }

    fn check_charge_of(&mut self, prefix: &str, web: &WebSpec, layer: &LayerSpec) {
        let [charge, walls] = ["charge", "walls"].map(|name| format!("{prefix}line.{name}"));
        if layer.charged().is_some() && !web.flies() {
            let fault = Fault::new(
                "is that of filaments of known numbers, which do not fly",
                "leave it out, or name a case in [laydown] in place of the numbers",
            );
            self.key_values.reject(&charge, fault);
            return;
        }
        let farthest = layer.farthest_inlet();
        if let Some(distance) = layer.walls.filter(|distance| *distance <= farthest) {
            let shown = |length| Dimension::Length.pretty(length);
            let fault = Fault::new(
                format!("is no more than {}, where filaments are fed", shown(farthest)),
                "write a larger distance from the middle of the slot",
            );
            self.refuse(&walls, shown(distance), fault);
        }
        let Some(estimate) = layer.charge_estimate(&web.sheet) else { return };
        let field = Dimension::ElectricField.pretty_to(estimate.edge_field, 2);
        if estimate.edge_field > BREAKDOWN {
            let most = layer.charge.unwrap_or(0.0).abs() * BREAKDOWN / estimate.edge_field;
            let fault = Fault::new(
                format!(
                    "gives a field of {field} at the edge of the curtain, and air breaks down at {}",
                    Dimension::ElectricField.pretty(BREAKDOWN)
                ),
                format!("write {} or less", Dimension::SpecificCharge.pretty_to(0.99 * most, 2)),
            );
            self.key_values.reject(&charge, fault);
        } else if estimate.edge_field > STRONG {
            let note = Note {
                place: Place::Code,
                key: charge,
                value: layer.charge.map(|charge| Dimension::SpecificCharge.pretty(charge)),
                what: Remark::StrongField { field: estimate.edge_field },
            };
            self.note(vec![note]);
        }
    }
}
