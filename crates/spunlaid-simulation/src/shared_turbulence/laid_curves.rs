//! The fibres of each layer: simulated in one air, or paths of a surrogate whose numbers are known.
//!
//! ```text
//! case → beam → laid points of each filament → the web, and the surrogate identified in some of the curves
//!             → of a few filaments: what they say of all, and all filaments that follow from them
//! ```

use super::BeamFindings;
use super::flyer::Flyer;
use super::layer_beam::{FilledLayer, LayerBeam, beam_on};
use super::sampled::FlownSheet;
use super::two_levels::{FineSheet, LayerSheets};
use crate::{Flown, LaydownSource, WebSpec};
use spunlaid_ground::{Error, RunContext};
use spunlaid_web::map::{Findings, WebWarning, blocks_on, find_laid, inner_columns, lay, pieces};
use spunlaid_web::{DepositionGrid, Depositor, Fibres, FlownCurves, LaidWeb, Map, TRIED, TimeSpent, Web};
use std::mem::take;
use std::sync::Arc;

/// A web with its fibres.
#[derive(Clone, Debug)]
pub struct FlownWeb {
    /// The web.
    pub web: Web,
    /// What filaments in shared turbulence have laid; None of a web that is still to be laid.
    laid: Option<LaidWeb>,
}

impl Flyer<'_> {
    /// A web and its fibres. Filaments that fly in shared turbulence have laid it then.
    ///
    /// # Errors
    /// If the fibres cannot be simulated, have laid nothing, or spread too far for the sheet; and if it is stopped.
    pub fn web(&self, spec: &WebSpec) -> Result<FlownWeb, Error> {
        let (fibres, laid) = if spec.flies() {
            let (fibres, laid) = self.fly_together(spec)?;
            (fibres, Some(laid))
        } else {
            let known = spec.layers.iter().filter_map(|layer| match layer.source {
                LaydownSource::Surrogate(surrogate) => Some(Fibres::Surrogate(surrogate)),
                LaydownSource::Case { .. } => None,
            });
            (known.collect(), None)
        };
        Ok(FlownWeb { web: spec.web(fibres), laid })
    }

    /// Flies all filaments of each layer, or a few for all of them, in independent turbulence, and lays them. A
    /// few curves of each layer are kept, which say what independent filaments would give.
    fn fly_together(&self, spec: &WebSpec) -> Result<(Vec<Fibres>, LaidWeb), Error> {
        if let Some(problem) = spec.air_beyond_memory() {
            return Err(vec![problem].into());
        }
        let beams = (0..spec.layers.len()).map(|number| beam_on(spec, number, None));
        let beams = beams.collect::<Result<Vec<_>, _>>()?;
        let elements: Vec<f64> = beams.iter().map(|layer| layer.beam().element_mass()).collect();
        let canvas =
            DepositionGrid::new(&spec.sheet, &elements, beams.iter().map(LayerBeam::basis_weight).sum())?;
        let mut fibres = Vec::new();
        let mut simulated = Vec::new();
        for (number, layer) in beams.into_iter().enumerate() {
            let brush = Depositor::new(&canvas, layer.beam().element_mass(), spec.titres(number));
            let (layer, mut found, curves) = self.simulate_until_estimated(spec, number, layer, &brush)?;
            let (mut of_layer, back) = (take(&mut found.layer), found.back);
            let gathered = layer.gather(found, self.threads)?;
            // In machine direction the sheet is not closed.
            spec.check_spreads([0.0, gathered.numbers[1].mean])?;
            let of_fibres = Fibres::Flown(Arc::new(gathered));
            if let (Some(curves), Some(few)) = (curves, &mut of_layer.few) {
                let inner = inner_columns(&spec.alone(number).web([of_fibres.clone()]));
                let filled = FilledLayer { spec, number, inner };
                of_layer.strands = layer.fill_in(&filled, &curves, back, few, &brush, self.workers())?;
            }
            fibres.push(of_fibres);
            simulated.push(of_layer);
        }
        Ok((fibres, LaidWeb { simulated, ..canvas.finish()? }))
    }

    /// Flies a layer. Unless the file says how many filaments are simulated, more of them fly where a few do not
    /// give what all do. The curves of a few filaments are returned too.
    fn simulate_until_estimated<'b>(
        &self,
        spec: &'b WebSpec,
        number: usize,
        mut layer: LayerBeam<'b>,
        on: &Depositor<'_>,
    ) -> Result<(LayerBeam<'b>, BeamFindings, Option<FlownCurves>), Error> {
        let (mut flights, mut spent) = (0, TimeSpent::default());
        let mut asked = spec.flown_sheet(number, None);
        let sheets = LayerSheets::new(self, spec, number);
        loop {
            let mut simulated = match &asked {
                Some(asked) if flights == 0 && layer.few.is_some() => sheets.fine(&layer, asked)?,
                _ => self.fly_layer(&layer, spec, Some(on).filter(|_| layer.few.is_none()))?,
            };
            spent.whole += simulated.layer.spent.whole;
            spent.in_parallel += simulated.layer.spent.in_parallel;
            simulated.layer.spent = spent;
            let Some(few) = &layer.few else { return Ok((layer, simulated, None)) };
            let beam = layer.beam();
            let sheet = &layer.sheet;
            let curves = few.curves(sheet, &beam, &simulated)?;
            let workers = self.workers();
            let estimate =
                few.estimate(sheet, blocks_on(sheet), &beam, &simulated, Some(&curves), workers)?;
            flights += 1;
            let finer = asked.clone().map(FlownSheet::finer);
            let more = estimate.warning().is_some() && spec.simulated == Flown::Auto && flights < TRIED.len();
            let more = more.then(|| beam_on(spec, number, finer.as_ref())).transpose()?;
            let Some(more) = more.filter(|more| more.few.is_some()) else {
                let estimate = match &asked {
                    Some(on) if estimate.warning().is_none() => {
                        let first = FineSheet { on, layer: &layer, simulated: &simulated, few: estimate };
                        sheets.until_sure(first)?
                    }
                    _ => estimate,
                };
                // The strands of all filaments are found when they are drawn.
                (simulated.layer.few, simulated.layer.strands) = (Some(estimate), Vec::new());
                return Ok((layer, simulated, Some(curves)));
            };
            (layer, asked) = (more, finer);
        }
    }
}

impl FlownWeb {
    /// What must be known of the numbers of this web before they are believed.
    pub fn warnings(&self, findings: &Findings) -> Vec<WebWarning> {
        findings.warnings(&self.web)
    }

    /// Pieces of filaments that are still to be laid.
    ///
    /// # Errors
    /// If the web cannot be laid.
    pub fn pieces(&self) -> Result<u64, Error> {
        if self.laid.is_some() { Ok(0) } else { pieces(&self.web) }
    }

    /// Lays the web, unless it has been laid, and looks at nothing but its map.
    ///
    /// # Errors
    /// If the web cannot be laid, or if it is stopped.
    pub fn map(&mut self, by: RunContext<'_>) -> Result<Map, Error> {
        let laid = self.laid.take().map_or_else(|| lay(&self.web, by), Ok)?;
        Ok(laid.map)
    }

    /// Lays the web, unless it has been laid, and looks at it.
    ///
    /// # Errors
    /// If the web cannot be laid, or if it is stopped.
    pub fn find(&mut self, by: RunContext<'_>) -> Result<Findings, Error> {
        let laid = self.laid.take();
        find_laid(&self.web, laid, by)
    }
}
