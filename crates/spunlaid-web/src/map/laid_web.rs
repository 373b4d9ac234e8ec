//! What has been laid.

use super::basis_weight::Map;
use super::few_findings::SubsampleEstimate;
use super::window::WindowCurve;
use crate::surrogate::{Residual, Surrogate};
use spunlaid_fibre::{SheetHeight, WayPlace};
use spunlaid_ground::statistics::student_t_95_at;
use spunlaid_ground::{Estimate, Fault};
use std::time::Duration;

/// Highest number of a cell, by which the quantum is chosen, over the mean one and over that of a single trace.
pub(super) const HIGHEST: f64 = 4.0;

/// Time that a computation took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TimeSpent {
    /// All of it.
    pub whole: Duration,
    /// The parts that are shared among threads.
    pub in_parallel: Duration,
}

/// What has been laid.
#[derive(Clone, Debug)]
pub struct LaidWeb {
    /// The basis weight.
    pub map: Map,
    /// Mass beyond edges that cut it off [kg].
    pub cut: f64,
    /// What is known of each layer whose filaments were simulated together and laid as they came down; empty of a web
    /// of independent filaments.
    pub simulated: Vec<LayerFlown>,
}

/// From what the CV of a web is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// From known numbers of filaments that are independent of each other.
    Known,
    /// From all filaments of the sheet, which were simulated in one air.
    AllInOneAir,
    /// From a few filaments that were simulated in one air, for all.
    FewInOneAir,
}

/// What is known of the filaments of a layer that were simulated together, in one air.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LayerFlown {
    /// Single fibres of a window.
    pub strands: Vec<WindowCurve>,
    /// How filaments come down together, over their distance.
    pub neighbours: Vec<NeighbourCorrelation>,
    /// What a few filaments say about the web of all; None if all were simulated.
    pub few: Option<SubsampleEstimate>,
    /// What charge has made of the filaments; None if they carry none.
    pub charged: Option<ChargedCurtain>,
    /// Filaments that were lost: they are missing on the web from then on.
    pub lost: u64,
    /// What the flights took.
    pub spent: TimeSpent,
}

impl LaidWeb {
    /// From what its CV is known.
    pub fn evidence(&self) -> Evidence {
        match (self.simulated.is_empty(), self.few().next()) {
            (true, _) => Evidence::Known,
            (false, None) => Evidence::AllInOneAir,
            (false, Some(_)) => Evidence::FewInOneAir,
        }
    }

    /// What the few filaments say of each layer of which only a few were simulated.
    pub fn few(&self) -> impl Iterator<Item = &SubsampleEstimate> {
        self.simulated.iter().filter_map(|layer| layer.few.as_ref())
    }

    /// The single fibres of all layers in the window.
    pub fn strands(&self) -> Vec<WindowCurve> {
        let of_layer = |(layer, simulated): (usize, &LayerFlown)| {
            simulated.strands.iter().map(|strand| WindowCurve { layer, ..strand.clone() }).collect::<Vec<_>>()
        };
        self.simulated.iter().enumerate().flat_map(of_layer).collect()
    }

    /// The layers whose filaments are charged, by their index.
    pub fn charged(&self) -> impl Iterator<Item = (usize, &ChargedCurtain)> {
        self.simulated
            .iter()
            .enumerate()
            .filter_map(|(layer, simulated)| Some((layer, simulated.charged.as_ref()?)))
    }
}

/// The fault of a cell that holds more fibre than can be counted.
pub(super) fn too_full(cell: f64) -> Fault {
    let message = format!(
        "a cell of {cell:e} m holds more fibre than can be counted, because the filaments lie in too small an area"
    );
    Fault::new(message, "choose smaller cells (web.cell)")
}

/// The charged filaments of a layer, as they hung at the end of their flight.
#[derive(Clone, Debug, PartialEq)]
pub struct ChargedCurtain {
    /// The strongest field beside them, at any height [V/m].
    pub edge_field: f64,
    /// Where they hung, from the inlet to the belt.
    pub heights: Vec<SheetHeight>,
}

/// The correlation of the places where two filaments of a layer come down, at equal fed length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeighbourCorrelation {
    /// Distance of their inlets in cross direction [m].
    pub distance: f64,
    /// Of the places in machine direction.
    pub md: Correlation,
    /// Of the places in cross direction.
    pub cd: Correlation,
}

/// A correlation coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlation {
    /// Its value.
    pub value: f64,
    /// Its standard error; None if too little was laid to know it.
    pub standard_error: Option<f64>,
    /// Degrees of freedom of the error; NaN without one.
    pub degrees: f64,
}

