//! The flight of one replicate: what is kept of it.

use super::Computing;
use crate::air::{EddyTurbulence, Stream, StreamKey, Turbulence};
use crate::case::Case;
use crate::chain::Strand;
use crate::energy::Energy;
use crate::error::Error;
use crate::fibre::Root;
use crate::flight::{Flight, Snapshot};
use crate::lanes::{Isa, Lanes, WIDTH};
use crate::observe::{EndNodeMotion, NodeSpread, SpreadObserver};
use crate::vec3::Vec3;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// One replicate of a case: the unit of work, fully described by data.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// The case.
    pub case: &'a Case,
    /// Which replicate of it.
    pub replicate: u64,
}

impl<'a> Job<'a> {
    /// Where its turbulence comes from.
    pub(super) fn stream(&self, turbulence_of_eddies: &'a [EddyTurbulence]) -> Stream<'a> {
        let key = StreamKey { seed: self.case.run.seed, replicate: self.replicate };
        Stream { air: &self.case.air, turbulence_of_eddies, key }
    }
}

/// What is kept of one replicate.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// Which replicate of its case.
    pub replicate: u64,
    /// Motion of the end node, from every step after the spin-up.
    pub end_node: EndNodeMotion,
    /// Share of the time that its elements have spent outside of what the flow knows; none where the air is the
    /// same everywhere.
    pub outside: Option<f64>,
    /// Largest strain of an element at the recorded instants, by size [-].
    pub max_strain: f64,
    /// End node and energies at the recorded instants, the start included.
    pub samples: Vec<Sample>,
    /// Mean position and spread of the `N+1` nodes over the recorded instants after the spin-up.
    pub nodes: Vec<NodeSpread>,
    /// The whole fibre at some of the recorded instants; empty unless asked for.
    pub shapes: Vec<Shape>,
}

/// The whole fibre at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Time [s].
    pub time: f64,
    /// Positions of the `N+1` nodes [m].
    pub position: Vec<Vec3<f64>>,
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

/// One recorded instant of a fibre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Time [s].
    pub time: f64,
    /// Position of the end node [m].
    pub end: Vec3<f64>,
    /// Kinetic energy [J].
    pub kinetic: f64,
    /// Energy stored in stretch [J].
    pub axial: f64,
    /// Energy stored in bending [J].
    pub bending: f64,
    /// Work of all forces on the nodes by the trapezoidal rule [J].
    pub work: f64,
    /// Work of gravity [J].
    pub gravity_work: f64,
    /// Work of the air [J].
    pub air_work: f64,
    /// Work of the damping [J].
    pub damping_work: f64,
    /// What the implicit tension has taken out of the motion beyond what the elements store [J]; zero with
    /// the explicit schemes.
    pub tension_dissipation: f64,
    /// What the energy balance leaves over [J].
    pub imbalance: f64,
}

impl Sample {
    fn of(snapshot: &Snapshot, lane: usize) -> Self {
        let e: &Energy = &snapshot.energy;
        Self {
            time: snapshot.time,
            end: snapshot.position.last().map_or_else(Vec3::default, |p| p.lane(lane)),
            kinetic: e.kinetic.0[lane],
            axial: e.axial.0[lane],
            bending: e.bending.0[lane],
            work: e.work.0[lane],
            gravity_work: e.gravity_work.0[lane],
            air_work: e.drag_work.0[lane],
            damping_work: e.damping_work.0[lane],
            tension_dissipation: e.tension_dissipation.0[lane],
            imbalance: e.imbalance().0[lane],
        }
    }

    /// The work check `100 |W − T|/T` [%]; NaN at rest.                      theory.md (35)
    pub fn work_error_percent(&self) -> f64 {
        percent(self.work - self.kinetic, self.kinetic).abs()
    }

    /// What the energy balance leaves over, by the work of the air [%]; without air by that of gravity,
    /// without either by the kinetic energy; NaN while that is zero.         theory.md (36)
    pub fn balance_error_percent(&self) -> f64 {
        percent(self.imbalance, self.input()).abs()
    }

    /// What the implicit tension has dissipated, by the same as the balance [%].
    pub fn tension_dissipation_percent(&self) -> f64 {
        percent(self.tension_dissipation, self.input().abs())
    }

    /// What the energies are compared with [J].
    fn input(&self) -> f64 {
        let scales = [self.air_work, self.gravity_work, self.kinetic];
        scales.into_iter().find(|&w| w != 0.0).unwrap_or(0.0)
    }
}

fn percent(part: f64, whole: f64) -> f64 {
    if whole == 0.0 { f64::NAN } else { 100.0 * (part / whole) }
}

