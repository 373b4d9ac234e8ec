//! Webs whose filaments all fly in one air, and lay the sheet as they come down.

use super::few::{FewFlight, FewPlan, FlownSheet};
use super::flown_curtain::{FlownCurtain, FlownLayers};
use super::flyer::Flights;
use super::{Flown, FlownFibres, Flyer, LaydownSource, LayerFibres, WebSpec};
use crate::fibre::Case;
use crate::ground::error::Place as ErrorPlace;
use crate::ground::place::Place;
use crate::ground::{Dimension, Error, Fault, Isa, Problem};
use crate::simulation::beam::{Beam, BeamCharge, BeamControl, BeamFindings};
use crate::web::map::{blocks_on, inlets};
use crate::web::{
    Brush, Canvas, Curves, Fibres, FlownCurves, LaidWeb, LayerFew, OneAir, Sheet, TRIED, TimeSpent,
};
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// Smallest lateral cut-off that is worth to be written.
const FEWEST_WAVES: f64 = 5.0;

/// How many times as long elements and steps are where webs are compared.
const MESH_OF_COMPARISON: f64 = 2.0;
/// How many times as rarely the air is looked at there: five times in the shortest period that a filament feels.
const LOOKS_OF_COMPARISON: f64 = 1.6;
/// Longest element that still follows the eddies, in their smallest length scale.
const LONGEST_ELEMENT: f64 = 0.5;

/// Width of filaments beside each other of which those beside them hardly know, in parts of the distance
/// after which the air repeats itself at least, which is ten length scales.
const APART: f64 = 0.5;
/// Length of fed fibre after which gusts are forgotten, in ways from inlet to belt.
const MEMORY: f64 = 2.0;

/// The filaments of a layer before they fly.
pub(super) struct LayerBeam<'a> {
    path: &'a Path,
    case: Case,
    /// The sheet on which they are laid, and whether they are a few of all.
    pub(super) sheet: Sheet,
    pub(super) few: Option<FewPlan>,
    pub(super) places: Vec<Place>,
    /// Size of the slot in machine direction [m].
    depth: f64,
    /// What they carry.
    pub(super) charge: Option<BeamCharge>,
}

/// The flight of a layer, with the curves of a few filaments and what they say of all.
type ToldFlight<'a> = (LayerBeam<'a>, BeamFindings, Option<(FlownCurves, LayerFew)>);

impl LayerBeam<'_> {
    pub(super) fn beam(&self) -> Beam<'_> {
        let Self { case, places, depth, charge, .. } = self;
        Beam { case, places, depth: *depth, charge: charge.as_ref() }
    }

    /// The same filaments in elements twice as long, and in steps twice as long, as far as these still follow
    /// the eddies, with rarer looks and half the start: what this does to one web it does to another one with which
    /// it is compared.
    pub(super) fn with_coarser_mesh(mut self) -> Self {
        let mut coarse = self.case.clone();
        coarse.run.rarer_looks = LOOKS_OF_COMPARISON;
        let element = MESH_OF_COMPARISON * coarse.fibre.rest_length();
        if let Some(line) =
            coarse.line.filter(|_| element <= LONGEST_ELEMENT * coarse.smallest_length_scale())
        {
            let looks = coarse.steps_between_looks() as f64 * coarse.run.time_step;
            coarse.fibre.span(line.distance, element);
            coarse.set_time_step((MESH_OF_COMPARISON * coarse.run.time_step).min(looks));
        }
        coarse.run.spin_up_steps /= 2;
        if coarse.check().is_ok() {
            self.case = coarse;
        }
        self
    }

    /// Mass of all filaments, the ones that are not flown too, over the area on which they are laid [kg/m²].
    fn basis_weight(&self) -> f64 {
        let beam = self.beam();
        let all = self.few.as_ref().map_or(1.0, |few| few.all / self.places.len() as f64);
        all * beam.basis_weight(&self.sheet)
    }

    /// What some of its filaments have laid, each for itself.
    fn gather(&self, mut flown: BeamFindings, threads: usize) -> Result<FlownFibres, Error> {
        flown.kept.retain(|(filament, _)| self.beam().keeps(*filament));
        let one_air = self.one_air(flown.kept.iter().map(|(filament, _)| *filament));
        let (way, curves) = (flown.way, flown.kept.into_iter().map(|(_, points)| points).collect());
        let gathered = FlownFibres::gather((self.path, &self.case), curves, threads)?;
        let curves = Curves::clone(&gathered.curves).in_one_air(one_air);
        Ok(FlownFibres { curves: Arc::new(curves), way, ..gathered })
    }

    /// How far some of its filaments hang together.
    fn one_air(&self, filaments: impl Iterator<Item = usize>) -> OneAir {
        let (case, sheet) = (&self.case, &self.sheet);
        let groups = (sheet.width / (APART * case.extent_of_air().z)).floor().max(1.0);
        let group =
            |filament: usize| (self.places[filament].z / sheet.width * groups).clamp(0.0, groups - 1.0);
        let way = case.line.map_or(0.0, |line| line.distance);
        OneAir { groups: filaments.map(|filament| group(filament) as usize).collect(), memory: MEMORY * way }
    }
}

