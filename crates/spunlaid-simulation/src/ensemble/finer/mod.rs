//! How far a run is from one with a finer time step or with finer elements.
//!
//! Some fibres fly twice in the same turbulence: as the run does, and with a finer discretisation. What
//! differs comes from the discretisation alone. Paths of single fibres are compared where they stay together,
//! statistics everywhere.
//!
//! ```text
//! plan     what is simulated again, and how much of it
//! flights  the flights of a check, and the paths that are compared
//! compare  what differs
//! ```

mod compare;
mod flights;
mod plan;

use super::Trajectory;
use crate::observe::{ENERGY, MEASURES, follows_axial_waves};
pub(super) use flights::Paths;
pub use flights::RunPaths;
pub use plan::{FinerPlan, FinerPlans};
use spunlaid_fibre::Run;
use spunlaid_fibre::chain::Scheme;
use spunlaid_ground::Estimate;
use std::slice;
use std::sync::LazyLock;

named! {
    /// What is finer.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Refinement {
        /// The time step.
        TimeStep = "time step",
        /// The elements.
        Elements = "mesh",
    }
}

/// A statistic that is compared: the mean of some measures.
#[derive(Debug, PartialEq, Eq)]
pub struct Statistic {
    /// Name in `summary.json`.
    pub name: &'static str,
    /// Its label in a sentence: `Amplitude`.
    pub label: &'static str,
    /// Names of the measures.
    pub measures: &'static [&'static str],
}

/// Statistics of the free end.
const OF_THE_END: &[Statistic] = &[
    Statistic { name: "amplitude", label: "Amplitude", measures: &["amplitude_y", "amplitude_z"] },
    Statistic { name: "mean_frequency", label: "Mean frequency", measures: &["mean_frequency"] },
    Statistic { name: "frequency", label: "Frequency", measures: &["frequency_y", "frequency_z"] },
];

/// Statistics of a laid fibre.
const OF_THE_LAID: &[Statistic] = &[
    Statistic { name: "spread", label: "Spread", measures: &["sigma_md", "sigma_cd"] },
    Statistic {
        name: "half_correlation_length",
        label: "Half correlation length",
        measures: &["half_correlation_length_md", "half_correlation_length_cd"],
    },
    Statistic { name: "chord_over_arc", label: "Chord over arc", measures: &["chord_over_arc"] },
];

/// Every measure alone: what is finer changes each of them, and so its error. Energy checks and a number of nodes are
/// of the discretisation itself.
static OF_MEASURES: LazyLock<Vec<Statistic>> = LazyLock::new(|| {
    MEASURES
        .iter()
        .filter(|measure| measure.group != ENERGY && measure.name != "nodes_in_air")
        .map(|measure| Statistic {
            name: measure.name,
            label: measure.label,
            measures: slice::from_ref(&measure.name),
        })
        .collect()
});

impl Statistic {
    /// Every statistic that is compared in some check.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        OF_THE_END.iter().chain(OF_THE_LAID)
    }

    fn measure(&self, trajectory: &Trajectory) -> f64 {
        let values = self.measures.iter().map(|measure| trajectory.number(measure));
        values.sum::<f64>() / self.measures.len() as f64
    }
}

/// The relative change of a statistic.
#[derive(Clone, Debug)]
pub struct Change {
    /// Which statistic.
    pub statistic: &'static Statistic,
    /// The ratio of the means over the replicates, minus one, with the standard error of the paired ratio, or, with
    /// `size`, the mean difference as a fraction of it;
    /// the values are those of each replicate [-].
    pub estimate: Estimate,
    /// Elements of a quarter of the length [m], and the same change from them; none if they were not simulated.
    pub from_quarter: Option<(f64, Estimate)>,
    /// Whether both refinements show that the error falls with the square of the element length.
    pub is_second_order: bool,
    /// Root mean square of a statistic that has both signs, in its unit: changes are fractions of it. None of one that
    /// keeps its sign, whose changes are fractions of itself.
    pub size: Option<f64>,
}

