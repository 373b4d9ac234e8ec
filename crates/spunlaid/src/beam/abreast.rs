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
use crate::threads::try_each;
use crate::web::{Sheet, Window};
use std::ops::Range;
use std::sync::Arc;

/// Largest lateral wave number of the air, times its length scale. Smaller eddies change no CV from patches
/// of 10 mm on, and hardly any change of it, but take as much time again.
const HIGHEST: f64 = 10.0;

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
/// # Errors
/// For each beam as of [`Beam::fly`]; and if it is stopped.
pub(crate) fn fly_abreast(
    beams: &[Beam<'_>],
    sheet: &Sheet,
    by: BeamControl<'_>,
) -> Result<Vec<Result<FlownAbreast, Error>>, Error> {
    let room = room_of(beams, sheet);
    let fields = fields(beams, &room)?;
    let Some(first) = fields.first().map(|first| first.field.block()) else { return Ok(Vec::new()) };
    let mut found: Vec<Option<Result<FlownAbreast, Error>>> = beams.iter().map(|_| None).collect();
    let mut until = None;
    for maker in 0..beams.len() {
        let members: Vec<usize> = (0..beams.len()).filter(|beam| fields[*beam].maker == maker).collect();
        if members.is_empty() {
            continue;
        }
        let group = Group { beams, fields: &fields, maker, members };
        let pace = first / fields[maker].field.block();
        let (flown, time) = group.fly(sheet, until.map(|until: f64| until / pace), by)?;
        until.get_or_insert(time * pace);
        for (beam, flown) in flown {
            let flown = flown.map(|flown| FlownAbreast { flown, pace: pace * fields[beam].pace });
            found[beam] = Some(flown);
        }
    }
    Ok(found.into_iter().map(|found| found.unwrap_or_else(|| Err(Error::no_fibre()))).collect())
}

/// Most memory that the airs of beams take which fly abreast, one field after the other [B].
pub(crate) fn memory_abreast(beams: &[Beam<'_>], sheet: &Sheet) -> f64 {
    let room = room_of(beams, sheet);
    let of_beam = |beam: &Beam<'_>| {
        let air = &beam.case.air;
        air.lateral.cutoff().map_or(0.0, |cutoff| EddyField::memory_in_room(air, &room, cutoff.min(HIGHEST)))
    };
    beams.iter().map(of_beam).fold(0.0, f64::max)
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
struct Group<'a> {
    beams: &'a [Beam<'a>],
    fields: &'a [BeamField],
    /// The beam whose field is made.
    maker: usize,
    members: Vec<usize>,
}

/// What a beam has flown, with its number.
type Flown = Vec<(usize, Result<BeamFindings, Error>)>;

impl Group<'_> {
    /// Flies the beams until a time of the field, or until all of them have laid the sheet. Returns the time too [s].
    fn fly(&self, sheet: &Sheet, until: Option<f64>, by: BeamControl<'_>) -> Result<(Flown, f64), Error> {
        let no_window = Window { corner: [0.0; 2], sides: [0.0; 2] };
        let mut ended = Vec::new();
        let mut flying = Vec::new();
        for &beam in &self.members {
            match Flying::new(self.beams[beam], (sheet, no_window)) {
                Ok(of_beam) => flying.push((beam, of_beam)),
                Err(error) => ended.push((beam, Err(error))),
            }
        }
        let belt = self.beams[self.maker].case.line.map_or(f64::NAN, |line| line.belt_speed);
        let enough = |laid: &Range<f64>| laid.end - laid.start >= sheet.length / belt;
        let mut making = self.fields[self.maker].field.clone();
        let own = |beam: &usize| self.beams[*beam].longest_block() * self.fields[*beam].pace;
        let block = self.members.iter().map(own).fold(making.block(), f64::min);
        let mut time = 0.0;
        while !flying.is_empty() {
            let from = time;
            time += block;
            let margin = 2.0 * flying.iter().map(|(beam, _)| self.step(*beam)).fold(0.0, f64::max);
            making.make(from - margin..time + margin, by.threads);
            let made = |beam: usize| {
                let BeamField { field, pace, .. } = &self.fields[beam];
                Arc::new(field.made_as(&making, *pace))
            };
            let fields: Vec<Arc<EddyField>> = flying.iter().map(|(beam, _)| made(*beam)).collect();
            let packs = |(number, (_, of_beam)): (usize, &(usize, Flying<'_>))| {
                (0..of_beam.packs()).map(move |pack| (number, pack)).collect::<Vec<_>>()
            };
            let packs: Vec<(usize, usize)> = flying.iter().enumerate().flat_map(packs).collect();
            let steps: Vec<u64> = (flying.iter())
                .map(|(beam, of_beam)| ((time / self.step(*beam)) as u64).saturating_sub(of_beam.done))
                .collect();
            // A beam that cannot fly does not end the others.
            let reaches = try_each(by.threads, packs.len(), |i| {
                let (number, pack) = packs[i];
                let (of_beam, field) = (&flying[number].1, Some(&fields[number]));
                let start = if of_beam.done == 0 { of_beam.start(pack, true, field, by) } else { Ok(()) };
                match start.and_then(|()| of_beam.advance(pack, steps[number], field, None, by)) {
                    Err(Error::Interrupted) => Err(Error::Interrupted),
                    reached => Ok(reached),
                }
            })?;
            drop(fields);
            let mut reaches = packs.iter().zip(reaches).peekable();
            let mut left = Vec::new();
            for (number, (beam, mut of_beam)) in flying.into_iter().enumerate() {
                let mut of_packs = Vec::new();
                while let Some((_, reach)) = reaches.next_if(|((of, _), _)| *of == number) {
                    of_packs.push(reach);
                }
                match of_packs.into_iter().collect::<Result<Vec<Reach>, Error>>() {
                    Ok(of_packs) => of_beam.reached(steps[number], of_packs),
                    Err(error) => {
                        ended.push((beam, Err(error)));
                        continue;
                    }
                }
                match of_beam.has_lost_too_many() {
                    true => ended.push((beam, of_beam.finish(BeamFindings::default()))),
                    false => left.push((beam, of_beam)),
                }
            }
            flying = left;
            let has_ended = match until {
                Some(until) => time >= until,
                None => self.laid_by_all(&flying).is_some_and(|laid| enough(&laid)),
            };
            if has_ended {
                break;
            }
        }
        let finish = |(beam, of_beam): (usize, Flying<'_>)| (beam, of_beam.finish(BeamFindings::default()));
        ended.extend(flying.into_iter().map(finish));
        Ok((ended, time))
    }

    /// Time of the field in a step of a beam [s].
    fn step(&self, beam: usize) -> f64 {
        self.beams[beam].case.run.time_step * self.fields[beam].pace
    }

    /// The times of the field at which the belt has passed on which the filaments of all beams lie; None
    /// while some lay the fibre of their start.
    fn laid_by_all(&self, flying: &[(usize, Flying<'_>)]) -> Option<Range<f64>> {
        let mut all = f64::NEG_INFINITY..f64::INFINITY;
        for (beam, of_beam) in flying {
            let (laid, pace) = (of_beam.laid_during()?, self.fields[*beam].pace);
            all = all.start.max(laid.start * pace)..all.end.min(laid.end * pace);
        }
        Some(all)
    }
}
