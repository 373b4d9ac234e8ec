//! What the filaments of a curtain do to each cell of the CFD field in which they fly: sources of momentum.
//!
//! ```text
//! flight, instant by instant → drag of each element, on the cell around it → CellSums of a replicate
//! CellSums of all replicates × filaments per metre of width / volume of the cell → Sources
//! ```
//!
//! Each cell gets the force that the flights have exerted on its air.         theory.md (120)

use super::{Job, RunControl, in_order};
use crate::air::{Flow, PlacedField};
use crate::case::Case;
use crate::chain::schemes::Scheme;
use crate::error::{Error, Fault};
use crate::fibre::Place;
use crate::field::{FieldCells, Hint};
use crate::flight::{Flight, Snapshot};
use crate::lanes::{Lanes, WIDTH};
use crate::observe::{MomentumBalance, NodeStates};
use crate::statistics::Estimate;
use crate::vec3::Vec3;
use std::collections::HashMap;
use std::sync::atomic::Ordering;

/// Fraction by which the place across the width moves on from one instant to the next: all places come equally often.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The filaments of a line.
#[derive(Clone, Debug, PartialEq)]
pub struct Curtain {
    /// Filaments per metre of width [1/m].
    pub filaments_per_metre: f64,
    /// Where they are fed, from the middle of the slot in machine direction [m], in increasing order. The flown ones are
    /// spread evenly over this list. Empty if all are fed in the middle.
    pub inlets: Vec<f64>,
}

/// The force of the filaments on the air of each cell, `Su + Sp U` per volume, as means over time and replicates.
///
/// Vectors and places are those of the field, so that it can be given back to the program that has made it.
#[derive(Clone, Debug)]
pub struct Sources {
    /// Filaments per metre of width [1/m].
    pub filaments_per_metre: f64,
    /// Number of flown filaments.
    pub replicates: u64,
    /// Of each cell, in the order of [`FieldCells`].
    pub cells: Vec<CellSource>,
    /// Force on the air in all cells, in the frame of the field [N/m].
    pub force: [Estimate; 3],
    /// The same along x of the case [N/m].
    pub along: Estimate,
    /// Along x of the case, outside of the cells [N/m].
    pub outside: Estimate,
    /// Force along x of the case between the inlet and 95 % of the way to the belt [N/m]: of the drag on the elements, and
    /// by the balance of the momentum of the same flights, which the belt disturbs below.
    pub above_belt: [Estimate; 2],
}

/// The source of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CellSource {
    /// Constant part of the force per volume [N/m³].
    pub su: [f64; 3],
    /// Its standard error [N/m³]; NaN of a single replicate.
    pub su_error: [f64; 3],
    /// Part per velocity of the air, zero or negative [N s/m⁴].
    pub sp: f64,
    /// Its standard error [N s/m⁴]; NaN of a single replicate.
    pub sp_error: f64,
    /// Mean velocity of the given air in the middle of the cell [m/s].
    pub velocity: [f64; 3],
    /// Volume [m³]; of a unit depth where the field has none.
    pub volume: f64,
    /// How many elements have been seen in it, at all instants of all replicates.
    pub hits: u64,
}

impl CellSource {
    /// The force on the air per volume in the given air [N/m³].
    pub fn force(&self) -> [f64; 3] {
        [0, 1, 2].map(|i| self.su[i] + self.sp * self.velocity[i])
    }
}

impl Sources {
    /// Flies the replicates of a case and finds what they do to the cells of its field.
    ///
    /// # Errors
    /// If the case has no such cells ([`Sources::fault`]), a fibre is lost, or another thread stops the flights.
    pub fn fly(case: &Case, curtain: &Curtain, by: RunControl<'_>) -> Result<Self, Error> {
        let fitting = fitting(case).map_err(Error::Flight)?;
        let mut merged = Merged::new(case, &fitting);
        let each = WIDTH as u64;
        let flights = case.run.replicates.div_ceil(each) as usize;
        in_order(
            flights,
            by.threads,
            |flight| {
                let first = flight as u64 * each;
                let last = case.run.replicates.min(first + each);
                let jobs: Vec<Job<'_>> =
                    (first..last).map(|replicate| curtain.job(case, replicate)).collect();
                fly_together(&jobs, &fitting, by)
            },
            |sums: Result<Vec<CellSums>, Error>| {
                sums?.iter().for_each(|sums| merged.add(sums, curtain.filaments_per_metre));
                Ok::<(), Error>(())
            },
        )?;
        Ok(merged.finish(curtain.filaments_per_metre))
    }

