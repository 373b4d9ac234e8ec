//! Which few filaments of a layer are simulated for all of them, and on which sheet.

use super::{Beam, BeamFindings};
use crate::{Flown, WantedError, WebSpec};
use spunlaid_fibre::LaidPoint;
use spunlaid_ground::place::{Inlet, rows};
use spunlaid_ground::{Error, Workers};
use spunlaid_web::curtain::lay;
use spunlaid_web::map::{Filaments, inlets, small_patch};
use spunlaid_web::{
    Arrangement, Belt, Covariances, Edges, FEWEST_OF_FEW, FilledMaps, Filling, FlownCurves, LEAST_SAVING,
    Row, Sheet, Subsample, SubsampleEstimate, Window,
};

/// Distance of the filaments that are simulated, in smallest length scales of the air on the way.
const PITCH: f64 = 1.0 / 8.0;
/// Area whose clouds give the CV over patches of 10 mm within some 4 % [m²], and the one that is simulated where coarse
/// flights add the rest.
const AREA: f64 = 0.2;
pub(super) const FINE: f64 = 0.1;
/// Pairs of neighbours whose own patches are looked at, at most: of the sheet, of webs that are compared, and of each
/// of many coarse sheets.
const PAIRS: usize = 64;
const PAIRS_OF_COMPARED: usize = 12;
const PAIRS_OF_COARSE: usize = 4;
/// Width of the sheet that is simulated, in ways from inlet to belt at least: eight spreads of a usual filament.
const WIDTH: f64 = 0.4;
/// Filaments that are filled in for each simulated one on a coarse sheet.
const SPARSELY: usize = 4;
/// Filaments that are filled in for each simulated one where a row is looked at over small patches.
const FINER: usize = 8;
/// A sheet whose area is larger by no more than this is simulated as it is.
const NEARLY: f64 = 1.3;

/// How much of webs is simulated where they are compared in the same air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compared {
    /// Area of the sheets [m²].
    pub area: f64,
    /// Distance of the filaments, in that of those which give the CV: what a larger pitch does to one web it
    /// does to the other.
    pub pitches: f64,
}

/// The sheet that a few filaments lay. It goes on at its edges across.
#[derive(Clone, Debug)]
pub(super) struct FlownSheet {
    pub(super) sheet: Sheet,
    /// Distance of the filaments, in the usual one.
    pitches: f64,
    /// Most pairs of neighbours whose own patches are looked at.
    pairs: usize,
}

impl FlownSheet {
    /// The same sheet with twice as many filaments.
    pub(super) fn finer(self) -> Self {
        Self { pitches: 0.5 * self.pitches, ..self }
    }

    /// A sheet of the same width and another area, from one cell to the next [m²].
    pub(super) fn with_area(&self, area: f64) -> Self {
        let Sheet { width, cell, .. } = self.sheet;
        // An even number, because coarse flights may look at cells of twice the size.
        let length = 2.0 * (0.5 * area / width / cell).ceil() * cell;
        Self { sheet: Sheet { length, ..self.sheet.clone() }, ..*self }
    }

    /// On what the numbers of a layer on this sheet depend besides its web.
    pub(super) fn deciding(&self, layer: usize) -> [f64; 5] {
        let Self { sheet, pitches, pairs } = self;
        [layer as f64, sheet.width, sheet.length, *pitches, *pairs as f64]
    }

    /// The same sheet, on which fewer neighbours are looked at.
    pub(super) fn coarse(&self) -> Self {
        Self { pairs: PAIRS_OF_COARSE, ..self.clone() }
    }
}

/// For which filaments a few stand.
#[derive(Clone, Debug)]
pub(super) struct SubsamplePlan {
    /// The filaments of each row, by their numbers across the web.
    pub(super) rows: Vec<Vec<usize>>,
    /// How all filaments hang.
    pub(super) arrangement: Arrangement,
    /// Number of all filaments over the width of the sheet that is simulated.
    pub(super) all: f64,
    /// Where all filaments of a slot hang.
    slot: Vec<Inlet>,
    /// Most pairs of neighbours whose own patches are looked at.
    pairs: usize,
}

