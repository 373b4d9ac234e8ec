//! What is simulated again for the checks of a run, and how much of it is worth its computing time.

use super::{Refinement, Refinements, Unchecked};
use spunlaid_air::EddyModel;
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Case, Checks, Contact, ERROR_TOLERANCE, Line, MOST_STEPS};
use spunlaid_ground::WIDTH;

/// Largest share of the computing time of a run that all its checks take together, and the share that each
/// takes if that is enough for it. They are counted in steps of elements, so that they do not depend on the
/// machine; the turbulence that each flight makes again is counted as steps too.
const SHARE_OF_ALL: f64 = 0.2;
const SHARE: f64 = 0.1;
/// Computing time of a step with implicit tension, in steps of the explicit schemes: 1.75 to 1.95 were measured.
const IMPLICIT: f64 = 1.85;
/// Longest time over which paths are compared [s].
const LONGEST: f64 = 1.0;
/// Fewest recorded instants from which a difference is computed. Runs that are too short for them are not checked.
const FEWEST: u64 = 20;
/// Time that a fed fibre needs to come down and to forget its start, and the time that is then compared, in `distance /
/// speed`.
const COMES_DOWN: f64 = 2.0;
const COMPARED: f64 = 2.0;
/// Part of the stability limit up to which finer elements are simulated.
const PART_OF_LIMIT: f64 = 0.75;
/// Time over which the motion of a fibre of fixed length is compared at least, in the time in which the air passes it.
const PASSES: f64 = 5.0;
/// Part of an eddy that an element is long at most where the error of a mesh has an order. Longer ones cannot follow
/// the eddies: of Table 1 the frequency goes up with the first halvings and down with the next ones.
const OF_AN_EDDY: f64 = 0.25;
/// Most recorded instants at which paths are compared, so that they take little memory.
const MOST_COMPARED: u64 = 1 << 14;

/// What is simulated for a check.
#[derive(Clone, Debug)]
pub struct FinerPlan {
    /// What is finer.
    pub refined: Refinement,
    /// The case with the step and mesh of the run, to compare with; `None` if the paths of the run itself are compared.
    pub(super) coarse: Option<Case>,
    pub(super) fine: Case,
    /// The case with elements of a quarter of the length, if it is simulated too.
    pub(super) finest: Option<Case>,
    /// Whether what is compared with the finer flights has the scheme of the run.
    pub(super) has_scheme_of_run: bool,
    /// Whether the elements of the run are short enough beside an eddy for their error to have an order.
    pub(super) resolves_eddies: bool,
    /// One recorded instant of the run in this many is compared.
    pub(super) stride: u64,
    /// Until when the air has to last [s].
    pub(super) horizon: f64,
    /// Number of replicates, from the first on. A flight costs the same for all its lanes.
    pub replicates: u64,
    /// Computing time as a share of that of the run, counted in steps of elements of the same cost [-].
    pub share_of_run: f64,
}

/// The plans of the checks of a run.
pub type FinerPlans = Refinements<FinerPlan>;

impl FinerPlans {
    /// The plans for a case, as far as its [`Checks`] go.
    pub fn for_case(case: &Case) -> Self {
        if case.run.checks == Checks::None {
            return Self::none(Unchecked::NotAsked);
        }
        let all = Budget::of_all(case);
        let step = if case.line.is_some() { step_of_the_laid(case, all) } else { step_of_a_path(case, all) };
        let mesh = mesh(case, all.after(step.as_ref().ok()));
        Self { step, mesh }
    }

    /// Number of fibre steps of all checks, as in
    /// [`RunContext::done`](spunlaid_ground::RunContext::done).
    pub fn fibre_steps(&self) -> u64 {
        self.all().map(FinerPlan::fibre_steps).sum()
    }

    /// Computing time of all checks as a share of that of the run, counted in steps of elements of the same cost [-].
    pub fn share_of_run(&self) -> f64 {
        self.all().map(|plan| plan.share_of_run).sum()
    }
}

