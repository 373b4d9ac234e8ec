//! Webs in the same air, of which a few filaments are simulated side by side, to be compared.
//!
//! ```text
//! webs → the filaments of a layer of each, on sheets of one width, at the same places
//!      → flights; one for all webs that differ in the speed of a slow belt only
//!      → what all have laid while the same part of the pattern of the air passed → few filaments of each web
//! ```

use super::flyer::Flyer;
use super::layer_beam::{LayerBeam, beam_on};
use super::sampled::Compared;
use super::shared_air::{fly_concurrent, memory_concurrent};
use super::{Beam, BeamFindings};
use crate::WebSpec;
use spunlaid_fibre::{Contact, LaidPoint, Line};
use spunlaid_ground::threads::par_map;
use spunlaid_ground::{Dimension, Error, Fault, Isa, RunContext, Workers};
use spunlaid_web::map::blocks_on;
use spunlaid_web::{Arrangement, Sheet, SubsampleEstimate};
use std::ops::Range;
use std::sync::atomic::AtomicU64;

/// Shortest sheet that is compared, in parts of the one that was to be laid: eddies of half the length pass
/// twice as fast, so half of it reports as much.
const LEAST: f64 = 0.25;
/// Fastest belt, over the speed of the feed, that does not pull at the filament in the air.
const SLOW: f64 = 0.1;

/// What a few filaments say about the layers of a web, or why they cannot be simulated.
pub type FewOfWeb = Result<Vec<SubsampleEstimate>, Error>;

impl Flyer<'_> {
    /// What a few filaments say about webs in the same air, without laying them; None if some of the first
    /// one are not simulated as a few for all.
    ///
    /// * `specs` – the web as it is, and changed ones
    /// * `steps` – grows by the steps of all filaments
    ///
    /// # Errors
    /// For each web as of [`Flyer::web`]; and if it is stopped.
    pub fn few_in_same_air(
        &self,
        specs: &[&WebSpec],
        of_each: Compared,
        steps: &AtomicU64,
    ) -> Result<Option<Vec<FewOfWeb>>, Error> {
        let Some(layers) = comparisons(specs, of_each) else { return Ok(None) };
        let mut estimates: Vec<FewOfWeb> = specs.iter().map(|_| Ok(Vec::new())).collect();
        for layer in &layers {
            for (estimates, of_layer) in estimates.iter_mut().zip(self.compare(layer, steps)?) {
                match (&mut *estimates, of_layer) {
                    (Ok(estimates), Ok(few)) => estimates.push(few),
                    (Ok(_), Err(error)) => *estimates = Err(error),
                    (Err(_), _) => {}
                }
            }
        }
        Ok(Some(estimates))
    }

    /// Flies a layer of all webs and says what the filaments of each give.
    fn compare(
        &self,
        layer: &Comparison<'_>,
        steps: &AtomicU64,
    ) -> Result<Vec<Result<SubsampleEstimate, Error>>, Error> {
        let by = RunContext { threads: self.threads, isa: Isa::detect(), stop: self.stop, done: steps };
        layer.check_memory()?;
        let simulated = fly_concurrent(&layer.flown_beams(), &layer.sheet, layer.memory_limit, by)?;
        let simulated: Vec<(usize, _)> = layer.flights().map(|(web, _)| web).zip(simulated).collect();
        let of_web = |web: usize| {
            let of_beam = layer.beams[web].as_ref().map_err(again)?;
            let flight = simulated.iter().find(|(flight, _)| Some(*flight) == layer.flight_of[web]);
            let (flight, simulated) = flight.ok_or_else(Error::no_fibre)?;
            let above = layer.beams[*flight].as_ref().map_err(again)?;
            Laid::new([&above.beam(), &of_beam.beam()], simulated.as_ref().map_err(again)?)
        };
        let laid: Vec<Result<Laid<'_>, Error>> = (0..layer.beams.len()).map(of_web).collect();
        let during = laid.iter().flatten().fold(f64::NEG_INFINITY..f64::INFINITY, |all, laid| {
            all.start.max(laid.during.start)..all.end.min(laid.during.end)
        });
        let threads = self.threads.div_ceil(laid.len());
        Ok(par_map(self.threads, laid.len(), |web| {
            let laid = laid[web].as_ref().map_err(again)?;
            let of_beam = layer.beams[web].as_ref().map_err(again)?;
            let few = of_beam.few.as_ref().ok_or_else(Error::no_fibre)?;
            let (sheet, simulated) = laid.sheet(&layer.sheet, &during)?;
            let beam = of_beam.beam();
            let curves = match few.arrangement {
                Arrangement::Rows => Some(few.curves(&sheet, &beam, &simulated)?),
                // Alone it is reported as the web as it is has been.
                Arrangement::Slot | Arrangement::AtRandom if layer.beams.len() == 1 => {
                    Some(few.curves(&sheet, &beam, &simulated)?)
                }
                Arrangement::Slot | Arrangement::AtRandom => None,
            };
            let workers = Workers { threads, stop: self.stop };
            few.estimate(&sheet, layer.blocks, &beam, &simulated, curves.as_ref(), workers)
        }))
    }
}

