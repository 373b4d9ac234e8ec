//! Coarse flights in other airs, until the CV of a layer is known to the error that is wanted.
//!
//! ```text
//! fine sheet → the same sheet and air, simulated coarsely → a pair
//!            → coarse sheets in other airs → CV of all and its error → more sheets until it is small enough
//! ```
//!
//! Each sheet depends on its number and not on the wanted error, so that a smaller error goes on from those that are
//! kept.

use super::BeamFindings;
use super::comparison::Laid;
use super::flyer::{Flights, Flyer};
use super::flying::Sink;
use super::layer_beam::{LayerBeam, beam_on, key};
use super::sampled::{FINE, FlownSheet};
use super::shared_air::{LARGER_WAVES, SharedAir};
use crate::layers::{USUAL_ERROR, kept_under};
use crate::{WantedError, WebSpec};
use spunlaid_ground::threads::{lock, try_together, unlock};
use spunlaid_ground::{Error, Isa, Log, RunContext, Workers};
use spunlaid_web::map::blocks_on;
use spunlaid_web::map::levels::{Levels, Pair, numbers_of, sheet_of};
use spunlaid_web::{Sheet, SubsampleEstimate, Window};
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::AtomicU64;
use std::time::Instant;

/// Area of a coarse sheet [m²]: long enough that the start of its filaments takes little of the time.
const AREA: f64 = 0.2;
/// Largest area that is simulated for an error [m²].
const MOST_AREA: f64 = 30.0;
/// How much farther the coarse filaments of a pair lay, in ways from inlet to belt, so that the fine sheet lies within.
const FARTHER: f64 = 0.15;
/// Most coarse sheets that fly before their error is looked at.
const MOST_AT_FIRST: u64 = 8;
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

/// The sheets of a layer that are kept, each under the number of its air.
struct KeptSheets<'a> {
    logs: [Option<&'a Log>; 2],
    /// A checksum of all else on which they depend.
    sum: u64,
}

impl KeptSheets<'_> {
    /// Returns the sheets in an air; None if they are not kept.
    fn find<const N: usize>(&self, air: u64) -> Option<[SubsampleEstimate; N]> {
        let of_log = |log: &Log| {
            let numbers = log.pieces([self.sum, air]).last()?.ok()?;
            let mut rest = &numbers[..];
            let sheets: Option<Vec<SubsampleEstimate>> = (0..N).map(|_| sheet_of(&mut rest)).collect();
            sheets?.try_into().ok()
        };
        self.logs.iter().copied().flatten().find_map(of_log)
    }

    /// Keeps sheets in the first log that takes them.
    fn keep(&self, air: u64, sheets: &[&SubsampleEstimate]) {
        let numbers: Vec<f64> = sheets.iter().flat_map(|sheet| numbers_of(sheet)).collect();
        let takes = |log: &&Log| log.append([self.sum, air], numbers.iter().copied()).is_ok();
        let _ = self.logs.iter().copied().flatten().find(takes);
    }

    /// Simulates a fine sheet coarsely too, and keeps both, unless the coarse filaments have not laid all of it.
    fn keep_pair(
        &self,
        air: u64,
        fine: &FineSheet<'_>,
        again: &LayerBeam<'_>,
        by: RunContext<'_>,
    ) -> Result<(), Error> {
        let FineSheet { layer, simulated, few, .. } = fine;
        let laid = coarsely(again, by)?;
        let beam = again.beam();
        let belt_speed = beam.case.line.map_or(f64::NAN, |line| line.belt_speed);
        let [from, to] =
            [simulated.back + layer.sheet.length, simulated.back].map(|place| -place / belt_speed);
        let within = Laid::new([&beam, &beam], &laid)?.during;
        if from < within.start || to > within.end {
            return Ok(());
        }
        let laid = BeamFindings { back: simulated.back, ..laid };
        let coarse = look_at(again, &with_larger_cells(&layer.sheet), &laid, by.workers())?;
        coarse.iter().for_each(|coarse| self.keep(air, &[few, coarse]));
        Ok(())
    }
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