impl WebSpec {
    /// Where the few filaments of a layer are fed that are simulated for all, in order across the web, and those for
    /// which they stand; None if all are simulated.
    ///
    /// * `on` – the sheet that they lay
    pub(super) fn few(&self, layer: usize, on: &FlownSheet) -> Option<(Vec<Inlet>, SubsamplePlan)> {
        let spec = self.layers.get(layer)?;
        let case = spec.source.case()?;
        let pitch = match self.simulated {
            Flown::All => return None,
            Flown::PerMetre(number) => 1.0 / number as f64,
            Flown::Auto => PITCH * case.smallest_length_scale(),
        };
        let (sheet, pitch) = (&on.sheet, on.pitches * pitch);
        let of_web = spec.filaments.count(&self.sheet) as f64;
        let all = of_web * sheet.width / self.sheet.width;
        // An even number, so that every second one is at an even pitch as well.
        let count = 2 * (0.5 * sheet.width / pitch).round().max(1.0) as u64;
        let is_few = |of_all: f64| LEAST_SAVING * count as f64 <= of_all;
        let (filaments, arrangement) = match &spec.filaments {
            Filaments::AtRandom { .. } => {
                (Filaments::Rows(vec![even_row(sheet, count, 0.0)]), Arrangement::AtRandom)
            }
            Filaments::Slot { depth, .. } => {
                let per_metre = count as f64 / sheet.width;
                (Filaments::Slot { per_metre, depth: *depth }, Arrangement::Slot)
            }
            Filaments::Rows(rows) => {
                let share = (sheet.width / self.sheet.width).min(1.0);
                if !rows.iter().all(|row| is_few(row.filaments as f64 * share)) {
                    return None;
                }
                let few = rows.iter().map(|row| even_row(sheet, count, row.md));
                (Filaments::Rows(few.collect()), Arrangement::Rows)
            }
        };
        if !is_few(all.min(of_web)) || (count as usize) < FEWEST_OF_FEW {
            return None;
        }
        let places = inlets(sheet, self.seed, layer, &filaments);
        let rows = match arrangement {
            Arrangement::Slot | Arrangement::AtRandom => vec![(0..places.len()).collect()],
            Arrangement::Rows => rows(&places),
        };
        let slot = match &spec.filaments {
            Filaments::Slot { depth, .. } => {
                let of_all = Filaments::Slot { per_metre: all / sheet.width, depth: *depth };
                inlets(sheet, self.seed, layer, &of_all)
            }
            Filaments::Rows(_) | Filaments::AtRandom { .. } => Vec::new(),
        };
        Some((places, SubsamplePlan { rows, arrangement, all, slot, pairs: on.pairs }))
    }

    /// Whether a few filaments of each layer lay the whole sheet of the web, as all of them would, in the same air.
    pub fn lays_whole_sheet(&self) -> bool {
        let is_whole =
            |on: FlownSheet| on.sheet.width >= self.sheet.width && on.sheet.length >= self.sheet.length;
        (0..self.layers.len()).all(|layer| self.flown_sheet(layer, None).is_some_and(is_whole))
    }

    /// The sheet that the filaments of a case lay: that of the web unless a smaller one says as much. Long
    /// and narrow ones take the least time, because filaments are simulated for a while before they lay the
    /// sheet. None of a layer that flies no case.
    ///
    /// * `compared` – how much of it is simulated where the web is compared with others
    pub(super) fn flown_sheet(&self, layer: usize, compared: Option<Compared>) -> Option<FlownSheet> {
        let area = if self.error == WantedError::OfOneSheet { AREA } else { FINE };
        let Compared { area, pitches } = compared.unwrap_or(Compared { area, pitches: 1.0 });
        let whole = if compared.is_some() { area } else { AREA };
        let pairs = if compared.is_some() { PAIRS_OF_COMPARED } else { PAIRS };
        let on = |sheet| Some(FlownSheet { sheet, pitches, pairs });
        let case = self.layers.get(layer)?.source.case()?;
        let way = case.line.map_or(0.0, |line| line.distance);
        let cell = self.sheet.cell;
        let cells = |size: f64| (size / cell).ceil() * cell;
        let [width, length] = [self.sheet.width, self.sheet.length];
        // In a narrower one the air repeats itself too soon.
        let least = cells(case.extent_of_air().z);
        let sheet = Sheet { edges: Edges::Periodic, width: width.max(least), ..self.sheet.clone() };
        if sheet.width * length <= NEARLY * whole {
            return on(sheet);
        }
        let narrow = cells(WIDTH * way).min(width).max(least);
        on(Sheet { width: narrow, length: cells(area / narrow), ..sheet })
    }
}

impl SubsamplePlan {
    /// With fewer filaments that are filled in: what that does to a coarse sheet it does to the one of the pair.
    pub(super) fn filled_sparsely(&mut self) {
        let simulated: usize = self.rows.iter().map(Vec::len).sum();
        let step = (self.slot.len() / (SPARSELY * simulated).max(1)).max(1);
        self.slot = self.slot.iter().copied().step_by(step).collect();
    }

    /// Their curves after the start, from which all others follow.
    ///
    /// # Errors
    /// If they have laid nothing.
    pub(super) fn curves(
        &self,
        sheet: &Sheet,
        beam: &Beam<'_>,
        simulated: &BeamFindings,
    ) -> Result<FlownCurves, Error> {
        let (case, belt_ratio) = (beam.case, beam.case.line.map_or(f64::NAN, |line| line.belt_ratio()));
        let places = simulated.kept.iter().map(|(filament, _)| beam.places[*filament]).collect();
        let spacing = case.fibre.rest_length();
        let start = case.line.map_or(0.0, |line| line.feed_speed * case.run.spin_up());
        let curve = |(_, points): &(usize, Vec<LaidPoint>)| {
            let laid = points.iter().filter(|point| point.fed >= start).enumerate();
            laid.map(|(i, point)| [point.md + belt_ratio * spacing * i as f64, point.cd]).collect()
        };
        let curves: Vec<Vec<[f64; 2]>> = simulated.kept.iter().map(curve).collect();
        Ok(FlownCurves::new(places, Some(sheet.width), spacing, belt_ratio, &curves)?)
    }

