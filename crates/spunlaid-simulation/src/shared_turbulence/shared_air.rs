//! The loop that flies the filaments of beams: of one beam in air of its own, or of several in the same air, which fly
//! side by side as far as they look at one field.
//!
//! ```text
//! beams → airs: beams whose airs have one pattern share a field
//!       → all fly for the same time, counted in what passes of the pattern → what they lay goes to their sinks
//! ```

use super::flying::{Flying, Sink};
use super::lane_group::Reach;
use super::{BLOCK, Beam, BeamFindings};
use spunlaid_air::{Air, EddyField, Extent, Flow, Hint, Room, StreamKey};
use spunlaid_ground::threads::{lock, par_map, try_par_map};
use spunlaid_ground::{Error, RunContext, Vec3};
use spunlaid_web::{Edges, Sheet, TimeSpent, Window};
use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::slice::from_ref;
use std::sync::{Arc, Mutex};
use std::time::Instant;

/// Largest lateral wave number of the air of beams that are compared, times its length scale. Smaller eddies change
/// no CV from patches of 10 mm on, and hardly any change of it, but take as much time again.
const HIGHEST: f64 = 8.0;

/// Largest lateral wave number of the air of coarse flights, times its smallest length scale: fine flights have these
/// waves too.
pub(super) const LARGER_WAVES: f64 = 5.5;

/// Beams that fly on one sheet, with their airs.
pub(super) struct SharedAir<'a> {
    beams: &'a [Beam<'a>],
    sheet: &'a Sheet,
    airs: Vec<BeamAir>,
    /// Most memory that the airs which pass side by side take, unless a single one takes more [B].
    memory: f64,
}

/// The air of a beam.
struct BeamAir {
    /// None if it is the same at every place.
    field: Option<EddyField>,
    /// The beam whose field is made, and how many times as fast the pattern passes as there.
    maker: usize,
    pace: f64,
    /// Most memory that it takes [B].
    memory: f64,
}

impl BeamAir {
    /// Time by which all flights advance before the next block [s].
    fn block(&self) -> f64 {
        self.field.as_ref().map_or(BLOCK, EddyField::block)
    }
}