/// The sheets of a layer whose CV is to be known to an error.
pub(super) struct LayerSheets<'a> {
    flyer: &'a Flyer<'a>,
    spec: &'a WebSpec,
    number: usize,
    /// The numbers of sheets that no file keeps.
    memory: Log,
}

/// A pair that is simulated at the same time as coarse sheets.
#[derive(Clone, Copy)]
struct NextPair<'p> {
    on: &'p FlownSheet,
    /// Number of its air.
    air: u64,
    /// The fine sheet, if that has been simulated.
    fine: Option<&'p FineSheet<'p>>,
}

/// What is simulated at the same time as coarse sheets.
struct Meanwhile<'m> {
    beams: &'m [&'m LayerBeam<'m>],
    work: &'m (dyn Fn(RunContext<'_>) -> Result<(), Error> + Sync),
}

impl<'a> LayerSheets<'a> {
    /// * `number` – of the layer
    pub(super) fn new(flyer: &'a Flyer<'a>, spec: &'a WebSpec, number: usize) -> Self {
        Self { flyer, spec, number, memory: Log::in_memory() }
    }

    /// How many coarse sheets are simulated before their error is looked at: some fewer than are expected, because some
    /// webs need fewer; and one where the time is short.
    fn at_first(&self) -> u64 {
        match self.spec.time {
            Some(_) => 1,
            None => (2 * self.spec.expected_sheets(self.number) / 3).clamp(1, MOST_AT_FIRST),
        }
    }

