//! Flies replicates and enters the drag on each of their elements, and its heat, into the cell around it.

use super::Fitting;
use crate::ensemble::Job;
use crate::ensemble::trajectory::{FlightEnd, each_or_lost};
use crate::observe::{MomentumBalance, NodeStates, tension_lag};
use spunlaid_air::Hint;
use spunlaid_fibre::{Cooled, Flight, Snapshot, SolidFilament};
use spunlaid_ground::place::Inlet;
use spunlaid_ground::{Error, Lanes, RunContext, Vec3};
use std::collections::HashMap;
use std::sync::atomic::Ordering;

/// Fraction by which the place across the width moves on from one instant to the next: all places come equally often.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// What a replicate has done: sums over instants.
#[derive(Debug)]
pub(super) struct CellSums {
    /// Of each cell that it has met: force in the frame of the field [N], drag per velocity [kg/s], heat [W] and heat
    /// per temperature of the air [W/K], and elements seen.
    pub(super) cells: HashMap<u32, ([f64; 6], u64)>,
    /// Force outside of the cells along x of the case [N], and heat [W].
    pub(super) outside: [f64; 2],
    /// Temperature at the belt [K].
    pub(super) at_belt: f64,
    pub(super) instants: u64,
    /// Force along x above the belt, of the drag [N].
    pub(super) above_belt: f64,
    /// And by the balance of momentum, as a mean over the instants [N].
    pub(super) by_momentum: f64,
}

/// Looks at the fibre in a lane.
#[derive(Debug)]
struct Watch {
    sums: CellSums,
    place: Inlet,
    hint: Hint,
    /// Where in the width the fibre is taken to be, as a share of it.
    turn: f64,
}

/// Flies up to eight replicates to the end of their case: what each of them has done, or why its fibre is lost.
pub fn fly_each(
    jobs: &[Job<'_>],
    fitting: &Fitting<'_>,
    by: RunContext<'_>,
) -> Result<Vec<Result<CellSums, Error>>, Error> {
    each_or_lost(jobs, |together| fly_until_lost(together, fitting, by))
}

fn fly_until_lost(
    jobs: &[Job<'_>],
    fitting: &Fitting<'_>,
    by: RunContext<'_>,
) -> Result<Vec<CellSums>, FlightEnd> {
    let mut flight = Flight::new(jobs, by.isa)?;
    let clock = flight.clock().clone();
    let mut watches: Vec<Watch> = jobs.iter().map(Watch::new).collect();
    let mut balances: Vec<MomentumBalance> = jobs.iter().map(|job| MomentumBalance::of(job.case)).collect();
    let mut step = 0;
    while step < clock.steps {
        let steps = clock.output_steps.min(clock.steps - step);
        if step < clock.spin_up_steps {
            flight.advance(steps);
        } else {
            let (snapshot, relative) = see(&mut flight, step);
            for (lane, (watch, balance)) in watches.iter_mut().zip(&balances).enumerate() {
                watch.see(&snapshot, &relative, lane, fitting, balance);
            }
            let nodes = NodeStates::of(&snapshot, tension_lag(&flight), |lane| lane < jobs.len());
            MomentumBalance::see(&mut balances, &nodes);
            flight.advance(steps - 1);
        }
        if let Some((lane, error)) = flight.lost() {
            // The fibres that are left fly again.
            by.done.fetch_sub(step * jobs.len() as u64, Ordering::Relaxed);
            return Err(FlightEnd::Lost { lane, error });
        }
        step += steps;
        (0..jobs.len()).for_each(|lane| drop(flight.take_laid(lane)));
        by.done.fetch_add(steps * jobs.len() as u64, Ordering::Relaxed);
        if by.stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted.into());
        }
    }
    let finish = |(watch, balance): (Watch, MomentumBalance)| CellSums {
        by_momentum: balance.force_above_belt(),
        ..watch.sums
    };
    Ok(watches.into_iter().zip(balances).map(finish).collect())
}

