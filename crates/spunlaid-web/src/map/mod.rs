//! The web: how much fibre lies where on the belt when many filaments are laid side by side.
//!
//! A [`Web`] is a sheet of cells on which layers of filaments are laid, each a curve of the
//! [surrogate](crate::surrogate) or one that was simulated. [`lay`] gives the [`Map`] of the basis weight, the
//! mass of fibre in each cell. Of such a map, simulated or measured, [`uniformity`] says how uneven it is.
//!
//! The error of a CV comes from what is chance, and each kind of chance has one place (theory.md):
//!
//! | what is chance | where | theory |
//! |---|---|---|
//! | the waves of one sheet, of independent filaments or of one air | [`uniformity`] | "Chance in a map" |
//! | which of the filaments were simulated | `few_filaments` | (83d), (83e), "The error of few filaments" |
//! | the mean over filaments that share eddies | `shared_error` | (72a) |
//! | the curves of single fibres, of a web of independent filaments | `expected` | scatter between the fibres |
//! | neighbours that land together | `simulation::shared_turbulence` | "The error of a correlation of neighbours" |
//!
//! md is the machine direction, in which the belt moves the web; cd is the cross direction.

mod at_random;
mod autocorrelation;
mod basis_weight;
mod canvas;
mod clouds;
mod defects;
mod expected;
mod few_filaments;
mod few_findings;
mod findings;
mod laid_web;
pub(crate) mod lattice;
mod lay;
pub mod levels;
mod measures;
mod one_fibre;
mod orientation;
mod plan;
mod shared_error;
pub mod uniformity;
mod warning;
mod waves;
mod window;

use crate::surrogate::Surrogate;
pub use autocorrelation::autocorrelation;
pub use basis_weight::Map;
pub use canvas::{CanvasPart, DepositionGrid, NO_CORNERS, widen};
pub use clouds::Clouds;
pub use defects::Defect;
pub use defects::{Depositor, LayerFilaments, Titres, holes, inlets};
pub use expected::{ExpectedCv, expected_cv, inner_columns};
pub use few_filaments::{
    Arrangement, FEWEST as FEWEST_OF_FEW, FilledMaps, Subsample, blocks_on, small_patch,
};
pub use few_findings::{LEAST_SAVING, TRIED};
pub use few_findings::{SubsampleCv, SubsampleEstimate, SubsampleWarning};
pub use findings::find_laid;
pub use findings::{ErrorBudget, Findings, PatchFindings, find};
pub use laid_web::OneAir;
pub use laid_web::{
    ChargedCurtain, Correlation, Curves, Evidence, FlownFibres, LaidWeb, LayerFlown, NeighbourCorrelation,
    TimeSpent,
};
pub use lattice::Chance;
pub use lay::{lay, pieces, strands};
pub use levels::OfMean;
pub use measures::{PATCH_MEASURES, WEB_MEASURES};
pub use one_fibre::{OneFibre, SingleFibres, one_fibre, straight_fibres};
pub use orientation::{Orientation, orientation};
use std::sync::Arc;
pub use uniformity::nearest_to_seen;
pub use warning::WebWarning;
pub use waves::{Places, Streaks};
pub use window::{Window, WindowCurve};
pub use window::{WindowCurves, WindowOnSheet};

/// A sheet and what is laid on it.
#[derive(Clone, Debug)]
pub struct Web {
    /// The sheet.
    pub sheet: Sheet,
    /// What lies on it; the basis weights add up.
    pub layers: Vec<Layer>,
    /// Seed of all random numbers. Equal webs with equal seeds are equal to the last bit.
    pub seed: u64,
}

/// The part of the web that is looked at, and its cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Size in cross direction, a whole number of cells [m].
    pub width: f64,
    /// Size in machine direction, a whole number of cells [m].
    pub length: f64,
    /// Side of a square cell [m].
    pub cell: f64,
    /// Sides of the square patches over which the basis weight is compared, whole numbers of cells [m].
    pub patches: Vec<f64>,
    /// What happens at the edges in cross direction.
    pub edges: Edges,
}