    /// Simulates the fine sheet. Where one sheet has too few filaments for all threads, the coarse sheets that are
    /// needed in any case are simulated at the same time.
    pub(super) fn fine(&self, layer: &LayerBeam<'_>, on: &FlownSheet) -> Result<BeamFindings, Error> {
        let (spec, simulated) = (self.spec, Mutex::new(None));
        let has_coarse = self.flyer.threads > 1 && spec.time.is_none() && layer.few.is_some();
        let has_coarse = has_coarse && spec.wanted_error(self.number).is_some();
        let work = |by: RunContext<'_>| {
            *lock(&simulated) = Some(layer.beam().fly(&layer.sheet, spec.window(), None, by)?);
            Ok(())
        };
        let airs = 1..if has_coarse { 1 + self.at_first() } else { 1 };
        self.coarse_meanwhile(on, airs, &Meanwhile { beams: &[layer], work: &work })?;
        unlock(simulated).ok_or_else(Error::no_fibre)
    }

    /// Simulates coarse sheets until the CV of the layer is known to the wanted error.
    ///
    /// * `first` – the fine sheet, in the air of the web
    pub(super) fn until_sure(&self, first: FineSheet<'_>) -> Result<SubsampleEstimate, Error> {
        let (begun, spec) = (Instant::now(), self.spec);
        let Some(wanted) = spec.wanted_error(self.number) else { return Ok(first.few) };
        let on = first.on;
        let of_pairs = on.with_area(first.few.fine_area.max(FINE));
        // If nothing can be combined, the fine sheet stands alone, and its error may be larger than the wanted one.
        let alone = SubsampleEstimate { wanted: Some(wanted), ..first.few.clone() };
        let mut levels = Levels::default();
        // Numbers of the airs of coarse sheets and of pairs.
        let mut airs = 1;
        let mut pairs = 1;
        let mut simulated = 0;
        let mut more = self.at_first();
        let mut pair = Some(NextPair { on, air: 0, fine: Some(&first) });
        loop {
            simulated += self.simulate(on, airs..airs + more, pair)?;
            levels.pairs.extend(pair.and_then(|pair| self.kept_pair(pair)));
            levels.coarse.extend((airs..airs + more).filter_map(|air| self.kept_coarse(on, air)));
            airs += more;
            let Some(variances) = levels.variances() else { return Ok(alone) };
            if !variances.whole().is_finite() {
                return Ok(alone);
            }
            let is_late = spec.time.is_some_and(|time| begun.elapsed().as_secs_f64() > time);
            let may_go_on = !is_late && AREA * (airs as f64) < MOST_AREA;
            let Some(next) = variances.next_sheets(wanted, airs, pairs).filter(|_| may_go_on) else {
                let combined = levels.combine().unwrap_or(alone);
                return Ok(SubsampleEstimate { wanted: Some(wanted), ..combined });
            };
            more = next.coarse;
            pair = next.has_pair.then_some(NextPair { on: &of_pairs, air: PAIRS | pairs, fine: None });
            pairs += u64::from(next.has_pair);
            if let Some(time) = spec.time {
                // Nothing is known of the time where all sheets were kept.
                let so_far = begun.elapsed().as_secs_f64();
                let of_each = if simulated > 0 { so_far / simulated as f64 } else { f64::INFINITY };
                more = more.min(((time - so_far) / of_each) as u64).max(1);
            }
        }
    }

    /// Simulates the coarse sheets of some airs and a pair at the same time, unless they are kept. Returns how many
    /// that were.
    fn simulate(
        &self,
        on: &FlownSheet,
        airs: Range<u64>,
        pair: Option<NextPair<'_>>,
    ) -> Result<usize, Error> {
        let Some(pair) = pair.filter(|pair| self.kept_pair(*pair).is_none()) else {
            return self.coarse_meanwhile(on, airs, &Meanwhile { beams: &[], work: &|_| Ok(()) });
        };
        let other = self.spec.in_air(pair.air);
        let own = match pair.fine {
            None => Some(beam_on(&other, self.number, Some(pair.on))?),
            Some(_) => None,
        };
        let Some(layer) = pair.fine.map(|fine| fine.layer).or(own.as_ref()) else { return Ok(0) };
        let again = beam_on(&other, self.number, Some(&pair.on.coarse()))?.with_coarsest_mesh();
        let Some(again) = lays_around(again, layer) else { return self.simulate(on, airs, None) };
        let (kept, NextPair { on: of_pair, air, fine }) = (self.kept(pair.on), pair);
        let work = |by: RunContext<'_>| {
            if let Some(fine) = fine {
                return kept.keep_pair(air, fine, &again, by);
            }
            let simulated = layer.beam().fly(&layer.sheet, other.window(), None, by)?;
            let few = look_at(layer, &layer.sheet, &simulated, by.workers())?;
            few.map_or(Ok(()), |few| {
                let fine = FineSheet { on: of_pair, layer, simulated: &simulated, few };
                kept.keep_pair(air, &fine, &again, by)
            })
        };
        let beams: Vec<&LayerBeam<'_>> = own.iter().chain([&again]).collect();
        Ok(1 + self.coarse_meanwhile(on, airs, &Meanwhile { beams: &beams, work: &work })?)
    }

    /// Simulates the coarse sheets of some airs that are not kept, each in another air, and keeps them. Returns their
    /// number.
    ///
    /// * `meanwhile` – what is simulated at the same time
    fn coarse_meanwhile(
        &self,
        on: &FlownSheet,
        airs: Range<u64>,
        meanwhile: &Meanwhile<'_>,
    ) -> Result<usize, Error> {
        let Flyer { threads, stop, .. } = *self.flyer;
        let airs: Vec<u64> = airs.filter(|air| self.kept_coarse(on, *air).is_none()).collect();
        let on = on.coarse().with_area(AREA);
        let kept = self.kept(&on);
        let specs: Vec<WebSpec> = airs.iter().map(|air| self.spec.in_air(*air)).collect();
        let beams = specs.iter().map(|spec| Ok(beam_on(spec, self.number, Some(&on))?.with_coarsest_mesh()));
        let beams: Vec<LayerBeam<'_>> = beams.collect::<Result<_, Error>>()?;
        let memory =
            |of_beam: &LayerBeam<'_>, highest: f64| of_beam.beam().memory_of_air(&of_beam.sheet, highest);
        let by_others =
            meanwhile.beams.iter().map(|of_beam| memory(of_beam, f64::INFINITY)).fold(0.0, f64::max);
        let of_each = beams.first().map_or(f64::INFINITY, |first| memory(first, LARGER_WAVES).max(1.0));
        let fits = 1 + ((self.spec.memory_limit - by_others) / of_each) as usize;
        let all: Vec<&LayerBeam<'_>> = meanwhile.beams.iter().copied().chain(&beams).collect();
        let work = |i: usize, by: RunContext<'_>| {
            // The longest work begins first.
            let Some(number) = i.checked_sub(1) else { return (meanwhile.work)(by) };
            let laid = coarsely(&beams[number], by)?;
            let beam = beams[number].beam();
            let of_sheet = Laid::new([&beam, &beam], &laid)?;
            let (sheet, laid) = of_sheet.sheet(&beams[number].sheet, &of_sheet.during)?;
            let few = look_at(
                &beams[number],
                &with_larger_cells(&sheet),
                &laid,
                Workers { threads: by.threads, stop },
            )?;
            few.iter().for_each(|few| kept.keep(airs[number], &[few]));
            Ok(())
        };
        self.flyer.watched(&all, |done| {
            let by = RunContext { threads, isa: Isa::detect(), stop, done };
            try_together(threads, fits, 1 + beams.len(), |i| work(i, by)).map(drop)
        })?;
        Ok(beams.len())
    }

    fn kept(&self, on: &FlownSheet) -> KeptSheets<'_> {
        let sum = kept_under([self.spec], &on.deciding(self.number));
        KeptSheets { logs: [self.flyer.kept, Some(&self.memory)], sum }
    }

    fn kept_coarse(&self, on: &FlownSheet, air: u64) -> Option<SubsampleEstimate> {
        let [sheet] = self.kept(&on.coarse().with_area(AREA)).find(air)?;
        Some(sheet)
    }

    fn kept_pair(&self, pair: NextPair<'_>) -> Option<Pair> {
        let [fine, coarse] = self.kept(pair.on).find(pair.air)?;
        // What is kept of a sheet is less than the first one has to say.
        Some(Pair { fine: pair.fine.map_or(fine, |first| first.few.clone()), coarse })
    }
}

