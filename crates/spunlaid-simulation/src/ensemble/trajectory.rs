//! The trajectory of one replicate.

use super::{EndPath, Recorder, Shapes};
use crate::observe::{FibreMeasure, Observation, Observers, Sample};
use spunlaid_air::Flow;
use spunlaid_fibre::{Case, Flight, Job, LaidPoint, SurroundingRun};
use spunlaid_ground::{Error, Isa, RunContext, Value, WIDTH};
use std::sync::atomic::Ordering;
use std::time::Instant;

/// The stored results of one replicate.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// Number of the replicate in its case, from 0.
    pub replicate: u64,
    /// Its measures, in the order of the declarations.
    pub values: Vec<(&'static FibreMeasure, Value)>,
    /// End node and energies at the recorded instants, including the start; empty unless asked for.
    pub samples: Vec<Sample>,
    /// Where the free end was, of the first fibre of each flight; empty if curves are not measured, and of a fed fibre.
    pub path: EndPath,
    /// The whole fibre at some of the recorded instants; empty unless asked for.
    pub shapes: Shapes,
    /// The first points that a fed fibre has laid after the spin-up, of the replicates whose shapes are stored.
    pub laid: Vec<LaidPoint>,
}

/// Recorded instants of a fibre that are passed on together, so that threads seldom wait for one another.
const TOGETHER: usize = 64;
/// Most points of a laid fibre that are kept with its shapes.
const LAID_WITH_SHAPES: usize = 16_384;

impl Trajectory {
    /// A number by its measure's name, in SI units; NaN if there is none.
    pub fn number(&self, name: &str) -> f64 {
        let found = self.values.iter().find(|(measure, _)| measure.name == name);
        match found {
            Some((_, Value::Number(value))) => *value,
            _ => f64::NAN,
        }
    }
}

/// What to store of an ensemble besides the numbers of each fibre.
#[derive(Clone, Copy, Debug)]
pub struct Recorded<'a> {
    /// Whether curves are measured too: profiles, series, spectra, and the path of a free end.
    pub curves: bool,
    /// Whether the recorded instants are kept in memory.
    pub samples: bool,
    /// The whole shapes that are stored.
    pub shapes: KeepShapes,
    /// Takes what is recorded of the fibres. Flights of several cases take none.
    pub recorder: Option<&'a dyn Recorder>,
}

impl Recorded<'_> {
    /// Numbers only.
    pub const NUMBERS: Self =
        Self { curves: false, samples: false, shapes: KeepShapes::NONE, recorder: None };
    /// Numbers and the recorded instants.
    pub const SAMPLES: Self = Self { samples: true, ..Self::NUMBERS };
    /// Curves, but no recorded instants and no shapes.
    pub const CURVES: Self = Self { curves: true, ..Self::NUMBERS };
}

/// Which shapes of an ensemble to store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeepShapes {
    /// Number of replicates, from the first on.
    pub replicates: u64,
    /// Stores one shape for this number of recorded instants.
    pub every: u64,
}

impl KeepShapes {
    /// No shapes.
    pub const NONE: Self = Self { replicates: 0, every: 1 };

    /// As many shapes as fit into `positions` node positions, of one to eight replicates. If they do not fit, the
    /// number of replicates is reduced first, then the number of instants. A case that says how many shapes are kept
    /// ([`Run::shapes`](spunlaid_fibre::Run)) has at least one replicate with so many.
    pub fn within(case: &Case, positions: u64) -> Self {
        let nodes = case.fibre.elements as u64 + 1;
        let instants = case.run.steps / case.run.output_steps + 1;
        if let Some(asked) = case.run.shapes {
            if asked == 0 {
                return Self::NONE;
            }
            let every = instants.div_ceil(asked);
            let one = nodes.saturating_mul(instants.div_ceil(every));
            let replicates = (positions / one).clamp(1, WIDTH as u64).min(case.run.replicates);
            return Self { replicates, every };
        }
        let one = nodes.saturating_mul(instants);
        let replicates = (positions / one).clamp(1, WIDTH as u64).min(case.run.replicates);
        Self { replicates, every: one.div_ceil(positions).max(1) }
    }
}

