//! How far a run is from one with a finer time step or with finer elements.
//!
//! Some fibres fly twice in the same turbulence: as the run does, and with a finer discretisation. What differs comes from
//! the discretisation alone. Paths of single fibres are compared where they stay together, statistics everywhere.

use super::{Computing, Job, Keep, Sample, Trajectory};
use crate::air::EddyModel;
use crate::case::{Case, ERROR_TOLERANCE, MOST_STEPS};
use crate::chain::schemes::Scheme;
use crate::error::Error;
use crate::flight::AirOf;
use crate::lanes::WIDTH;
use crate::line::{Contact, Line};
use crate::statistics::Estimate;

/// Share of the computing time of a run that a check may always take. It is counted in steps of flights, so that
/// it does not depend on the machine.
const SHARE: f64 = 0.1;
/// Steps, times elements, that a check may always take: some tenths of a second. A short run is then checked for its whole
/// duration.
const ALWAYS: f64 = 2e6;
/// The same where shorter flights could say nothing: some seconds.
const AT_MOST: f64 = 2e7;
/// Longest time over which paths are compared [s].
const LONGEST: f64 = 1.0;
/// Fewest recorded instants from which a difference is computed. Runs that are too short for them are not checked.
const FEWEST: u64 = 20;
/// Amplitude below which the fibre does not move but for rounding, as a share of its length.
const ROUNDING: f64 = 1e-12;
/// Time that a fed fibre needs to come down and to forget its start, and the time that is then compared, in `distance /
/// speed`.
const COMES_DOWN: f64 = 2.0;
const COMPARED: f64 = 2.0;
/// Part of the stability limit up to which finer elements are flown.
const PART_OF_LIMIT: f64 = 0.75;
/// Time over which the motion of a fibre of fixed length is compared at least, in the time in which the air passes it.
const PASSES: f64 = 5.0;

/// What is finer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refined {
    /// The time step.
    TimeStep,
    /// The elements.
    Elements,
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

impl Statistic {
    /// Every statistic that is compared in some check.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        OF_THE_END.iter().chain(OF_THE_LAID)
    }

    fn of(&self, trajectory: &Trajectory) -> f64 {
        let values = self.measures.iter().map(|measure| trajectory.number(measure));
        values.sum::<f64>() / self.measures.len() as f64
    }
}

/// The relative change of a statistic.
#[derive(Clone, Debug)]
pub struct Change {
    /// Which statistic.
    pub statistic: &'static Statistic,
    /// The ratio of the means over the replicates, minus one, with the standard error of the paired ratio; the values are
    /// those of each replicate [-].
    pub estimate: Estimate,
}

/// What a finer discretisation changes: from it to that of the run.
#[derive(Clone, Debug)]
pub struct FinerCheck {
    /// What is finer.
    pub refined: Refined,
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
    /// Number of replicates that are compared.
    pub replicates: usize,
    /// Computing time of the check as a share of that of the run, counted in steps of elements [-].
    pub share_of_run: f64,
    /// Rms distance of two paths of the free end, divided by the amplitude; of each replicate [-]. `None` where only
    /// statistics are compared.
    pub path: Option<Estimate>,
    /// The changes of the statistics.
    pub changes: Vec<Change>,
}

/// What finer steps and finer elements change, or the reason why that is not known, as a part of a sentence.
#[derive(Clone, Debug)]
pub struct FinerChecks {
    /// Of the time step.
    pub step: Result<FinerCheck, String>,
    /// Of the elements.
    pub mesh: Result<FinerCheck, String>,
}

impl FinerCheck {
    /// What differs, by its name: `path_difference`, `amplitude_difference`.
    pub fn differences(&self) -> impl Iterator<Item = (String, &Estimate)> {
        let path = self.path.iter().map(|path| ("path", path));
        let changes = self.changes.iter().map(|change| (change.statistic.name, &change.estimate));
        path.chain(changes).map(|(name, of)| (format!("{name}_difference"), of))
    }

