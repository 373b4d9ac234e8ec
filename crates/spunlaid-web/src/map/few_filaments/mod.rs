//! The CV of a web of many filaments in shared turbulence from a few of them, simulated evenly across.
//!
//! ```text
//! curves of n filaments → map of all, of the even ones, of the odd ones → CV
//!                       → patches of single ones and of their neighbours → what a filament makes alone and with others
//! ```
//!
//! Neighbours that hang a few millimetres apart come down almost alike, so the CV of a row hardly depends on
//! its pitch. In a slot a filament is nearer to itself than to any other one at the same place across, and
//! this own part falls with the number of filaments (theory.md, 83d). Where the filaments between them are filled in,
//! the map with these gives the CV of a slot, unless the patches are smaller than the distance of the simulated ones.

mod products;
#[cfg(test)]
mod tests;

use super::basis_weight::Map;
use super::canvas::DepositionGrid;
use super::clouds::Clouds;
use super::few_findings::{SubsampleCv, SubsampleEstimate};
use super::laid_web::too_full;
use super::uniformity::{boxes, patch_cv, places_of_patches};
use super::{Edges, Sheet};
use products::{CornerSums, Known, Patches, Products};
use spunlaid_ground::Error;
use spunlaid_ground::threads::{par_map, try_par_map};
use std::ops::Range;

/// How all filaments hang of which a few are simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrangement {
    /// In rows at an even pitch.
    Rows,
    /// In a slot, each at a random place of its depth.
    Slot,
    /// In one row, at random places of it.
    AtRandom,
}

/// The filaments that were simulated, and those for which they stand.
#[derive(Debug)]
pub struct Subsample<'a> {
    /// The sheet on which they are laid, with the patches that are looked at.
    pub sheet: &'a Sheet,
    /// Number of blocks of the sheet that are distinguished, across and along.
    pub blocks: [usize; 2],
    /// Of each row of filaments the curves in order across, as places on the sheet in cross and in machine
    /// direction [m]; None of one that was lost.
    pub rows: Vec<Vec<Option<Vec<[f64; 2]>>>>,
    /// Mass of a piece of a curve [kg].
    pub piece: f64,
    /// Length of the longest of them on the belt, but for rare exceptions [m].
    pub longest: f64,
    /// How all filaments hang.
    pub arrangement: Arrangement,
    /// Number of all filaments over the width of the sheet.
    pub all: f64,
    /// Most pairs of neighbours whose own patches are looked at, spread over the beam.
    pub pairs: usize,
}

/// Maps in which the filaments between the simulated ones have been filled in.
#[derive(Debug)]
pub struct FilledMaps {
    /// From all simulated ones.
    pub of_all: Map,
    /// From every second one of them.
    pub of_every_second: Map,
    /// Sides of the patches over which they give the CV [m].
    pub patches: Range<f64>,
    /// See [`SubsampleEstimate::missing`].
    pub missing: [f64; 2],
}

/// Side of a patch of a row below which its CV depends on the pitch [m].
pub fn small_patch(pitch: f64) -> f64 {
    PITCHES * pitch
}

/// Fewest filaments of a row that say something of its neighbours.
pub const FEWEST: usize = 10;
/// Neighbours with which a filament is compared: itself, the next ones, and those of every second filament.
const NEIGHBOURS: [usize; 4] = [0, 1, 2, 4];
/// Smallest patch of a row whose CV does not know the pitch, in pitches.
const PITCHES: f64 = 2.5;
/// How far smaller patches are off, as a share of the CV, whatever halves say: 0.3 to 2.4 % in four lines of
/// which all filaments were simulated.
pub(super) const SMALL: f64 = 0.02;
/// Side of a block, which is larger than a cloud, so that one is hardly correlated with the next [m].
const BLOCK: f64 = 0.05;

/// By how much of the variance that is missing the map of a slot is too non-uniform at least: 0.2 to 0.5 of it, as
/// three slots showed of which all filaments were simulated.
const OFF_BY_MISSING: f64 = 0.3;

/// The error of the variance of waves from one length to another, as a part of it: that of the patches which are half
/// as large, because these are the smallest that such waves make uneven. The two fillings may be off alike, and over
/// patches the simulated filaments say so without them.
fn error_of_waves([from, to]: [f64; 2], of_patches: &[(f64, f64)]) -> f64 {
    let middle = 0.5 * (from * to).sqrt();
    let distance = |patch: f64| libm::log(patch / middle).abs();
    let nearest = of_patches.iter().min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
    nearest.map_or(0.0, |(_, error)| *error)
}