impl Change {
    /// A change that says nothing about the order of convergence.
    pub const fn new(statistic: &'static Statistic, estimate: Estimate) -> Self {
        Self { statistic, estimate, from_quarter: None, is_second_order: false, size: None }
    }

    /// Whether it is known to no better than a quarter of the size of a statistic that has both signs. Pairs that have
    /// nothing in common know it to a half.
    fn is_lost_in_sampling_error(&self) -> bool {
        self.size.is_some() && self.estimate.standard_error.is_none_or(|error| error > 0.25)
    }

    /// What the finer flights change, from the half on.
    pub fn estimates(&self) -> impl Iterator<Item = &Estimate> {
        [Some(&self.estimate), self.from_quarter.as_ref().map(|(_, estimate)| estimate)].into_iter().flatten()
    }
}

/// What a finer discretisation changes: from it to that of the run.
#[derive(Clone, Debug)]
pub struct FinerCheck {
    /// What is finer.
    pub refined: Refinement,
    /// Scheme of the finer flights.
    pub scheme: Scheme,
    /// Time step of the finer flights [s].
    pub time_step: f64,
    /// Element length of the finer flights [m].
    pub element_length: f64,
    /// Time from the start that both fly [s].
    pub duration: f64,
    /// Whether the fibre is fed.
    pub is_fed: bool,
    /// Whether the finer flights resolve axial waves that the run does not.
    pub is_resolved: bool,
    /// Whether the flights that are compared with the finer ones have the scheme of the run.
    pub has_scheme_of_run: bool,
    /// Number of replicates that are compared.
    pub replicates: usize,
    /// Computing time of the check as a share of that of the run, counted in steps of elements of the same cost [-].
    pub share_of_run: f64,
    /// Rms distance of two paths of the free end, divided by the amplitude; of each replicate [-]. `None` where only
    /// statistics are compared.
    pub path: Option<Estimate>,
    /// The changes of the statistics.
    pub changes: Vec<Change>,
    /// The changes of single measures; none where only paths are compared.
    pub of_measures: Vec<Change>,
}

/// Why a check says nothing of a measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Silence {
    /// The axial waves of the fibre decide the measure, and they are others in another scheme.
    AxialWaves,
    /// The measure has both signs, and the flights of the check are too few to show what changes.
    SamplingError,
}

/// What there is for each refinement, or the reason why there is nothing.
#[derive(Clone, Debug)]
pub struct Refinements<T> {
    /// Of the time step.
    pub step: Result<T, Unchecked>,
    /// Of the elements.
    pub mesh: Result<T, Unchecked>,
}

/// What finer steps and finer elements change.
pub type FinerChecks = Refinements<FinerCheck>;

impl<T> Refinements<T> {
    /// Nothing is compared.
    pub fn none(reason: Unchecked) -> Self {
        Self { step: Err(reason.clone()), mesh: Err(reason) }
    }

    /// All that there are.
    pub fn all(&self) -> impl Iterator<Item = &T> {
        [&self.step, &self.mesh].into_iter().flatten()
    }

    /// What follows from each, that of the time step first.
    pub(super) fn and_then<U>(&self, mut next: impl FnMut(&T) -> Result<U, Unchecked>) -> Refinements<U> {
        let mut next =
            |result: &Result<T, Unchecked>| result.as_ref().map_err(Unchecked::clone).and_then(&mut next);
        Refinements { step: next(&self.step), mesh: next(&self.mesh) }
    }
}

impl FinerCheck {
    /// Whether it is over a part of a fed fibre's run. Such a fibre wanders more slowly than it folds, so
    /// that a part of its laydown may differ by another share than all of it.
    pub fn is_of_a_part(&self, run: &Run) -> bool {
        self.is_fed && self.duration < 0.99 * run.duration()
    }

