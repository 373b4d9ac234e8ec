//! How the filaments of a layer are drawn: where they come down, in which pieces, with which random numbers.

use super::canvas::{CanvasPart, LaneDepositors, OUTSIDE};
use super::defects::{PLACES, Titres, inlets};
use super::{Fibres, Layer, Sheet, Web};
use crate::surrogate::{PATH_POINTS, PathKey, Paths, Surrogate};
use spunlaid_ground::random::{stream, uniform};
use spunlaid_ground::{Error, Fault, Isa, Lanes, RunContext, WIDTH};
use std::ops::Range;
use std::sync::atomic::Ordering;

/// Longest piece of a path: of the smaller standard deviation, and of the length 1/A² in which the direction
/// is forgotten.
const LONGEST_PIECE: [f64; 2] = [0.06, 0.2];
/// How the filaments of a layer are drawn.
pub(super) struct Plan<'a> {
    number: u64,
    pub(super) layer: &'a Layer,
    surrogate: Surrogate,
    /// Places of the filaments across the web, in order [m].
    pub(super) places: Vec<f64>,
    /// Pieces of each filament.
    pub(super) pieces: usize,
    /// Length of a piece [m].
    pub(super) piece: f64,
    /// What is wrong with some filaments.
    titres: Titres,
}

/// Time of a point of a path, in times that it takes to draw a part of a piece.
const POINT: f64 = 1.3;

/// The piece that takes the least time for a length of fibre: the longest one, or the longest that fills whole parts.
///
/// * `part` – longest part [m]
fn cheapest_piece(longest: f64, part: f64) -> f64 {
    let parts = longest / part;
    // Below a whole number by more than rounding.
    let whole = parts.floor() * (1.0 - 1e-9);
    let cost = |parts: f64| (POINT + parts.ceil()) / parts;
    if whole > 0.0 && cost(whole) < cost(parts) { whole * part } else { longest }
}

impl<'a> Plan<'a> {
    pub(super) fn new(web: &Web, number: usize, layer: &'a Layer) -> Result<Self, Fault> {
        let sheet = &web.sheet;
        let fed = layer.fed_length(sheet);
        let Fibres::Surrogate(surrogate) = layer.fibres else {
            return Err(Fault::plain(
                "filaments in shared turbulence lay the web while they are simulated".to_owned(),
            ));
        };
        let least = surrogate.sigma_md.min(surrogate.sigma_cd);
        let longest = (LONGEST_PIECE[0] * least).min(LONGEST_PIECE[1] / (surrogate.noise * surrogate.noise));
        // A whole number of pieces, none of them longer.
        let wanted = fed / (fed / cheapest_piece(longest, sheet.cell / (1.0 + layer.belt_ratio()))).ceil();
        let pieces = (fed / wanted).round().max(1.0);
        if !(fed > 0.0 && pieces < 1e12) {
            return Err(no_layer(number + 1));
        }
        let piece = fed / pieces;
        let places = places(web, number, layer);
        if places.is_empty() {
            return Err(no_layer(number + 1));
        }
        let titres = Titres::new(web.layer_filaments(number, layer), &layer.defects, layer.belt_speed);
        let number = number as u64;
        let pieces = pieces as usize;
        Ok(Self { number, layer, surrogate, places, pieces, piece, titres })
    }

    /// Mass of a piece [kg].
    pub(super) fn mass_of_piece(&self) -> f64 {
        self.layer.linear_density * self.piece
    }

    /// Mean mass per area of the cells in the middle of a single trace [kg/m²].
    pub(super) fn weight_of_trace(&self, sheet: &Sheet) -> f64 {
        let width = (2.0 * std::f64::consts::PI).sqrt() * self.surrogate.sigma_cd;
        self.layer.linear_density / self.layer.belt_ratio() / sheet.cell.max(width)
    }

    fn key(&self, web: &Web, filament: usize) -> PathKey {
        PathKey { seed: web.seed, fibre: self.number << 48 | filament as u64 }
    }

    /// The curves of the filaments from the number `first` on.
    fn paths(&self, web: &Web, isa: Isa, first: usize, count: usize) -> Result<Paths, Fault> {
        let keys: Vec<PathKey> = (first..first + count).map(|f| self.key(web, f)).collect();
        Paths::new(isa, self.surrogate, self.piece, &keys).ok_or_else(|| {
            let Surrogate { sigma_md, sigma_cd, noise } = self.surrogate;
            Fault::new(
                format!(
                    "no path can be made with the standard deviations {sigma_md:e} m and {sigma_cd:e} m and \
                    the noise {noise:e} m^-0.5"
                ),
                "all must be above zero",
            )
        })
    }