    /// The error of a statistic over the change that was found [-]; `None` where the order of convergence is not known.
    ///
    /// Half the elements leave a quarter of the error, so the change is three quarters of it: second order was found for
    /// fibres of fixed length. A laid fibre folds more finely than its elements, and has no order. The error of the step was
    /// at most 2.5 times what half of it changes. Leapfrog that resolves the axial waves stands for the limit itself.
    /// validation.md has what was found.
    pub fn error_over_change(&self) -> Option<f64> {
        match self.refined {
            Refined::TimeStep if self.is_resolved => Some(1.0),
            Refined::TimeStep => Some(2.5),
            Refined::Elements if self.is_fed => None,
            Refined::Elements => Some(4.0 / 3.0),
        }
    }
}

impl FinerChecks {
    /// Nothing was compared.
    pub fn none(reason: &str) -> Self {
        Self { step: Err(reason.to_owned()), mesh: Err(reason.to_owned()) }
    }
}

/// What is flown for a check.
#[derive(Clone, Debug)]
pub struct FinerPlan {
    /// What is finer.
    pub refined: Refined,
    /// As the run; `None` if the paths of the run itself are compared.
    own: Option<Case>,
    fine: Case,
    /// Until when the air has to last [s].
    horizon: f64,
    /// Number of replicates, from the first on. A flight costs the same for all its lanes.
    pub replicates: u64,
    /// Computing time as a share of that of the run [-].
    pub share_of_run: f64,
}

/// The plans of the checks of a run, or the reasons why there are none.
#[derive(Clone, Debug)]
pub struct FinerPlans {
    /// Of the time step.
    pub step: Result<FinerPlan, String>,
    /// Of the elements.
    pub mesh: Result<FinerPlan, String>,
}

impl FinerPlans {
    /// The plans for a case.
    pub fn of(case: &Case) -> Self {
        let step = if case.line.is_some() { step_of_the_laid(case) } else { step_of_a_path(case) };
        Self { step, mesh: mesh(case) }
    }

    /// No checks.
    pub fn none(reason: &str) -> Self {
        Self { step: Err(reason.to_owned()), mesh: Err(reason.to_owned()) }
    }

    /// The plans that there are.
    pub fn all(&self) -> impl Iterator<Item = &FinerPlan> {
        [&self.step, &self.mesh].into_iter().flatten()
    }

    /// Number of steps of single elements of all checks.
    pub fn element_steps(&self) -> f64 {
        let of = |plan: &FinerPlan| {
            (plan.own.as_ref().map_or(0.0, cost) + cost(&plan.fine)) * plan.replicates as f64
        };
        self.all().map(of).sum()
    }

    /// Number of flights of all checks.
    pub fn flights(&self) -> usize {
        self.all().map(|plan| plan.flights().count()).sum()
    }

    /// Number of fibre steps of all checks, as in [`Computing::fibre_steps`].
    pub fn fibre_steps(&self) -> u64 {
        self.all().map(FinerPlan::fibre_steps).sum()
    }

    /// Computing time of all checks as a share of that of the run, counted in steps of elements [-].
    pub fn share_of_run(&self) -> f64 {
        self.all().map(|plan| plan.share_of_run).sum()
    }
}

/// Steps of the elements of a flight.
fn cost(case: &Case) -> f64 {
    case.run.steps as f64 * case.fibre.elements as f64
}

/// Steps of the elements of all flights of a run.
fn cost_of_run(case: &Case) -> f64 {
    cost(case) * case.run.replicates.div_ceil(WIDTH as u64) as f64
}

fn too_short() -> String {
    "the run is too short for it".to_owned()
}

/// Flies the paths of the first replicates again with half the step.
fn step_of_a_path(case: &Case) -> Result<FinerPlan, String> {
    let run = &case.run;
    // Half the step takes two steps for one.
    let affordable = 0.5 * (SHARE * cost_of_run(case)).max(ALWAYS) / case.fibre.elements as f64;
    let most = affordable.min(LONGEST / run.time_step).min(run.steps as f64);
    let instants = (most / run.output_steps as f64 * (1.0 + 1e-9)) as u64;
    if instants < FEWEST || 2 * instants * run.output_steps > MOST_STEPS {
        return Err(too_short());
    }
    let mut fine = case.clone();
    fine.run.time_step *= 0.5;
    fine.run.output_steps *= 2;
    fine.run.steps = instants * fine.run.output_steps;
    fine.run.spin_up_steps = 0;
    let share_of_run = cost(&fine) / cost_of_run(case);
    let replicates = run.replicates.min(WIDTH as u64);
    let horizon = case.air_horizon();
    Ok(FinerPlan { refined: Refined::TimeStep, own: None, fine, horizon, replicates, share_of_run })
}