/// Flies one to eight jobs side by side. Their cases must agree in number of elements, eddy of each element,
/// times, scheme, cut-off frequency and number of harmonics, and in whether they are damped.
///
/// # Errors
/// A fibre that stops being finite, and a stop from elsewhere.
pub fn fly_together(
    jobs: &[Job<'_>],
    keep_shapes: KeepShapes,
    computing: Computing<'_>,
) -> Result<Vec<Trajectory>, Error> {
    let case = jobs[0].case;
    let run = &case.run;
    let eddies = case.eddies();
    let turbulence_of_eddies: Vec<Vec<EddyTurbulence>> =
        jobs.iter().map(|job| job.case.turbulence_of_eddies(&eddies)).collect();
    let streams: Vec<Stream<'_>> = jobs
        .iter()
        .zip(&turbulence_of_eddies)
        .map(|(job, turbulence_of_eddies)| job.stream(turbulence_of_eddies))
        .collect();
    // One step more than the run: the last instant's energies look one step ahead.
    let horizon = run.duration() + run.time_step;
    let turbulence = Turbulence::of(computing.isa, &streams, horizon);
    let strands: Vec<Strand> = jobs.iter().map(|job| job.case.strand()).collect();
    let start = || {
        let air = (&eddies, &turbulence, case.surroundings(jobs.iter().map(|job| &job.case.air)));
        Flight::within(computing.isa, &strands, air, run.scheme, run.time_step, run.spin_up_steps)
    };
    let mut bundle = start();

    let mut flights: Vec<Trajectory> =
        jobs.iter().map(|job| Trajectory { replicate: job.replicate, ..Trajectory::default() }).collect();
    let mut spread = SpreadObserver::new(case.fibre.elements + 1);
    let mut step = 0;
    for instant in 0.. {
        // Taken while advancing by the first of the steps to the next instant; the last looks ahead only.
        let snapshot = if step < run.steps { bundle.observe() } else { bundle.snapshot() };
        if !is_finite(&snapshot.position, jobs.len()) {
            return Err(divergence(jobs, start(), step - run.output_steps.min(step)));
        }
        if step >= run.spin_up_steps {
            spread.see(&snapshot.position);
        }
        for (lane, flight) in flights.iter_mut().enumerate() {
            flight.samples.push(Sample::of(&snapshot, lane));
            flight.max_strain = flight.max_strain.max(snapshot.energy.strain.0[lane]);
            if flight.replicate < keep_shapes.replicates && instant % keep_shapes.every == 0 {
                let position = snapshot.position.iter().map(|p| p.lane(lane)).collect();
                flight.shapes.push(Shape { time: snapshot.time, position });
            }
        }
        if step >= run.steps {
            break;
        }
        let steps = run.output_steps.min(run.steps - step);
        bundle.advance(steps - 1);
        step += steps;
        computing.fibre_steps.fetch_add(steps * jobs.len() as u64, Ordering::Relaxed);
        if computing.stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted);
        }
    }
    let observed = run.duration() - run.spin_up();
    for (lane, flight) in flights.iter_mut().enumerate() {
        flight.end_node = bundle.end_node().motion(lane, observed);
        flight.nodes = spread.nodes(lane);
        flight.outside = bundle.outside(lane);
    }
    Ok(flights)
}

/// Time a bundle takes for a step of a case on this machine [s], tried out for a moment.
pub fn pace(case: &Case, isa: Isa) -> f64 {
    const TRIAL: f64 = 0.05;
    let run = &case.run;
    let eddies = case.eddies();
    let turbulence_of_eddies = case.turbulence_of_eddies(&eddies);
    let stream = [Job { case, replicate: 0 }.stream(&turbulence_of_eddies)];
    let steps = (2e5 / case.fibre.elements as f64).clamp(1.0, 1e4) as u64;
    let horizon = (steps * 100) as f64 * run.time_step;
    let turbulence = Turbulence::of(isa, &stream, horizon.min(run.duration()));
    let strands = [case.strand()];
    let air = (&eddies, &turbulence, case.surroundings(std::iter::once(&case.air)));
    let bundle = Flight::within(isa, &strands, air, run.scheme, run.time_step, 0);
    let (mut done, started) = (0, Instant::now());
    while done == 0 || started.elapsed().as_secs_f64() < TRIAL {
        bundle.clone().advance(steps.min(run.steps));
        done += steps.min(run.steps);
    }
    started.elapsed().as_secs_f64() / done as f64
}

/// Whether the positions in the first `lanes` lanes are all numbers.
fn is_finite(position: &[Vec3<Lanes>], lanes: usize) -> bool {
    (0..lanes).all(|lane| position.iter().all(|p| p.lane(lane).norm().is_finite()))
}

/// Says where a bundle lost its numbers first: flies it again, step by step after the last good one.
fn divergence(jobs: &[Job<'_>], mut bundle: Flight<'_>, good_steps: u64) -> Error {
    bundle.advance(good_steps);
    while is_finite(&bundle.chain().position, jobs.len()) {
        bundle.advance(1);
    }
    let held = usize::from(jobs[0].case.fibre.root != Root::Free);
    let position = &bundle.chain().position;
    let lost = |lane: usize| (held..position.len()).find(|&i| !position[i].lane(lane).norm().is_finite());
    let (lane, node) = (0..jobs.len()).find_map(|lane| Some((lane, lost(lane)?))).unwrap_or((0, held));
    Error::NotFinite {
        replicate: jobs[lane].replicate + 1,
        node: node + 1,
        time: bundle.time(),
        cause: jobs[lane].case.likely_cause_of_divergence(),
    }
}