    /// Mass per length of a filament over that of the others where its straight trace is at a place [m], the
    /// same for a block of pieces.
    pub(super) fn titre_at(&self, filament: usize, along: f64, web: &Web) -> f64 {
        self.titres.of(filament).map_or(1.0, |titre| titre.at(along.rem_euclid(web.sheet.length)))
    }

    /// Draws some filaments.
    ///
    /// * `quanta` – of a piece of a filament without a defect
    pub(super) fn draw(
        &self,
        web: &Web,
        which: Range<usize>,
        quanta: u32,
        part: &mut CanvasPart<'_>,
        by: RunContext<'_>,
    ) -> Result<(), Error> {
        let (Some(low), Some(high)) = (self.places.get(which.start), self.places.get(which.end - 1)) else {
            return Ok(());
        };
        let (cell, advance) = (web.sheet.cell, self.layer.belt_ratio() * self.piece);
        let longest = self.piece + advance;
        let reach = self.layer.fibres.reach() + longest + 4.0 * cell;
        let first = ((low - reach) / cell).floor();
        let columns = ((high + reach) / cell - first).ceil() as i64 + 1;
        let rows = web.sheet.cells()[1] as i64;
        part.cover([first as i64, -OUTSIDE], [columns, rows + 2 * OUTSIDE]);
        for start in which.clone().step_by(2 * WIDTH) {
            let starts = (start..which.end).step_by(WIDTH).take(2);
            let sets: Vec<_> = starts.map(|start| (start, WIDTH.min(which.end - start))).collect();
            let of_set = |(first, count): &(usize, usize)| {
                let mut pens = part.canvas.pens(self.start(web, *first, *count), advance, longest);
                pens.is_bounded = true;
                pens
            };
            let mut pens: Vec<LaneDepositors> = sets.iter().map(of_set).collect();
            self.walk(web, &sets, by, |set, points| {
                let ((first, count), pens) = (sets[set], &mut pens[set]);
                let of_lane = |lane: usize| {
                    let titre = self.titre_at(first + lane, pens.at[1].0[lane] * cell, web);
                    (f64::from(quanta) * titre).round()
                };
                pens.quanta = Lanes::from_fn(|lane| if lane < count { of_lane(lane) } else { 0.0 });
                part.draw(pens, points);
            })?;
        }
        part.pass_on();
        Ok(())
    }

    /// Where the straight traces of some filaments begin, across the web and along it [m].
    pub(super) fn start(&self, web: &Web, first: usize, count: usize) -> [Lanes; 2] {
        // Filaments start anywhere on the ring, so that it has no seam.
        let mut starts = stream([web.seed, self.number << 48 | first as u64, 0, PLACES]);
        [
            Lanes::from_fn(|i| self.places[first + i.min(count - 1)]),
            Lanes::from_fn(|_| uniform(&mut starts) * web.sheet.length),
        ]
    }

    /// Passes on the points (ξ₁, ξ₂) of sets of up to eight filaments, block by block. The first point of a block
    /// is where its first piece begins.
    ///
    /// * `sets` – first filament and number of filaments of each
    /// * `take` – is given the number of the set and its points
    pub(super) fn walk(
        &self,
        web: &Web,
        sets: &[(usize, usize)],
        by: RunContext<'_>,
        mut take: impl FnMut(usize, &[[Lanes; 2]]),
    ) -> Result<(), Error> {
        let paths = sets.iter().map(|(first, count)| self.paths(web, by.isa, *first, *count));
        let mut paths: Vec<Paths> = paths.collect::<Result<_, _>>()?;
        let filaments: usize = sets.iter().map(|(_, count)| count).sum();
        for first in (0..self.pieces).step_by(PATH_POINTS) {
            if by.stop.load(Ordering::Relaxed) {
                return Err(Error::Interrupted);
            }
            Paths::go_on(&mut paths);
            let pieces = PATH_POINTS.min(self.pieces - first);
            paths.iter().enumerate().for_each(|(set, paths)| take(set, &paths.block()[..=pieces]));
            by.done.fetch_add((pieces * filaments) as u64, Ordering::Relaxed);
        }
        Ok(())
    }
}

/// Where the filaments of a layer come down in cross direction, in order [m].
pub(super) fn places(web: &Web, number: usize, layer: &Layer) -> Vec<f64> {
    inlets(&web.sheet, web.seed, number, &layer.filaments).iter().map(|place| place.z).collect()
}

pub(super) fn plans(web: &Web) -> Result<Vec<Plan<'_>>, Fault> {
    web.layers.iter().enumerate().map(|(number, layer)| Plan::new(web, number, layer)).collect()
}

/// The fault of a layer without filaments or without fibre.
fn no_layer(number: usize) -> Fault {
    Fault::new(
        format!("layer {number} of the web lays nothing"),
        "it needs filaments, a feed speed and a belt speed above zero",
    )
}