/// Compares what is laid with what leapfrog lays, with steps in which the axial waves are resolved. That is another scheme,
/// and close to its limit for short steps: its error falls with the square of the step. Half of a long step would say
/// little, because implicit tension damps axial waves by as much at half the step.         theory.md (58)
fn step_of_the_laid(case: &Case) -> Result<FinerPlan, String> {
    let mut fine = case.clone();
    let slides = case.line.is_some_and(|line| line.contact != Contact::Stick);
    fine.run.scheme = Scheme::Leapfrog;
    let resolved = 0.5 * shortest_limit(&fine);
    if slides || resolved >= 0.99 * case.run.time_step {
        // Sliding fibres need implicit tension. Steps that resolve the axial waves are halved as any others.
        fine.run.scheme = case.run.scheme;
    }
    fine.set_time_step(resolved.min(0.5 * case.run.time_step));
    statistics(Refined::TimeStep, case, case.clone(), fine)
}

/// Compares the statistics of the case's elements with those of half their length, both with the same long steps of
/// implicit tension: the elements matter whatever the scheme.
fn mesh(case: &Case) -> Result<FinerPlan, String> {
    let (mut own, mut fine) = (case.clone(), case.clone());
    fine.fibre.elements *= 2;
    fine.run.scheme = Scheme::ImplicitTension;
    let suggested = fine.suggested_time_step(ERROR_TOLERANCE, case.run.duration()).0;
    // Bending limits the step with the square of the elements, and then the longest steps are long enough.
    let suggested = match case.line {
        Some(_) => suggested,
        None => {
            own.run.scheme = Scheme::ImplicitTension;
            let accurate = own.suggested_time_step(ERROR_TOLERANCE, case.run.duration()).0;
            suggested.max(accurate.min(PART_OF_LIMIT * shortest_limit(&fine)))
        }
    };
    let is_implicit = case.run.scheme == Scheme::ImplicitTension;
    let longest = if is_implicit { suggested.min(case.run.time_step) } else { suggested };
    // Whole steps from one recorded instant to the next.
    let interval = case.run.output_interval();
    let step =
        if case.line.is_some() { longest } else { interval / (interval / longest - 1e-9).ceil().max(1.0) };
    own.run.scheme = Scheme::ImplicitTension;
    fine.set_time_step(step);
    own.set_time_step(fine.run.time_step);
    statistics(Refined::Elements, case, own, fine)
}

fn shortest_limit(case: &Case) -> f64 {
    let limits = case.stable_step_limits().into_iter();
    limits.map(|limit| limit.limit).fold(f64::INFINITY, f64::min)
}

/// A plan that compares statistics, over as much time as is worth its computing time.
fn statistics(refined: Refined, case: &Case, mut own: Case, mut fine: Case) -> Result<FinerPlan, String> {
    let all = case.run.duration();
    let per_second = |case: &Case| case.fibre.elements as f64 / case.run.time_step;
    let per_second = per_second(&own) + per_second(&fine);
    let (spin_up, least) = match &case.line {
        Some(line) => {
            let way = way(line);
            ((COMES_DOWN * way).min(case.run.spin_up()), (COMES_DOWN + COMPARED) * way)
        }
        None => {
            let passes =
                if case.air.velocity > 0.0 { PASSES * case.fibre.length / case.air.velocity } else { 0.0 };
            (case.run.spin_up(), case.run.spin_up() + passes)
        }
    };
    // A fed fibre stays close to its pair, so little of it says enough.
    let usual = if case.line.is_some() { 0.0 } else { ALWAYS };
    let share = SHARE * cost_of_run(case);
    let least = least.min(all);
    if least * per_second > AT_MOST.max(share) {
        let times = least * per_second / cost_of_run(case);
        return Err(format!("it would take about {:.0} times the run's computing time", times.ceil()));
    }
    let duration = (share.max(usual) / per_second).max(least).min(all);
    for of in [&mut own, &mut fine] {
        let steps = |time: f64| (time / of.run.time_step * (1.0 + 1e-9)) as u64;
        (of.run.steps, of.run.spin_up_steps) = (steps(duration).max(1), steps(spin_up));
        of.run.output_steps = of.run.output_steps.min(of.run.steps);
        if of.run.steps > MOST_STEPS || of.check().is_err() {
            return Err("the finer flights are beyond what the program can fly".to_owned());
        }
    }
    if duration < spin_up || fine.run.steps / fine.run.output_steps < FEWEST && case.line.is_none() {
        return Err(too_short());
    }
    if case.line.as_ref().is_some_and(|line| duration < (COMES_DOWN + COMPARED) * way(line) * (1.0 - 1e-9)) {
        return Err(too_short());
    }
    let share_of_run = (cost(&own) + cost(&fine)) / cost_of_run(case);
    // Replicates of a record need a record that is long enough.
    let replicates =
        if case.air.records.is_empty() { WIDTH as u64 } else { case.run.replicates.min(WIDTH as u64) };
    let horizon = case.air_horizon();
    Ok(FinerPlan { refined, own: Some(own), fine, horizon, replicates, share_of_run })
}