/// The same error once more, that several webs report.
fn again(error: &Error) -> Error {
    Error::Flight(Fault::plain(error.to_string()))
}

/// About how many steps all filaments take for webs in the same air; where all filaments are simulated, those of
/// all webs but the first.
pub fn steps_in_same_air(specs: &[&WebSpec], of_each: Compared) -> u64 {
    let Some(layers) = comparisons(specs, of_each) else {
        let layers = |spec: &&'_ WebSpec| -> u64 {
            let beams = (0..spec.layers.len()).filter_map(|number| beam_on(spec, number, None).ok());
            beams.map(|of_beam| of_beam.beam().steps(&of_beam.sheet)).sum()
        };
        return specs.iter().skip(1).map(layers).sum();
    };
    let of_layer = |layer: &Comparison<'_>| -> u64 {
        layer.flights().map(|(_, of_beam)| of_beam.beam().steps(&layer.sheet)).sum()
    };
    layers.iter().map(of_layer).sum()
}

/// Whether the air in which webs fly beside each other takes no more memory than the first of them may take.
pub fn fits_memory(specs: &[&WebSpec], of_each: Compared) -> bool {
    let layers = comparisons(specs, of_each).unwrap_or_default();
    layers.iter().all(|layer| layer.check_memory().is_ok())
}

/// A layer of webs that are compared.
struct Comparison<'a> {
    /// The sheet of the web as it is.
    sheet: Sheet,
    /// Number of blocks of the sheet, across and along.
    blocks: [usize; 2],
    /// The filaments of each web.
    beams: Vec<Result<LayerBeam<'a>, Error>>,
    /// Most memory that their air may take [B].
    memory_limit: f64,
    /// Of each web, the one whose flight says what its filaments do.
    flight_of: Vec<Option<usize>>,
}

/// The layers of webs that are compared; None if some of the first one are not simulated as a few for all.
fn comparisons<'a>(specs: &[&'a WebSpec], of_each: Compared) -> Option<Vec<Comparison<'a>>> {
    (0..specs.first()?.layers.len()).map(|number| Comparison::new(specs, number, of_each)).collect()
}

impl<'a> Comparison<'a> {
    fn new(specs: &[&'a WebSpec], number: usize, of_each: Compared) -> Option<Self> {
        let first = specs.first()?;
        let on = first.flown_sheet(number, Some(of_each))?;
        first.few(number, &on)?;
        let is_few = |of_beam: LayerBeam<'a>| match of_beam.few {
            Some(_) => Ok(of_beam.with_coarser_mesh()),
            None => Err(Fault::plain("it has so few filaments that all of them are simulated").into()),
        };
        let beams: Vec<Result<LayerBeam<'_>, Error>> =
            specs.iter().map(|spec| beam_on(spec, number, Some(&on)).and_then(is_few)).collect();
        let flight_of = (0..beams.len()).map(|web| {
            let of_beam = beams[web].as_ref().ok()?;
            let is_same = |other: &usize| beams[*other].as_ref().is_ok_and(|other| flies_as(of_beam, other));
            Some((0..web).find(is_same).unwrap_or(web))
        });
        let (flight_of, memory_limit) = (flight_of.collect(), first.memory_limit);
        Some(Self { blocks: blocks_on(&on.sheet), sheet: on.sheet, memory_limit, flight_of, beams })
    }

    /// Refuses webs whose common air does not fit into the memory that it may take.
    fn check_memory(&self) -> Result<(), Fault> {
        let needed = memory_concurrent(&self.flown_beams(), &self.sheet);
        if needed <= self.memory_limit {
            return Ok(());
        }
        let memory = |size: f64| Dimension::Memory.pretty_to(size, 3);
        let message = format!(
            "the field of eddies in which the changed webs are simulated together takes {}, more than \
            web.memory_limit = {}",
            memory(needed),
            memory(self.memory_limit)
        );
        let remedy = format!("write {} or more there if the machine has it", memory(1.05 * needed));
        Err(Fault::new(message, remedy))
    }

