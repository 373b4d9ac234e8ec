//! The fabric that a web becomes.

use super::WebSpec;
use crate::fabric::{Fabric, Filaments, Laid, tell};
use crate::web::{Findings, Web};

impl WebSpec {
    /// What a buyer wants to know of the fabric.
    ///
    /// * `web`, `found` – the web that was laid, and what was found of it
    pub fn fabric(&self, web: &Web, found: &Findings, threads: usize) -> Fabric {
        let sheet = &web.sheet;
        let kinds = self.layers.iter().zip(&web.layers).map(|(layer, drawn)| Filaments {
            diameter: layer.diameter,
            density: layer.density,
            basis_weight: drawn.basis_weight(sheet),
        });
        let counted = self.windows().counted;
        let laid = Laid {
            map: &found.laid.map,
            margins: found.margins,
            reach: Some(found.reach),
            filaments: kinds.collect(),
            orientation: Some(&found.orientation),
            patches: found.patches.iter().map(|patch| patch.map).collect(),
            windows: counted.as_ref().map(|windows| (windows, &found.laid.pieces[..])),
        };
        tell(&laid, &self.fabric, threads)
    }
}
