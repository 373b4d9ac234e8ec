//! What the summary of a web tells of charged filaments.

use serde::Serialize;
use spunlaid::web::{ChargedCurtain, Findings};

/// The charged filaments of a layer, as they hung at the end of their flight.
#[derive(Debug, Serialize)]
pub(super) struct ChargeSummary<'a> {
    /// Name of the layer.
    layer: &'a str,
    /// The strongest field beside them, at any height [V/m].
    edge_field_v_m: f64,
    /// From the inlet to the belt.
    heights: Vec<HeightSummary>,
}

#[derive(Debug, Serialize)]
struct HeightSummary {
    x_m: f64,
    /// Length of filament for each length of height.
    length_per_height: f64,
    /// Places in machine direction behind which 2.5, 25, 50, 75 and 97.5 % of the filament hangs.
    md_m: [f64; 5],
}

impl<'a> ChargeSummary<'a> {
    /// * `name` – of a layer
    pub(super) fn from_findings(findings: &Findings, name: impl Fn(usize) -> &'a str) -> Vec<Self> {
        let together = findings.laid.shared_air.iter().flat_map(|together| &together.charged);
        let entry = |charged: &ChargedCurtain| Self {
            layer: name(charged.layer),
            edge_field_v_m: charged.edge_field,
            heights: (charged.heights.iter())
                .map(|height| HeightSummary {
                    x_m: height.x,
                    length_per_height: height.length,
                    md_m: height.places,
                })
                .collect(),
        };
        together.map(entry).collect()
    }
}