/// What becomes of fibre beyond the edges of the sheet in cross direction. In machine direction the sheet is
/// a stretch of an endless web; that of filaments of known numbers is closed to a ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edges {
    /// It comes in at the other edge: the sheet is a part of a web that is wide everywhere.
    Periodic,
    /// It is cut off.
    Cut,
}

/// Filaments of one kind.
#[derive(Clone, Debug)]
pub struct Layer {
    /// Mass per length of a filament [kg/m].
    pub linear_density: f64,
    /// Speed at which each filament is fed [m/s].
    pub feed_speed: f64,
    /// Speed of the belt [m/s].
    pub belt_speed: f64,
    /// Where the filaments come down.
    pub filaments: Filaments,
    /// Holes that feed more or less than the others.
    pub defects: Vec<Defect>,
    /// The curves that they lay.
    pub fibres: Fibres,
}

/// Where the filaments of a layer come down in cross direction.
#[derive(Clone, Debug, PartialEq)]
pub enum Filaments {
    /// At random places, independent of each other, over the whole width of the sheet.
    AtRandom {
        /// Number of filaments per width of the sheet [1/m]; the nearest whole number is laid.
        per_metre: f64,
    },
    /// At an even pitch over the width of the sheet, in a slot: each at a random place of the slot's depth.
    Slot {
        /// Number of filaments per width of the sheet [1/m]; the nearest whole number is laid.
        per_metre: f64,
        /// Size of the slot in machine direction [m].
        depth: f64,
    },
    /// In rows of holes.
    Rows(Vec<Row>),
}

impl Filaments {
    /// Number of filaments on a sheet.
    pub fn count(&self, sheet: &Sheet) -> u64 {
        match self {
            Self::AtRandom { per_metre } | Self::Slot { per_metre, .. } => {
                (per_metre * sheet.width).round() as u64
            }
            Self::Rows(rows) => rows.iter().map(|row| row.filaments).sum(),
        }
    }

    /// Size in machine direction of the slot through which they come with their air [m]; None if it is not known.
    pub fn slot(&self) -> Option<f64> {
        match self {
            Self::Slot { depth, .. } if *depth > 0.0 => Some(*depth),
            _ => None,
        }
    }

    /// From where to where they are fed in machine direction, seen from the middle of the slot [m].
    pub fn depths(&self) -> [f64; 2] {
        match self {
            Self::AtRandom { .. } => [0.0; 2],
            Self::Slot { depth, .. } => [-0.5 * depth, 0.5 * depth],
            Self::Rows(rows) => {
                let md = || rows.iter().map(|row| row.md);
                [md().fold(f64::INFINITY, f64::min), md().fold(f64::NEG_INFINITY, f64::max)]
            }
        }
    }

    /// How far they are spread in machine direction where they are fed [m].
    pub fn depth(&self) -> f64 {
        let [from, to] = self.depths();
        (to - from).max(0.0)
    }

    /// Whether another web of this kind has its filaments at other places in cross direction.
    pub const fn are_at_random(&self) -> bool {
        matches!(self, Self::AtRandom { .. })
    }
}

/// A row of holes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Place of the first hole, from the sheet's edge [m].
    pub offset: f64,
    /// Distance from hole to hole [m].
    pub pitch: f64,
    /// Number of holes.
    pub filaments: u64,
    /// Place of the row in machine direction, from the middle of the slot [m].
    pub md: f64,
    /// Whether the pitch is the width of the sheet over the number of holes.
    pub is_even: bool,
}

impl Row {
    /// A row in the middle of the slot.
    ///
    /// * `offset` – place of the first hole [m]
    /// * `pitch` – distance from hole to hole [m]
    pub const fn new(offset: f64, pitch: f64, filaments: u64) -> Self {
        Self { offset, pitch, filaments, md: 0.0, is_even: false }
    }
}