impl Correlation {
    /// The 95 % confidence interval, by Student's t; None if too little was laid to know it.
    pub fn interval(&self) -> Option<[f64; 2]> {
        let half = student_t_95_at(self.degrees) * self.standard_error?;
        Some([self.value - half, self.value + half])
    }
}

/// What filaments have laid that were simulated in one air, and the surrogate of it.
#[derive(Clone, Debug)]
pub struct FlownFibres {
    /// The curves of some of them on the belt, without the spin-up.
    pub curves: Curves,
    /// σ₁ and σ₂ [m] and A [m^-½] over the filaments for which they are known.
    pub numbers: [Estimate; 3],
    /// How well the surrogate with the mean numbers fits; None without one.
    pub residual: Option<Residual>,
    /// What a filament does to its air on its way, on average.
    pub way: Vec<WayPlace>,
}

impl FlownFibres {
    /// The surrogate with the mean numbers of the filaments; None if none was identified.
    pub fn surrogate(&self) -> Option<Surrogate> {
        let [sigma_md, sigma_cd, noise] = [0, 1, 2].map(|number| self.numbers[number].mean);
        noise.is_finite().then_some(Surrogate { sigma_md, sigma_cd, noise })
    }
}

/// Laid curves of one line, seen from their straight traces.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    spacing: f64,
    /// Of each curve the points (ξ₁, ξ₂) [m].
    curves: Vec<Vec<[f64; 2]>>,
    /// How far they hang together.
    pub(super) one_air: OneAir,
}

/// How far curves that were simulated in one air hang together.
#[derive(Clone, Debug, PartialEq)]
pub struct OneAir {
    /// Number of the group of neighbours of each curve. Groups are so wide that one is hardly correlated with another.
    pub groups: Vec<usize>,
    /// Length of fed fibre after which eddies are forgotten [m].
    pub memory: f64,
}

impl Curves {
    /// Fewest pieces of a curve.
    const FEWEST: usize = 16;

    /// Curves from their points on the belt.
    ///
    /// * `spacing` – fed length from point to point [m]
    /// * `belt_ratio` – speed of the belt over speed of the feed
    /// * `curves` – of each fibre the places (md, cd) of its points on the belt [m], in the order of feed
    ///
    /// # Errors
    /// If there is no curve, or one of less than 16 pieces or with a point that is not finite.
    pub fn new(
        spacing: f64,
        belt_ratio: f64,
        mut curves: Vec<Vec<[f64; 2]>>,
        one_air: OneAir,
    ) -> Result<Self, Fault> {
        let usable = |curve: &Vec<[f64; 2]>| {
            curve.len() > Self::FEWEST && curve.iter().flatten().all(|x| x.is_finite())
        };
        let known = spacing > 0.0 && spacing.is_finite() && belt_ratio > 0.0 && belt_ratio.is_finite();
        if !known || curves.is_empty() || !curves.iter().all(usable) {
            return Err(no_curves());
        }
        for curve in &mut curves {
            for (i, point) in curve.iter_mut().enumerate() {
                point[0] += belt_ratio * spacing * i as f64;
            }
            let middle = [0, 1].map(|axis| curve.iter().map(|p| p[axis]).sum::<f64>() / curve.len() as f64);
            for point in curve.iter_mut() {
                // The place under the hole is where the curve is on average.
                *point = [point[0] - middle[0], point[1] - middle[1]];
            }
        }
        Ok(Self { spacing, curves, one_air })
    }

    /// Fed length from point to point [m].
    pub(crate) const fn spacing(&self) -> f64 {
        self.spacing
    }

    /// The points (ξ₁, ξ₂) of each curve [m].
    pub(super) fn curves(&self) -> &[Vec<[f64; 2]>] {
        &self.curves
    }

    /// Fed length of the shortest curve [m].
    pub(super) fn length(&self) -> f64 {
        self.curves.iter().map(|curve| curve.len() - 1).min().unwrap_or(0) as f64 * self.spacing
    }

    /// Spread about the straight trace in cross direction [m].
    pub(super) fn sigma_cd(&self) -> f64 {
        let points = self.curves.iter().map(Vec::len).sum::<usize>() as f64;
        (self.curves.iter().flatten().map(|p| p[1] * p[1]).sum::<f64>() / points).sqrt()
    }
}

/// The fault of curves that cannot be laid.
fn no_curves() -> Fault {
    Fault::new(
        "there are no laid curves, or they are too short: each needs more than 16 points at a spacing above zero",
        "simulate the case for longer (run.duration)",
    )
}
