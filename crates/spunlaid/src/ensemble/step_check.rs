//! What half the time step changes.
//!
//! The first fibres of a run fly again, for a short time, with half the step in the same turbulence. The difference
//! between the two paths comes from the step alone. The path of a fed fibre is the one that it lays on the belt.

use super::{Computing, Job};
use crate::case::{Case, MOST_STEPS};
use crate::error::Error;
use crate::flight::{Flight, LaidPoint};
use crate::lanes::{Lanes, WIDTH};
use crate::observe::Sample;
use crate::statistics::Estimate;
use crate::vec3::Vec3;
use std::sync::atomic::Ordering;

/// Share of the computing time of a run that the check may always take. It is counted in steps of flights, so that
/// it does not depend on the machine.
const SHARE: f64 = 0.1;
/// Steps, times elements, that one more flight may always take: some tenths of a second. A short run is then
/// checked for its whole duration.
const ALWAYS: f64 = 2e6;
/// Longest time that is flown again [s].
const LONGEST: f64 = 1.0;
/// Fewest recorded instants from which a difference is computed. Runs that are too short for them are not checked.
const FEWEST: u64 = 20;
/// Amplitude below which the fibre does not move but for rounding, as a share of its length.
const ROUNDING: f64 = 1e-12;

/// Change of the free end's motion across the flow, or of the laid fibre about its straight trace, from half the time step
/// to the step of the run. The amplitude is the rms distance from the mean, of a laid fibre its spread.
#[derive(Clone, Debug)]
pub struct StepCheck {
    /// Time from the start over which both are compared [s].
    pub duration: f64,
    /// Computing time of the check as a share of that of the run, counted in steps of flights [-].
    pub share_of_run: f64,
    /// Rms distance between the two paths, divided by the amplitude; of each replicate [-].
    pub path: Estimate,
    /// Relative change of the amplitude; of each replicate [-].
    pub amplitude: Estimate,
}

/// The position across the flow at the recorded instants after the start [m]. Of a fed fibre: the place of each laid point
/// about the straight trace.
pub(super) type Path = Vec<[f64; 2]>;

/// Which points of a laid fibre are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Counted {
    /// Those from this fed length on, after the spin-up [m].
    from: f64,
    /// Speed of the belt over speed of the feed.
    belt_ratio: f64,
}

impl Counted {
    /// Their places about the straight trace [m].
    fn of(self, laid: &[LaidPoint]) -> impl Iterator<Item = [f64; 2]> {
        let counted = laid.iter().filter(move |point| point.fed >= self.from);
        counted.map(move |point| [point.md + self.belt_ratio * point.fed, point.cd])
    }
}

/// What is flown again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepCheckPlan {
    /// The number of replicates, from the first on. A flight costs the same for all its lanes.
    pub replicates: u64,
    /// The number of recorded instants after the start.
    instants: u64,
    /// The number of steps of the run until then.
    steps: u64,
    /// Of a fed fibre.
    laid: Option<Counted>,
    /// Computing time as a share of that of the run [-].
    pub share_of_run: f64,
}

impl StepCheckPlan {
    /// The plan for a case; `None` if the run is too short for it.
    pub fn of(case: &Case) -> Option<Self> {
        let run = &case.run;
        let flights = run.replicates.div_ceil(WIDTH as u64) as f64;
        // Half the step takes two steps for one.
        let affordable = 0.5 * (SHARE * flights * run.steps as f64).max(ALWAYS / case.fibre.elements as f64);
        let most = affordable.min(LONGEST / run.time_step).min(run.steps as f64);
        let instants = (most / run.output_steps as f64 * (1.0 + 1e-9)) as u64;
        let steps = instants * run.output_steps;
        let share_of_run = 2.0 * steps as f64 / (flights * run.steps as f64);
        let replicates = run.replicates.min(WIDTH as u64);
        let laid = case.line.as_ref().map(|line| Counted {
            from: line.feed_speed * run.spin_up(),
            belt_ratio: line.belt_speed / line.feed_speed,
        });
        // A spread needs some time after the spin-up.
        let settled = laid.is_none() || steps >= 3 * run.spin_up_steps;
        let possible = instants >= FEWEST && settled && 2 * steps <= MOST_STEPS;
        possible.then_some(Self { replicates, instants, steps, laid, share_of_run })
    }

