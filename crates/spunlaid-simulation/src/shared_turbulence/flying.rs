//! The filaments of a beam while they fly.

use super::charge::BeamField;
use super::lane_group::{BeltStretch, Pack, Reach, adjacent_filaments};
use super::neighbours::Neighbours;
use super::{Beam, BeamFindings};
use crate::observe::StretchedBalance;
use spunlaid_air::EddyField;
use spunlaid_fibre::{LaidPoint, Line};
use spunlaid_ground::threads::{lock, unlock};
use spunlaid_ground::{Error, Fault, RunContext};
use spunlaid_web::{Depositor, LayerFlown, Sheet, TimeSpent, Window};
use std::ops::Range;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex};

/// Most filaments that may be lost, of all.
const MOST_LOST: f64 = 0.02;

/// What takes what the filaments of a beam lay.
pub(super) struct Sink<'a> {
    /// A window of the sheet, whose single fibres are kept.
    pub(super) window: Window,
    /// What draws an element of fibre; None to keep the curves of all filaments in place of it.
    pub(super) on: Option<&'a Depositor<'a>>,
    pub(super) neighbours: Option<Neighbours>,
}

/// The filaments of a beam, and how far they have come.
pub(super) struct Flying<'a> {
    beam: Beam<'a>,
    line: Line,
    /// The numbers of the filaments of each pack, which begins to fly in the first block.
    packs: Vec<(Vec<usize>, Mutex<Option<Pack>>)>,
    sink: Sink<'a>,
    stretch: BeltStretch,
    reach: Reach,
    /// The electric field around them, if they are charged.
    field: Option<BeamField>,
    /// Steps that have been done.
    pub(super) done: u64,
}

impl<'a> Flying<'a> {
    /// Filaments that have not been started yet.
    ///
    /// # Errors
    /// If the fibre of the case is not laid on a moving belt.
    pub(super) fn new(beam: Beam<'a>, sheet: &Sheet, sink: Sink<'a>) -> Result<Self, Error> {
        let line = beam.case.line.filter(|line| line.belt_speed > 0.0);
        let line = line.ok_or_else(|| Fault::plain("the fibre of the case is not laid on a moving belt"))?;
        let packs =
            adjacent_filaments(beam.places).into_iter().map(|numbers| (numbers, Mutex::new(None))).collect();
        let stretch = BeltStretch::before(&beam, &line, sheet, sink.window);
        let field = BeamField::new(&beam);
        Ok(Self { beam, line, packs, sink, stretch, reach: Reach::default(), field, done: 0 })
    }

    /// Number of packs.
    pub(super) fn packs(&self) -> usize {
        self.packs.len()
    }

    /// Advances a pack by some steps and lays what has come down; [`Flying::reached`] takes how far all packs reach.
    ///
    /// * `field` – the air of all filaments, if they share one
    pub(super) fn advance(
        &self,
        pack: usize,
        steps: u64,
        field: Option<&Arc<EddyField>>,
        by: RunContext<'_>,
    ) -> Result<Reach, Error> {
        if by.stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted);
        }
        let ((numbers, pack), on) = (&self.packs[pack], self.sink.on);
        let mut pack = lock(pack);
        let pack = match &mut *pack {
            Some(pack) => pack,
            none => none.insert(Pack::new(&self.beam, numbers, on.is_none(), by.isa, field)?),
        };
        if let Some(field) = &self.field {
            pack.charge(field);
        }
        let reach = pack.advance(steps, field, &self.stretch, on);
        by.done.fetch_add(steps * pack.filaments().len() as u64, Ordering::Relaxed);
        Ok(reach)
    }

    /// Takes how far the packs reach after some more steps.
    pub(super) fn reached(&mut self, steps: u64, packs: impl IntoIterator<Item = Reach>) {
        let before = Reach { fed: f64::INFINITY, lost: 0, ..self.reach };
        self.reach = packs.into_iter().fold(before, Reach::with);
        self.done += steps;
        if let Some(field) = &mut self.field {
            field.begin(steps as f64 * self.beam.case.run.time_step);
            self.packs.iter().for_each(|(_, pack)| lock(pack).iter().for_each(|pack| pack.see_charge(field)));
            field.renew();
        }
        if self.has_lost_too_many() {
            return;
        }
        self.stretch.reconcile(&self.reach);
        if let Some(together) = &mut self.sink.neighbours {
            self.packs.iter().for_each(|(_, pack)| {
                lock(pack).iter_mut().for_each(|pack| pack.compare(together));
            });
            together.add();
        }
    }

    pub(super) fn has_lost_too_many(&self) -> bool {
        self.reach.lost as f64 > MOST_LOST * self.beam.places.len() as f64
    }

    /// The times at which the belt has passed on which all filaments lie as after their start, as far as they
    /// have been simulated [s].
    pub(super) fn laid_during(&self) -> Option<Range<f64>> {
        self.stretch.back()?;
        let Reach { ahead, start, fed, .. } = self.reach;
        let behind = ahead - self.line.belt_ratio() * fed;
        Some(-start / self.line.belt_speed..-behind / self.line.belt_speed)
    }

    /// Hands over the filaments whose curves are kept and that are not lost: their numbers, and all points so far.
    pub(super) fn each_curve(&self, mut see: impl FnMut(usize, &[LaidPoint])) {
        for (_, pack) in &self.packs {
            let pack = lock(pack);
            let filaments = pack.iter().flat_map(Pack::filaments).filter(|filament| filament.lost.is_none());
            filaments.for_each(|filament| see(filament.number, filament.kept.as_deref().unwrap_or_default()));
        }
    }

    /// What the filaments have done.
    ///
    /// * `spent` – what all flights took
    /// * `pace` – as of [`BeamFindings`]
    ///
    /// # Errors
    /// If more than 2 % of them are lost.
    pub(super) fn finish(self, spent: TimeSpent, pace: f64) -> Result<BeamFindings, Error> {
        let has_lost_too_many = self.has_lost_too_many();
        let neighbours = self.sink.neighbours.as_ref().map_or_else(Vec::new, Neighbours::correlations);
        let charged = self.field.as_ref().map(BeamField::curtain);
        let layer = LayerFlown { neighbours, charged, spent, ..LayerFlown::default() };
        let back = self.stretch.back().unwrap_or(f64::NAN);
        let mut simulated = BeamFindings { layer, back, pace, ..BeamFindings::default() };
        let mut balance = StretchedBalance::new(self.beam.case);
        for (_, pack) in self.packs {
            unlock(pack).into_iter().for_each(|pack| pack.finish(&mut simulated, &mut balance));
        }
        simulated.way = balance.way();
        simulated.layer.lost = simulated.lost.len() as u64;
        simulated.sort();
        if has_lost_too_many { Err(too_many_lost(simulated, self.beam.places.len())) } else { Ok(simulated) }
    }
}

/// The error that is returned when so many filaments are lost that no usable web remains.
fn too_many_lost(simulated: BeamFindings, filaments: usize) -> Error {
    let count = simulated.lost.len();
    match simulated.lost.into_iter().next() {
        Some((_, reason)) => Error::Flight(Fault::plain(format!(
            "{count} of {filaments} filaments were lost, which leaves no web to look at. The first: {reason}"
        ))),
        None => Error::no_fibre(),
    }
}
