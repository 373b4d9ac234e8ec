//! Webs whose filaments all fly in shared turbulence, and lay the sheet as they come down.

use super::sampled::{FlownSheet, SubsamplePlan};
use super::{Beam, BeamCharge, BeamFindings};
use crate::{LaydownSource, LayerSpec, WebSpec};
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use spunlaid_fibre::{Case, LaidPoint};
use spunlaid_ground::place::Inlet;
use spunlaid_ground::threads::par_map;
use spunlaid_ground::{Diagnostic, Dimension, Error, Estimate, Fault, Workers};
use spunlaid_web::curtain::drawing::draw;
use spunlaid_web::curtain::lay_with;
use spunlaid_web::map::inlets;
use spunlaid_web::map::uniformity::patch_cv;
use spunlaid_web::surrogate::identify;
use spunlaid_web::{
    Belt, Curves, Depositor, Edges, FlownCurves, FlownFibres, Library, OneAir, Sheet, SubsampleCv,
    SubsampleEstimate, Titres, Trace, TraceSettings, Window, WindowCurve,
};
use std::ops::Range;
use std::path::Path;

/// Area of a sheet of pieces on which places and defects of its filaments are looked at [m²]: they are the same along
/// all of it.
const OF_PLACES: f64 = 2.0;
/// Smallest lateral cut-off that is worth to be written.
const FEWEST_WAVES: f64 = 5.0;

/// How many times as long elements and steps are where webs are compared.
const MESH_OF_COMPARISON: f64 = 2.0;
/// How many times as rarely the air is looked at there: five times in the shortest period that a filament feels.
const LOOKS_OF_COMPARISON: f64 = 1.6;
/// The same of the coarsest flights, and how many times as long their steps are if that is stable.
const LOOKS_OF_COARSEST: f64 = 3.2;
const STEPS_OF_COARSEST: [f64; 5] = [3.6, 2.5, 1.8, 1.3, 1.0];
/// Longest element that still follows the eddies, in their smallest length scale.
const LONGEST_ELEMENT: f64 = 0.5;

/// Width of filaments beside each other of which those beside them hardly know, in parts of the distance
/// after which the air repeats itself at least, which is ten length scales.
const APART: f64 = 0.5;
/// Length of fed fibre after which eddies are forgotten, in lengths of the fibre that hangs between inlet and belt, or
/// longer where the air itself changes slowly.
const MEMORY: f64 = 2.0;

/// A layer of a web that is filled in from few of its filaments.
pub(super) struct FilledLayer<'a> {
    pub(super) spec: &'a WebSpec,
    pub(super) number: usize,
    /// Columns of the sheet that are not edges.
    pub(super) inner: Range<usize>,
}

/// The library of a flight, from which sheets around a belt are made.
struct Pieces<'a> {
    simulated: &'a Library,
    /// Width after which the sheet repeats itself [m].
    around: f64,
}

/// The filaments of a layer before they fly.
pub(super) struct LayerBeam<'a> {
    pub(super) path: &'a Path,
    case: Case,
    /// The sheet on which they are laid, and whether they are a few of all.
    pub(super) sheet: Sheet,
    pub(super) few: Option<SubsamplePlan>,
    pub(super) places: Vec<Inlet>,
    /// Size of the slot in machine direction [m].
    depth: f64,
    /// What they carry.
    pub(super) charge: Option<BeamCharge>,
}

