//! What a few filaments of each layer have laid, and all filaments of any stretch of the sheet that follow from it.

use super::{LayerFibres, WebSpec};
use crate::ground::Error;
use crate::ground::place::Place;
use crate::ground::sort::sort_by_key;
use crate::web::curtain::drawing::draw;
use crate::web::map::inlets;
use crate::web::{Belt, Brush, Canvas, Edges, FlownCurves, Library, SharedAirFindings, Strand};
use std::sync::atomic::AtomicBool;

/// The curves of a few filaments of a layer, from which those of all others follow.
#[derive(Clone, Debug)]
pub(super) struct FlownCurtain {
    /// Number of the layer, from 0.
    pub(super) layer: usize,
    /// The curves.
    pub(super) curves: FlownCurves,
    /// Width and length of the sheet that they have laid [m].
    pub(super) sheet: [f64; 2],
    /// Where that sheet begins on the belt [m].
    pub(super) back: f64,
}

/// The layers of a web once they have been flown.
#[derive(Clone, Debug, Default)]
pub(super) struct FlownLayers {
    pub(super) layers: Vec<LayerFibres>,
    pub(super) shared_air: SharedAirFindings,
    /// Those of which only a few filaments were flown.
    pub(super) curtains: Vec<FlownCurtain>,
}

impl FlownLayers {
    /// Draws all filaments of curtains of which a few were flown.
    pub(super) fn draw(
        &mut self,
        spec: &WebSpec,
        canvas: &Canvas,
        by: (usize, &AtomicBool),
    ) -> Result<(), Error> {
        for (curtain, few) in self.curtains.iter().zip(&mut self.shared_air.few) {
            let (strands, missing) = curtain.draw(spec, canvas, by)?;
            let layer = curtain.layer;
            let strands = strands.into_iter().map(|strand| Strand { layer, ..strand });
            self.shared_air.strands.extend(strands);
            few.missing = missing;
        }
        sort_by_key(&mut self.shared_air.strands, |strand| strand.layer);
        Ok(())
    }
}

impl FlownCurtain {
    /// Draws all filaments: those between the flown ones on the sheet that these have laid, and pieces of it
    /// on any other sheet. Returns their parts in the window, and the part of the variance that the few do
    /// not tell.
    fn draw(
        &self,
        spec: &WebSpec,
        canvas: &Canvas,
        by: (usize, &AtomicBool),
    ) -> Result<(Vec<Strand>, [f64; 2]), Error> {
        let (sheet, window, back) = (&spec.sheet, spec.window(), self.back);
        let Some(layer) = spec.layers.get(self.layer) else { return Ok((Vec::new(), [0.0; 2])) };
        let mass = layer.source.case().map_or(f64::NAN, |case| case.fibre.element_mass());
        let brush = Brush::new(canvas, mass, spec.titres(self.layer));
        let inlets = inlets(sheet, spec.seed, self.layer, &layer.filaments);
        let places = inlets.into_iter().map(|[z, y]| Place { y, z }).collect();
        if [sheet.width, sheet.length] == self.sheet {
            let all = self.curves.fill(places, by.0);
            let kept = draw(&all, Belt { sheet, window, back }, &brush, by)?;
            return Ok((kept, all.missing()));
        }
        let library = Library::new(&self.curves, by.0)?;
        let around = match sheet.edges {
            // A web that is narrower than the flown sheet is a strip of it.
            Edges::Periodic => sheet.width.max(self.sheet[0]),
            // Filaments at the two edges know nothing of each other.
            Edges::Cut => sheet.width + self.sheet[0],
        };
        let tiles = library.tiles(places, around, sheet.length, [spec.seed, self.layer as u64])?;
        let kept = draw(&tiles, Belt::within(&tiles, sheet, window)?, &brush, by)?;
        Ok((kept, library.missing()))
    }
}
