//! What is measured of the fibres: each measure is declared once, with its name, unit, meaning and figure.
//!
//! ```text
//! Flight → recorded instants → observers → values of each fibre → statistics over replicates
//! ```
//!
//! A new measure of fibres is a [`Declaration`] beside those of the same part of the fibre, and a line in
//! [`DECLARED`]. The summary, the tables, the report with its figures and CSV files, and the studies loop over the
//! declarations.
//!
//! A measure of anything else stands beside it, in `measures.rs` of its room.

mod along_fibre;
mod along_way;
mod end_node;
mod energy;
mod laydown;
mod momentum;
mod sample;
mod strain;

pub(crate) use along_way::{FIBRE_ON_WAY, FORCE_ON_AIR};
pub use laydown::{LAYDOWN, SURROGATE};
pub(crate) use momentum::{MomentumBalance, NodeStates, StretchedBalance, tension_lag};
pub use sample::Sample;
use spunlaid_fibre::{Case, Flight, LaidPoint, Snapshot};
use spunlaid_ground::{Aggregate, Group, Measure, MeasureKind, Value, WIDTH};
use std::sync::LazyLock;

/// A measure of the fibres of a flight, which observers look at.
pub type FibreMeasure = Measure<Flight>;

/// Motion of the free end.
pub(crate) const END_NODE: Group = Group { name: "end_node", title: "free end of the fibre" };
/// The fibre as a whole.
pub(crate) const FIBRE: Group = Group { name: "fibre", title: "fibre" };
/// The energy checks.
pub(crate) const ENERGY: Group = Group { name: "energy", title: "energy" };

/// Everything that is measured, in the order of the tables.
pub const DECLARED: &[&Declaration] = &[
    &end_node::MOTION,
    &end_node::MEAN_FREQUENCY,
    &end_node::DEFLECTIONS,
    &end_node::RESIDENCE,
    &along_fibre::DECLARATION,
    &along_fibre::CURVATURE,
    &end_node::SPECTRA,
    &laydown::DECLARATION,
    &along_way::DECLARATION,
    &along_way::FORCES,
    &strain::ROOT_TENSION,
    &strain::USUAL,
    &strain::LARGEST,
    &strain::OUTSIDE_FLOW,
    &energy::WORK,
    &energy::BALANCE,
    &energy::DISSIPATION,
];

/// Some measures, and the observer that takes all of them.
#[derive(Debug)]
pub struct Declaration {
    /// The measures, in the order of the observer's values.
    pub measures: &'static [FibreMeasure],
    /// Whether they have a meaning for a case.
    pub applies: fn(&Case) -> bool,
    /// The observer of the fibres of a flight. Their cases may differ, so it takes what it needs of each lane's own,
    /// [`Flight::case`].
    pub observer: fn(&Flight) -> Box<dyn Observer>,
}

/// The state of the fibres at a recorded instant.
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// The fibres.
    pub snapshot: &'a Snapshot,
    /// The sample of each of the eight fibres.
    pub samples: &'a [Sample],
    /// Whether the spin-up is over.
    pub settled: bool,
    /// What each of the eight fibres has laid since the last recorded instant.
    pub laid: &'a [Vec<LaidPoint>],
}

/// Looks at up to eight fibres while they fly.
pub trait Observer: std::fmt::Debug + Send {
    /// Receives a recorded instant. The instants come in order and begin with the start.
    fn see(&mut self, observation: &Observation<'_>);

    /// The values of one fibre at the end of the flight, one for each declared measure.
    fn finish(&self, lane: usize, flight: &Flight) -> Vec<Value>;
}

/// The observers of a flight.
#[derive(Debug)]
pub(crate) struct Observers(Vec<(&'static Declaration, Box<dyn Observer>)>);

impl Observers {
    /// The observers of all measures that apply to a fibre of a flight.
    ///
    /// * `curves` – whether to measure curves too. A study does without; observers of curves alone are then left
    ///   out.
    pub(crate) fn new(flight: &Flight, curves: bool) -> Self {
        let has = |d: &Declaration, wanted: fn(&FibreMeasure) -> bool| d.measures.iter().any(wanted);
        let wanted = |d: &&Declaration| curves || has(d, |m| m.kind == MeasureKind::Number);
        let any = |d: &&Declaration| (0..WIDTH).any(|lane| applies(d, flight, lane));
        let declared = DECLARED.iter().copied().filter(wanted).filter(any);
        Self(declared.map(|declared| (declared, (declared.observer)(flight))).collect())
    }

    /// Passes a recorded instant to all observers.
    pub(crate) fn see(&mut self, observation: &Observation<'_>) {
        self.0.iter_mut().for_each(|(_, observer)| observer.see(observation));
    }

    /// The measures that apply to one fibre, in the order of their declarations.
    pub(crate) fn finish(
        &self,
        lane: usize,
        flight: &Flight,
    ) -> impl Iterator<Item = (&'static FibreMeasure, Value)> {
        let of_lane = self.0.iter().filter(move |(declared, _)| applies(declared, flight, lane));
        of_lane
            .flat_map(move |(declared, observer)| declared.measures.iter().zip(observer.finish(lane, flight)))
    }
}

/// All measures that are numbers, whether they apply to a case or not. A study stores these for each fibre.
pub static MEASURES: LazyLock<Vec<&FibreMeasure>> = LazyLock::new(|| {
    let all = DECLARED.iter().flat_map(|declared| declared.measures);
    all.filter(|measure| measure.kind == MeasureKind::Number).collect()
});

/// The measure of this name, if the axial waves of a fibre decide it. A time mean of a fibre of fixed length is taken
/// over whole waves, and they hardly change it.
pub(crate) fn follows_axial_waves(measure: &str, is_fed: bool) -> bool {
    let declared = [&strain::ROOT_TENSION, &strain::USUAL, &strain::LARGEST];
    let mut measures = declared.into_iter().flat_map(|declared| declared.measures);
    measures.any(|of| of.name == measure && (is_fed || of.aggregate == Aggregate::Largest))
}

/// Whether measures have a meaning for the fibre in a lane.
fn applies(declared: &Declaration, flight: &Flight, lane: usize) -> bool {
    flight.case(lane).is_some_and(declared.applies)
}

/// A number of the case in each lane; NaN in unused lanes.
fn number_of_each(flight: &Flight, number: impl Fn(&Case) -> f64) -> [f64; WIDTH] {
    std::array::from_fn(|lane| flight.case(lane).map_or(f64::NAN, &number))
}

/// Applies to fibres of fixed length.
fn fixed(case: &Case) -> bool {
    case.line.is_none()
}

/// Applies to fed fibres.
fn fed(case: &Case) -> bool {
    case.line.is_some()
}

/// Applies to every case.
fn always(_: &Case) -> bool {
    true
}

#[cfg(test)]
mod tests;