impl LayerBeam<'_> {
    pub(super) fn beam(&self) -> Beam<'_> {
        let Self { case, places, depth, charge, .. } = self;
        Beam { case, places, depth: *depth, charge: charge.as_ref() }
    }

    /// The same filaments in elements twice as long, or as long as these still follow the eddies, and in steps twice as
    /// long, with rarer looks and half the start: what this does to one web it does to another one with which it is
    /// compared.
    pub(super) fn with_coarser_mesh(mut self) -> Self {
        let mut coarse = self.case.clone();
        coarse.run.rarer_looks = LOOKS_OF_COMPARISON;
        let fine = coarse.fibre.rest_length();
        let element = (MESH_OF_COMPARISON * fine).min(LONGEST_ELEMENT * coarse.smallest_length_scale());
        if let Some(line) = coarse.line.filter(|_| element > fine) {
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

    /// The same filaments in elements as long as the eddies allow, in the longest steps that are stable, with rarer
    /// looks and half the start.
    pub(super) fn with_coarsest_mesh(mut self) -> Self {
        self.few.iter_mut().for_each(SubsamplePlan::filled_sparsely);
        let Some(line) = self.case.line else { return self };
        let longest = LONGEST_ELEMENT * self.case.smallest_length_scale();
        let coarse = |longer: f64| {
            let mut coarse = self.case.clone();
            coarse.run.rarer_looks = LOOKS_OF_COARSEST;
            let looks = coarse.steps_between_looks() as f64 * coarse.run.time_step;
            coarse.fibre.span(line.distance, longest.max(coarse.fibre.rest_length()));
            coarse.set_time_step((longer * coarse.run.time_step).min(looks));
            coarse.run.spin_up_steps /= 2;
            coarse.check().is_ok().then_some(coarse)
        };
        if let Some(coarse) = STEPS_OF_COARSEST.into_iter().find_map(coarse) {
            self.case = coarse;
        }
        self
    }

    /// The same filaments, which lay a longer sheet.
    ///
    /// * `length` – by which it is longer at least [m]
    pub(super) fn longer_by(mut self, length: f64) -> Self {
        self.sheet.length += (length / self.sheet.cell).ceil() * self.sheet.cell;
        self
    }

    /// Mass of all filaments, the ones that are not simulated too, over the area on which they are laid [kg/m²].
    pub(super) fn basis_weight(&self) -> f64 {
        let beam = self.beam();
        let all = self.few.as_ref().map_or(1.0, |few| few.all / self.places.len() as f64);
        all * beam.basis_weight(&self.sheet)
    }

    /// What some of its filaments have laid, each for itself, and the surrogate of it.
    pub(super) fn gather(&self, simulated: BeamFindings, threads: usize) -> Result<FlownFibres, Error> {
        let line = self
            .case
            .line
            .ok_or_else(|| Error::folder(self.path, Fault::plain("its fibre is not fed on to a belt")))?;
        // Where it swings and folds, more of it hangs there than the way is long.
        let slack =
            simulated.way.iter().map(|place| place.fibre).sum::<f64>() / simulated.way.len().max(1) as f64;
        let hanging = line.distance * slack.max(1.0);
        let kept = simulated.kept.into_iter().filter(|(filament, _)| self.beam().keeps(*filament));
        let (filaments, laid): (Vec<usize>, Vec<Vec<LaidPoint>>) = kept.unzip();
        let (spacing, belt_ratio) = (self.case.fibre.rest_length(), line.belt_ratio());
        // As the measures of a run do, to the same bits.
        let skip = (line.feed_speed * self.case.run.spin_up() / spacing).round() as u64;
        let tracing = TraceSettings { spacing, belt_ratio, skip, reach: line.distance };
        let traced = par_map(threads, laid.len(), |filament| {
            let mut trace = Trace::new(tracing);
            laid[filament].iter().for_each(|point| trace.add(point.md, point.cd));
            let statistics = trace.finish();
            let sigmas = [statistics.sigma_md, statistics.sigma_cd];
            let correlations = [&*statistics.correlation_md, &*statistics.correlation_cd];
            let found = identify(sigmas, statistics.lag_step, correlations);
            let noise = found.map_or(f64::NAN, |found| found.surrogate.noise);
            (statistics, [sigmas[0], sigmas[1], noise])
        });
        let numbers = [0, 1, 2].map(|number| {
            let of_each = traced.iter().map(|(_, numbers)| numbers[number]);
            Estimate::new(of_each.filter(|value| value.is_finite()).collect())
        });
        let after_start = |points: Vec<LaidPoint>| {
            points.iter().skip(skip as usize).map(|point| [point.md, point.cd]).collect()
        };
        let places = laid.into_iter().map(after_start).collect();
        let curves = Curves::new(spacing, belt_ratio, places, self.one_air(filaments, hanging))?;
        let found = FlownFibres { curves, numbers, residual: None, way: simulated.way };
        let correlations: Vec<[&[f64]; 2]> =
            traced.iter().map(|(of, _)| [&*of.correlation_md, &*of.correlation_cd]).collect();
        let step = traced.first().map_or(f64::NAN, |(statistics, _)| statistics.lag_step);
        let residual = found.surrogate().and_then(|surrogate| surrogate.residual(step, &correlations));
        Ok(FlownFibres { residual, ..found })
    }

    /// Draws all filaments of which these are a few: those between the simulated ones on the sheet that these have
    /// laid, and pieces of it on any other sheet. Returns their parts in the window.
    ///
    /// * `back` – where the sheet that was simulated begins on the belt [m]
    /// * `few` – what these say, which takes the part of the variance that is not known from them, and on a sheet of
    ///   pieces what places and defects of its filaments do to its CV
    pub(super) fn fill_in(
        &self,
        layer: &FilledLayer<'_>,
        curves: &FlownCurves,
        back: f64,
        few: &mut SubsampleEstimate,
        brush: &Depositor<'_>,
        workers: Workers<'_>,
    ) -> Result<Vec<WindowCurve>, Error> {
        let FilledLayer { spec, number, .. } = *layer;
        let (sheet, window, simulated) = (&spec.sheet, spec.window(), &self.sheet);
        let places = inlets(sheet, spec.seed, number, &spec.layers[number].filaments);
        if [sheet.width, sheet.length] == [simulated.width, simulated.length] {
            let all = curves.fill(places, workers.threads);
            few.missing = all.missing();
            return draw(&all, Belt { sheet, window, back }, brush, workers);
        }
        let library = Library::new(curves, workers.threads)?;
        let around = match sheet.edges {
            // A web that is narrower than the simulated sheet is a strip of it.
            Edges::Periodic => sheet.width.max(simulated.width),
            // Filaments at the two edges know nothing of each other.
            Edges::Cut => sheet.width + simulated.width,
        };
        few.missing = library.missing();
        let tiles = library.tiles(places, around, sheet.length, [spec.seed, number as u64])?;
        let kept = draw(&tiles, Belt::within(&tiles, sheet, window)?, brush, workers)?;
        let LayerSpec { filaments, defects, .. } = &spec.layers[number];
        if filaments.are_at_random() || !defects.is_empty() {
            few.by_places =
                self.changes_by_places(layer, &Pieces { simulated: &library, around }, few, workers)?;
        }
        Ok(kept)
    }

    /// Computes what the places of the filaments and their defects add to CV² of a sheet of pieces, over the patches of
    /// each size: that of the same pieces with an even row, or without defects, is known too.
    fn changes_by_places(
        &self,
        layer: &FilledLayer<'_>,
        pieces: &Pieces<'_>,
        few: &SubsampleEstimate,
        workers: Workers<'_>,
    ) -> Result<Vec<f64>, Error> {
        let FilledLayer { spec, number, .. } = *layer;
        let LayerSpec { filaments, defects, .. } = &spec.layers[number];
        let mut sheet = spec.sheet.clone();
        if defects.iter().all(|defect| defect.after <= 0.0) {
            let cells = (OF_PLACES / sheet.width / sheet.cell).ceil();
            sheet.length = sheet.length.min(cells * sheet.cell);
        }
        let window = Window { corner: [0.0; 2], sides: [0.0; 2] };
        let squares = |places: Vec<Inlet>, titres: Titres| {
            let tiles =
                pieces.simulated.tiles(places, pieces.around, sheet.length, [spec.seed, number as u64])?;
            let belt = Belt::within(&tiles, &sheet, window)?;
            let (laid, _) = lay_with(&tiles, belt, self.beam().element_mass(), titres, workers)?;
            let map = laid.map.between(layer.inner.clone());
            let square = |few: &SubsampleCv| {
                patch_cv(&map, (few.patch / sheet.cell).round() as usize).map(|found| found.cv * found.cv)
            };
            Ok::<Vec<Option<f64>>, Error>(few.cvs.iter().map(square).collect())
        };
        let places = inlets(&spec.sheet, spec.seed, number, filaments);
        let pitch = sheet.width / places.len() as f64;
        let even = (0..places.len()).map(|i| Inlet { z: (i as f64 + 0.5) * pitch, ..places[i] });
        let without: Vec<Inlet> = if filaments.are_at_random() { even.collect() } else { places.clone() };
        let without = squares(without, Titres::default())?;
        let with = squares(places, spec.titres(number))?;
        // What places do on average gives way to what these do.
        let expected = |cv: &SubsampleCv| if filaments.are_at_random() { cv.own } else { 0.0 };
        let more = |((cv, with), without): ((&SubsampleCv, Option<f64>), Option<f64>)| {
            with.zip(without).map_or(0.0, |(with, without)| with - without - expected(cv))
        };
        Ok(few.cvs.iter().zip(with).zip(without).map(more).collect())
    }

    /// How far some of its filaments hang together.
    ///
    /// * `hanging` – length of the fibre between inlet and belt [m]
    fn one_air(&self, filaments: Vec<usize>, hanging: f64) -> OneAir {
        let (case, sheet) = (&self.case, &self.sheet);
        let groups = (sheet.width / (APART * case.extent_of_air().z)).floor().max(1.0);
        let group =
            |filament: usize| (self.places[filament].z / sheet.width * groups).clamp(0.0, groups - 1.0);
        let groups = filaments.into_iter().map(|filament| group(filament) as usize);
        let feed_speed = case.line.map_or(0.0, |line| line.feed_speed);
        let same_air = case.air.memory() * feed_speed;
        OneAir { groups: groups.collect(), memory: same_air.max(MEMORY * hanging) }
    }
}

impl WebSpec {
    /// Largest lateral wave number of the air that all filaments of a layer share, times its length scale;
    /// None of filaments in independent turbulence.
    pub fn lateral_cutoff(&self, layer: usize) -> Option<f64> {
        let case = self.layers.get(layer)?.source.case()?;
        case.air.lateral.in_one_air().cutoff()
    }

    /// The problem of a web in shared turbulence whose field of eddies does not fit into the memory that it may take.
    pub fn air_beyond_memory(&self) -> Option<Diagnostic> {
        let beams = (0..self.layers.len()).filter_map(|number| beam_on(self, number, None).ok());
        let largest = beams
            .map(|layer| (layer.beam().memory_of_air(&layer.sheet, f64::INFINITY), layer.case.air.lateral))
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
        Some(Diagnostic::from(what).with_key("web.memory_limit", Some(memory(self.memory_limit))))
    }
}

/// The filaments of a layer at their places. Air that a case leaves the same across the flow becomes a field
/// in space. The seed of the web and the number of the layer are in the key of the air, so that layers and
/// webs have independent turbulence.
///
/// * `sheet` – that a few of them lay; None for the one whose clouds give the CV
pub(super) fn beam_on<'a>(
    spec: &'a WebSpec,
    number: usize,
    sheet: Option<&FlownSheet>,
) -> Result<LayerBeam<'a>, Error> {
    let layer = &spec.layers[number];
    let LaydownSource::Case { path, case } = &layer.source else {
        let fault = Fault::new(
            "the filaments of a web in shared turbulence are simulated",
            "name their case (laydown.case)",
        );
        return Err(fault.into());
    };
    let mut case = Case::clone(case);
    case.air.lateral = case.air.lateral.in_one_air();
    case.run.seed = key(case.run.seed, spec.seed, number as u64);
    let depth = layer.filaments.depth();
    let flown_sheet = sheet.cloned().or_else(|| spec.flown_sheet(number, None));
    let few = flown_sheet.and_then(|on| Some((spec.few(number, &on)?, on.sheet)));
    let (places, sheet, few) = match few {
        Some(((places, few), sheet)) => (places, sheet, Some(few)),
        None => (inlets(&spec.sheet, spec.seed, number, &layer.filaments), spec.sheet.clone(), None),
    };
    let charge = spec.beam_charge(number, &places, few.as_ref());
    Ok(LayerBeam { path, case, sheet, few, places, depth, charge })
}