/// The curves that filaments lay.
#[derive(Clone, Debug)]
pub enum Fibres {
    /// Paths of the stochastic model, each its own.
    Surrogate(Surrogate),
    /// Curves of filaments that were simulated in one air, which lay them on the sheet as they come down.
    Flown(Arc<FlownFibres>),
}

impl Layer {
    /// Speed of the belt over speed of the feed.
    pub fn belt_ratio(&self) -> f64 {
        self.belt_speed / self.feed_speed
    }

    /// Number of filaments on a sheet.
    pub fn count(&self, sheet: &Sheet) -> u64 {
        self.filaments.count(sheet)
    }

    /// Length that each filament lays on a sheet [m].
    pub fn fed_length(&self, sheet: &Sheet) -> f64 {
        sheet.length / self.belt_ratio()
    }

    /// Mass of all its filaments over the sheet's area [kg/m²].
    pub fn basis_weight(&self, sheet: &Sheet) -> f64 {
        self.linear_density * self.count(sheet) as f64 * self.fed_length(sheet) / (sheet.width * sheet.length)
    }
}

/// Power of the random streaks of a layer, if they had no width.
struct LayerStreaks<'a> {
    layer: &'a Layer,
    /// By the number of filaments at a place.
    by_number: f64,
    /// By the holes that have a defect.
    by_defects: f64,
}

/// What a layer lays with its defects over what it lays without them.
struct WithDefects {
    /// Mean over webs.
    mean: f64,
    /// Variance over webs, by which of the holes have a defect.
    variance: f64,
}

/// Most waves of streaks across a sheet.
const MOST_STREAKS: usize = 512;

impl Web {
    /// The filaments of a layer.
    pub const fn layer_filaments<'a>(&'a self, number: usize, layer: &'a Layer) -> LayerFilaments<'a> {
        LayerFilaments { sheet: &self.sheet, seed: self.seed, number, filaments: &layer.filaments }
    }

    /// What is known of the places at which the filaments come down, for a part of the sheet.
    ///
    /// * `width` – of the part [m]
    pub fn places(&self, width: f64) -> Places {
        Places::Known(self.streaks(width))
    }

    /// [`Web::places`] of filaments that share an air, which makes streaks too. What the map has of streaks beyond
    /// those of defects at random counts as the same in all webs, because one map does not show it.
    fn places_in_one_air(&self, width: f64) -> Places {
        Places::Known(Streaks { variance_of_mean: 0.0, has_rows: true, ..self.streaks(width) })
    }

    fn streaks(&self, width: f64) -> Streaks {
        let layers = self.with_defects();
        let weight = self.weight_of(&layers);
        let fraction = width / self.sheet.width;
        let mut streaks = Vec::new();
        for (layer, with) in self.layers.iter().zip(&layers).filter(|_| weight > 0.0) {
            let part = (layer.basis_weight(&self.sheet) / weight).powi(2);
            // Of a web that is wide everywhere, so many filaments lie in this width on average: a Poisson number.
            let count = layer.count(&self.sheet) as f64 * fraction;
            let by_number = match layer.filaments.are_at_random() {
                true => part * with.mean.powi(2) / count,
                false => 0.0,
            };
            streaks.push(LayerStreaks { layer, by_number, by_defects: part * with.variance / fraction });
        }
        let power = |number: usize| {
            let wave = 2.0 * std::f64::consts::PI * number as f64 / width;
            streaks.iter().map(|of| (of.by_number + of.by_defects) * of.layer.fibres.power_across(wave)).sum()
        };
        // Shorter waves have hardly a part in streaks.
        let least = 1e-6 * streaks.iter().map(|of| of.by_number + of.by_defects).sum::<f64>();
        Streaks {
            variance_of_mean: streaks.iter().map(|of| of.by_number).sum(),
            powers: (1..=MOST_STREAKS).map(power).take_while(|power| *power > least).collect(),
            has_rows: self.layers.iter().any(|layer| !layer.filaments.are_at_random()),
        }
    }