impl Flyer<'_> {
    /// Threads and stop flag.
    const fn by(&self) -> (usize, &AtomicBool) {
        (self.threads, self.stop)
    }

    /// Flies all filaments of each layer, or a few for all of them, in an air of its own, and lays them. A
    /// few curves of each layer are kept, which say what independent filaments would give.
    pub(super) fn fly_together(&self, spec: &WebSpec) -> Result<(Vec<LayerFibres>, LaidWeb), Error> {
        let beams = beams(spec)?;
        let canvas = canvas(spec)?;
        let mut all = FlownLayers::default();
        for (number, layer) in beams.into_iter().enumerate() {
            let brush = Brush::new(&canvas, layer.beam().element_mass(), spec.titres(number));
            let (layer, mut flown, told) = self.fly_until_told(spec, (number, layer), &brush)?;
            let mut of_layer = flown.take_shared_air();
            if let Some((curves, told)) = told {
                let flown_sheet = [layer.sheet.width, layer.sheet.length];
                all.curtains.push(FlownCurtain {
                    layer: number,
                    curves,
                    sheet: flown_sheet,
                    back: flown.back,
                });
                of_layer.few = vec![told];
                // Those of all filaments are found when they are drawn.
                of_layer.strands = Vec::new();
            }
            all.shared_air.add(number, of_layer);
            let flown = Arc::new(layer.gather(flown, self.threads)?);
            // In machine direction the sheet is not closed.
            spec.check_spreads([0.0, flown.numbers[1].mean])?;
            let (curves, surrogate) = (Arc::clone(&flown.curves), flown.surrogate());
            let fibres = Fibres::Flown { curves, surrogate };
            all.layers.push(LayerFibres { fibres, flown: Some(flown) });
        }
        all.draw(spec, &canvas, self.by())?;
        let FlownLayers { layers, shared_air, .. } = all;
        Ok((layers, LaidWeb { shared_air: Some(shared_air), ..canvas.finish()? }))
    }

    /// Flies a layer. Unless the file says how many filaments are flown, more of them fly where a few do not
    /// tell what all do.
    fn fly_until_told<'a>(
        &self,
        spec: &'a WebSpec,
        (number, mut layer): (usize, LayerBeam<'a>),
        on: &Brush<'_>,
    ) -> Result<ToldFlight<'a>, Error> {
        let (mut flights, mut spent) = (0, TimeSpent::default());
        let mut sheet = spec.flown_sheet(number, None);
        loop {
            let mut flown = self.fly_layer(&layer, spec, Some(on).filter(|_| layer.few.is_none()))?;
            spent.whole += flown.spent.whole;
            spent.in_parallel += flown.spent.in_parallel;
            flown.spent = spent;
            let Some(few) = &layer.few else { return Ok((layer, flown, None)) };
            let curves = few.curves(&layer.sheet, &layer.beam(), &flown)?;
            let of_sheet = (number, &layer.sheet, blocks_on(&layer.sheet));
            let told = few.tell(of_sheet, (&layer.beam(), &flown), Some(&curves), self.by())?;
            flights += 1;
            sheet = sheet.map(FlownSheet::finer);
            let more = told.doubt().is_some() && spec.flown == Flown::Auto && flights < TRIED.len();
            let more = more.then(|| beam_on(spec, number, sheet.as_ref())).transpose()?;
            let Some(more) = more.filter(|more| more.few.is_some()) else {
                return Ok((layer, flown, Some((curves, told))));
            };
            layer = more;
        }
    }

    /// Flies a layer and shows the progress.
    ///
    /// * `on` – what lays an element of fibre; None if only a few are flown
    fn fly_layer(
        &self,
        layer: &LayerBeam<'_>,
        spec: &WebSpec,
        on: Option<&Brush<'_>>,
    ) -> Result<BeamFindings, Error> {
        let (beam, done) = (layer.beam(), AtomicU64::new(0));
        let by = BeamControl { threads: self.threads, isa: Isa::detect(), stop: self.stop, steps: &done };
        let flights = Flights {
            path: layer.path,
            fibres: layer.places.len() as u64,
            done: &done,
            steps: beam.steps(&layer.sheet),
            time_step: layer.case.run.time_step,
        };
        let mut flown = Err(Error::Interrupted);
        (self.follow)(flights, &mut || flown = beam.fly((&layer.sheet, spec.window()), on, by));
        flown
    }
}

