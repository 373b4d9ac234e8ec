//! The neighbours in `summary.json`: how fibres are correlated with their companions in the same air.

use serde::Serialize;
use serde_json::{Map, Value as Json};
use spunlaid::ensemble::{Curve, Results};
use spunlaid::observe::Kind;

/// The correlations over the distance, in cross and in machine direction.
#[derive(Debug, Serialize)]
pub(super) struct NeighboursSummary {
    cd: Vec<Map<String, Json>>,
    md: Vec<Map<String, Json>>,
}

impl NeighboursSummary {
    pub(super) fn new(results: &Results) -> Self {
        let correlations = |direction: &str| {
            let before = format!("neighbours_{direction}_");
            let is_one = |curve: &&Curve| curve.measure.kind == Kind::Neighbour;
            let curves = results.curves.iter().filter(is_one);
            distances(curves.filter_map(|curve| Some((curve.measure.column.strip_prefix(&before)?, curve))))
        };
        Self { cd: correlations("cd"), md: correlations("md") }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.cd.is_empty() && self.md.is_empty()
    }
}

/// An entry for each distance: `distance_m`, and each correlation with its standard error, `correlation_md` and
/// `correlation_md_se`.
fn distances<'a>(curves: impl Iterator<Item = (&'a str, &'a Curve)>) -> Vec<Map<String, Json>> {
    let mut entries: Vec<Map<String, Json>> = Vec::new();
    for (name, curve) in curves {
        entries.resize_with(curve.places.len(), Map::new);
        for (entry, place) in entries.iter_mut().zip(&curve.places) {
            entry.insert("distance_m".to_owned(), place.at.into());
            entry.insert(name.to_owned(), place.mean.into());
            entry.insert(format!("{name}_se"), place.standard_error.into());
        }
    }
    entries
}