/// What checks may take.
#[derive(Clone, Copy, Debug)]
enum Budget {
    /// This share of the run's computing time.
    Share(f64),
    /// As much as the whole run with a finer discretisation.
    Whole,
}

impl Budget {
    fn of_all(case: &Case) -> Self {
        if case.run.checks == Checks::Full { Self::Whole } else { Self::Share(SHARE_OF_ALL) }
    }

    /// What is left beside another check.
    fn after(self, other: Option<&FinerPlan>) -> Self {
        match self {
            Self::Share(share) => Self::Share(share - other.map_or(0.0, |other| other.share_of_run)),
            Self::Whole => Self::Whole,
        }
    }

    /// The part of a run that is simulated again.
    ///
    /// * `takes` – what a part takes, as a share of the computing time of the run; more for a larger part
    /// * `least` – the smallest part that says something
    fn part(self, takes: impl Fn(f64) -> f64, least: f64) -> Result<f64, Unchecked> {
        let least = least.min(1.0);
        match self {
            Self::Whole => Ok(1.0),
            Self::Share(most) if takes(least) > most => Err(Unchecked::Dear { times: takes(1.0) }),
            Self::Share(_) if takes(1.0) <= SHARE => Ok(1.0),
            Self::Share(_) if takes(least) >= SHARE => Ok(least),
            Self::Share(_) => Ok(largest(takes, least)),
        }
    }
}

/// The largest part that takes no more than its share. Halving finds it, because the air is made window by
/// window, so that the time that a part takes has jumps.
fn largest(takes: impl Fn(f64) -> f64, least: f64) -> f64 {
    let (mut enough, mut more) = (least, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (enough + more);
        *if takes(middle) <= SHARE { &mut enough } else { &mut more } = middle;
    }
    enough
}

/// Computing time of a flight until a time [s], in steps of elements with the explicit schemes.
///
/// * `air` – the case whose air is made for it
fn cost(case: &Case, air: &Case, time: f64) -> f64 {
    let relative = if case.run.scheme == Scheme::ImplicitTension { IMPLICIT } else { 1.0 };
    time / case.run.time_step * case.fibre.elements as f64 * relative + air.cost_of_air(time)
}

/// The same of all flights of a run.
fn cost_of_run(case: &Case) -> f64 {
    cost(case, case, case.run.duration()) * case.flights() as f64
}

/// Flies the paths of the first replicates again with half the step.
fn step_of_a_path(case: &Case, budget: Budget) -> Result<FinerPlan, Unchecked> {
    let run = &case.run;
    let recorded = run.steps.min((LONGEST / run.time_step * (1.0 + 1e-9)) as u64) / run.output_steps;
    if recorded < FEWEST {
        return Err(Unchecked::TooShort);
    }
    let mut fine = case.clone();
    fine.run.time_step *= 0.5;
    let longest = recorded as f64 * run.output_interval();
    let of_run = cost_of_run(case);
    let takes = |part: f64| cost(&fine, case, part * longest) / of_run;
    let part = budget.part(takes, FEWEST as f64 / recorded as f64)?;
    let instants = ((part * recorded as f64 * (1.0 + 1e-9)) as u64).max(FEWEST);
    let stride = instants.div_ceil(MOST_COMPARED).max(1);
    if 2 * instants * run.output_steps > MOST_STEPS {
        return Err(Unchecked::beyond());
    }
    fine.run.output_steps *= 2 * stride;
    fine.run.steps = instants / stride * fine.run.output_steps;
    fine.run.spin_up_steps = 0;
    let share_of_run = cost(&fine, case, fine.run.duration()) / of_run;
    let replicates = run.replicates.min(WIDTH as u64);
    let horizon = case.air_horizon();
    Ok(FinerPlan {
        refined: Refinement::TimeStep,
        coarse: None,
        fine,
        finest: None,
        has_scheme_of_run: true,
        resolves_eddies: false,
        stride,
        horizon,
        replicates,
        share_of_run,
    })
}