    fn flown_beams(&self) -> Vec<Beam<'_>> {
        self.flights().map(|(_, of_beam)| of_beam.beam()).collect()
    }

    /// The filaments that are simulated, with the number of their web.
    fn flights(&self) -> impl Iterator<Item = (usize, &LayerBeam<'a>)> {
        let all = self.beams.iter().enumerate();
        all.filter_map(|(web, of_beam)| Some((web, of_beam.as_ref().ok()?)))
            .filter(|(web, _)| self.flight_of[*web] == Some(*web))
    }
}

/// Whether filaments fly as others do: they differ in nothing but the speed of a belt that is too slow to
/// pull at them.                                                                               theory.md (75)
pub(super) fn flies_as(of_beam: &LayerBeam<'_>, other: &LayerBeam<'_>) -> bool {
    let [own, other] = [of_beam, other].map(|of_beam| of_beam.beam());
    let is_slow = |line: Line| line.belt_ratio() <= SLOW && line.contact == Contact::Stick;
    let (Some(line), Some(of_other)) = (own.case.line, other.case.line) else { return false };
    let mut case = own.case.clone();
    case.line = Some(Line { belt_speed: of_other.belt_speed, ..line });
    let is_same = case == *other.case
        && own.places == other.places
        && own.depth == other.depth
        && own.charge == other.charge;
    is_same && (line.belt_speed == of_other.belt_speed || (is_slow(line) && is_slow(of_other)))
}

/// What the filaments of a web have laid.
pub(super) struct Laid<'a> {
    flight: &'a BeamFindings,
    /// How much faster the belt is above which they have simulated than that of the web [m/s].
    faster: f64,
    /// The times at which the belt has passed on which all filaments lie as after their start, counted in
    /// what passes of the pattern of the air [s].
    pub(super) during: Range<f64>,
    /// How far the belt moves in such a time [m/s].
    belt_speed: f64,
}

impl<'a> Laid<'a> {
    /// * `beams` – the one that was simulated, and the one of the web, which fly alike: every point comes down at
    ///   the same time and place above both belts
    pub(super) fn new(beams: [&Beam<'_>; 2], flight: &'a BeamFindings) -> Result<Self, Error> {
        let [above, line] = beams.map(|beam| beam.case.line);
        let (above, line) = above.zip(line).ok_or_else(Error::no_fibre)?;
        let start = line.feed_speed * beams[1].case.run.spin_up();
        let faster = above.belt_speed - line.belt_speed;
        let mut front = f64::INFINITY;
        let mut ahead = f64::NEG_INFINITY;
        let mut fed = f64::INFINITY;
        for (filament, points) in &flight.kept {
            let y = beams[1].places[*filament].y;
            for point in points {
                let md = y + on_slower_belt(point, faster);
                ahead = ahead.max(md + line.belt_ratio() * point.fed);
                if point.fed < start {
                    front = front.min(md);
                }
            }
            fed = fed.min(points.last().map_or(0.0, |point| point.fed));
        }
        let belt_speed = line.belt_speed / flight.pace;
        let [from, to] = [front, ahead - line.belt_ratio() * fed].map(|place| -place / belt_speed);
        Ok(Self { flight, faster, during: from..to, belt_speed })
    }

    /// The stretch of belt that passes during some time, and what comes down on it; the filaments lie on it
    /// from then on.
    ///
    /// # Errors
    /// If hardly anything was laid during it.
    pub(super) fn sheet(&self, like: &Sheet, during: &Range<f64>) -> Result<(Sheet, BeamFindings), Error> {
        let [front, behind] = [during.start, during.end].map(|time| -time * self.belt_speed);
        let length = ((front - behind) / like.cell).floor() * like.cell;
        if length < LEAST * like.length {
            return Err(
                Fault::plain("the length laid in the same turbulence is too short to be compared").into()
            );
        }
        let mut kept = self.flight.kept.clone();
        let points = kept.iter_mut().flat_map(|(_, points)| points);
        points.for_each(|point| point.md = on_slower_belt(point, self.faster));
        let simulated = BeamFindings { kept, back: front - length, ..BeamFindings::default() };
        Ok((Sheet { length, ..like.clone() }, simulated))
    }
}

/// Where a point lies on a belt that is slower than the one above which it has simulated [m].
fn on_slower_belt(point: &LaidPoint, faster: f64) -> f64 {
    point.md + faster * point.time
}