impl WebSpec {
    /// Largest lateral wave number of the air that all filaments of a layer share, times its length scale;
    /// None of filaments in airs of their own.
    pub fn lateral_cutoff(&self, layer: usize) -> Option<f64> {
        let case = self.layers.get(layer)?.source.case()?;
        case.air.lateral.in_one_air().cutoff()
    }

    /// The problem of a web in one air whose field of eddies does not fit into the memory that it may take.
    pub(crate) fn air_beyond_memory(&self) -> Option<Problem> {
        let beams = (0..self.layers.len()).filter_map(|number| beam_on(self, number, None).ok());
        let largest = beams
            .map(|layer| (layer.beam().memory_of_air(&layer.sheet), layer.case.air.lateral))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let (needed, cutoff) = largest.and_then(|(needed, lateral)| Some((needed, lateral.cutoff()?)))?;
        if needed <= self.memory_limit {
            return None;
        }
        let share = self.memory_limit / needed;
        let memory = |size: f64| Dimension::Memory.pretty_to(size, 3);
        let (width, cutoff) = (self.sheet.width * share, cutoff * share.sqrt());
        let what = Fault::new(
            format!(
                "is less than the field of eddies takes, {}, which all filaments share across the whole web",
                memory(needed)
            ),
            match cutoff >= FEWEST_WAVES {
                true => format!(
                    "write {} or more if the machine has it; a web.width of about {}, or air.lateral_cutoff \
                    = {} in the case, would fit",
                    memory(1.05 * needed),
                    Dimension::Length.pretty_to(width, 2),
                    Dimension::Ratio.pretty_to(cutoff, 2)
                ),
                false => format!(
                    "write {} or more if the machine has it, or make the web narrower",
                    memory(1.05 * needed)
                ),
            },
        );
        let value = Some(memory(self.memory_limit));
        Some(Problem { place: ErrorPlace::Code, key: "web.memory_limit".to_owned(), value, what })
    }
}

/// The filaments of all layers.
///
/// # Errors
/// If a layer is not flown, or if its air does not fit into the memory.
fn beams(spec: &WebSpec) -> Result<Vec<LayerBeam<'_>>, Error> {
    if let Some(problem) = spec.air_beyond_memory() {
        return Err(vec![problem].into());
    }
    (0..spec.layers.len()).map(|number| beam_on(spec, number, None)).collect()
}

