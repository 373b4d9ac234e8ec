//! Eight neighbours of a beam, in one flight.

use super::filament::{Extent, Filament, Stretch};
use super::{Beam, Flown};
use crate::error::Error;
use crate::fibre::Place;
use crate::flight::{Flight, Job};
use crate::lanes::{Isa, WIDTH};
use crate::web::Canvas;

/// Neighbours across the web that are shared out to packs by their places in the slot.
const AREA: usize = 8 * WIDTH;
/// Number of steps between two checks that no fibre is lost.
const STEPS_UNSEEN: u64 = 256;

/// The filaments of each pack: neighbours read the same part of the air.
pub(super) fn neighbours(places: &[Place]) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..places.len()).collect();
    for area in order.chunks_mut(AREA) {
        area.sort_by(|a, b| places[*a].y.total_cmp(&places[*b].y));
    }
    order.chunks(WIDTH).map(<[usize]>::to_vec).collect()
}

/// Up to eight filaments and their flight.
#[derive(Debug)]
pub(super) struct Pack {
    flight: Flight,
    filaments: Vec<Filament>,
}

impl Pack {
    pub(super) fn new(beam: &Beam<'_>, numbers: &[usize], isa: Isa) -> Result<Self, Error> {
        let job = |number: &usize| Job {
            case: beam.case,
            replicate: beam.replicate(*number),
            place: beam.places[*number],
        };
        let jobs: Vec<Job<'_>> = numbers.iter().map(job).collect();
        let filament = |number: &usize| Filament::new(*number, beam.places[*number], beam.keeps(*number));
        Ok(Self { flight: Flight::new(&jobs, isa)?, filaments: numbers.iter().map(filament).collect() })
    }

    pub(super) fn filaments(&self) -> &[Filament] {
        &self.filaments
    }

    /// Advances all filaments and lays what has come down.
    pub(super) fn advance(&mut self, steps: u64, stretch: &Stretch, on: (&Canvas, u32)) -> Extent {
        let mut left = steps;
        while left > 0 && self.filaments.iter().any(|filament| filament.lost.is_none()) {
            let now = left.min(STEPS_UNSEEN);
            self.flight.advance(now);
            left -= now;
            for (lane, reason) in self.flight.all_lost() {
                self.filaments[lane].lost.get_or_insert(reason);
            }
        }
        let mut extent = Extent { fed: f64::INFINITY, ..Extent::default() };
        for (lane, filament) in self.filaments.iter_mut().enumerate() {
            let points = self.flight.take_laid(lane);
            // What it laid last may be wrong.
            if filament.lost.is_none() {
                filament.lay(points, stretch, on, &mut extent);
            } else {
                extent.lost += 1;
            }
        }
        extent
    }

    /// Hands over what its filaments have done.
    pub(super) fn finish(self, flown: &mut Flown) {
        for filament in self.filaments {
            let Filament { number, kept, strands, lost, .. } = filament;
            flown.strands.extend(strands);
            match lost {
                Some(reason) => flown.lost.push((number, reason)),
                None => flown.kept.extend(kept.map(|points| (number, points))),
            }
        }
    }
}