    /// Why there are no sources of a case; none if they can be found.
    pub fn fault(case: &Case) -> Option<Fault> {
        fitting(case).err()
    }
}

impl Curtain {
    /// The curtain of a case whose spinline has one; None of any other.
    pub fn of_spinline(case: &Case) -> Option<Self> {
        let curtain = case.spinline.as_ref()?.curtain?;
        let filaments_per_metre = curtain.rows as f64 * curtain.filaments_per_metre;
        Some(Self { filaments_per_metre, inlets: Vec::new() })
    }

    fn job<'a>(&self, case: &'a Case, replicate: u64) -> Job<'a> {
        let share = (replicate as f64 + 0.5) / case.run.replicates as f64;
        let inlet = (share * self.inlets.len() as f64) as usize;
        let place = Place { y: self.inlets.get(inlet).copied().unwrap_or_default(), z: 0.0 };
        Job { case, replicate, place }
    }
}

/// A case whose sources can be found, in its field.
#[derive(Debug)]
struct Fitting<'a> {
    placed: &'a PlacedField,
    cells: FieldCells<'a>,
    /// Distance from the inlet to the belt [m].
    distance: f64,
    /// The lowest place of the field across the width, and how wide it is [m].
    across: [f64; 2],
}

fn fitting(case: &Case) -> Result<Fitting<'_>, Fault> {
    let Some(line) = case.line else {
        return Err(Fault::new(
            "the fibre has a fixed length, and sources are those of the filaments of a line",
            "give the case the tables [feed] and [belt]",
        ));
    };
    let Flow::Field(placed) = &case.air.flow else {
        return Err(Fault::new(
            "the air is no CFD field, so it has no cells for sources",
            "give the file of a CFD solution in air.field",
        ));
    };
    if case.run.scheme != Scheme::ImplicitTension {
        return Err(Fault::new(
            "the drag on each element is known with implicit tension only",
            "set run.scheme = \"implicit-tension\"",
        ));
    }
    let cells = placed.field.cells().ok_or_else(|| {
        Fault::new(
            "air.field has points without cells, so there are no cells for sources",
            "export the cells of the CFD solution, as .vtu or .vtk",
        )
    })?;
    let width = placed.turned(Vec3::new(0.0, 0.0, 1.0));
    let axis = [width.x, width.y, width.z].iter().position(|share| *share != 0.0);
    if placed.field.plane_axis().is_some_and(|plane| Some(plane) != axis) {
        return Err(Fault::new(
            "air.field is a plane flow that does not lie across the width of the line, so its cells hold the \
             filaments of no known width",
            "turn the CFD model, or set air.field_axis, so that the air is the same along the cross direction z",
        ));
    }
    let (low, high) = placed.extent();
    let across = match cells.depth() {
        Some(depth) => [low.z - 0.5 * depth * placed.unit, depth * placed.unit],
        None => [low.z, high.z - low.z],
    };
    Ok(Fitting { placed, cells, distance: line.distance, across })
}

/// What a replicate has done: sums over instants.
#[derive(Debug)]
struct CellSums {
    /// Of each cell that it has met: force in the frame of the field [N], drag per velocity [kg/s], and elements seen.
    cells: HashMap<u32, ([f64; 4], u64)>,
    /// Force outside of the cells along x of the case [N].
    outside: f64,
    instants: u64,
    /// Force along x above the belt, of the drag [N].
    above_belt: f64,
    /// And by the balance of momentum, as a mean over the instants [N].
    by_momentum: f64,
}

/// Looks at the fibre in a lane.
#[derive(Debug)]
struct Watch {
    sums: CellSums,
    place: Place,
    hint: Hint,
    /// Where in the width the fibre is taken to be, as a share of it.
    turn: f64,
}