/// Time in which a fed fibre comes down at the speed of its feed [s].
fn way(line: &Line) -> f64 {
    line.distance / line.feed_speed
}

/// What one flight of a check has flown: the numbers of its fibres, and the paths if they are compared.
#[derive(Debug, Default)]
pub(super) struct Flight {
    trajectories: Vec<Trajectory>,
    paths: Vec<Path>,
}

impl Flight {
    /// Numbers and samples of a flight of the run itself.
    pub(super) const fn of_run(trajectories: Vec<Trajectory>) -> Self {
        Self { trajectories, paths: Vec::new() }
    }

    /// The trajectories.
    pub(super) fn into_trajectories(self) -> Vec<Trajectory> {
        self.trajectories
    }
}

/// One flight of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flown {
    Own,
    Fine,
}

impl FinerPlan {
    /// Number of fibre steps, as in [`Computing::fibre_steps`].
    pub fn fibre_steps(&self) -> u64 {
        let own = self.own.as_ref().map_or(0, |own| own.run.steps);
        (own + self.fine.run.steps) * self.replicates
    }

    fn is_resolved(&self) -> bool {
        let own = self.own.as_ref();
        own.is_some_and(|own| self.refined == Refined::TimeStep && own.run.scheme == Scheme::ImplicitTension)
    }

    /// The flights.
    pub(super) fn flights(&self) -> impl Iterator<Item = Flown> {
        self.own.iter().map(|_| Flown::Own).chain([Flown::Fine])
    }

    /// Flies one of them. The recorded instants are not kept, but for the paths that are compared.
    pub(super) fn fly(&self, which: Flown, computing: Computing<'_>) -> Result<Flight, Error> {
        let case = self.own.as_ref().filter(|_| which == Flown::Own).unwrap_or(&self.fine);
        let jobs: Vec<Job<'_>> = (0..self.replicates).map(|replicate| Job { case, replicate }).collect();
        // A carried pattern has a signal for each element. Both feel the one of the finer elements.
        let carried = case.line.is_none() && matches!(case.air.eddies, EddyModel::Convected { .. });
        let of = if carried { &self.fine } else { case };
        let air = AirOf { case: of, horizon: self.horizon };
        let computing = Computing { laid: None, ..computing };
        let mut trajectories = super::trajectory::fly_in_air(&jobs, Keep::NUMBERS, air, computing)?;
        let mut paths = Vec::new();
        for trajectory in &mut trajectories {
            let samples = std::mem::take(&mut trajectory.samples);
            if self.own.is_none() {
                paths.push(path(&samples, usize::MAX));
            }
        }
        Ok(Flight { trajectories, paths })
    }

    /// The path that is compared of a trajectory of the run; empty if no path is.
    pub(super) fn path(&self, trajectory: &Trajectory) -> Path {
        if self.own.is_some() || trajectory.replicate >= self.replicates {
            return Path::new();
        }
        let instants = self.fine.run.steps / self.fine.run.output_steps;
        path(&trajectory.samples, instants as usize)
    }