    /// Variance of the mean basis weight over webs of this kind by the holes that have a defect at random, over its
    /// square; zero of a web without fibre.
    pub fn variance_by_defects(&self) -> f64 {
        let layers = self.with_defects();
        let weight = self.weight_of(&layers);
        if weight <= 0.0 {
            return 0.0;
        }
        let part = |layer: &Layer| (layer.basis_weight(&self.sheet) / weight).powi(2);
        self.layers.iter().zip(&layers).map(|(layer, with)| part(layer) * with.variance).sum()
    }

    /// Mean basis weight of webs of this kind, with their defects [kg/m²].
    fn weight_of(&self, layers: &[WithDefects]) -> f64 {
        self.layers.iter().zip(layers).map(|(layer, with)| with.mean * layer.basis_weight(&self.sheet)).sum()
    }

    /// What defects make of each layer.
    fn with_defects(&self) -> Vec<WithDefects> {
        self.layers.iter().enumerate().map(|(number, layer)| self.layer_with_defects(number, layer)).collect()
    }

    fn layer_with_defects(&self, number: usize, layer: &Layer) -> WithDefects {
        let count = layer.count(&self.sheet) as usize;
        // Mean and mean square over webs of what each hole lays, over what it lays without a defect.
        let mut of_holes = vec![[1.0; 2]; count];
        for defect in &layer.defects {
            let of_all = Defect { share: 1.0, ..*defect };
            let holes = holes(self.layer_filaments(number, layer), 0, &of_all);
            let length =
                (defect.until(self.sheet.length, layer.belt_speed) / self.sheet.length).clamp(0.0, 1.0);
            let left = 1.0 - (1.0 - defect.titre) * length;
            let mut give = |hole: usize, share: f64| {
                for (power, moment) in (1..).zip(&mut of_holes[hole]) {
                    *moment *= 1.0 - share * (1.0 - left.powi(power));
                }
            };
            // Of filaments at random places, any may be one of those that come down there.
            let is_one = defect.from.is_some() && defect.to.is_none();
            match layer.filaments.are_at_random() && !is_one {
                true => {
                    (0..count).for_each(|hole| give(hole, defect.share * holes.len() as f64 / count as f64))
                }
                false => holes.iter().for_each(|(hole, _)| give(*hole, defect.share)),
            }
        }
        // A layer without filaments has no weight either.
        let count = count.max(1) as f64;
        WithDefects {
            mean: of_holes.iter().map(|[mean, _]| mean).sum::<f64>() / count,
            variance: of_holes.iter().map(|[mean, square]| square - mean * mean).sum::<f64>()
                / (count * count),
        }
    }

    /// Mass of all filaments over the sheet's area [kg/m²]. With [`Edges::Cut`] some of it may lie beyond the edges.
    pub fn basis_weight(&self) -> f64 {
        self.layers.iter().map(|layer| layer.basis_weight(&self.sheet)).sum()
    }

    /// Length of all filaments [m].
    pub fn fibre_length(&self) -> f64 {
        self.layers.iter().map(|layer| layer.count(&self.sheet) as f64 * layer.fed_length(&self.sheet)).sum()
    }
}

impl Sheet {
    /// A sheet with periodic edges and without patches.
    ///
    /// * `width`, `length` – whole numbers of cells [m]
    /// * `cell` – side of a cell [m]
    pub const fn new(width: f64, length: f64, cell: f64) -> Self {
        Self { width, length, cell, patches: Vec::new(), edges: Edges::Periodic }
    }

    /// Number of cells in cross and in machine direction.
    pub fn cells(&self) -> [usize; 2] {
        [self.width, self.length].map(|size| (size / self.cell).round() as usize)
    }
}

#[cfg(test)]
mod tests;
