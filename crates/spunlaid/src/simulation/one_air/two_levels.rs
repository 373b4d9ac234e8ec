//! Coarse flights in other airs, until the CV of a layer is known to the error that is wanted.
//!
//! ```text
//! fine sheet → the same sheet and air, simulated coarsely → a pair
//!            → coarse sheets in other airs → CV of all and its error → more sheets until it is small enough
//! ```

use super::BeamFindings;
use super::comparison::Laid;
use super::flyer::{Flights, Flyer};
use super::flying::Sink;
use super::layer_beam::{LayerBeam, beam_on, key};
use super::sampled::{FINE, FlownSheet};
use super::shared_air::{LARGER_WAVES, SharedAir};
use crate::ground::threads::try_par_map;
use crate::ground::{Error, Isa, RunContext};
use crate::simulation::layers::USUAL_ERROR;
use crate::simulation::{WantedError, WebSpec};
use crate::web::map::blocks_on;
use crate::web::map::levels::{Levels, Pair};
use crate::web::{Sheet, SubsampleEstimate, Window};
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::Instant;

/// Area of a coarse sheet [m²]: long enough that the start of its filaments takes little of the time.
const AREA: f64 = 0.2;
/// Largest area that is simulated for an error [m²].
const MOST_AREA: f64 = 30.0;
/// How much farther the coarse filaments of a pair lay, in ways from inlet to belt, so that the fine sheet lies within.
const FARTHER: f64 = 0.15;
/// Most coarse sheets that fly before their error is looked at.
const MOST_AT_FIRST: u64 = 8;
/// Part of the wanted variance that may come from the pairs before another pair is simulated.
const BY_PAIRS: f64 = 0.5;
/// Marks the seeds of other airs.
const OTHER_AIR: u64 = 0x6c65_7665_6c73;
/// What is expected before anything is simulated: relative variance of a CV that an area of 1 m² leaves open, and the
/// part of it that coarse filaments do not give.
const EXPECTED: f64 = 6e-4;
const NOT_TOLD: f64 = 0.08;

/// A sheet that was simulated finely.
pub(super) struct FineSheet<'a> {
    /// The sheet as it was asked for.
    pub(super) on: &'a FlownSheet,
    pub(super) layer: &'a LayerBeam<'a>,
    pub(super) simulated: &'a BeamFindings,
    pub(super) few: SubsampleEstimate,
}

impl WebSpec {
    /// The standard error that is wanted of a layer's CV, as a part of it; None if one sheet is enough.
    pub(super) fn wanted_error(&self, layer: usize) -> Option<f64> {
        let error = match self.error {
            WantedError::OfOneSheet => return None,
            WantedError::Of(error) => error,
            WantedError::Auto => {
                let FlownSheet { sheet, .. } = self.flown_sheet(layer, None)?;
                let is_whole = sheet.width >= self.sheet.width && sheet.length >= self.sheet.length;
                if is_whole {
                    return None;
                }
                USUAL_ERROR
            }
        };
        // The variances of layers add up, each with the square of its share.
        let shares: Vec<f64> =
            (0..self.layers.len()).map(|layer| self.alone(layer).mass_flow().powi(2)).collect();
        let sum = shares.iter().sum::<f64>();
        let squares = shares.iter().map(|share| share * share).sum::<f64>();
        Some(error * sum / squares.sqrt())
    }

    /// The coarse sheets that a layer is expected to need.
    pub(super) fn expected_sheets(&self, layer: usize) -> u64 {
        let Some((wanted, fine)) = self.wanted_error(layer).zip(self.flown_sheet(layer, None)) else {
            return 0;
        };
        let fine = fine.sheet.width * fine.sheet.length;
        let by_area = wanted * wanted - NOT_TOLD * EXPECTED / fine;
        let area = if by_area > 0.0 { (EXPECTED / by_area).min(MOST_AREA) } else { MOST_AREA };
        ((area - fine) / AREA).ceil().max(1.0) as u64
    }

    /// The same web in another air, with its filaments at other places.
    fn in_air(&self, number: u64) -> Self {
        let seed = if number == 0 { self.seed } else { key(self.seed, OTHER_AIR, number) };
        Self { seed, ..self.clone() }
    }
}

impl LayerBeam<'_> {
    /// Steps of the coarse flights that are expected for the wanted error, in steps of fine elements.
    pub(super) fn expected_steps(&self, spec: &WebSpec, number: usize) -> Result<u64, Error> {
        let sheets = spec.expected_sheets(number);
        let on = spec.flown_sheet(number, None).filter(|_| sheets > 0 && self.few.is_some());
        let Some(on) = on else { return Ok(0) };
        let coarse = beam_on(spec, number, Some(&on.coarse().with_area(AREA)))?.with_coarsest_mesh();
        let share = self.beam().case.fibre.rest_length() / coarse.beam().case.fibre.rest_length();
        Ok((share * (sheets * coarse.beam().steps(&coarse.sheet)) as f64) as u64)
    }
}