impl Subsample<'_> {
    /// What they say of all filaments.
    ///
    /// * `filled` – with the filaments between them
    ///
    /// # Errors
    /// If a cell would hold more fibre than can be counted.
    pub fn estimate(&self, filled: Option<&FilledMaps>, threads: usize) -> Result<SubsampleEstimate, Error> {
        let count = self.count();
        let halves = [self.map(Some(0))?, self.map(Some(1))?];
        let mut cells = halves[0].cells.clone();
        for (cell, other) in cells.iter_mut().zip(&halves[1].cells) {
            *cell = cell.checked_add(*other).ok_or_else(|| too_full(self.sheet.cell))?;
        }
        let [even, odd] = halves;
        let maps = [Map { cells, ..even.clone() }, even, odd];
        let sides: Vec<usize> = self.sheet.patches.iter().map(|patch| self.side(*patch)).collect();
        let products = match self.arrangement {
            Arrangement::Rows => vec![Products::default(); sides.len()],
            Arrangement::Slot | Arrangement::AtRandom => self.products(&maps, &sides, threads)?,
        };
        let found = par_map(threads, sides.len(), |i| {
            (maps.each_ref().map(|map| patch_cv(map, sides[i])), blocks(&maps[0], sides[i], self.blocks))
        });
        let sheet = [self.sheet.width, self.sheet.length];
        let lost = self.rows.iter().flatten().filter(|curve| curve.is_none()).count() as u64;
        let filaments = count as u64;
        let pitch = self.pitch();
        let blocks_across = self.blocks[0];
        let area = sheet[0] * sheet[1];
        let mut estimate = SubsampleEstimate {
            filaments,
            lost,
            sheet,
            area,
            fine_area: area,
            pitch,
            blocks_across,
            missing: filled.map_or([0.0; 2], |filled| filled.missing),
            ..SubsampleEstimate::default()
        };
        // How far the variance of the filled map may be off over patches of a side, as a part of it.
        let mut of_variance: Vec<(f64, f64)> = Vec::new();
        let clouds = filled.map(|filled| [&filled.of_all, &filled.of_every_second].map(Clouds::measure));
        if let Some([Some(all), Some(half)]) = clouds {
            estimate.octaves = all.apart(&half);
        }
        for ((found, blocks), (products, patch)) in
            found.into_iter().zip(products.into_iter().zip(&self.sheet.patches))
        {
            let [Some(all), Some(even), Some(odd)] = found else { continue };
            let [itself, next, second, fourth] = products.means;
            // What filaments at random places of a row have more than those of an even one.
            let at_random = |square: f64| (itself - 1.0 - square) / self.all;
            // What is left of the CV² of this many filaments where there are all of them, and their own part.
            let of_all = |cv: f64, count: f64, [near, far]: [f64; 2]| {
                let own = itself - (4.0 * near - far) / 3.0;
                let square = cv * cv;
                match self.arrangement {
                    Arrangement::Rows => [square, 0.0],
                    Arrangement::Slot => [square - (1.0 / count - 1.0 / self.all) * own, own / self.all],
                    Arrangement::AtRandom => {
                        let own = at_random(square);
                        [square + own, own]
                    }
                }
            };
            let root = |[square, _]: [f64; 2]| square.max(0.0).sqrt();
            let whole = of_all(all.cv, count, [next, second]);
            let halves = [even.cv, odd.cv].map(|cv| root(of_all(cv, 0.5 * count, [second, fourth])));
            let cv = root(whole);
            let off = 0.5 * (halves[0] + halves[1]) - cv;
            let small = if *patch < small_patch(pitch) { SMALL * cv } else { 0.0 };
            // One half differs from the other as the places of its filaments do. The depths of a slot are
            // known better from all filaments than from two halves, which may agree by chance.
            let by_places = match self.arrangement {
                Arrangement::Slot => 0.5 * products.variance(cv * cv, count, self.all).sqrt() / cv,
                Arrangement::Rows | Arrangement::AtRandom => 0.5 * (halves[0] - halves[1]),
            };
            // The error falls faster than the pitch.
            let by_pitch = (0.5 * off).hypot(by_places).hypot(small);
            let by_filling =
                filled.and_then(|filled| self.by_filling(filled, *patch, all.cv, whole[1], &at_random));
            let of_filled = filled.and_then(|filled| patch_cv(&filled.of_all, self.side(*patch)));
            let of_places = if self.arrangement == Arrangement::AtRandom { whole[1] } else { 0.0 };
            if let Some((mut by_filling, of_filled)) = by_filling {
                estimate.blocks.push(of_filled);
                // Filled maps of all and of every second one may agree and both be wrong. In a slot the few
                // say the CV without them too: what is between the two beyond its error is one of the filling.
                if self.arrangement == Arrangement::Slot {
                    let apart = (by_filling.cv - cv).powi(2) - by_pitch * by_pitch;
                    by_filling.by_pitch = by_filling.by_pitch.max(apart.max(0.0).sqrt());
                }
                let SubsampleCv { cv, by_pitch, beyond_filling, .. } = by_filling;
                let of_map = cv * cv - beyond_filling;
                of_variance.push((*patch, (2.0 * by_pitch * cv / of_map).hypot(beyond_filling / of_map)));
                estimate.cvs.push(by_filling);
                continue;
            }
            estimate.blocks.push(blocks);
            let beyond_filling = of_filled.map_or(0.0, |filled| whole[0] - of_places - filled.cv * filled.cv);
            if let Some(filled) = of_filled {
                of_variance
                    .push((*patch, (2.0 * by_pitch / cv).hypot(beyond_filling / (filled.cv * filled.cv))));
            }
            estimate.cvs.push(SubsampleCv {
                patch: *patch,
                cv,
                // The waves of the few hold the chance of their depths too, which is an error by the few. The
                // clouds leave the same part of the CV open whether the own part lies in them or not.
                by_chance: all.standard_error.map(|error| error * cv / all.cv),
                by_pitch,
                of_halves: off / cv,
                by_missing: 0.0,
                own: whole[1],
                few: all.cv,
                beyond_filling,
                beyond_sheet: 0.0,
            });
        }
        for ([from, to], error) in &mut estimate.octaves {
            *error = error.max(error_of_waves([*from, *to], &of_variance));
        }
        Ok(estimate)
    }

    /// The CV of the map in which the filaments between the simulated ones are filled in, and its blocks; None over
    /// patches that it does not give.
    ///
    /// * `few` – CV of the simulated ones alone
    /// * `slot` – part of CV² that filaments of a slot make each for itself
    /// * `at_random` – what filaments at random places have more, of a CV²
    fn by_filling(
        &self,
        filled_maps: &FilledMaps,
        patch: f64,
        few: f64,
        slot: f64,
        at_random: &dyn Fn(f64) -> f64,
    ) -> Option<(SubsampleCv, Vec<f64>)> {
        if !filled_maps.patches.contains(&patch) {
            return None;
        }
        let maps = [&filled_maps.of_all, &filled_maps.of_every_second];
        let [of_blocks, of_half_blocks] = maps.map(|map| blocks(map, self.side(patch), self.blocks));
        let [filled, half] = maps.map(|map| patch_cv(map, self.side(patch)));
        let (filled, half) = (filled?, half?);
        let own = |cv: f64| match self.arrangement {
            Arrangement::AtRandom => at_random(cv * cv),
            Arrangement::Rows | Arrangement::Slot => 0.0,
        };
        let [of_map, half] = [filled.cv, half.cv].map(|cv| (cv * cv + own(cv)).max(0.0).sqrt());
        // Filaments of a slot that are filled in lie more alike than they do, in proportion to the distance of the
        // simulated ones, which is twice as large for every second one. In a row the error falls faster.
        let cv = match self.arrangement {
            Arrangement::Slot => (2.0 * of_map - half).max(0.0),
            Arrangement::Rows | Arrangement::AtRandom => of_map,
        };
        // Halves may agree by chance, but not in every block of the sheet.
        let differences =
            of_blocks.iter().zip(&of_half_blocks).map(|(all, half)| (half - all) * (half - all));
        let by_blocks = 0.5 * differences.sum::<f64>().sqrt() / of_blocks.len() as f64 / of_map;
        // They also lack what is missing. Over small patches the two errors may cancel in the halves, which then say
        // too little.
        let small = if patch < small_patch(self.pitch()) { SMALL * cv } else { 0.0 };
        let is_slot = self.arrangement == Arrangement::Slot;
        let [in_md, in_cd] = filled_maps.missing;
        let of_halves = half / of_map - 1.0;
        let mut estimate = SubsampleCv {
            patch,
            cv,
            by_chance: filled.standard_error.map(|error| error * filled.cv * cv / (of_map * of_map)),
            by_pitch: 0.0,
            of_halves,
            by_missing: if is_slot { OFF_BY_MISSING * 0.5 * (in_md + in_cd) } else { 0.0 },
            own: if is_slot { slot } else { own(filled.cv) },
            few,
            beyond_filling: cv * cv - of_map * of_map,
            beyond_sheet: 0.0,
        };
        let off = half - of_map;
        let by_halves = match is_slot {
            true => (0.5 * off).hypot(by_blocks).hypot(of_map * estimate.beyond_halves(of_halves)),
            false => off.abs().max(by_blocks),
        };
        estimate.by_pitch = by_halves.hypot(small);
        Some((estimate, of_blocks))
    }

    /// Distance of neighbours in the row that has most of them [m].
    pub fn pitch(&self) -> f64 {
        self.sheet.width / self.rows.iter().map(Vec::len).max().unwrap_or(1) as f64
    }

    /// Number of those that were not lost.
    pub(crate) fn count(&self) -> f64 {
        self.rows.iter().flatten().flatten().count() as f64
    }

    /// Cells along the side of a patch [m].
    fn side(&self, patch: f64) -> usize {
        (patch / self.sheet.cell).round() as usize
    }

    /// The map of the filaments, or of every second one of each row.
    ///
    /// * `half` – the first of these; None for all
    pub(crate) fn map(&self, half: Option<usize>) -> Result<Map, Error> {
        let (first, step) = half.map_or((0, 1), |first| (first, 2));
        let curves = self.rows.iter().flat_map(|row| row.iter().skip(first).step_by(step));
        let mut canvas = self.canvas(self.sheet)?;
        let quanta = canvas.quanta(self.piece);
        curves.flatten().for_each(|curve| canvas.draw_alone(curve, self.longest, quanta));
        Ok(canvas.finish()?.map)
    }

    fn canvas(&self, sheet: &Sheet) -> Result<DepositionGrid, Error> {
        let pieces: usize = self.rows.iter().flatten().flatten().map(Vec::len).sum();
        let weight = pieces as f64 * self.piece / (self.sheet.width * self.sheet.length);
        Ok(DepositionGrid::new(sheet, &[self.piece], weight)?)
    }

    /// Products of the patches of filaments with those of their neighbours and of all, for each side.
    ///
    /// * `maps` – of all, of the even and of the odd ones
    fn products(&self, maps: &[Map; 3], sides: &[usize], threads: usize) -> Result<Vec<Products>, Error> {
        let Some(row) = self.rows.first().filter(|row| row.len() >= FEWEST) else {
            let unknown = Products { means: [f64::NAN; NEIGHBOURS.len()], pairs: Vec::new() };
            return Ok(vec![unknown; sides.len()]);
        };
        let pairs = (row.len() / 2).min(self.pairs);
        let references: Vec<usize> =
            (0..pairs).flat_map(|i| [0, 1].map(|second| i * row.len() / pairs + second)).collect();
        let found =
            try_par_map(threads, references.len(), |i| self.products_of(row, references[i], maps, sides))?;
        let map = &maps[0];
        let per_filament = map.total() as f64 / map.cells.len() as f64 / row.iter().flatten().count() as f64;
        let of_side = |(number, side): (usize, &usize)| {
            let patches = (map.columns * (map.rows + 1 - side)) as f64;
            let mean = per_filament * (side * side) as f64;
            let scale = 1.0 / patches / (mean * mean);
            let means = std::array::from_fn(|neighbour| {
                let known = || found.iter().filter_map(|found| found[number][neighbour]);
                known().sum::<f64>() / known().count() as f64 * scale
            });
            let known = |(found, reference): (&Vec<Known>, &usize)| {
                let [Some(itself), Some(next), Some(second), _, Some(even), Some(odd), Some(alike)] =
                    found[number]
                else {
                    return None;
                };
                let [own, other] = if reference % 2 == 0 { [even, odd] } else { [odd, even] };
                Some([itself, next, second, own, other, per_filament * alike].map(|product| scale * product))
            };
            let known: Vec<_> = found.iter().zip(&references).map(known).collect();
            let pairs = known.chunks_exact(2).filter_map(|pair| Some([pair[0]?, pair[1]?]));
            Products { means, pairs: pairs.collect() }
        };
        Ok(sides.iter().enumerate().map(of_side).collect())
    }

    /// Sums over all patches of the products of one filament with its neighbours, and with all [quanta²];
    /// None where one of them is lost.
    ///
    /// * `maps` – of all, of the even and of the odd ones
    fn products_of(
        &self,
        row: &[Option<Vec<[f64; 2]>>],
        reference: usize,
        maps: &[Map; 3],
        sides: &[usize],
    ) -> Result<Vec<Known>, Error> {
        let none = || vec![Known::default(); sides.len()];
        let cell = self.sheet.cell;
        let largest = sides.iter().copied().max().unwrap_or(1);
        let curves = NEIGHBOURS.map(|further| {
            let number = reference + further;
            let turns = (number / row.len()) as f64;
            let curve = row[number % row.len()].as_ref()?;
            Some((curve, turns * self.sheet.width))
        });
        let Some((own, _)) = curves[0] else { return Ok(none()) };
        // All patches that hold a part of it.
        let reach = own.iter().map(|point| point[0]);
        let [first, last] =
            [reach.clone().fold(f64::INFINITY, f64::min), reach.fold(f64::NEG_INFINITY, f64::max)];
        let first = (first / cell).floor() - largest as f64;
        let columns = (last / cell).ceil() - first + largest as f64;
        let strip =
            Sheet { width: columns * cell, edges: Edges::Cut, patches: Vec::new(), ..self.sheet.clone() };
        let sums = |curve: Option<(&Vec<[f64; 2]>, f64)>| {
            let Some((curve, further)) = curve else { return Ok(None) };
            let mut canvas = self.canvas(&strip)?;
            let quanta = canvas.quanta(self.piece);
            let place = |[cd, md]: &[f64; 2]| [cd + further - first * cell, *md];
            canvas.draw_alone(&curve.iter().map(place).collect::<Vec<_>>(), self.longest, quanta);
            Ok::<_, Error>(Some(CornerSums::over(&canvas.finish()?.map)))
        };
        let mut all = Vec::new();
        for curve in curves {
            all.push(sums(curve)?);
        }
        let Some(own) = &all[0] else { return Ok(none()) };
        let [even, odd] = [1, 2].map(|half| CornerSums::around(&maps[half], first as i64, own.columns));
        let alike = CornerSums::even(own.columns, maps[0].rows);
        let of_side = |side: &usize| {
            if *side > own.columns.min(maps[0].rows) {
                return Known::default();
            }
            let patches = Patches::of(own, *side);
            let with = |other: &CornerSums| patches.product(other);
            let [itself, next, second, fourth] =
                std::array::from_fn(|neighbour| all[neighbour].as_ref().map(with));
            [itself, next, second, fourth, Some(with(&even)), Some(with(&odd)), Some(with(&alike))]
        };
        Ok(sides.iter().map(of_side).collect())
    }
}

/// Number of blocks of a sheet, across and along.
pub fn blocks_on(sheet: &Sheet) -> [usize; 2] {
    [sheet.width, sheet.length].map(|size| ((size / BLOCK) as usize).max(1))
}

/// The mean square of the deviations of the patches in each block of a map from the mean of all, over that mean.
///
/// * `numbers` – of the blocks, across and along
fn blocks(map: &Map, side: usize, numbers: [usize; 2]) -> Vec<f64> {
    let Some((places, mean)) = places_of_patches(map, side) else { return Vec::new() };
    let mut sums = vec![(0.0, 0.0); numbers[0] * numbers[1]];
    boxes(map, side, places, |row, boxes| {
        let along = row * numbers[1] / places[1];
        for (column, weight) in boxes.iter().enumerate() {
            let (sum, count) = &mut sums[along * numbers[0] + column * numbers[0] / places[0]];
            *sum += (*weight as f64 / mean - 1.0).powi(2);
            *count += 1.0;
        }
    });
    sums.into_iter().map(|(sum, count): (f64, f64)| sum / count).collect()
}
