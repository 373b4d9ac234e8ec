//! How the filaments of a layer are drawn: where they come down, in which pieces, with which random numbers.

use super::canvas::CanvasPart;
use super::defects::{PLACES, Titres, inlets};
use super::laid_web::LayControl;
use super::raster::{Draw, OUTSIDE, Pens};
use super::{Fibres, Layer, Sheet, Web};
use crate::ground::random::{stream, uniform};
use crate::ground::{Error, Fault, Isa, Lanes, WIDTH};
use crate::web::surrogate::{PATH_POINTS, PathKey, Paths, Surrogate};
use std::ops::Range;
use std::sync::atomic::Ordering;

/// Longest piece of a path: of the smaller standard deviation, and of the length 1/A² in which the direction
/// is forgotten.
const LONGEST_PIECE: [f64; 2] = [0.06, 0.2];
/// Points that are drawn at once.
const BLOCK: usize = PATH_POINTS + 1;

/// Paths of up to eight filaments, point by point.
struct Points {
    paths: Paths,
    last: Option<[Lanes; 2]>,
}

impl Points {
    /// Fills `points` with the ends of at most so many pieces: the first is where the next piece begins, the
    /// others where pieces end. Returns the number of points.
    fn next(&mut self, pieces: usize, points: &mut [[Lanes; 2]]) -> usize {
        let count = points.len().min(pieces + 1);
        let points = match self.last {
            Some(last) => {
                points[0] = last;
                self.paths.fill(&mut points[1..count]);
                &points[..count]
            }
            // After these, the paths need new points whenever some are asked for.
            None => {
                let points = &mut points[..count.min(PATH_POINTS)];
                self.paths.fill(points);
                points
            }
        };
        self.last = points.last().copied();
        points.len()
    }
}

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
    /// Parts of a piece, and quanta of a part.
    pub(super) parts: usize,
    pub(super) quanta: u32,
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
            return Err(Fault::plain("filaments in one air lay the web as they fly".to_owned()));
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
        let advance = layer.belt_ratio() * piece;
        let parts = Pens::parts_of((piece + advance) / sheet.cell);
        let places = places(web, number, layer);
        if places.is_empty() {
            return Err(no_layer(number + 1));
        }
        let titres =
            Titres::new((sheet, web.seed), (number, &layer.filaments), (&layer.defects, layer.belt_speed));
        let number = number as u64;
        let pieces = pieces as usize;
        Ok(Self { number, layer, surrogate, places, pieces, piece, parts, quanta: 0, titres })
    }

    /// Mass of a part of a piece [kg].
    pub(super) fn mass_of_part(&self) -> f64 {
        self.layer.linear_density * self.piece / self.parts as f64
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
    fn points(&self, web: &Web, isa: Isa, first: usize, count: usize) -> Result<Points, Fault> {
        let keys: Vec<PathKey> = (first..first + count).map(|f| self.key(web, f)).collect();
        let paths = Paths::new(isa, self.surrogate, self.piece, &keys).ok_or_else(|| {
            let Surrogate { sigma_md, sigma_cd, noise } = self.surrogate;
            Fault::new(
                format!(
                    "no path can be made with the standard deviations {sigma_md:e} m and {sigma_cd:e} m and \
                    the noise {noise:e} m^-0.5"
                ),
                "all must be above zero",
            )
        })?;
        Ok(Points { paths, last: None })
    }

    /// Mass per length of a filament over that of the others where its straight trace is at a place [m], the
    /// same for a block of pieces.
    pub(super) fn titre_at(&self, filament: usize, along: f64, web: &Web) -> f64 {
        self.titres.of(filament).map_or(1.0, |titre| titre.at(along.rem_euclid(web.sheet.length)))
    }

    /// Quanta of a part of the pieces of some filaments.
    ///
    /// * `along` – rows at which their straight traces are
    fn quanta_at(&self, first: usize, count: usize, along: &Lanes, web: &Web) -> Lanes {
        let of_lane = |lane: usize| {
            let titre = self.titre_at(first + lane, along.0[lane] * web.sheet.cell, web);
            (f64::from(self.quanta) * titre).round()
        };
        Lanes::from_fn(|lane| if lane < count { of_lane(lane) } else { 0.0 })
    }

    /// Draws some filaments.
    pub(super) fn draw(
        &self,
        web: &Web,
        which: Range<usize>,
        part: &mut CanvasPart<'_>,
        by: LayControl<'_>,
    ) -> Result<(), Error> {
        let per_cell = 1.0 / web.sheet.cell;
        let (Some(low), Some(high)) = (self.places.get(which.start), self.places.get(which.end - 1)) else {
            return Ok(());
        };
        let reach = self.layer.fibres.reach() + 2.0 * web.sheet.cell;
        let first = ((low - reach) * per_cell).floor();
        let columns = ((high + reach) * per_cell - first).ceil() as i64 + 1;
        let rows = web.sheet.cells()[1] as i64;
        part.cover(
            [first as i64 - OUTSIDE[0], -OUTSIDE[1]],
            [columns + 2 * OUTSIDE[0], rows + 2 * OUTSIDE[1]],
        );
        let pens = |start: usize| {
            let count = WIDTH.min(which.end - start);
            let at = self.start(web, start, count).map(|at| Lanes(at.0.map(|at| at * per_cell)));
            let advance = self.layer.belt_ratio() * self.piece * per_cell;
            let quanta = self.quanta_at(start, count, &at[1], web);
            Pens { per_cell, advance, parts: self.parts, quanta, at, curves: count }
        };
        for start in which.clone().step_by(2 * WIDTH) {
            let starts: Vec<usize> = (start..which.end).step_by(WIDTH).take(2).collect();
            let mut pens: Vec<Pens> = starts.iter().map(|start| pens(*start)).collect();
            let counts: Vec<usize> = pens.iter().map(|pens| pens.curves).collect();
            let sets = starts.iter().zip(&pens).map(|(start, pens)| (*start, pens.curves)).collect();
            self.walk_together(web, sets, by, |set, points| {
                if !self.titres.is_empty() {
                    let pens = &mut pens[set];
                    pens.quanta = self.quanta_at(starts[set], counts[set], &pens.at[1], web);
                }
                by.isa.run(Draw { pens: &mut pens[set], part, points });
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

    /// Passes on the points (ξ₁, ξ₂) of up to eight filaments, block by block. The first point of a block is
    /// where its first piece begins.
    pub(super) fn walk(
        &self,
        web: &Web,
        first: usize,
        count: usize,
        by: LayControl<'_>,
        mut take: impl FnMut(&[[Lanes; 2]]),
    ) -> Result<(), Error> {
        self.walk_together(web, vec![(first, count)], by, |_, points| take(points))
    }

    /// [`Plan::walk`] for one or two sets of filaments at once.
    ///
    /// * `sets` – first filament and number of filaments of each
    /// * `take` – is given the number of the set and its points
    fn walk_together(
        &self,
        web: &Web,
        sets: Vec<(usize, usize)>,
        by: LayControl<'_>,
        mut take: impl FnMut(usize, &[[Lanes; 2]]),
    ) -> Result<(), Error> {
        let mut points = [[Lanes::ZERO; 2]; BLOCK];
        let curves = sets.iter().map(|(first, count)| self.points(web, by.isa, *first, *count));
        let mut curves: Vec<Points> = curves.collect::<Result<_, _>>()?;
        let mut left = vec![self.pieces; sets.len()];
        while left.iter().any(|left| *left > 0) {
            if by.stop.load(Ordering::Relaxed) {
                return Err(Error::Interrupted);
            }
            if let [one, other] = &mut curves[..] {
                one.paths.go_on_together(&mut other.paths);
            }
            for ((set, curves), left) in curves.iter_mut().enumerate().zip(&mut left) {
                if *left > 0 {
                    let given = curves.next(*left, &mut points);
                    take(set, &points[..given]);
                    *left -= given - 1;
                    by.laid.fetch_add(((given - 1) * sets[set].1) as u64, Ordering::Relaxed);
                }
            }
        }
        Ok(())
    }
}

/// Where the filaments of a layer come down in cross direction, in order [m].
pub(super) fn places(web: &Web, number: usize, layer: &Layer) -> Vec<f64> {
    inlets(&web.sheet, web.seed, number, &layer.filaments).into_iter().map(|[cd, _]| cd).collect()
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