/// Makes a coarse layer lay the sheet of a fine one and what lies around it; None of filaments that are not fed.
fn lays_around<'a>(coarse: LayerBeam<'a>, fine: &LayerBeam<'_>) -> Option<LayerBeam<'a>> {
    let line = fine.beam().case.line?;
    // It begins to lay earlier, because its start is shorter.
    let earlier = fine.beam().case.run.spin_up() - coarse.beam().case.run.spin_up();
    let longer = (earlier * line.belt_speed + FARTHER * line.distance).max(0.0);
    Some(coarse.longer_by(longer))
}

impl Flyer<'_> {
    /// Shows the progress of flights while it does the work that it is given; nothing if there are none.
    pub(super) fn watched(
        &self,
        beams: &[&LayerBeam<'_>],
        work: impl Fn(&AtomicU64) -> Result<(), Error> + Sync,
    ) -> Result<(), Error> {
        let (Some(first), done) = (beams.first(), AtomicU64::new(0)) else { return Ok(()) };
        let steps = |of_beam: &&LayerBeam<'_>| of_beam.beam().steps(&of_beam.sheet);
        let time = |of_beam: &&LayerBeam<'_>| steps(of_beam) as f64 * of_beam.beam().case.run.time_step;
        let all = beams.iter().map(steps).sum::<u64>();
        let flights = Flights {
            path: first.path,
            fibres: beams.iter().map(|of_beam| of_beam.places.len() as u64).sum(),
            done: &done,
            steps: all,
            time_step: beams.iter().map(time).sum::<f64>() / all.max(1) as f64,
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
    workers: Workers<'_>,
) -> Result<Option<SubsampleEstimate>, Error> {
    let Some(few) = &of_beam.few else { return Ok(None) };
    let beam = of_beam.beam();
    let curves = few.curves(sheet, &beam, laid)?;
    few.estimate(sheet, blocks_on(sheet), &beam, laid, Some(&curves), workers).map(Some)
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