    /// Compares. An error is the reason why nothing can be said.
    pub(super) fn compare(&self, paths: &[Path], own: &Flight, fine: &Flight) -> Result<FinerCheck, String> {
        let still = || {
            let fed = self.fine.line.is_some();
            if fed { "the fibre laid nothing down" } else { "the free end does not move across the flow" }
                .to_owned()
        };
        let least = ROUNDING * self.fine.fibre.length;
        let mut check = FinerCheck {
            refined: self.refined,
            scheme: self.fine.run.scheme,
            time_step: self.fine.run.time_step,
            element_length: self.fine.fibre.rest_length(),
            duration: self.fine.run.duration(),
            is_fed: self.fine.line.is_some(),
            is_resolved: self.is_resolved(),
            replicates: fine.trajectories.len(),
            share_of_run: self.share_of_run,
            path: None,
            changes: Vec::new(),
        };
        if self.own.is_none() {
            let (mut apart, mut amplitudes) = (Vec::new(), Vec::new());
            for (own, fine) in paths.iter().zip(&fine.paths) {
                let fine = &fine[..own.len().min(fine.len())];
                let amplitude = amplitude(fine);
                if amplitude > least {
                    apart.push(rms_distance(own, fine) / amplitude);
                    amplitudes.push(self::amplitude(own) / amplitude - 1.0);
                }
            }
            if apart.is_empty() || apart.iter().chain(&amplitudes).any(|value| !value.is_finite()) {
                return Err(still());
            }
            check.replicates = apart.len();
            check.path = Some(Estimate::of(apart));
            check.changes = vec![Change { statistic: &OF_THE_END[0], estimate: Estimate::of(amplitudes) }];
            return Ok(check);
        }
        let statistics = if self.fine.line.is_some() { OF_THE_LAID } else { OF_THE_END };
        for statistic in statistics {
            let pairs = own
                .trajectories
                .iter()
                .zip(&fine.trajectories)
                .map(|(own, fine)| [statistic.of(own), statistic.of(fine)]);
            let pairs: Vec<[f64; 2]> =
                pairs.filter(|pair| pair.iter().all(|value| value.is_finite())).collect();
            // Of a fibre that does not move, rounding has no meaning.
            let moves = statistic.name == "frequency" || pairs.iter().all(|pair| pair[1] > least);
            if let Some(estimate) = ratio(&pairs).filter(|_| moves) {
                check.changes.push(Change { statistic, estimate });
            }
        }
        let moves = check.changes.first().is_some_and(|change| change.statistic == &statistics[0]);
        if moves { Ok(check) } else { Err(still()) }
    }
}

/// Ratio of the means minus one, from pairs of the same turbulence. Its standard error is that of the ratio estimator: of
/// the mean of `aᵢ − R bᵢ`, over the mean of `b`. The values are `R − 1 + (aᵢ − R bᵢ)/b̄`.           theory.md (58)
fn ratio(pairs: &[[f64; 2]]) -> Option<Estimate> {
    let sum = |which: usize| pairs.iter().map(|pair| pair[which]).sum::<f64>();
    let ratio = sum(0) / sum(1);
    let mean = sum(1) / pairs.len() as f64;
    let values: Vec<f64> = pairs.iter().map(|[a, b]| ratio - 1.0 + (a - ratio * b) / mean).collect();
    (!values.is_empty() && values.iter().all(|value| value.is_finite())).then(|| Estimate::of(values))
}

/// The position across the flow at the recorded instants after the start [m].
pub(super) type Path = Vec<[f64; 2]>;

fn path(samples: &[Sample], instants: usize) -> Path {
    samples.iter().skip(1).take(instants).map(|sample| [sample.end.y, sample.end.z]).collect()
}

/// Rms distance of a path from its mean [m].
fn amplitude(path: &[[f64; 2]]) -> f64 {
    let count = path.len() as f64;
    let mean = [0, 1].map(|axis| path.iter().map(|point| point[axis]).sum::<f64>() / count);
    rms_distance(path, &vec![mean; path.len()])
}

fn rms_distance(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2));
    (squares.sum::<f64>() / a.len() as f64).sqrt()
}
