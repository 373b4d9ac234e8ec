//! What a few filaments of each layer have laid, and all filaments of any stretch of the sheet that follow from it.

use super::{LayerFibres, WebSpec};
use crate::curtain::drawing::draw;
use crate::curtain::{Belt, FlownCurves, Library};
use crate::error::Error;
use crate::fibre::Place;
use crate::sort::sort_by_key;
use crate::web::{Brush, Canvas, Edges, KeptFibres, PieceInWindow, SharedAirFindings, Strand, inlets};
use std::sync::atomic::AtomicBool;

/// The curves of a few filaments of a layer, from which those of all others follow.
#[derive(Clone, Debug)]
pub struct FlownCurtain {
    /// Number of the layer, from 0.
    pub layer: usize,
    /// The curves.
    pub curves: FlownCurves,
    /// Width and length of the sheet that they have laid [m].
    pub sheet: [f64; 2],
    /// Where that sheet begins on the belt [m].
    pub back: f64,
}

/// Those of all layers of which only a few filaments were flown.
#[derive(Clone, Debug, Default)]
pub struct FlownCurtains(pub Vec<FlownCurtain>);

/// The layers of a web once they have been flown.
#[derive(Clone, Debug, Default)]
pub(super) struct FlownLayers {
    pub(super) layers: Vec<LayerFibres>,
    pub(super) shared_air: SharedAirFindings,
    pub(super) curtains: FlownCurtains,
    /// The pieces of fibres in the windows in which holes are counted, by window.
    pub(super) pieces: Vec<PieceInWindow>,
}

/// What is found while the filaments of curtains are drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DrawnCurtains {
    /// Their parts in the window of the sheet, by layer.
    pub strands: Vec<Strand>,
    /// Their pieces in the windows in which holes are counted.
    pub pieces: Vec<PieceInWindow>,
    /// Of each curtain, the part of the variance that the few do not tell, in machine and in cross direction.
    pub missing: Vec<[f64; 2]>,
}

impl FlownLayers {
    /// Adds what was found while the curtains were drawn.
    pub(super) fn add(&mut self, drawn: DrawnCurtains) {
        let strands = &mut self.shared_air.strands;
        strands.extend(drawn.strands);
        sort_by_key(strands, |strand| strand.layer);
        self.pieces.extend(drawn.pieces);
        sort_by_key(&mut self.pieces, |piece| piece.window);
        for (few, missing) in self.shared_air.few.iter_mut().zip(drawn.missing) {
            few.missing = missing;
        }
    }
}

impl FlownCurtains {
    /// Draws all filaments on the rows of a canvas.
    pub(super) fn draw(
        &self,
        spec: &WebSpec,
        canvas: &Canvas,
        by: (usize, &AtomicBool),
    ) -> Result<DrawnCurtains, Error> {
        let mut all = DrawnCurtains::default();
        for curtain in &self.0 {
            let (KeptFibres { strands, pieces }, missing) = curtain.draw(spec, canvas, by)?;
            let layer = curtain.layer;
            all.strands.extend(strands.into_iter().map(|strand| Strand { layer, ..strand }));
            all.pieces.extend(pieces.into_iter().map(|piece| PieceInWindow { layer, ..piece }));
            all.missing.push(missing);
        }
        Ok(all)
    }
}

impl FlownCurtain {
    /// Draws all filaments: those between the flown ones on the sheet that these have laid, and pieces of it
    /// on any other sheet. Returns their parts in the windows, and the part of the variance that the few do
    /// not tell.
    fn draw(
        &self,
        spec: &WebSpec,
        canvas: &Canvas,
        by: (usize, &AtomicBool),
    ) -> Result<(KeptFibres, [f64; 2]), Error> {
        let (sheet, windows, back) = (&spec.sheet, spec.windows(), self.back);
        let Some(layer) = spec.layers.get(self.layer) else { return Ok((KeptFibres::default(), [0.0; 2])) };
        let mass = layer.source.case().map_or(f64::NAN, |case| case.fibre.element_mass());
        let brush = Brush::new(canvas, mass, spec.titres(self.layer));
        let inlets = inlets(sheet, spec.seed, self.layer, &layer.filaments);
        let places = inlets.into_iter().map(|[z, y]| Place { y, z }).collect();
        if [sheet.width, sheet.length] == self.sheet {
            let all = self.curves.fill(places, by.0);
            let kept = draw(&all, Belt { sheet, windows, back }, &brush, by)?;
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
        let kept = draw(&tiles, Belt::within(&tiles, sheet, windows)?, &brush, by)?;
        Ok((kept, library.missing()))
    }
}
