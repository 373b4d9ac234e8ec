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

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }

    /// Student's t of four degrees of freedom is 2.776.
    #[test]
    fn published_the_interval_of_a_correlation() {
        let correlation = Correlation { value: 0.3, standard_error: Some(0.1), degrees: 4.0 };
        let [low, high] = correlation.interval().unwrap();
        assert!((low - 0.0224).abs() < 1e-4 && (high - 0.5776).abs() < 1e-4, "{low} {high}");
        assert_eq!(Correlation { standard_error: None, degrees: f64::NAN, ..correlation }.interval(), None);
    }

    /// A curve that lies straight, as seen from its trace, and one that goes from side to side.
    #[test]
    fn analytic_curves_are_seen_from_their_straight_traces() {
        let one_air = OneAir { groups: vec![0, 0], memory: 1.0 };
        let curve = |side: f64, pieces: usize| -> Vec<[f64; 2]> {
            let point = |i: usize| {
                [7.0 - 0.5 * 2e-3 * i as f64, 3.0 + if i.is_multiple_of(2) { side } else { -side }]
            };
            (0..=pieces).map(point).collect()
        };
        let of = |curves: &[Vec<[f64; 2]>]| Curves::new(2e-3, 0.5, curves.to_vec(), one_air.clone());
        let curves = of(&[curve(0.0, 17), curve(4e-3, 19)]).unwrap();
        close(curves.length(), 17.0 * 2e-3);
        close(curves.spacing(), 2e-3);
        // Twenty of 38 points are 4 mm off.
        close(curves.sigma_cd(), 4e-3 * (20.0 / 38.0_f64).sqrt());
        for (number, side) in [0.0, 4e-3].into_iter().enumerate() {
            for (i, [md, cd]) in curves.curves()[number].iter().enumerate() {
                close(*md, 0.0);
                close(*cd, if i % 2 == 0 { side } else { -side });
            }
        }
        assert!(of(&[]).is_err() && of(&[curve(0.0, 16)]).is_ok() && of(&[curve(0.0, 15)]).is_err());
        assert!(of(&[vec![[f64::NAN, 0.0]; 20]]).is_err());
        for (spacing, ratio) in [(0.0, 0.5), (f64::INFINITY, 0.5), (2e-3, 0.0), (2e-3, f64::INFINITY)] {
            assert!(Curves::new(spacing, ratio, vec![curve(0.0, 17)], one_air.clone()).is_err());
        }
    }

    #[test]
    fn layers_are_found_by_their_numbers() {
        let strand = WindowCurve { layer: 7, filament: 3, points: Vec::new() };
        let charged = ChargedCurtain { edge_field: 2.0, heights: Vec::new() };
        let layers = [
            LayerFlown { strands: vec![strand.clone()], ..LayerFlown::default() },
            LayerFlown { strands: vec![strand; 2], charged: Some(charged.clone()), ..LayerFlown::default() },
        ];
        let map = Map { columns: 1, rows: 1, cell: 1.0, quantum: 1.0, closed: [false; 2], cells: vec![1] };
        let laid = LaidWeb { map, cut: 0.0, simulated: layers.to_vec() };
        let found: Vec<_> = laid.strands().iter().map(|strand| (strand.layer, strand.filament)).collect();
        assert_eq!(found, [(0, 3), (1, 3), (1, 3)]);
        assert_eq!(laid.charged().collect::<Vec<_>>(), [(1, &charged)]);
        let mut few = laid.clone();
        few.simulated[1].few = Some(SubsampleEstimate::default());
        let known = LaidWeb { simulated: Vec::new(), ..laid.clone() };
        let evidence = [known, laid, few].map(|laid| laid.evidence());
        assert_eq!(evidence, [Evidence::Known, Evidence::AllInOneAir, Evidence::FewInOneAir]);
    }
}
