//! Defects of a line: holes that are blocked or feed more or less than the others, dead rows, filaments that broke.

use super::canvas::DepositionGrid;
use super::{Filaments, Row, Sheet};
use spunlaid_ground::place::Inlet;
use spunlaid_ground::random::{stream, uniform};
use std::collections::BTreeMap;

/// Last word of the keys of the choice of holes.
const HOLES: u64 = 7;

/// Some holes of a layer that feed more or less than the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Defect {
    /// Where they begin, from the edge of the web [m]; from the edge on if it is not given.
    pub from: Option<f64>,
    /// Where they end [m]. If only `from` is given, it is the one hole that is nearest to it.
    pub to: Option<f64>,
    /// Number of their row of holes, from 1; all rows if it is not given.
    pub row: Option<u64>,
    /// Share of these holes that have the defect, chosen at random.
    pub share: f64,
    /// Mass per length of their filaments over that of the others, 0 of a blocked hole.
    pub titre: f64,
    /// Time from which on it is so, after the sheet began to be laid [s].
    pub after: f64,
}

impl Defect {
    /// Whatever a file leaves out.
    pub const USUAL: Self = Self { from: None, to: None, row: None, share: 1.0, titre: 0.0, after: 0.0 };

    /// The place along a sheet up to which it is so: what is laid later lies farther back [m].
    pub fn until(&self, length: f64, belt_speed: f64) -> f64 {
        if self.after > 0.0 { length - belt_speed * self.after } else { f64::INFINITY }
    }
}

/// What is wrong with a filament: shares of its mass per length, each up to a place along the sheet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Titre(Vec<(f64, f64)>);

impl Titre {
    /// Its mass per length over that of the others at a place along the sheet [m].
    #[inline]
    pub(crate) fn at(&self, md: f64) -> f64 {
        self.0.iter().filter(|(_, until)| md < *until).map(|(titre, _)| titre).product()
    }
}

/// The filaments of a layer that have a defect, by their numbers across the web.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Titres(BTreeMap<usize, Titre>);

impl Titres {
    /// What is wrong with a filament, if anything.
    #[inline]
    pub fn of(&self, filament: usize) -> Option<&Titre> {
        self.0.get(&filament)
    }
}

/// The filaments of a layer of a web.
#[derive(Clone, Copy, Debug)]
pub struct LayerFilaments<'a> {
    /// The sheet on which they land.
    pub sheet: &'a Sheet,
    /// Seed of the web.
    pub seed: u64,
    /// Number of the layer.
    pub number: usize,
    /// How they are arranged.
    pub filaments: &'a Filaments,
}

/// The holes of a defect: their numbers across the web and their positions [m].
///
/// * `number` – of the defect in its layer
pub fn holes(layer: LayerFilaments<'_>, number: usize, defect: &Defect) -> Vec<(usize, f64)> {
    let LayerFilaments { sheet, seed, number: layer, filaments } = layer;
    let of_layer = sorted_holes(sheet, seed, layer, filaments);
    let is_of_row = |row: u64| defect.row.is_none_or(|wanted| wanted == row);
    let in_rows = of_layer.iter().enumerate().filter(|(_, hole)| is_of_row(hole.row));
    let mut holes: Vec<(usize, f64)> = in_rows.map(|(i, hole)| (i, hole.at[0])).collect();
    match (defect.from, defect.to) {
        (Some(from), None) => {
            let far = |hole: &(usize, f64)| (hole.1 - from).abs();
            holes = holes.into_iter().min_by(|a, b| far(a).total_cmp(&far(b))).into_iter().collect();
        }
        (from, to) => {
            let reach = from.unwrap_or(f64::NEG_INFINITY)..=to.unwrap_or(f64::INFINITY);
            holes.retain(|(_, place)| reach.contains(place));
        }
    }
    let mut choice = stream([seed, (layer as u64) << 48 | 1 << 47 | (number as u64) << 1, 0, HOLES]);
    holes.retain(|_| uniform(&mut choice) < defect.share);
    holes
}