/// A seed from those of the case and of the web and the number of a layer, each of which changes about half
/// of its bits.
pub(super) fn key(case: u64, web: u64, layer: u64) -> u64 {
    [case, web, layer]
        .into_iter()
        .fold(0, |sum: u64, part| SplitMix64::seed_from_u64(sum.wrapping_add(part)).next_u64())
}

/// The flight of a layer of a web in shared turbulence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedFlight {
    /// Number of filaments that are simulated.
    pub filaments: u64,
    /// Whether they stand for others that are not simulated.
    pub is_few: bool,
    /// Steps of all of them, about.
    pub steps: u64,
    /// Coarse sheets in other airs until the wanted error is reached, about.
    pub coarse_sheets: u64,
    /// Steps of their flights, about, in steps of the fine elements.
    pub coarse_steps: u64,
    /// Size of the sheet that they lay, across and along [m].
    pub sheet: [f64; 2],
    /// Memory that the field of eddies takes [B].
    pub memory: f64,
}

impl WebSpec {
    /// What a web in shared turbulence will fly, layer by layer; nothing of any other web, and of layers that name no
    /// case.
    pub fn planned_flights(&self) -> Vec<PlannedFlight> {
        let layers =
            (0..self.layers.len()).filter_map(|number| Some((number, beam_on(self, number, None).ok()?)));
        let plan = layers.map(|(number, layer)| PlannedFlight {
            coarse_sheets: if layer.few.is_some() { self.expected_sheets(number) } else { 0 },
            coarse_steps: layer.expected_steps(self, number).unwrap_or(0),
            filaments: layer.places.len() as u64,
            is_few: layer.few.is_some(),
            steps: layer.beam().steps(&layer.sheet),
            sheet: [layer.sheet.width, layer.sheet.length],
            memory: layer.beam().memory_of_air(&layer.sheet, f64::INFINITY),
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