    /// The change of the statistic that a measure belongs to.
    pub fn change_of_statistic(&self, measure: &str) -> Option<&Change> {
        self.changes.iter().find(|change| change.statistic.measures.contains(&measure))
    }

    /// The change of a measure, or that of its statistic where measures are not compared one by one.
    pub fn change_of(&self, measure: &str) -> Option<&Change> {
        let own = self.of_measures.iter().find(|change| change.statistic.name == measure);
        own.or_else(|| self.change_of_statistic(measure))
    }

    /// Why it cannot say what step or mesh do to a measure; none if it can.
    pub fn silence_about(&self, measure: &str) -> Option<Silence> {
        let change = self.change_of(measure);
        let is_other_scheme = !self.has_scheme_of_run || change.is_none();
        if is_other_scheme && follows_axial_waves(measure, self.is_fed) {
            return Some(Silence::AxialWaves);
        }
        change.is_some_and(Change::is_lost_in_sampling_error).then_some(Silence::SamplingError)
    }

    /// What differs, by its name, `path_difference` or `amplitude_difference`, and the factor from it to the error, as
    /// [`FinerCheck::error_over`].
    pub fn differences(&self) -> impl Iterator<Item = (String, &Estimate, Option<f64>)> {
        let path = self.path.iter().map(|path| ("path", path, self.error_of_step()));
        let changes = self.changes.iter().map(|change| {
            let Change { statistic, estimate, .. } = change;
            (statistic.name, estimate, self.error_over(change))
        });
        path.chain(changes).map(|(name, change, factor)| (format!("{name}_difference"), change, factor))
    }

    /// The error of a statistic over the change that was found [-]; `None` where the order of convergence is not
    /// known, so that the change is the least that can be reported.
    ///
    /// Half the elements leave a quarter of the error, so the change is three quarters of it, where a second
    /// refinement shows this order. A laid fibre folds more finely than its elements, and has no order.
    pub fn error_over(&self, change: &Change) -> Option<f64> {
        match self.refined {
            Refinement::TimeStep => self.error_of_step(),
            Refinement::Elements => change.is_second_order.then_some(4.0 / 3.0),
        }
    }

    /// The same of the time step. Leapfrog that resolves the axial waves stands for the limit itself. Explicit
    /// schemes are unstable unless they resolve all waves, so that their order is that of theory, and the error at most
    /// 2.5 times the change. Implicit tension damps axial waves by as much at half the step, and shows no order.
    /// validation.md has what was found.
    pub fn error_of_step(&self) -> Option<f64> {
        match self.scheme {
            _ if self.refined == Refinement::Elements => None,
            _ if self.is_resolved => Some(1.0),
            Scheme::ImplicitTension => None,
            Scheme::SemiImplicitEuler | Scheme::Leapfrog => Some(2.5),
        }
    }
}

/// Why the step or the mesh of a run is not checked. Its text is a sentence without a full stop.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unchecked {
    /// The case says so.
    #[error("it was not requested")]
    NotAsked,
    /// The results are there before the check has been simulated.
    #[error("these results were written before the check was run")]
    Pending,
    /// It was interrupted.
    #[error("it was stopped")]
    Stopped,
    /// It would cost more than it may.
    #[error(
        "it would take {times:.digits$} times the computing time of the run; write run.checks = \"full\" for it",
        digits = usize::from(*.times < 10.0)
    )]
    Dear {
        /// Computing time of a check of the whole run, in computing times of the run.
        times: f64,
    },
    /// There are too few recorded instants, or the fibre does not come down.
    #[error("the run is too short for it")]
    TooShort,
    /// Another reason.
    #[error("{0}")]
    Other(String),
}

impl Unchecked {
    fn beyond() -> Self {
        Self::Other("the finer runs are larger than the program can simulate".to_owned())
    }

    /// Whether the error of the run is left open though it could be known.
    pub const fn leaves_doubt(&self) -> bool {
        matches!(self, Self::Pending | Self::Stopped | Self::Dear { .. })
    }
}