impl Titres {
    /// What defects make of the filaments of a layer.
    ///
    /// * `belt_speed` – [m/s]
    pub fn new(layer: LayerFilaments<'_>, defects: &[Defect], belt_speed: f64) -> Self {
        let mut titres = Self::default();
        for (number, defect) in defects.iter().enumerate() {
            let until = defect.until(layer.sheet.length, belt_speed);
            for (hole, _) in holes(layer, number, defect) {
                titres.0.entry(hole).or_default().0.push((defect.titre, until));
            }
        }
        titres
    }
}

/// What draws the filaments of a layer on a canvas.
#[derive(Clone, Debug)]
pub struct Depositor<'a> {
    /// What it draws on.
    pub canvas: &'a DepositionGrid,
    /// Of a piece of a filament without a defect.
    pub(crate) quanta: u32,
    /// The linear densities of the filaments.
    pub titres: Titres,
}

impl<'a> Depositor<'a> {
    /// * `piece` – mass of a piece [kg]
    pub fn new(canvas: &'a DepositionGrid, piece: f64, titres: Titres) -> Self {
        Self { canvas, quanta: canvas.quanta(piece), titres }
    }

    /// Quanta of a piece of a filament, and its mass per length over that of the others.
    #[inline(always)]
    pub fn quanta_at(&self, titre: Option<&Titre>, md: f64) -> (u32, f64) {
        let Some(titre) = titre else { return (self.quanta, 1.0) };
        let titre = titre.at(md);
        ((f64::from(self.quanta) * titre).round() as u32, titre)
    }
}

/// Last word of the keys of the places of filaments, and of the depths in a slot.
pub(super) const PLACES: u64 = 4;
const DEPTHS: u64 = 6;

/// Where the inlets of the filaments of a layer are, in order across the web.
///
/// * `seed` – of the web
/// * `number` – of the layer
pub fn inlets(sheet: &Sheet, seed: u64, number: usize, filaments: &Filaments) -> Vec<Inlet> {
    let holes = sorted_holes(sheet, seed, number, filaments).into_iter();
    holes.map(|Hole { at: [z, y], .. }| Inlet { y, z }).collect()
}

/// Where a filament comes from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hole {
    /// Its place in cross and in machine direction [m].
    pub(super) at: [f64; 2],
    /// The number of its row, from 1.
    pub(super) row: u64,
}

/// The holes of a layer, in order across the web. See [`inlets`].
pub(super) fn sorted_holes(sheet: &Sheet, seed: u64, number: usize, filaments: &Filaments) -> Vec<Hole> {
    let random = |kind| stream([seed, (number as u64) << 48 | 1 << 47, 0, kind]);
    let count = filaments.count(sheet);
    let single = |at: [f64; 2]| Hole { at, row: 1 };
    let mut holes: Vec<Hole> = match filaments {
        Filaments::AtRandom { .. } => {
            let mut random = random(PLACES);
            (0..count).map(|_| single([uniform(&mut random) * sheet.width, 0.0])).collect()
        }
        Filaments::Slot { depth, .. } => {
            let (mut random, pitch) = (random(DEPTHS), sheet.width / count as f64);
            let inlet = |i| [(i as f64 + 0.5) * pitch, (uniform(&mut random) - 0.5) * depth];
            (0..count).map(inlet).map(single).collect()
        }
        Filaments::Rows(rows) => {
            let of_row = |(row, of): (u64, &Row)| {
                let of = *of;
                (0..of.filaments).map(move |i| Hole { at: [of.offset + of.pitch * i as f64, of.md], row })
            };
            (1..).zip(rows).flat_map(of_row).collect()
        }
    };
    holes.sort_by(|one, other| one.at[0].total_cmp(&other.at[0]));
    holes
}
