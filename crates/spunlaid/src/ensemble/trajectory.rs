//! The flight of one replicate: what is kept of it.

use super::Computing;
use crate::case::Case;
use crate::error::Error;
use crate::flight::{Flight, Job};
use crate::lanes::{Isa, Lanes, WIDTH};
use crate::observe::{Measure, Observers, Sample, Seen, Value};
use crate::vec3::Vec3;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// What is kept of one replicate.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// Which replicate of its case.
    pub replicate: u64,
    /// What was measured of it, in the order of the declarations.
    pub values: Vec<(&'static Measure, Value)>,
    /// End node and energies at the recorded instants, the start included.
    pub samples: Vec<Sample>,
    /// The whole fibre at some of the recorded instants; empty unless asked for.
    pub shapes: Vec<Shape>,
}

impl Trajectory {
    /// A number by its measure's name, in SI units; NaN where there is none.
    pub fn number(&self, name: &str) -> f64 {
        let found = self.values.iter().find(|(measure, _)| measure.name == name);
        match found {
            Some((_, Value::Number(value))) => *value,
            _ => f64::NAN,
        }
    }
}

/// The whole fibre at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Time [s].
    pub time: f64,
    /// Positions of the `N+1` nodes [m].
    pub position: Vec<Vec3<f64>>,
}

/// What to keep of an ensemble besides the numbers measured of each fibre and its samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Keep {
    /// Whether curves are measured too: profiles, series, spectra.
    pub curves: bool,
    /// The whole fibres that are kept.
    pub shapes: KeepShapes,
}

impl Keep {
    /// Numbers and samples only.
    pub const NUMBERS: Self = Self { curves: false, shapes: KeepShapes::NONE };
    /// Curves, but no shapes.
    pub const CURVES: Self = Self { curves: true, shapes: KeepShapes::NONE };
}

/// Which shapes of an ensemble to keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeepShapes {
    /// Of the first so many replicates.
    pub replicates: u64,
    /// Every so many recorded instants.
    pub every: u64,
}

impl KeepShapes {
    /// None.
    pub const NONE: Self = Self { replicates: 0, every: 1 };

    /// As many as up to eight replicates and `positions` node positions in all allow, one replicate at
    /// least: fewer replicates first, then fewer instants.
    pub fn within(case: &Case, positions: u64) -> Self {
        let nodes = case.fibre.elements as u64 + 1;
        let instants = case.run.steps / case.run.output_steps + 1;
        let one = nodes.saturating_mul(instants);
        let replicates = (positions / one).clamp(1, WIDTH as u64).min(case.run.replicates);
        Self { replicates, every: one.div_ceil(positions).max(1) }
    }
}

/// Flies one to eight jobs side by side to the end of their cases.
///
/// # Errors
/// Jobs that cannot fly together ([`Flight::new`]), a fibre that stops being finite, and a stop from elsewhere.
pub fn fly_together(
    jobs: &[Job<'_>],
    keep: Keep,
    computing: Computing<'_>,
) -> Result<Vec<Trajectory>, Error> {
    let mut flight = Flight::new(jobs, computing.isa)?;
    let case = jobs[0].case;
    let run = &case.run;
    let mut observers = Observers::of(case, keep.curves);
    let mut trajectories: Vec<Trajectory> =
        jobs.iter().map(|job| Trajectory { replicate: job.replicate, ..Trajectory::default() }).collect();
    let mut step = 0;
    for instant in 0.. {
        // Taken while advancing by the first of the steps to the next instant; the last looks ahead only.
        let snapshot = if step < run.steps { flight.observe() } else { flight.snapshot() };
        if !is_finite(&snapshot.position, jobs.len()) {
            return Err(divergence(jobs, computing.isa, step - run.output_steps.min(step)));
        }
        let samples: [Sample; WIDTH] = std::array::from_fn(|lane| Sample::of(&snapshot, lane));
        observers.see(&Seen { snapshot: &snapshot, samples: &samples, settled: step >= run.spin_up_steps });
        for (lane, trajectory) in trajectories.iter_mut().enumerate() {
            trajectory.samples.push(samples[lane]);
            if trajectory.replicate < keep.shapes.replicates && instant % keep.shapes.every == 0 {
                let position = snapshot.position.iter().map(|p| p.lane(lane)).collect();
                trajectory.shapes.push(Shape { time: snapshot.time, position });
            }
        }
        if step >= run.steps {
            break;
        }
        let steps = run.output_steps.min(run.steps - step);
        flight.advance(steps - 1);
        step += steps;
        computing.fibre_steps.fetch_add(steps * jobs.len() as u64, Ordering::Relaxed);
        if computing.stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted);
        }
    }
    for (lane, trajectory) in trajectories.iter_mut().enumerate() {
        trajectory.values = observers.finish(lane, &flight).collect();
    }
    Ok(trajectories)
}

/// Time a flight takes for a step of a case on this machine [s], tried out for a moment.
///
/// # Errors
/// As of [`Flight::new`].
pub fn pace(case: &Case, isa: Isa) -> Result<f64, Error> {
    const TRIAL: f64 = 0.05;
    let steps = ((2e5 / case.fibre.elements as f64).clamp(1.0, 1e4) as u64).min(case.run.steps).max(1);
    let flight = Flight::new(&[Job { case, replicate: 0 }], isa)?;
    let (mut done, started) = (0, Instant::now());
    while done == 0 || started.elapsed().as_secs_f64() < TRIAL {
        flight.clone().advance(steps);
        done += steps;
    }
    Ok(started.elapsed().as_secs_f64() / done as f64)
}

/// Whether the positions in the first `lanes` lanes are all numbers.
fn is_finite(position: &[Vec3<Lanes>], lanes: usize) -> bool {
    (0..lanes).all(|lane| position.iter().all(|p| p.lane(lane).norm().is_finite()))
}

/// Says where a flight lost its numbers first: flies it again, step by step after the last good one.
fn divergence(jobs: &[Job<'_>], isa: Isa, good_steps: u64) -> Error {
    let mut flight = match Flight::new(jobs, isa) {
        Ok(flight) => flight,
        Err(error) => return error,
    };
    flight.advance(good_steps);
    loop {
        if let Some(lost) = flight.lost() {
            return lost;
        }
        flight.advance(1);
    }
}
