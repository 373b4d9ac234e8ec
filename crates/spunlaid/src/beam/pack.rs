//! Eight neighbours of a beam, in one flight.

use super::charge::BeamField;
use super::filament::{Filament, Reach, Stretch};
use super::neighbours::Neighbours;
use super::{Beam, BeamFindings};
use crate::air::EddyField;
use crate::error::Error;
use crate::fibre::Place;
use crate::flight::{Flight, Job, SurroundingRun};
use crate::lanes::{Isa, WIDTH};
use crate::observe::{NodeStates, StretchedBalance};
use crate::sort::sort_by_key;
use crate::web::Brush;
use std::sync::Arc;

/// Neighbours across the web that are shared out to packs by their places in the slot.
const AREA: usize = 8 * WIDTH;
/// Number of steps between two checks that no fibre is lost.
const STEPS_UNSEEN: u64 = 256;
/// Fewest steps between two looks at the momentum of the filaments, each of which takes about as long as a step.
const LEAST_BETWEEN: u64 = 16;

/// The filaments of each pack: neighbours read the same part of the air.
pub(super) fn side_by_side(places: &[Place]) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..places.len()).collect();
    for area in order.chunks_mut(AREA) {
        sort_by_key(area, |filament| places[*filament].y);
    }
    order.chunks(WIDTH).map(<[usize]>::to_vec).collect()
}

/// Up to eight filaments and their flight.
#[derive(Debug)]
pub(super) struct Pack {
    flight: Flight,
    filaments: Vec<Filament>,
    balance: StretchedBalance,
    spin_up: f64,
    /// Number of steps from one look at the momentum of the filaments to the next.
    steps_between: u64,
}

impl Pack {
    /// * `numbers` – of its filaments, and whether the curves of all of them are kept
    /// * `field` – the air of all filaments, if they share one
    pub(super) fn new(
        beam: &Beam<'_>,
        (numbers, keeps_all): (&[usize], bool),
        isa: Isa,
        field: Option<&Arc<EddyField>>,
    ) -> Result<Self, Error> {
        let job = |number: &usize| Job { case: beam.case, replicate: 0, place: beam.places[*number] };
        let jobs: Vec<Job<'_>> = numbers.iter().map(job).collect();
        let filament =
            |number: &usize| Filament::new(*number, beam.places[*number], keeps_all || beam.keeps(*number));
        let flight = Flight::in_air(&jobs, isa, SurroundingRun { field, ..SurroundingRun::run(beam.case) })?;
        // With no common divisor, births are seen at all of their phases.
        let to_birth = beam.case.line.map_or(1, |line| line.steps_per_element.max(1));
        Ok(Self {
            flight,
            filaments: numbers.iter().map(filament).collect(),
            balance: StretchedBalance::new(beam.case),
            spin_up: beam.case.run.spin_up(),
            steps_between: LEAST_BETWEEN.div_ceil(to_birth) * to_birth + 1,
        })
    }

    pub(super) fn filaments(&self) -> &[Filament] {
        &self.filaments
    }

    /// Advances all filaments and lays what has come down.
    ///
    /// * `field` – the air of all filaments during these steps, if they share one
    pub(super) fn advance(
        &mut self,
        steps: u64,
        field: Option<&Arc<EddyField>>,
        stretch: &Stretch,
        on: Option<&Brush<'_>>,
    ) -> Reach {
        field.iter().for_each(|field| self.flight.give_field(field));
        let mut left = steps;
        while left > 0 && self.filaments.iter().any(|filament| filament.lost.is_none()) {
            let now = left.min(STEPS_UNSEEN);
            self.advance_and_look(now);
            left -= now;
            for (lane, reason) in self.flight.losses() {
                self.filaments[lane].lost.get_or_insert(reason);
            }
        }
        if field.is_some() {
            self.flight.release_field();
        }
        let mut reach = Reach { fed: f64::INFINITY, ..Reach::default() };
        for (lane, filament) in self.filaments.iter_mut().enumerate() {
            let points = self.flight.take_laid(lane);
            // What it laid last may be wrong.
            if filament.lost.is_none() {
                filament.lay(points, stretch, on, &mut reach);
            } else {
                reach.lost += 1;
            }
        }
        reach
    }

    /// Advances all filaments, and looks at their momentum in between.
    fn advance_and_look(&mut self, steps: u64) {
        let mut left = steps;
        while left > 0 {
            let now = left.min(self.steps_between);
            self.flight.advance(now);
            left -= now;
            if now < self.steps_between {
                continue;
            }
            let time = self.flight.time() - self.spin_up;
            let tension = self.flight.chain().tension();
            let flies =
                |lane: usize| self.filaments.get(lane).is_some_and(|filament| filament.lost.is_none());
            let drag = self.flight.drag_of_last_step();
            let nodes = NodeStates::between_steps(&self.flight, (&tension, &drag), flies);
            self.balance.see(&nodes, time);
        }
    }

    /// Gives its filaments their charge and what the others do to them.
    pub(super) fn charge(&mut self, field: &BeamField) {
        field.charge(&mut self.flight);
    }

    /// Hands over where the charge of its filaments is.
    pub(super) fn see_charge(&self, field: &mut BeamField) {
        for (lane, filament) in self.filaments.iter().enumerate().filter(|(_, one)| one.lost.is_none()) {
            field.see(&self.flight, lane, filament.number);
        }
    }

    /// Hands over where its filaments have come down since the last time.
    pub(super) fn compare(&mut self, neighbours: &mut Neighbours) {
        for filament in &mut self.filaments {
            match filament.lost {
                Some(_) => neighbours.lose(filament.number),
                None => neighbours.lay(filament.number, &mut filament.deviations),
            }
        }
    }

    /// Hands over what its filaments have done.
    ///
    /// * `balance` – to which it adds its own
    pub(super) fn finish(self, flown: &mut BeamFindings, balance: &mut StretchedBalance) {
        balance.add(&self.balance);
        for filament in self.filaments {
            let Filament { number, kept, strands, lost, .. } = filament;
            flown.strands.extend(strands.into_parts());
            match lost {
                Some(reason) => flown.lost.push((number, reason)),
                None => flown.kept.extend(kept.map(|points| (number, points))),
            }
        }
    }
}