/// Compares what is laid with what leapfrog lays, with steps in which the axial waves are resolved. That is
/// another scheme, and close to its limit for short steps: its error falls with the square of the step. Half
/// of a long step would say little, because implicit tension damps axial waves by as much at half the step.
///                                                                                             theory.md (58)
fn step_of_the_laid(case: &Case, budget: Budget) -> Result<FinerPlan, Unchecked> {
    let mut fine = case.clone();
    let slides = case.line.is_some_and(|line| line.contact != Contact::Stick);
    fine.run.scheme = Scheme::Leapfrog;
    let resolved = 0.5 * shortest_limit(&fine);
    if slides || resolved >= 0.99 * case.run.time_step {
        // Sliding fibres need implicit tension. Steps that resolve the axial waves are halved as any others.
        fine.run.scheme = case.run.scheme;
    }
    fine.set_time_step(resolved.min(0.5 * case.run.time_step));
    statistics(Refinement::TimeStep, case, vec![case.clone(), fine], budget)
}

/// Compares the statistics of the case's elements with those of half their length, and of a quarter of it if that can
/// be paid: two refinements show the order of the error. A laid fibre has none, and a carried pattern is made for
/// elements of two lengths at most.
fn mesh(case: &Case, budget: Budget) -> Result<FinerPlan, Unchecked> {
    let one = case.line.is_some() || matches!(case.air.eddies, EddyModel::Convected { .. });
    let twice = (!one).then(|| refined(case, 2, budget)).and_then(Result::ok);
    twice.map_or_else(|| refined(case, 1, budget), Ok)
}

/// The same, with elements that are halved so many times. All fly with the same long steps of implicit tension: the
/// elements matter whatever the scheme.
fn refined(case: &Case, halvings: u32, budget: Budget) -> Result<FinerPlan, Unchecked> {
    let (mut coarse, mut fine) = (case.clone(), case.clone());
    fine.fibre.elements *= 1 << halvings;
    fine.run.scheme = Scheme::ImplicitTension;
    let suggested = fine.suggested_time_step(ERROR_TOLERANCE, case.run.duration()).0;
    // Bending limits the step with the square of the elements, and then the longest steps are long enough.
    let suggested = match case.line {
        Some(_) => suggested,
        None => {
            coarse.run.scheme = Scheme::ImplicitTension;
            let accurate = coarse.suggested_time_step(ERROR_TOLERANCE, case.run.duration()).0;
            suggested.max(accurate.min(PART_OF_LIMIT * shortest_limit(&fine)))
        }
    };
    let is_implicit = case.run.scheme == Scheme::ImplicitTension;
    let longest = if is_implicit { suggested.min(case.run.time_step) } else { suggested };
    // Whole steps from one recorded instant to the next.
    let interval = case.run.output_interval();
    let step =
        if case.line.is_some() { longest } else { interval / (interval / longest - 1e-9).ceil().max(1.0) };
    fine.set_time_step(step);
    coarse.run.scheme = Scheme::ImplicitTension;
    // An element of each mesh is fed in its own number of these steps.
    let mesh = |halved: u32| {
        let mut mesh = coarse.clone();
        mesh.fibre.elements <<= halved;
        mesh.set_time_step(fine.run.time_step);
        mesh
    };
    let meshes = (0..=halvings).map(mesh).collect();
    statistics(Refinement::Elements, case, meshes, budget)
}

fn shortest_limit(case: &Case) -> f64 {
    let limits = case.stable_step_limits().into_iter();
    limits.map(|limit| limit.limit).fold(f64::INFINITY, f64::min)
}

