//! What has been laid.

use super::few_findings::{FewDoubt, LayerFew};
use super::lay::TimeSpent;
use super::map::Map;
use super::window::Strand;
use crate::charge::SheetHeight;
use crate::error::Fault;
use crate::statistics::student_t_95_at;

/// Highest number of a cell, by which the quantum is chosen, over the mean one and over that of a single trace.
pub(super) const HIGHEST: f64 = 4.0;

/// What has been laid.
#[derive(Clone, Debug)]
pub struct LaidWeb {
    /// The basis weight.
    pub map: Map,
    /// Mass beyond edges that cut it off [kg].
    pub cut: f64,
    /// What is known of filaments that were flown together and laid as they came down; None of a web of
    /// independent filaments.
    pub shared_air: Option<SharedAirFindings>,
}

/// What is known of filaments that were flown together, in one air.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SharedAirFindings {
    /// Single fibres of a window.
    pub strands: Vec<Strand>,
    /// How filaments of each layer come down together, over their distance.
    pub neighbours: Vec<NeighbourCorrelation>,
    /// What a few filaments say about the web of all, of each layer of which only a few were flown.
    pub few: Vec<LayerFew>,
    /// What charge has made of the filaments of each layer that carry some.
    pub charged: Vec<ChargedCurtain>,
    /// Filaments that were lost: they are missing on the web from then on.
    pub lost: u64,
    /// Length of time that was flown, of the layer that took the longest [s].
    pub time: f64,
    /// What the flights took.
    pub spent: TimeSpent,
}

impl SharedAirFindings {
    /// Why the few filaments of a layer do not tell the CV of all over patches of a side; None if they do.
    pub fn doubt_over(&self, patch: f64) -> Option<FewDoubt> {
        self.few.iter().find_map(|few| few.doubt_over(patch))
    }

    /// Adds what is known of another layer.
    pub(crate) fn add(&mut self, layer: usize, other: Self) {
        self.strands.extend(other.strands.into_iter().map(|strand| Strand { layer, ..strand }));
        let neighbours = other.neighbours.into_iter();
        self.neighbours.extend(neighbours.map(|neighbour| NeighbourCorrelation { layer, ..neighbour }));
        self.few.extend(other.few.into_iter().map(|few| LayerFew { layer, ..few }));
        self.charged.extend(other.charged.into_iter().map(|charged| ChargedCurtain { layer, ..charged }));
        self.lost += other.lost;
        self.time = self.time.max(other.time);
        self.spent.whole += other.spent.whole;
        self.spent.in_parallel += other.spent.in_parallel;
    }
}

/// The fault of a cell that holds more fibre than can be counted.
pub(super) fn too_full(cell: f64) -> Fault {
    let message = format!(
        "a cell of {cell:e} m holds more fibre than can be counted, since the filaments lie in few places"
    );
    Fault::new(message, "choose smaller cells (web.cell)")
}

/// The charged filaments of a layer, as they hung at the end of their flight.
#[derive(Clone, Debug, PartialEq)]
pub struct ChargedCurtain {
    /// Index of the layer.
    pub layer: usize,
    /// The strongest field beside them, at any height [V/m].
    pub edge_field: f64,
    /// Where they hung, from the inlet to the belt.
    pub heights: Vec<SheetHeight>,
}

/// The correlation of the places where two filaments of a layer come down, at equal fed length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeighbourCorrelation {
    /// Index of the layer.
    pub layer: usize,
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
