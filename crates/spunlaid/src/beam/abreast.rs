//! Beams in the same air, which fly side by side as far as they look at one field.
//!
//! ```text
//! beams → one room for all airs → beams whose airs have one pattern share a field
//!       → all fly for the same time, counted in what passes of the pattern → curves of all filaments
//! ```

use super::air::room_of;
use super::filament::Reach;
use super::flying::Flying;
use super::{Beam, BeamControl, BeamFindings};
use crate::air::{EddyField, Room, StreamKey};
use crate::error::{Error, Fault};
use crate::threads::{each, lock, try_each};
use crate::web::{Sheet, Window};
use std::collections::VecDeque;
use std::sync::{Arc, Mutex};

/// Largest lateral wave number of the air, times its length scale. Smaller eddies change no CV from patches
/// of 10 mm on, and hardly any change of it, but take as much time again.
const HIGHEST: f64 = 8.0;

/// A beam that has flown beside others.
#[derive(Debug)]
pub(crate) struct FlownAbreast {
    /// The curves of all filaments, and the lost ones.
    pub(crate) flown: BeamFindings,
    /// How many times as fast the pattern of its air passes as that of the first beam.
    pub(crate) pace: f64,
}

/// The field of the air of a beam.
struct BeamField {
    field: EddyField,
    /// The beam whose field is made, and how many times as fast the pattern passes as there.
    maker: usize,
    pace: f64,
}