    /// Number of fibre steps, as in [`Computing::fibre_steps`].
    pub const fn fibre_steps(&self) -> u64 {
        2 * self.steps * self.replicates
    }

    /// Number of jobs whose paths are compared, from the first on.
    pub(super) fn paths(&self, jobs: &[Job<'_>]) -> usize {
        jobs.iter().filter(|job| job.replicate < self.replicates).count()
    }

    /// Adds to the path of a fibre of the run what is compared of a recorded instant.
    ///
    /// * `instant` – 0 at the start
    /// * `laid` – the points that have been laid since the last instant
    pub(super) fn follow(&self, instant: u64, sample: &Sample, laid: &[LaidPoint], path: &mut Path) {
        match self.laid {
            _ if !(1..=self.instants).contains(&instant) => {}
            Some(counted) => path.extend(counted.of(laid)),
            None => path.push([sample.end.y, sample.end.z]),
        }
    }

    /// The paths of the first replicates with half the step.
    pub(super) fn fly(&self, case: &Case, computing: Computing<'_>) -> Result<Vec<Path>, Error> {
        let mut half = case.clone();
        half.run.time_step *= 0.5;
        half.run.steps = 2 * self.steps;
        half.run.output_steps *= 2;
        half.run.spin_up_steps = 0;
        if let Some(line) = &mut half.line {
            line.steps_per_element *= 2;
        }
        let jobs: Vec<Job<'_>> =
            (0..self.replicates).map(|replicate| Job { case: &half, replicate }).collect();
        // In the air of the run: which stretches of a record a fibre gets depends on how long they have to last.
        let mut flight = Flight::in_air_until(&jobs, computing.isa, case.air_horizon())?;
        let mut paths = vec![Path::new(); jobs.len()];
        for _ in 0..self.instants {
            flight.advance(half.run.output_steps);
            for (lane, path) in paths.iter_mut().enumerate() {
                let end = |end: &Vec3<Lanes>| [end.y.0[lane], end.z.0[lane]];
                match self.laid {
                    Some(counted) => path.extend(counted.of(&flight.take_laid(lane))),
                    None => path.extend(flight.chain().position.last().map(end)),
                }
            }
            let steps = half.run.output_steps * self.replicates;
            computing.fibre_steps.fetch_add(steps, Ordering::Relaxed);
            if computing.stop.load(Ordering::Relaxed) {
                return Err(Error::Interrupted);
            }
        }
        Ok(paths)
    }

    /// Compares the paths of the run with those of half the step. `None` if the fibres do not move across the flow.
    pub(super) fn compare(&self, case: &Case, own: &[Path], half: &[Path]) -> Option<StepCheck> {
        let least = ROUNDING * case.fibre.length;
        let (mut paths, mut amplitudes) = (Vec::new(), Vec::new());
        for (own, half) in own.iter().zip(half) {
            // One of two laid fibres may have come a little further.
            let both = own.len().min(half.len());
            let (own, half) = (&own[..both], &half[..both]);
            if (both as u64) < FEWEST {
                continue;
            }
            let amplitude = amplitude(half);
            if amplitude > least {
                paths.push(rms_distance(own, half) / amplitude);
                amplitudes.push(self::amplitude(own) / amplitude - 1.0);
            }
        }
        if paths.iter().chain(&amplitudes).any(|value| !value.is_finite()) || paths.is_empty() {
            return None;
        }
        Some(StepCheck {
            duration: self.steps as f64 * case.run.time_step,
            share_of_run: self.share_of_run,
            path: Estimate::of(paths),
            amplitude: Estimate::of(amplitudes),
        })
    }
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