impl Flyer<'_> {
    /// Flies coarse sheets of a layer until its CV is known to the wanted error.
    ///
    /// * `first` – the fine sheet, in the air of the web
    pub(super) fn until_sure(
        &self,
        spec: &WebSpec,
        number: usize,
        first: FineSheet<'_>,
    ) -> Result<SubsampleEstimate, Error> {
        let begun = Instant::now();
        let Some(wanted) = spec.wanted_error(number) else { return Ok(first.few) };
        let on = first.on;
        let of_pairs = on.with_area(first.few.fine_area.max(FINE));
        // If nothing can be combined, the fine sheet stands alone, and its error may be larger than the wanted one.
        let alone = SubsampleEstimate { wanted: Some(wanted), ..first.few.clone() };
        let Some(pair) = self.pair(spec, number, first)? else { return Ok(alone) };
        let mut levels = Levels { pairs: vec![pair], coarse: Vec::new() };
        // Numbers of the airs in which coarse sheets and pairs fly.
        let (mut airs, mut pairs) = (1, 1);
        // Some fewer than are expected, because some webs need fewer; and one where the time is short.
        let expected = (2 * spec.expected_sheets(number) / 3).clamp(1, MOST_AT_FIRST);
        let mut more = if spec.time.is_some() { 1 } else { expected };
        loop {
            let coarse = self.coarse_sheets(spec, number, on, airs..airs + more)?;
            levels.coarse.extend(coarse);
            airs += more;
            let Some(variances) = levels.variances() else { return Ok(alone) };
            let (limit, area) = (wanted * wanted, AREA * airs as f64);
            let is_late = spec.time.is_some_and(|time| begun.elapsed().as_secs_f64() > time);
            if variances.whole() <= limit || area >= MOST_AREA || is_late {
                let combined = levels.combine().unwrap_or(alone);
                return Ok(SubsampleEstimate { wanted: Some(wanted), ..combined });
            }
            let mut by_pairs = variances.by_pairs;
            if by_pairs > BY_PAIRS * limit {
                let other = spec.in_air(PAIRS | pairs);
                pairs += 1;
                let pair = self.fine_sheet(&other, number, &of_pairs)?;
                levels.pairs.extend(pair);
                // The sheets that it spares are not simulated.
                by_pairs *= (pairs - 1) as f64 / pairs as f64;
            }
            let left = (limit - by_pairs).max(0.5 * BY_PAIRS * limit);
            // No more than as many again, because the variance is not known well yet.
            let needed = airs as f64 * ((variances.by_area + variances.by_pitch) / left - 1.0);
            more = (needed.ceil() as u64).clamp(1, airs);
            if let Some(time) = spec.time {
                let of_each = begun.elapsed().as_secs_f64() / airs as f64;
                more = more.min(((time / of_each) as u64).saturating_sub(airs)).max(1);
            }
        }
    }

    /// Flies another sheet both ways.
    fn fine_sheet(&self, spec: &WebSpec, number: usize, on: &FlownSheet) -> Result<Option<Pair>, Error> {
        let layer = beam_on(spec, number, Some(on))?;
        let simulated = self.fly_layer(&layer, spec, None)?;
        let Some(few) = look_at(&layer, &layer.sheet, &simulated, (self.threads, self.stop))? else {
            return Ok(None);
        };
        self.pair(spec, number, FineSheet { on, layer: &layer, simulated: &simulated, few })
    }

    /// Flies a fine sheet coarsely too; None if the coarse filaments have not laid all of it.
    fn pair(&self, spec: &WebSpec, number: usize, first: FineSheet<'_>) -> Result<Option<Pair>, Error> {
        let FineSheet { on, layer, simulated, few } = first;
        let Some(line) = layer.beam().case.line else { return Ok(None) };
        let coarse = beam_on(spec, number, Some(&on.coarse()))?.with_coarsest_mesh();
        // It begins to lay earlier, because its start is shorter.
        let earlier = layer.beam().case.run.spin_up() - coarse.beam().case.run.spin_up();
        let longer = (earlier * line.belt_speed + FARTHER * line.distance).max(0.0);
        let coarse = [coarse.longer_by(longer)];
        let (threads, stop) = (self.threads, self.stop);
        let laid = self.watched(&coarse, |done| {
            coarsely(&coarse[0], RunContext { threads, isa: Isa::detect(), stop, done })
        })?;
        let beam = coarse[0].beam();
        let [from, to] =
            [simulated.back + layer.sheet.length, simulated.back].map(|place| -place / line.belt_speed);
        let within = Laid::new([&beam, &beam], &laid)?.during;
        if from < within.start || to > within.end {
            return Ok(None);
        }
        let laid = BeamFindings { back: simulated.back, ..laid };
        let coarse = look_at(&coarse[0], &with_larger_cells(&layer.sheet), &laid, (threads, stop))?;
        Ok(coarse.map(|coarse| Pair { fine: few, coarse }))
    }

    /// Flies coarse sheets side by side, each in another air.
    fn coarse_sheets(
        &self,
        spec: &WebSpec,
        number: usize,
        on: &FlownSheet,
        airs: std::ops::Range<u64>,
    ) -> Result<Vec<SubsampleEstimate>, Error> {
        let specs: Vec<WebSpec> = airs.map(|air| spec.in_air(air)).collect();
        let on = on.coarse().with_area(AREA);
        let beams = specs.iter().map(|spec| Ok(beam_on(spec, number, Some(&on))?.with_coarsest_mesh()));
        let beams: Vec<LayerBeam<'_>> = beams.collect::<Result<_, Error>>()?;
        let Some(first) = beams.first() else { return Ok(Vec::new()) };
        let fits =
            (spec.memory_limit / first.beam().memory_of_air(&first.sheet, LARGER_WAVES).max(1.0)) as usize;
        let concurrent = beams.len().min(self.threads).min(fits).max(1);
        let (threads, stop) = (self.threads.div_ceil(concurrent), self.stop);
        let found = self.watched(&beams, |done| {
            try_par_map(concurrent, beams.len(), |i| {
                let by = RunContext { threads, isa: Isa::detect(), stop, done };
                let laid = coarsely(&beams[i], by)?;
                let beam = beams[i].beam();
                let of_sheet = Laid::new([&beam, &beam], &laid)?;
                let (sheet, laid) = of_sheet.sheet(&beams[i].sheet, &of_sheet.during)?;
                look_at(&beams[i], &with_larger_cells(&sheet), &laid, (threads, stop))
            })
        })?;
        Ok(found.into_iter().flatten().collect())
    }

    /// Shows the progress of coarse flights while it does the work that it is given.
    fn watched<T: Send>(
        &self,
        beams: &[LayerBeam<'_>],
        work: impl Fn(&AtomicU64) -> Result<T, Error> + Sync,
    ) -> Result<T, Error> {
        let (Some(first), done) = (beams.first(), AtomicU64::new(0)) else { return Err(Error::no_fibre()) };
        let flights = Flights {
            path: first.path,
            fibres: beams.iter().map(|of_beam| of_beam.places.len() as u64).sum(),
            done: &done,
            steps: beams.iter().map(|of_beam| of_beam.beam().steps(&of_beam.sheet)).sum(),
            time_step: first.beam().case.run.time_step,
        };
        let mut found = Err(Error::Interrupted);
        (self.follow)(flights, &mut || found = work(&done));
        found
    }
}