/// A plan that compares statistics, over as much time as is worth its computing time.
///
/// * `flights` – as the run and finer, the finest one last
fn statistics(
    refined: Refinement,
    case: &Case,
    mut flights: Vec<Case>,
    budget: Budget,
) -> Result<FinerPlan, Unchecked> {
    let all = case.run.duration();
    let of_run = cost_of_run(case);
    let takes = |flights: &[Case], time: &dyn Fn(&Case) -> f64| {
        let finest = flights.last().unwrap_or(case);
        flights.iter().map(|one| cost(one, case_of_air(one, finest), time(one))).sum::<f64>() / of_run
    };
    let (comes_down, least) = match &case.line {
        Some(line) => (COMES_DOWN * way(line), (COMES_DOWN + COMPARED) * way(line)),
        None => {
            let passes =
                if case.air.velocity > 0.0 { PASSES * case.fibre.length / case.air.velocity } else { 0.0 };
            (case.run.spin_up(), (case.run.spin_up() + passes).min(all))
        }
    };
    if least > all * (1.0 + 1e-9) {
        return Err(Unchecked::TooShort);
    }
    let duration = all * budget.part(|part| takes(&flights, &|_| part * all), least / all)?;
    // A part of a run leaves out no more than the way down; the whole leaves out what the run leaves out.
    let spin_up = if duration < all { comes_down.min(case.run.spin_up()) } else { case.run.spin_up() };
    for case in &mut flights {
        let steps = |time: f64| (time / case.run.time_step * (1.0 + 1e-9)) as u64;
        (case.run.steps, case.run.spin_up_steps) = (steps(duration).max(1), steps(spin_up));
        case.run.output_steps = case.run.output_steps.min(case.run.steps);
        if case.run.steps > MOST_STEPS || case.check().is_err() {
            return Err(Unchecked::beyond());
        }
    }
    let share_of_run = takes(&flights, &|one| one.run.duration());
    let mut flights = flights.into_iter();
    let coarse = flights.next();
    let fine = flights.next().unwrap_or_else(|| case.clone());
    let finest = flights.next();
    let instants = fine.run.steps / fine.run.output_steps;
    if duration < spin_up || instants < FEWEST && case.line.is_none() {
        return Err(Unchecked::TooShort);
    }
    // Replicates of a record need a record that is long enough.
    let replicates =
        if case.air.records.is_empty() { WIDTH as u64 } else { case.run.replicates.min(WIDTH as u64) };
    let resolves_eddies = case.fibre.rest_length() <= OF_AN_EDDY * case.air.length_scale * (1.0 + 1e-9);
    let horizon = case.air_horizon();
    let has_scheme_of_run = coarse.as_ref().is_some_and(|coarse| coarse.run.scheme == case.run.scheme);
    Ok(FinerPlan {
        refined,
        coarse,
        fine,
        finest,
        has_scheme_of_run,
        resolves_eddies,
        stride: 1,
        horizon,
        replicates,
        share_of_run,
    })
}

/// The case whose air a flight of a check has: a carried pattern has a signal for each element, and both
/// flights feel the one of the finer elements.
pub(super) fn case_of_air<'a>(own: &'a Case, fine: &'a Case) -> &'a Case {
    let carried = own.line.is_none() && matches!(own.air.eddies, EddyModel::Convected { .. });
    if carried { fine } else { own }
}

/// Time in which a fed fibre comes down at the speed of its feed [s].
fn way(line: &Line) -> f64 {
    line.distance / line.feed_speed
}

impl FinerPlan {
    /// The cases that are simulated: as the run where its own paths are not compared, and finer.
    pub(super) fn flights(&self) -> impl Iterator<Item = &Case> {
        self.coarse.iter().chain([&self.fine]).chain(&self.finest)
    }

    /// Number of fibre steps, as in [`RunContext::done`](spunlaid_ground::RunContext::done).
    pub fn fibre_steps(&self) -> u64 {
        self.flights().map(|case| case.run.steps).sum::<u64>() * self.replicates
    }

    pub(super) fn is_resolved(&self) -> bool {
        let coarse = self.coarse.as_ref();
        coarse.is_some_and(|coarse| {
            self.refined == Refinement::TimeStep && coarse.run.scheme == Scheme::ImplicitTension
        })
    }
}