/// Looks at beams after each block, and says whether they fly on.
pub(super) type Watch<'w> = &'w mut dyn FnMut(&[Result<Flying<'_>, Error>]) -> Result<ControlFlow<()>, Error>;

/// Flies beams on a sheet, or on the belt that passes for them in the same time. All are simulated for as long as
/// the first ones take; a beam may lay a little less than the sheet.
///
/// * `memory` – that the airs which pass side by side take at most, unless a single one takes more [B]
///
/// # Errors
/// For each beam as of [`Beam::fly`]; and if it is stopped.
pub(super) fn fly_concurrent(
    beams: &[Beam<'_>],
    sheet: &Sheet,
    memory: f64,
    by: RunContext<'_>,
) -> Result<Vec<Result<BeamFindings, Error>>, Error> {
    let window = Window { corner: [0.0; 2], sides: [0.0; 2] };
    let sinks = beams.iter().map(|_| Sink { window, on: None, neighbours: None }).collect();
    let room = room_of(beams, sheet);
    SharedAir::new(beams, sheet, &room, HIGHEST, memory).fly(sinks, by)
}

/// Whether a beam goes on.
fn flies(of_beam: &Result<Flying<'_>, Error>) -> bool {
    of_beam.as_ref().is_ok_and(|of_beam| !of_beam.has_lost_too_many())
}

/// Makes the fields of all groups for their next block, side by side.
fn make(groups: &mut [Group], threads: usize) {
    let of_each = threads.div_ceil(groups.len());
    let groups: Vec<_> = groups.iter_mut().map(Mutex::new).collect();
    par_map(threads, groups.len(), |group| {
        let mut group = lock(&groups[group]);
        let from = group.time;
        group.time += group.block;
        // A flight that found its time outside would make a field for itself.
        let times = from - group.margin..group.time + group.margin;
        group.making.iter_mut().for_each(|field| field.make(times.clone(), of_each));
    });
}

/// The room in which the airs of beams have the same pattern as far as they can.
fn room_of(beams: &[Beam<'_>], sheet: &Sheet) -> Room {
    let air = |beam: &'_ Beam<'_>| beam.extent_of_air(sheet);
    let airs = beams.iter().map(|beam| (&beam.case.air, beam.case.way_of_air(), air(beam)));
    Room::of(&airs.collect::<Vec<_>>())
}

/// Most memory that the air of one of some beams takes that fly abreast [B].
pub(super) fn memory_concurrent(beams: &[Beam<'_>], sheet: &Sheet) -> f64 {
    let room = room_of(beams, sheet);
    beams.iter().map(|beam| beam.memory_in(&room, HIGHEST)).fold(0.0, f64::max)
}

impl<'a> SharedAir<'a> {
    /// The air of one beam alone.
    ///
    /// * `highest` – lateral wave number, times the length scale
    pub(super) fn of_one(beam: &'a Beam<'a>, sheet: &'a Sheet, highest: f64) -> Self {
        Self::new(from_ref(beam), sheet, &beam.room(sheet), highest, f64::INFINITY)
    }

    /// The air of one beam in a larger room.
    pub(super) fn of_one_in(room: &Room, beam: &'a Beam<'a>, sheet: &'a Sheet) -> Self {
        Self::new(from_ref(beam), sheet, room, HIGHEST, f64::INFINITY)
    }

    /// Time by which the first beam advances before the next block [s].
    pub(super) fn block(&self) -> f64 {
        self.airs[0].block()
    }

    /// The airs of beams in one room, of which those with one pattern share one.
    ///
    /// * `highest` – lateral wave number, times the length scale
    fn new(beams: &'a [Beam<'a>], sheet: &'a Sheet, room: &Room, highest: f64, memory: f64) -> Self {
        let mut airs: Vec<BeamAir> = Vec::new();
        for (number, beam) in beams.iter().enumerate() {
            let (air, seed) = (&beam.case.air, beam.case.run.seed);
            let mut makers = (0..number).filter(|maker| airs[*maker].maker == *maker);
            let shared = makers.find_map(|maker| {
                let other = beams[maker].case;
                if other.run.seed != seed || other.air.lateral != air.lateral {
                    return None;
                }
                let field = airs[maker].field.as_ref()?;
                let (field, pace) = match other.air == *air {
                    true => (field.clone(), 1.0),
                    false => field.at_pace_of([&other.air, air], room)?,
                };
                Some(BeamAir { field: Some(field), maker, pace, memory: beam.memory_in(room, highest) })
            });
            airs.push(shared.unwrap_or_else(|| {
                let key = StreamKey { seed, replicate: 0 };
                let made = |cutoff: f64| EddyField::in_room(air, room, cutoff.min(highest), key);
                let field = air.lateral.cutoff().map(made);
                BeamAir { field, maker: number, pace: 1.0, memory: beam.memory_in(room, highest) }
            }));
        }
        Self { beams, sheet, airs, memory }
    }

    /// Flies the beams until they have laid the sheet, or the belt that passes in the same time.
    pub(super) fn fly(
        &self,
        sinks: Vec<Sink<'_>>,
        by: RunContext<'_>,
    ) -> Result<Vec<Result<BeamFindings, Error>>, Error> {
        self.fly_watched(sinks, &mut |_| Ok(ControlFlow::Continue(())), by)
    }

    /// The same, but for somebody who looks at the beams after each block, and may end the flight.
    pub(super) fn fly_watched(
        &self,
        sinks: Vec<Sink<'_>>,
        watch: Watch<'_>,
        by: RunContext<'_>,
    ) -> Result<Vec<Result<BeamFindings, Error>>, Error> {
        let (started, mut spent) = (Instant::now(), TimeSpent::default());
        let beside = self.beams.iter().zip(sinks);
        let mut flying: Vec<_> = beside.map(|(beam, sink)| Flying::new(*beam, self.sheet, sink)).collect();
        let makers = (0..self.beams.len()).filter(|beam| self.airs[*beam].maker == *beam);
        let mut waiting: VecDeque<Group> = makers.map(|maker| self.group(maker)).collect();
        let memory = |group: &Group| self.airs[group.members[0]].memory;
        let mut until = None;
        while let Some(first) = waiting.pop_front() {
            let mut needed = memory(&first);
            let mut groups = vec![first];
            while let Some(next) = waiting.front()
                && needed + memory(next) <= self.memory
            {
                needed += memory(next);
                groups.extend(waiting.pop_front());
            }
            let begun = Instant::now();
            loop {
                groups.retain(|group| group.members.iter().any(|beam| flies(&flying[*beam])));
                let has_ended = match (groups.first(), until) {
                    (None, _) => true,
                    (Some(group), Some(until)) => group.time * group.pace >= until,
                    (Some(group), None) => self.is_laid_by(group, &flying),
                };
                if has_ended {
                    break;
                }
                make(&mut groups, by.threads);
                self.advance(&groups, &mut flying, by)?;
                if watch(&flying)?.is_break() {
                    break;
                }
            }
            spent.in_parallel += begun.elapsed();
            // Beams that have lost too many do not say for how long the others fly.
            until = until.or(groups.first().map(|group| group.time * group.pace));
        }
        spent.whole = started.elapsed();
        let paces = self.airs.iter().map(|of_beam| self.pace(of_beam.maker) * of_beam.pace);
        Ok(flying.into_iter().zip(paces).map(|(of_beam, pace)| of_beam?.finish(spent, pace)).collect())
    }
}

/// Beams that look at one field.
struct Group {
    /// The field, as far as it has been made; None if the air is the same at every place.
    making: Option<EddyField>,
    /// How many times as fast its pattern passes as that of the first beam.
    pace: f64,
    /// The beams, of which the first one has made the field, each with the time of the field in its step [s].
    members: Vec<usize>,
    steps: Vec<f64>,
    /// Time by which they advance, until which they have, and for which the field is made besides [s].
    block: f64,
    time: f64,
    margin: f64,
}

impl SharedAir<'_> {
    /// How many times as fast the pattern passes in the field of a beam as in that of the first one.
    fn pace(&self, maker: usize) -> f64 {
        self.airs[0].block() / self.airs[maker].block()
    }

    /// The beams of a field before they fly.
    fn group(&self, maker: usize) -> Group {
        let Self { beams, airs, .. } = self;
        let members: Vec<usize> = (0..beams.len()).filter(|beam| airs[*beam].maker == maker).collect();
        let making = airs[maker].field.clone();
        let of_field = |beam: usize, time: f64| time * airs[beam].pace;
        let steps: Vec<f64> =
            members.iter().map(|beam| of_field(*beam, beams[*beam].case.run.time_step)).collect();
        // The same stretch of the pattern passes for all groups, so that they end together.
        let longest = |beam: usize| of_field(beam, beams[beam].longest_block()) * self.pace(airs[beam].maker);
        let block = (0..beams.len()).map(longest).fold(airs[0].block(), f64::min);
        let pace = self.pace(maker);
        let margin = 2.0 * steps.iter().copied().fold(0.0, f64::max);
        let block =
            if beams.len() == 1 { (block / steps[0]).ceil().max(1.0) * steps[0] } else { block / pace };
        Group { making, pace, members, steps, block, time: 0.0, margin }
    }

    /// Whether all beams of a group have laid the sheet during the same time.
    fn is_laid_by(&self, group: &Group, flying: &[Result<Flying<'_>, Error>]) -> bool {
        let mut all = f64::NEG_INFINITY..f64::INFINITY;
        for beam in group.members.iter().filter(|beam| flies(&flying[**beam])) {
            // While some lay the fibre of their start, nothing is known.
            let Some(laid) = flying[*beam].as_ref().ok().and_then(Flying::laid_during) else { return false };
            let pace = self.airs[*beam].pace;
            all = all.start.max(laid.start * pace)..all.end.min(laid.end * pace);
        }
        let belt = self.beams[group.members[0]].case.line.map_or(f64::NAN, |line| line.belt_speed);
        all.end - all.start >= self.sheet.length / belt
    }

    /// Advances all beams of some groups to the end of the block that has been made. Their packs are shared
    /// among the threads.
    fn advance(
        &self,
        groups: &[Group],
        flying: &mut [Result<Flying<'_>, Error>],
        by: RunContext<'_>,
    ) -> Result<(), Error> {
        let members = groups.iter().flat_map(|group| {
            group.members.iter().zip(&group.steps).map(move |(beam, step)| (group, *beam, *step))
        });
        let mut packs = Vec::new();
        let mut advancing = Vec::new();
        for (group, beam, step) in members {
            let Some(of_beam) = flying[beam].as_ref().ok().filter(|_| flies(&flying[beam])) else { continue };
            let BeamAir { field, pace, .. } = &self.airs[beam];
            // A whole number of steps may be rounded to a little less.
            let steps = ((group.time / step + 1e-6) as u64).saturating_sub(of_beam.done);
            let made = field.as_ref().zip(group.making.as_ref());
            let field = made.map(|(field, making)| Arc::new(field.made_as(making, *pace)));
            packs.extend((0..of_beam.packs()).map(|pack| (advancing.len(), of_beam, pack)));
            advancing.push((beam, field, steps));
        }
        // A beam that cannot fly does not end the others.
        let reaches = try_par_map(by.threads, packs.len(), |i| {
            let (number, of_beam, pack) = packs[i];
            let (_, field, steps) = &advancing[number];
            match of_beam.advance(pack, *steps, field.as_ref(), by) {
                Err(Error::Interrupted) => Err(Error::Interrupted),
                reached => Ok(reached),
            }
        })?;
        let numbers: Vec<usize> = packs.into_iter().map(|(number, ..)| number).collect();
        let mut reaches = numbers.into_iter().zip(reaches).peekable();
        for (number, (beam, _, steps)) in advancing.into_iter().enumerate() {
            let of_packs = std::iter::from_fn(|| Some(reaches.next_if(|(of, _)| *of == number)?.1));
            match (of_packs.collect::<Result<Vec<Reach>, Error>>(), &mut flying[beam]) {
                (Ok(of_packs), Ok(of_beam)) => of_beam.reached(steps, of_packs),
                (Err(error), of_beam) => *of_beam = Err(error),
                (Ok(_), Err(_)) => {}
            }
        }
        Ok(())
    }
}

/// Distance in which the filaments of a slot without depth come down, in ways from inlet to belt: five standard
/// deviations of a usual filament. Hardly two of them hang so far apart that they meet the same eddies again.
const REACH: f64 = 0.22;

impl Beam<'_> {
    /// The room of its air alone, in which coarse flights have the larger waves too.
    fn room(&self, sheet: &Sheet) -> Room {
        let room = Room::alone(self.case.way_of_air(), self.extent_of_air(sheet));
        room.with_waves_in_common(LARGER_WAVES)
    }

    /// Most memory that the air of all filaments takes [B].
    ///
    /// * `highest` – lateral wave number, times the length scale
    pub(super) fn memory_of_air(&self, sheet: &Sheet, highest: f64) -> f64 {
        self.memory_in(&self.room(sheet), highest)
    }

    /// Most memory that its air takes in a room [B].
    fn memory_in(&self, room: &Room, highest: f64) -> f64 {
        let air = &self.case.air;
        let memory = |cutoff: f64| EddyField::memory_in_room(1, air, room, cutoff.min(highest));
        air.lateral.cutoff().map_or(0.0, memory)
    }

    /// After what distances the air repeats itself. Across a web that is wide everywhere it is the width;
    /// otherwise no filament meets the air of another one again.
    pub(super) fn extent_of_air(&self, sheet: &Sheet) -> Extent {
        let (air, distance) = (&self.case.air, self.case.way_of_air());
        let least = self.case.extent_of_air().y;
        let width = range(self.places.iter().map(|place| place.z));
        let y = (self.depth + REACH * distance) * widening(air, distance).sqrt();
        let z = match sheet.edges {
            Edges::Periodic => sheet.width,
            Edges::Cut => width + REACH * distance + least,
        };
        Extent { y: y.max(least), z }
    }
}

/// The largest of some numbers less the smallest.
fn range(numbers: impl Iterator<Item = f64> + Clone) -> f64 {
    let smallest = numbers.clone().fold(f64::INFINITY, f64::min);
    let largest = numbers.fold(f64::NEG_INFINITY, f64::max);
    (largest - smallest).max(0.0)
}

/// How many times as wide the mean flow is at the belt as at the inlet. What comes down in the middle of the
/// way has been moved aside by less.
fn widening(air: &Air, distance: f64) -> f64 {
    if matches!(air.flow, Flow::Uniform) || (matches!(air.flow, Flow::Profile(_)) && !air.widens()) {
        return 1.0;
    }
    let mut hint = Hint::default();
    let [inlet, belt] = [0.0, distance].map(|x| air.local(Vec3::new(x, 0.0, 0.0), &mut hint).velocity.x);
    if belt > 0.0 { (inlet / belt).max(1.0) } else { 1.0 }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use spunlaid_fibre::chain::Scheme;
    use spunlaid_fibre::{Case, Fibre, Line, Root};
    use spunlaid_ground::Isa;
    use spunlaid_ground::place::Inlet;
    use std::sync::atomic::{AtomicBool, AtomicU64};

    /// A line with a fibre of this stiffness [Pa].
    fn line(youngs_modulus: f64) -> Case {
        let mut case = Case::unset();
        case.fibre =
            Fibre { diameter: 18e-6, density: 910.0, youngs_modulus, root: Root::Clamped, ..Fibre::UNKNOWN };
        case.fibre.span(0.1, 4e-3);
        let feed_speed = 50.0;
        let belt_speed = 3.0;
        let kept_length = 0.03;
        let line = Line { feed_speed, distance: 0.1, belt_speed, kept_length, ..Line::UNKNOWN };
        case.line = Some(Line { steps_per_element: 2, ..line });
        case.air = Air::uniform(60.0, 0.1, 0.016, 500.0);
        (case.run.time_step, case.run.steps, case.run.output_steps) = (40e-6, 5000, 5);
        case.run.spin_up_steps = 250;
        (case.run.scheme, case.run.gravity, case.run.damping) = (Scheme::ImplicitTension, 9.81, 0.0);
        case
    }

    /// A fibre of no stiffness does not fly, and so the first beam is not there to say for how long the next one does.
    #[test]
    fn beams_that_fly_after_one_that_does_not_go_on_lay_their_sheet() {
        let lost = line(0.0);
        let good = line(2e9);
        let sheet = Sheet::new(24e-3, 32e-3, 1e-3);
        let places: Vec<Inlet> = (0..4).map(|i| Inlet { y: 0.0, z: 6e-3 * f64::from(i) }).collect();
        let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
        let by = RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &done };
        let beams = [Beam::new(&lost, &places), Beam::new(&good, &places)];
        // One after the other: there is no memory for two airs.
        let found = fly_concurrent(&beams, &sheet, -1.0, by).unwrap();
        assert!(found[0].is_err() && found[1].as_ref().unwrap().back.is_finite(), "{found:?}");
    }
}