/// Marks the numbers of the airs of further pairs.
const PAIRS: u64 = 1 << 32;

/// Flies filaments in the larger eddies of their air.
fn coarsely(of_beam: &LayerBeam<'_>, by: RunContext<'_>) -> Result<BeamFindings, Error> {
    let window = Window { corner: [0.0; 2], sides: [0.0; 2] };
    let sink = Sink { window, on: None, neighbours: None };
    let beam = of_beam.beam();
    let simulated = SharedAir::of_one(&beam, &of_beam.sheet, LARGER_WAVES).fly(vec![sink], by)?;
    simulated.into_iter().next().ok_or_else(Error::no_fibre)?
}

/// The CV of a sheet from its few filaments; None if all of its filaments are simulated.
fn look_at(
    of_beam: &LayerBeam<'_>,
    sheet: &Sheet,
    laid: &BeamFindings,
    by: (usize, &AtomicBool),
) -> Result<Option<SubsampleEstimate>, Error> {
    let Some(few) = &of_beam.few else { return Ok(None) };
    let beam = of_beam.beam();
    let curves = few.curves(sheet, &beam, laid)?;
    few.estimate((sheet, blocks_on(sheet)), (&beam, laid), Some(&curves), by).map(Some)
}

/// The same sheet in cells twice as large, if its patches are whole numbers of them.
pub(super) fn with_larger_cells(sheet: &Sheet) -> Sheet {
    let cell = 2.0 * sheet.cell;
    let is_whole = |size: &f64| ((size / cell).round() * cell / size - 1.0).abs() < 1e-6;
    let sizes = [sheet.width, sheet.length];
    if sizes.iter().chain(&sheet.patches).all(is_whole) {
        Sheet { cell, ..sheet.clone() }
    } else {
        sheet.clone()
    }
}