    /// What they say of all filaments.
    ///
    /// * `blocks` – number of those that are reported of the sheet, across and along
    /// * `curves` – of the filaments, from which those between them are filled in
    ///
    /// # Errors
    /// If a cell would hold more fibre than can be counted, or if it is stopped.
    pub(super) fn estimate(
        &self,
        sheet: &Sheet,
        blocks: [usize; 2],
        beam: &Beam<'_>,
        simulated: &BeamFindings,
        curves: Option<&FlownCurves>,
        workers: Workers<'_>,
    ) -> Result<SubsampleEstimate, Error> {
        let filaments = self.filaments(sheet, blocks, beam, simulated);
        let usual_pitch = PITCH * beam.case.smallest_length_scale();
        let pitch_of_all = sheet.width * self.rows.len() as f64 / self.all;
        let with_pitches =
            |estimate: SubsampleEstimate| SubsampleEstimate { usual_pitch, pitch_of_all, ..estimate };
        let Some(curves) = curves else {
            return Ok(with_pitches(filaments.estimate(None, workers.threads)?));
        };
        let covariances = Covariances::fit(curves, workers.threads);
        let window = Window { corner: [0.0; 2], sides: [0.0; 2] };
        let belt = Belt { sheet, window, back: simulated.back };
        let filled = self.filled(belt, beam, filaments.pitch(), curves, &covariances, workers)?;
        let estimate = filaments.estimate(Some(&filled), workers.threads)?;
        let correlation = covariances.smooth.map(|covariance| covariance.correlation([estimate.pitch, 0.0]));
        Ok(with_pitches(SubsampleEstimate {
            correlation: Some(correlation[0].min(correlation[1])),
            ..estimate
        }))
    }

    /// Maps in which the filaments between the simulated ones have been filled in.
    ///
    /// * `pitch` – of the simulated ones in a row [m]
    ///
    /// # Errors
    /// If a cell would hold more fibre than can be counted, or if it is stopped.
    fn filled(
        &self,
        belt: Belt<'_>,
        beam: &Beam<'_>,
        pitch: f64,
        curves: &FlownCurves,
        covariances: &Covariances,
        workers: Workers<'_>,
    ) -> Result<FilledMaps, Error> {
        let places = || match self.arrangement {
            Arrangement::Slot => self.slot.clone(),
            Arrangement::AtRandom => self.finer_rows(usize::MAX, belt.sheet, beam),
            // Rows are filled in up to their own pitch.
            Arrangement::Rows => {
                self.finer_rows((self.all / self.rows.len() as f64).round() as usize, belt.sheet, beam)
            }
        };
        let patches = match self.arrangement {
            Arrangement::Slot => curves.mean_distance()..f64::INFINITY,
            Arrangement::Rows | Arrangement::AtRandom => 0.0..small_patch(pitch),
        };
        let map =
            |filled: &Filling<'_>| lay(filled, belt, beam.element_mass(), workers).map(|(laid, _)| laid.map);
        let filling = curves.fill_by(covariances, places(), workers.threads);
        let of_all = map(&filling)?;
        let of_every_second = map(&curves.every_second()?.fill(places(), workers.threads))?;
        Ok(FilledMaps { of_all, of_every_second, patches, missing: filling.missing() })
    }

    /// Rows that have up to [`FINER`] times as many filaments as were simulated.
    fn finer_rows(&self, most: usize, sheet: &Sheet, beam: &Beam<'_>) -> Vec<Inlet> {
        let row = |row: &Vec<usize>| {
            let y = row.first().map_or(0.0, |first| beam.places[*first].y);
            let count = most.min(FINER * row.len());
            let pitch = sheet.width / count as f64;
            (0..count).map(move |i| Inlet { y, z: (i as f64 + 0.5) * pitch })
        };
        self.rows.iter().flat_map(row).collect()
    }

    /// The filaments, with what they have laid on their sheet.
    fn filaments<'a>(
        &self,
        sheet: &'a Sheet,
        blocks: [usize; 2],
        beam: &Beam<'_>,
        simulated: &BeamFindings,
    ) -> Subsample<'a> {
        let curve = |number: &usize| {
            let (_, points) = simulated.kept.iter().find(|(filament, _)| filament == number)?;
            let place = beam.places[*number];
            Some(
                points
                    .iter()
                    .map(|point| [place.z + point.cd, place.y + point.md - simulated.back])
                    .collect(),
            )
        };
        let rows = self.rows.iter().map(|row| row.iter().map(curve).collect()).collect();
        let Self { arrangement, all, pairs, .. } = *self;
        let (piece, longest) = (beam.element_mass(), beam.longest_piece());
        Subsample { sheet, blocks, rows, piece, longest, arrangement, all, pairs }
    }
}

/// A row over the whole width.
fn even_row(sheet: &Sheet, count: u64, md: f64) -> Row {
    let pitch = sheet.width / count as f64;
    Row { offset: 0.5 * pitch, pitch, filaments: count, md, is_even: true }
}