/// The canvas of the sheet.
fn canvas(spec: &WebSpec) -> Result<Canvas, Error> {
    let beams = (0..spec.layers.len()).map(|number| beam_on(spec, number, None));
    let beams = beams.collect::<Result<Vec<_>, _>>()?;
    let elements: Vec<f64> = beams.iter().map(|layer| layer.beam().element_mass()).collect();
    let weight = beams.iter().map(LayerBeam::basis_weight).sum();
    Ok(Canvas::new(&spec.sheet, &elements, weight)?)
}

/// The filaments of a layer at their places. Air that a case leaves the same across the flow becomes a field
/// in space. The seed of the web and the number of the layer are in the key of the air, so that layers and
/// webs have airs of their own.
///
/// * `sheet` – that a few of them lay; None for the one whose clouds tell the CV
pub(super) fn beam_on<'a>(
    spec: &'a WebSpec,
    number: usize,
    sheet: Option<&FlownSheet>,
) -> Result<LayerBeam<'a>, Error> {
    let layer = &spec.layers[number];
    let LaydownSource::Case { path, case } = &layer.source else {
        let fault = Fault::new("a web in one air flies its filaments", "name their case (laydown.case)");
        return Err(fault.into());
    };
    let mut case = Case::clone(case);
    case.air.lateral = case.air.lateral.in_one_air();
    case.run.seed = key(case.run.seed, spec.seed, number as u64);
    let depth = layer.filaments.depth();
    let flown_sheet = sheet.cloned().or_else(|| spec.flown_sheet(number, None));
    Ok(match flown_sheet.and_then(|sheet| spec.few(number, &sheet)) {
        Some(FewFlight { sheet, places, few }) => {
            let charge = spec.beam_charge(number, (&places, Some(&few)));
            LayerBeam { path, case, sheet, few: Some(few), places, depth, charge }
        }
        None => {
            let place = |[z, y]: [f64; 2]| Place { y, z };
            let inlets = inlets(&spec.sheet, spec.seed, number, &layer.filaments);
            let places: Vec<Place> = inlets.into_iter().map(place).collect();
            let charge = spec.beam_charge(number, (&places, None));
            LayerBeam { path, case, sheet: spec.sheet.clone(), few: None, places, depth, charge }
        }
    })
}

/// A seed from those of the case and of the web and the number of a layer, each of which changes about half
/// of its bits.
fn key(case: u64, web: u64, layer: u64) -> u64 {
    [case, web, layer]
        .into_iter()
        .fold(0, |sum: u64, part| SplitMix64::seed_from_u64(sum.wrapping_add(part)).next_u64())
}

/// The flight of a layer of a web in one air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedFlight {
    /// Number of filaments that are flown.
    pub filaments: u64,
    /// Whether they stand for others that are not flown.
    pub is_few: bool,
    /// Size of the sheet that they lay, across and along [m].
    pub sheet: [f64; 2],
    /// Memory that the field of eddies takes [B].
    pub memory: f64,
}

impl WebSpec {
    /// What a web in one air will fly, layer by layer; nothing of any other web, and of layers that name no case.
    pub fn planned_flights(&self) -> Vec<PlannedFlight> {
        let layers = (0..self.layers.len()).filter_map(|number| beam_on(self, number, None).ok());
        let plan = layers.map(|layer| PlannedFlight {
            filaments: layer.places.len() as u64,
            is_few: layer.few.is_some(),
            sheet: [layer.sheet.width, layer.sheet.length],
            memory: layer.beam().memory_of_air(&layer.sheet),
        });
        plan.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The airs of webs that were laid before stay as they were.
    #[test]
    fn reproducible_the_key_of_an_air_keeps_its_bits() {
        let found = [(0, 0, 0), (1, 1, 0), (1, 1, 1), (1, 2, 0), (2, 1, 0), (u64::MAX, u64::MAX, 7)]
            .map(|(case, web, layer)| key(case, web, layer));
        assert_eq!(
            found,
            [
                0x2382_75bc_38fc_be91,
                0xd515_9b73_432a_2795,
                0x7970_e130_d0c7_742f,
                0xe68e_6fc0_1df0_8360,
                0x90b9_6b4d_d23b_d6eb,
                0x5bde_e0cd_b40a_fc85,
            ]
        );
    }
}