/// Computes one to eight jobs side by side to the end of their cases.
///
/// # Errors
/// The jobs cannot fly together ([`Flight::new`]), a fibre is lost, or another thread stops it.
pub fn fly_together(
    jobs: &[Job<'_>],
    keep: Recorded<'_>,
    computing: RunContext<'_>,
) -> Result<Vec<Trajectory>, Error> {
    let first = jobs.first().ok_or_else(Error::no_fibre)?;
    fly_in_air(jobs, keep, SurroundingRun::run(first.case), computing)
}

/// Length of fibre fed in the spin-up, whose points are not kept [m].
fn first_counted(case: &Case) -> f64 {
    case.line.map_or(0.0, |line| line.feed_speed * case.run.spin_up())
}

/// [`fly_together`], where a fibre that is lost does not stop the others: for each job, its trajectory or the
/// reason why its fibre is lost.
///
/// # Errors
/// The jobs cannot fly together ([`Flight::new`]), or another thread stops the flight.
pub fn fly_each(
    jobs: &[Job<'_>],
    keep: Recorded<'_>,
    computing: RunContext<'_>,
) -> Result<Vec<Result<Trajectory, Error>>, Error> {
    each_or_lost(jobs, |together| {
        let first = together.first().ok_or_else(Error::no_fibre)?;
        fly_until_lost(together, keep, SurroundingRun::run(first.case), computing)
    })
}

/// Flies jobs side by side, and those that are left again as long as one of them is lost: for each job what it
/// gives, or the reason why its fibre is lost.
///
/// * `fly` – what each of some jobs gives, or the first fibre among them that is lost
pub(super) fn each_or_lost<T>(
    jobs: &[Job<'_>],
    mut fly: impl FnMut(&[Job<'_>]) -> Result<Vec<T>, FlightEnd>,
) -> Result<Vec<Result<T, Error>>, Error> {
    let mut lost: Vec<(usize, Error)> = Vec::new();
    loop {
        let flying: Vec<usize> =
            (0..jobs.len()).filter(|job| lost.iter().all(|(other, _)| other != job)).collect();
        let together: Vec<Job<'_>> = flying.iter().map(|job| jobs[*job]).collect();
        let simulated = if together.is_empty() && !jobs.is_empty() { Ok(Vec::new()) } else { fly(&together) };
        match simulated {
            Ok(simulated) => {
                let mut all: Vec<_> = flying.into_iter().zip(simulated.into_iter().map(Ok)).collect();
                all.extend(lost.into_iter().map(|(job, error)| (job, Err(error))));
                all.sort_by_key(|(job, _)| *job);
                return Ok(all.into_iter().map(|(_, simulated)| simulated).collect());
            }
            // The others fly again without it, with the same bits.
            Err(FlightEnd::Lost { lane, error }) => lost.push((flying[lane], error)),
            Err(FlightEnd::Otherwise(error)) => return Err(error),
        }
    }
}

/// [`fly_together`], in the air of another run.
pub(super) fn fly_in_air(
    jobs: &[Job<'_>],
    keep: Recorded<'_>,
    air: SurroundingRun<'_>,
    computing: RunContext<'_>,
) -> Result<Vec<Trajectory>, Error> {
    fly_until_lost(jobs, keep, air, computing).map_err(|ended| match ended {
        FlightEnd::Lost { error, .. } | FlightEnd::Otherwise(error) => error,
    })
}

/// Why a flight has ended before its time.
pub(super) enum FlightEnd {
    /// The fibre in a lane is lost.
    Lost {
        lane: usize,
        error: Error,
    },
    Otherwise(Error),
}

impl From<Error> for FlightEnd {
    fn from(error: Error) -> Self {
        Self::Otherwise(error)
    }
}

fn fly_until_lost(
    jobs: &[Job<'_>],
    keep: Recorded<'_>,
    air: SurroundingRun<'_>,
    computing: RunContext<'_>,
) -> Result<Vec<Trajectory>, FlightEnd> {
    let mut flight = Flight::in_air(jobs, computing.isa, air)?;
    if let Some(recorder) = keep.recorder {
        jobs.iter().for_each(|job| recorder.begin(job.replicate));
    }
    let clock = flight.clock().clone();
    let mut observers = Observers::new(&flight, keep.curves);
    let keeps_shapes = |lane: usize| jobs[lane].replicate < keep.shapes.replicates;
    let begin = |(lane, job): (usize, &Job<'_>)| {
        let place = keep.recorder.filter(|_| keeps_shapes(lane));
        let shapes = place.map_or_else(|| Ok(Shapes::default()), |place| place.shapes(job.replicate))?;
        Ok(Trajectory { replicate: job.replicate, shapes, ..Trajectory::default() })
    };
    let mut trajectories = jobs.iter().enumerate().map(begin).collect::<Result<Vec<_>, Error>>()?;
    let mut recorded: [Vec<Sample>; WIDTH] = Default::default();
    let mut step = 0;
    for instant in 0.. {
        // A snapshot needs one step. The last one takes that step on a copy.
        let snapshot = if step < clock.steps { flight.observe() } else { flight.snapshot() };
        if let Some((lane, error)) = flight.lost() {
            // The fibres that are left fly again.
            computing.done.fetch_sub(step * jobs.len() as u64, Ordering::Relaxed);
            let good_steps = step - clock.output_steps.min(step);
            return Err(match error {
                Error::Diverged { .. } => divergence(jobs, air, good_steps, computing)?,
                adrift => FlightEnd::Lost { lane, error: adrift },
            });
        }
        let samples: [Sample; WIDTH] = std::array::from_fn(|lane| Sample::new(&snapshot, lane));
        let laid: [Vec<LaidPoint>; WIDTH] = std::array::from_fn(|lane| flight.take_laid(lane));
        let settled = step >= clock.spin_up_steps;
        observers.see(&Observation { snapshot: &snapshot, samples: &samples, settled, laid: &laid });
        for (lane, trajectory) in trajectories.iter_mut().enumerate() {
            if keep.samples {
                trajectory.samples.push(samples[lane]);
            }
            if keep.curves && lane == 0 && jobs[lane].case.line.is_none() {
                trajectory.path.push(&samples[lane]);
            }
            if keeps_shapes(lane) && instant % keep.shapes.every == 0 {
                let nodes = snapshot.position.iter().take(snapshot.nodes[lane]);
                trajectory.shapes.push(snapshot.time, nodes.map(|p| p.lane(lane)))?;
            }
            if keeps_shapes(lane) {
                let room = LAID_WITH_SHAPES - trajectory.laid.len();
                let first_counted = first_counted(jobs[lane].case);
                let counted = laid[lane].iter().filter(|point| point.fed >= first_counted);
                trajectory.laid.extend(counted.take(room));
            }
            if let Some(recorder) = keep.recorder {
                recorded[lane].push(samples[lane]);
                if recorded[lane].len() == TOGETHER || step >= clock.steps {
                    recorder.samples(trajectory.replicate, &recorded[lane])?;
                    recorded[lane].clear();
                }
                if !laid[lane].is_empty() {
                    recorder.lay(trajectory.replicate, &laid[lane])?;
                }
            }
        }
        if step >= clock.steps {
            break;
        }
        let steps = clock.output_steps.min(clock.steps - step);
        flight.advance(steps - 1);
        step += steps;
        computing.done.fetch_add(steps * jobs.len() as u64, Ordering::Relaxed);
        if computing.stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted.into());
        }
    }
    for (lane, trajectory) in trajectories.iter_mut().enumerate() {
        trajectory.values = observers.finish(lane, &flight).collect();
    }
    Ok(trajectories)
}

/// Computing time of a flight for one step of a case [s], measured on this machine.
///
/// # Errors
/// Those of [`Flight::new`].
pub fn pace(case: &Case, isa: Isa) -> Result<f64, Error> {
    const TRIAL: f64 = 0.05;
    const PARTS: u64 = 64;
    let steps = ((2e5 / case.fibre.elements as f64).clamp(1.0, 1e4) as u64).min(case.run.steps).max(1);
    // Each fibre finds its own part of a field, and has eddies in space of its own.
    let is_in_field = matches!(case.air.flow, Flow::Field(_));
    let windows = case.windows_of_eddies();
    let fibres = if is_in_field || windows > 0.0 { case.run.replicates.clamp(1, WIDTH as u64) } else { 1 };
    let jobs: Vec<Job<'_>> = (0..fibres).map(|replicate| Job::new(case, replicate)).collect();
    let mut flight = Flight::new(&jobs, isa)?;
    // The first step makes the first windows, and those that follow take as long.
    let begun = Instant::now();
    flight.advance(u64::from(windows > 0.0));
    let making = windows * begun.elapsed().as_secs_f64() / case.run.steps as f64;
    if let Some(line) = case.line {
        // Until the fibre has come down.
        let down = 1.5 * line.distance / line.feed_speed / case.run.time_step;
        flight.advance((down as u64).min(case.run.steps).min(100_000));
    }
    // In parts, because a fibre that is lost may take very long for a step. In a field the fibre flies on: it comes to
    // places where no air was looked up before, which takes the longest at the beginning.
    let part = steps.div_ceil(PARTS);
    let (trial_time, until) = if is_in_field { (4.0 * TRIAL, case.run.steps) } else { (TRIAL, steps) };
    let mut done = 0;
    let mut trial = flight.clone();
    let started = Instant::now();
    let mut before = (0, 0.0);
    while done == 0 || started.elapsed().as_secs_f64() < trial_time {
        if done > 0 && done % until < part {
            trial = flight.clone();
        }
        trial.advance(part);
        done += part;
        if is_in_field && before.0 == 0 && started.elapsed().as_secs_f64() > 0.5 * trial_time {
            before = (done, started.elapsed().as_secs_f64());
        }
    }
    let (done_before, time_before) = if before.0 < done { before } else { (0, 0.0) };
    Ok(making + (started.elapsed().as_secs_f64() - time_before) / (done - done_before) as f64)
}

/// Steps that are repeated between two looks at whether to stop.
const REPEATED: u64 = 1024;

/// Finds where a fibre is first seen to be lost: repeats the flight, step by step after the last good instant.
fn divergence(
    jobs: &[Job<'_>],
    air: SurroundingRun<'_>,
    good_steps: u64,
    by: RunContext<'_>,
) -> Result<FlightEnd, Error> {
    let mut flight = Flight::in_air(jobs, by.isa, air)?;
    let mut left = good_steps;
    loop {
        if by.stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted);
        }
        if let Some((lane, error)) = flight.lost().filter(|_| left == 0) {
            return Ok(FlightEnd::Lost { lane, error });
        }
        let steps = left.clamp(1, REPEATED);
        flight.advance(steps);
        left = left.saturating_sub(steps);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use spunlaid_air::Air;
    use spunlaid_fibre::Fibre;
    use std::sync::atomic::{AtomicBool, AtomicU64};

    #[test]
    fn a_lost_fibre_is_sought_until_somebody_stops_it() {
        let mut case = Case::unset();
        case.fibre = Fibre { diameter: 50e-6, density: 950.0, youngs_modulus: 2e9, ..Fibre::UNKNOWN };
        case.fibre.span(1.0, 0.05);
        case.air = Air::uniform(10.0, 0.1, 0.05, 100.0);
        (case.run.time_step, case.run.steps, case.run.output_steps) = (20e-6, 10_000, 1000);
        (case.run.gravity, case.run.damping) = (9.81, 0.0);
        // This fibre is never lost.
        let (stop, done) = (AtomicBool::new(true), AtomicU64::new(0));
        let by = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &done };
        let found = divergence(&[Job::new(&case, 0)], SurroundingRun::run(&case), 5000, by);
        assert!(matches!(found, Err(Error::Interrupted)), "{:?}", found.is_ok());
    }
}