/// Looks at a flight, which advances by one step: what it is, and the velocity of the air relative to each element
/// [m/s].
///
/// * `step` – number of that step, from 0
pub(super) fn see(flight: &mut Flight, step: u64) -> (Snapshot, Vec<Vec3<Lanes>>) {
    let fed = flight.chain().fed();
    let snapshot = flight.observe();
    // Air that is known after the step has the numbers of after the step.
    let born = (flight.chain().fed() - fed) as usize;
    let count = snapshot.nodes.iter().copied().max().unwrap_or_default().saturating_sub(1);
    let relative = |j: usize| {
        let velocity = (snapshot.velocity[j] + snapshot.velocity[j + 1]) * Lanes::splat(0.5);
        let felt = flight.air_felt(j + born, step);
        felt.map_or(Vec3::ZERO, |felt| felt - velocity)
    };
    let relative = (0..count).map(relative).collect();
    (snapshot, relative)
}

impl Watch {
    fn new(job: &Job<'_>) -> Self {
        let sums = CellSums {
            cells: HashMap::new(),
            outside: [0.0; 2],
            at_belt: 0.0,
            instants: 0,
            above_belt: 0.0,
            by_momentum: f64::NAN,
        };
        Self { sums, place: job.place, hint: Hint::default(), turn: 0.5 }
    }

    /// Enters the drag on each element that hangs in the air, and its heat.
    ///
    /// The fibre at an instant is taken for the way of each of its elements.                     theory.md (121)
    fn see(
        &mut self,
        snapshot: &Snapshot,
        relative: &[Vec3<Lanes>],
        lane: usize,
        fitting: &Fitting<'_>,
        balance: &MomentumBalance,
    ) {
        let Fitting { placed, cells, distance, across: [low, width], filament, along } = fitting;
        let filament = filament.as_ref().ok();
        let mut temperature = filament.map_or(f64::NAN, |filament| filament.at_start);
        // The first element has the fibre between the inlet and the root with it.
        let mut before = snapshot.position.first().map_or(0.0, |root| root.lane(lane).dot(*along));
        self.sums.instants += 1;
        self.turn = (self.turn + GOLDEN).fract();
        for j in 0..snapshot.nodes[lane].saturating_sub(1) {
            let [above, below] = [j, j + 1].map(|node| snapshot.position[node].lane(lane));
            let middle = (above + below) * 0.5;
            // The others lie on the belt.
            if middle.x >= *distance {
                continue;
            }
            let (drag, relative) = (snapshot.drag[j].lane(lane), relative[j].lane(lane));
            self.sums.above_belt -= drag.x * balance.share_above_belt(middle.x);
            let cool = |filament: &SolidFilament<'_>| {
                let edge = below - above;
                let length = edge.norm();
                let faster = relative.dot(edge) / length;
                let cross = (relative.dot(relative) - faster * faster).max(0.0).sqrt();
                filament.cool(temperature, length + before, [faster, cross])
            };
            let cooled = filament.map_or(Cooled { temperature, heat: 0.0, per_kelvin: 0.0 }, cool);
            (temperature, before) = (cooled.temperature, 0.0);
            // The filaments stand everywhere across the width, and those beyond one side come in from the other.
            let z = low + ((middle.z - low) / width + self.turn).rem_euclid(1.0) * width;
            let at = placed.in_field(Vec3::new(middle.x, middle.y + self.place.y, z));
            let Some(cell) = cells.find(at, &mut self.hint) else {
                self.sums.outside[0] -= drag.x;
                self.sums.outside[1] += cooled.heat;
                continue;
            };
            let speed = relative.dot(relative);
            let per_velocity = if speed > 0.0 { (drag.dot(relative) / speed).max(0.0) } else { 0.0 };
            let force = placed.turned(-drag);
            let (sums, hits) = self.sums.cells.entry(cell as u32).or_default();
            let terms = [force.x, force.y, force.z, per_velocity, cooled.heat, cooled.per_kelvin];
            sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
            *hits += 1;
        }
        self.sums.at_belt += temperature;
    }
}
