//! What the summary of a web tells of charged filaments.

use serde_json::{Value as Json, json};
use spunlaid::web::{ChargedCurtain, Findings};

/// The charged filaments of each layer, as they hung at the end of their flight.
///
/// * `name` – of a layer
pub(super) fn summary<'a>(findings: &Findings, name: impl Fn(usize) -> &'a str) -> Json {
    let together = findings.laid.shared_air.iter().flat_map(|together| &together.charged);
    let entry = |charged: &ChargedCurtain| {
        // From the inlet to the belt: length of filament for each length of height, and places in machine direction
        // behind which 2.5, 25, 50, 75 and 97.5 % of the filament hangs.
        let heights = charged.heights.iter().map(
            |height| json!({"x_m": height.x, "length_per_height": height.length, "md_m": height.places}),
        );
        json!({
            "layer": name(charged.layer),
            "edge_field_v_m": charged.edge_field,
            "heights": heights.collect::<Json>(),
        })
    };
    together.map(entry).collect()
}