/// Flies up to eight replicates to the end of their case.
fn fly_together(jobs: &[Job<'_>], fitting: &Fitting<'_>, by: RunControl<'_>) -> Result<Vec<CellSums>, Error> {
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
            let (snapshot, elements) = Elements::see(&mut flight, step);
            for (lane, (watch, balance)) in watches.iter_mut().zip(&balances).enumerate() {
                watch.see((&snapshot, &elements), lane, fitting, balance);
            }
            let tension_lag = flight.time_step();
            MomentumBalance::see(&mut balances, &NodeStates::of(&snapshot, jobs.len(), tension_lag));
            flight.advance(steps - 1);
        }
        if let Some((_, lost)) = flight.lost() {
            return Err(lost);
        }
        step += steps;
        (0..jobs.len()).for_each(|lane| drop(flight.take_laid(lane)));
        by.fibre_steps.fetch_add(steps * jobs.len() as u64, Ordering::Relaxed);
        if by.stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted);
        }
    }
    let finish = |(watch, balance): (Watch, MomentumBalance)| CellSums {
        by_momentum: balance.force_above_belt(),
        ..watch.sums
    };
    Ok(watches.into_iter().zip(balances).map(finish).collect())
}

/// The elements of eight fibres at an instant.
struct Elements {
    /// Of each element: the drag on it [N], and the velocity of the air relative to it [m/s].
    drag: Vec<Vec3<Lanes>>,
    relative: Vec<Vec3<Lanes>>,
}

impl Elements {
    /// Looks at a flight, which advances by one step.
    ///
    /// * `step` – number of that step, from 0
    fn see(flight: &mut Flight, step: u64) -> (Snapshot, Self) {
        let fed = flight.chain().fed();
        let snapshot = flight.observe();
        // Air that is known after the step has the numbers of after the step.
        let born = (flight.chain().fed() - fed) as usize;
        let count = snapshot.nodes.iter().copied().max().unwrap_or_default().saturating_sub(1);
        let (mut drag, mut relative) = (Vec::with_capacity(count), Vec::with_capacity(count));
        // A node has half of the drag of each element beside it, and the root that of the first one.
        let mut half = Vec3::ZERO;
        for j in 0..count {
            half = flight.chain().tensions.drag(j) - half;
            drag.push(half + half);
            let velocity = (snapshot.velocity[j] + snapshot.velocity[j + 1]) * Lanes::splat(0.5);
            let felt = flight.air_felt(j + born, step);
            relative.push(felt.map_or(Vec3::ZERO, |felt| felt - velocity));
        }
        (snapshot, Self { drag, relative })
    }
}

impl Watch {
    fn new(job: &Job<'_>) -> Self {
        let sums = CellSums {
            cells: HashMap::new(),
            outside: 0.0,
            instants: 0,
            above_belt: 0.0,
            by_momentum: f64::NAN,
        };
        Self { sums, place: job.place, hint: Hint::default(), turn: 0.5 }
    }

    /// Enters the drag on each element that hangs in the air.
    fn see(
        &mut self,
        (snapshot, elements): (&Snapshot, &Elements),
        lane: usize,
        fitting: &Fitting<'_>,
        balance: &MomentumBalance,
    ) {
        let Fitting { placed, cells, distance, across: [low, width] } = fitting;
        self.sums.instants += 1;
        self.turn = (self.turn + GOLDEN).fract();
        for j in 0..snapshot.nodes[lane].saturating_sub(1) {
            let middle = (snapshot.position[j].lane(lane) + snapshot.position[j + 1].lane(lane)) * 0.5;
            // The others lie on the belt.
            if middle.x >= *distance {
                continue;
            }
            let (drag, relative) = (elements.drag[j].lane(lane), elements.relative[j].lane(lane));
            self.sums.above_belt -= drag.x * balance.share_above_belt(middle.x);
            // The filaments stand everywhere across the width, and those beyond one side come in from the other.
            let z = low + ((middle.z - low) / width + self.turn).rem_euclid(1.0) * width;
            let at = placed.in_field(Vec3::new(middle.x, middle.y + self.place.y, z));
            let Some(cell) = cells.find(at, &mut self.hint) else {
                self.sums.outside -= drag.x;
                continue;
            };
            let speed = relative.dot(relative);
            let per_velocity = if speed > 0.0 { (drag.dot(relative) / speed).max(0.0) } else { 0.0 };
            let force = placed.turned(-drag);
            let (sums, hits) = self.sums.cells.entry(cell as u32).or_default();
            let terms = [force.x, force.y, force.z, per_velocity];
            sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
            *hits += 1;
        }
    }
}