/// Flies beams on a sheet, or on the belt that passes for them in the same time. All are flown for as long as
/// the first ones take; a beam may lay a little less than the sheet.
///
/// * `memory` – that the airs which pass side by side take at most, unless a single one takes more [B]
///
/// # Errors
/// For each beam as of [`Beam::fly`]; and if it is stopped.
pub(crate) fn fly_abreast(
    beams: &[Beam<'_>],
    (sheet, memory): (&Sheet, f64),
    by: BeamControl<'_>,
) -> Result<Vec<Result<FlownAbreast, Error>>, Error> {
    let room = room_of(beams, sheet);
    let fields = fields(beams, &room)?;
    let none = Window { corner: [0.0; 2], sides: [0.0; 2] };
    let mut flying: Vec<_> = beams.iter().map(|beam| Flying::new(*beam, (sheet, none))).collect();
    let all = All { beams, fields: &fields, sheet };
    let makers = (0..beams.len()).filter(|beam| fields[*beam].maker == *beam);
    let mut waiting: VecDeque<Group> = makers.map(|maker| all.group(maker)).collect();
    let mut until = None;
    while let Some(first) = waiting.pop_front() {
        let mut needed = memory_of_air(first.beam(beams), &room);
        let mut groups = vec![first];
        while let Some(next) = waiting.front()
            && needed + memory_of_air(next.beam(beams), &room) <= memory
        {
            needed += memory_of_air(next.beam(beams), &room);
            groups.extend(waiting.pop_front());
        }
        loop {
            groups.retain(|group| group.members.iter().any(|beam| flies(&flying[*beam])));
            let has_ended = match (groups.first(), until) {
                (None, _) => true,
                (Some(group), Some(until)) => group.time * group.pace >= until,
                (Some(group), None) => all.is_laid_by(group, &flying),
            };
            if has_ended {
                break;
            }
            make(&mut groups, by.threads);
            all.advance(&groups, &mut flying, by)?;
        }
        until.get_or_insert(groups.first().map_or(0.0, |group| group.time * group.pace));
    }
    let paces = fields.iter().map(|field| all.pace(field.maker) * field.pace);
    let finish = |(of_beam, pace): (Result<Flying<'_>, Error>, f64)| {
        Ok(FlownAbreast { flown: of_beam?.finish(BeamFindings::default())?, pace })
    };
    Ok(flying.into_iter().zip(paces).map(finish).collect())
}

/// Whether a beam goes on.
fn flies(of_beam: &Result<Flying<'_>, Error>) -> bool {
    of_beam.as_ref().is_ok_and(|of_beam| !of_beam.has_lost_too_many())
}

/// Makes the fields of all groups for their next block, side by side.
fn make(groups: &mut [Group], threads: usize) {
    let of_each = threads.div_ceil(groups.len());
    let groups: Vec<_> = groups.iter_mut().map(Mutex::new).collect();
    each(threads, groups.len(), |group| {
        let mut group = lock(&groups[group]);
        let from = group.time;
        group.time += group.block;
        let times = from - group.margin..group.time + group.margin;
        group.making.make(times, of_each);
    });
}

/// Most memory that the air of a beam takes in a room [B].
fn memory_of_air(beam: &Beam<'_>, room: &Room) -> f64 {
    let air = &beam.case.air;
    let memory = |cutoff: f64| EddyField::memory_in_room(air, room, cutoff.min(HIGHEST));
    air.lateral.cutoff().map_or(0.0, memory)
}

/// Most memory that the air of one of some beams takes that fly abreast [B].
pub(crate) fn memory_abreast(beams: &[Beam<'_>], sheet: &Sheet) -> f64 {
    let room = room_of(beams, sheet);
    beams.iter().map(|beam| memory_of_air(beam, &room)).fold(0.0, f64::max)
}

/// The fields of the airs of beams, of which those with one pattern share one.
fn fields(beams: &[Beam<'_>], room: &Room) -> Result<Vec<BeamField>, Error> {
    let mut fields: Vec<BeamField> = Vec::new();
    for (number, beam) in beams.iter().enumerate() {
        let (air, seed) = (&beam.case.air, beam.case.run.seed);
        let cutoff = air.lateral.cutoff();
        let cutoff = cutoff.ok_or_else(|| Fault::plain("the air of a beam is the same everywhere across"))?;
        let cutoff = cutoff.min(HIGHEST);
        let mut makers = (0..number).filter(|maker| fields[*maker].maker == *maker);
        let shared = makers.find_map(|maker| {
            let other = beams[maker].case;
            if other.run.seed != seed || other.air.lateral != air.lateral {
                return None;
            }
            let (field, pace) = match other.air == *air {
                true => (fields[maker].field.clone(), 1.0),
                false => fields[maker].field.at_pace_of([&other.air, air], room)?,
            };
            Some(BeamField { field, maker, pace })
        });
        fields.push(match shared {
            Some(shared) => shared,
            None => {
                let key = StreamKey { seed, replicate: 0 };
                BeamField { field: EddyField::in_room(air, room, cutoff, key), maker: number, pace: 1.0 }
            }
        });
    }
    Ok(fields)
}

/// Beams that look at one field.
struct Group {
    /// The field, as far as it has been made.
    making: EddyField,
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

impl Group {
    fn beam<'a, 'b>(&self, beams: &'b [Beam<'a>]) -> &'b Beam<'a> {
        &beams[self.members[0]]
    }
}

/// All beams, with the fields of their airs.
struct All<'a> {
    beams: &'a [Beam<'a>],
    fields: &'a [BeamField],
    sheet: &'a Sheet,
}

impl All<'_> {
    /// How many times as fast the pattern passes in the field of a beam as in that of the first one.
    fn pace(&self, maker: usize) -> f64 {
        self.fields[0].field.block() / self.fields[maker].field.block()
    }

    /// The beams of a field before they fly.
    fn group(&self, maker: usize) -> Group {
        let Self { beams, fields, .. } = self;
        let members: Vec<usize> = (0..beams.len()).filter(|beam| fields[*beam].maker == maker).collect();
        let making = fields[maker].field.clone();
        let of_field = |beam: usize, time: f64| time * fields[beam].pace;
        let steps: Vec<f64> =
            members.iter().map(|beam| of_field(*beam, beams[*beam].case.run.time_step)).collect();
        // The same stretch of the pattern passes for all groups, so that they end together.
        let longest =
            |beam: usize| of_field(beam, beams[beam].longest_block()) * self.pace(fields[beam].maker);
        let block = (0..beams.len()).map(longest).fold(fields[0].field.block(), f64::min);
        let (pace, margin) = (self.pace(maker), 2.0 * steps.iter().copied().fold(0.0, f64::max));
        Group { making, pace, members, steps, block: block / pace, time: 0.0, margin }
    }

    /// Whether all beams of a group have laid the sheet during the same time.
    fn is_laid_by(&self, group: &Group, flying: &[Result<Flying<'_>, Error>]) -> bool {
        let mut all = f64::NEG_INFINITY..f64::INFINITY;
        for beam in group.members.iter().filter(|beam| flies(&flying[**beam])) {
            // While some lay the fibre of their start, nothing is known.
            let Some(laid) = flying[*beam].as_ref().ok().and_then(Flying::laid_during) else { return false };
            let pace = self.fields[*beam].pace;
            all = all.start.max(laid.start * pace)..all.end.min(laid.end * pace);
        }
        let belt = group.beam(self.beams).case.line.map_or(f64::NAN, |line| line.belt_speed);
        all.end - all.start >= self.sheet.length / belt
    }

    /// Advances all beams of some groups to the end of the block that has been made. Their packs are shared
    /// among the threads.
    fn advance(
        &self,
        groups: &[Group],
        flying: &mut [Result<Flying<'_>, Error>],
        by: BeamControl<'_>,
    ) -> Result<(), Error> {
        let members = groups.iter().flat_map(|group| {
            group.members.iter().zip(&group.steps).map(move |(beam, step)| (group, *beam, *step))
        });
        let mut packs = Vec::new();
        let mut advancing = Vec::new();
        for (group, beam, step) in members {
            let Some(of_beam) = flying[beam].as_ref().ok().filter(|_| flies(&flying[beam])) else { continue };
            let BeamField { field, pace, .. } = &self.fields[beam];
            let steps = ((group.time / step) as u64).saturating_sub(of_beam.done);
            packs.extend((0..of_beam.packs()).map(|pack| (advancing.len(), of_beam, pack)));
            advancing.push((beam, Arc::new(field.made_as(&group.making, *pace)), steps));
        }
        // A beam that cannot fly does not end the others.
        let reaches = try_each(by.threads, packs.len(), |i| {
            let (number, of_beam, pack) = packs[i];
            let (_, field, steps) = &advancing[number];
            let start = if of_beam.done == 0 { of_beam.start(pack, true, Some(field), by) } else { Ok(()) };
            match start.and_then(|()| of_beam.advance(pack, *steps, Some(field), None, by)) {
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