/// The sums of all replicates.
struct Merged<'a> {
    fitting: &'a Fitting<'a>,
    cells: Vec<CellSource>,
    /// Of each cell that was met: sums of Su and Sp over replicates, and of their squares.
    sums: HashMap<u32, [[f64; 4]; 2]>,
    /// Of each replicate, per metre of width: force in the frame of the field, outside, and above the belt by drag and by momentum
    /// [N/m].
    forces: [Vec<f64>; 6],
}

impl<'a> Merged<'a> {
    fn new(case: &Case, fitting: &'a Fitting<'a>) -> Self {
        let (cells, unit) = (&fitting.cells, fitting.placed.unit);
        let mut hint = Hint::default();
        let of_case = case.air.speed_factor;
        let mut cell = |cell: usize| {
            let Vec3 { x, y, z } =
                fitting.placed.field.sample(cells.centre(cell), &mut hint).velocity * of_case;
            CellSource {
                velocity: [x, y, z],
                volume: cells.volume(cell) * unit.powi(3),
                ..CellSource::default()
            }
        };
        let cells = (0..cells.len()).map(&mut cell).collect();
        Self { fitting, cells, sums: HashMap::new(), forces: Default::default() }
    }

    /// Adds a replicate.
    fn add(&mut self, sums: &CellSums, filaments_per_metre: f64) {
        let per_instant = filaments_per_metre / sums.instants as f64;
        let mut met: Vec<_> = sums.cells.iter().collect();
        // In the same order whatever the map, so that the sums have the same bits.
        met.sort_unstable_by_key(|(cell, _)| **cell);
        let mut force = [0.0; 3];
        for (number, ([x, y, z, per_velocity], hits)) in met {
            let cell = &mut self.cells[*number as usize];
            let per_volume = per_instant * self.fitting.across[1] / cell.volume;
            let sp = -per_velocity * per_volume;
            let su = |i: usize, force: f64| force * per_volume - sp * cell.velocity[i];
            let terms = [su(0, *x), su(1, *y), su(2, *z), sp];
            let [sum, squares] = self.sums.entry(*number).or_default();
            for i in 0..4 {
                sum[i] += terms[i];
                squares[i] += terms[i] * terms[i];
            }
            cell.hits += hits;
            force.iter_mut().zip([x, y, z]).for_each(|(sum, term)| *sum += term * per_instant);
        }
        let [outside, above] = [sums.outside, sums.above_belt].map(|sum| sum * per_instant);
        let by_momentum = sums.by_momentum * filaments_per_metre;
        let [x, y, z] = force;
        self.forces
            .iter_mut()
            .zip([x, y, z, outside, above, by_momentum])
            .for_each(|(all, term)| all.push(term));
    }

    fn finish(mut self, filaments_per_metre: f64) -> Sources {
        let n = self.forces[0].len() as f64;
        for (number, [sum, squares]) in self.sums {
            let mean = sum.map(|sum| sum / n);
            let error = |i: usize| {
                let spread = squares[i] - sum[i] * mean[i];
                if n > 1.0 { (spread.max(0.0) / (n - 1.0) / n).sqrt() } else { f64::NAN }
            };
            let cell = &mut self.cells[number as usize];
            (cell.su, cell.su_error) = ([mean[0], mean[1], mean[2]], [error(0), error(1), error(2)]);
            (cell.sp, cell.sp_error) = (mean[3], error(3));
        }
        let [x, y, z, outside, above, by_momentum] = self.forces;
        let along = self.fitting.placed.turned(Vec3::new(1.0, 0.0, 0.0));
        let share = |i: usize| x[i] * along.x + y[i] * along.y + z[i] * along.z;
        Sources {
            filaments_per_metre,
            replicates: n as u64,
            cells: self.cells,
            along: Estimate::new((0..x.len()).map(share).collect()),
            outside: Estimate::new(outside),
            above_belt: [above, by_momentum].map(Estimate::new),
            force: [x, y, z].map(Estimate::new),
        }
    }
}

#[cfg(test)]
mod tests;
