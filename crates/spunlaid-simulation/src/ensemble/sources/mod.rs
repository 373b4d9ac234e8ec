//! What the filaments of a curtain do to each cell of the CFD field in which they fly: sources of momentum and heat.
//!
//! ```text
//! flight, instant by instant → drag and heat of each element, in the cell around it → CellSums of a replicate
//! CellSums of all replicates × filaments per metre of width / volume of the cell → Sources
//! ```
//!
//! Each cell gets the force that the flights have exerted on its air, and the heat that hot filaments have given it.
//!                                                                            theory.md (120), (121)

mod merged;
#[cfg(test)]
mod tests;
mod watch;

use super::{Job, LostFibre, in_order};
use merged::Merged;
use spunlaid_air::motion::temperature_of;
use spunlaid_air::{FieldCells, Flow, PlacedField};
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Case, SolidFilament};
use spunlaid_ground::place::Inlet;
use spunlaid_ground::{Difference, Error, Estimate, Fault, NORMAL_95, RunContext, Vec3, WIDTH};
use watch::{CellSums, fly_each};

/// Part of the force by which the two ways to find it may differ: the belt disturbs the last elements.
const FAR: f64 = 0.05;
/// Standard errors beyond which a difference is none by chance, of many replicates.
const ERRORS: f64 = 3.0;
/// Replicates below which the errors themselves are too uncertain, and the part by which the two forces may then
/// differ.
const FEW: u64 = 3;
const FAR_OF_FEW: f64 = 0.25;

/// The filaments of a line.
#[derive(Clone, Debug, PartialEq)]
pub struct LineFilaments {
    /// Filaments per metre of width [1/m].
    pub filaments_per_metre: f64,
    /// Where they are fed, from the middle of the slot in machine direction [m], in increasing order. The simulated
    /// ones are spread evenly over this list. Empty if all are fed in the middle.
    pub inlets: Vec<f64>,
}

/// The force of the filaments on the air of each cell, `Su + Sp U` per volume, and their heat, as means over time and
/// replicates.
///
/// Vectors and places are those of the field, so that it can be given back to the program that has made it.
#[derive(Clone, Debug)]
pub struct Sources {
    /// Filaments per metre of width [1/m].
    pub filaments_per_metre: f64,
    /// Number of simulated filaments without those that were lost.
    pub replicates: u64,
    /// The filaments that were lost. They are in no mean.
    pub lost: Vec<LostFibre>,
    /// Of each cell, in the order of [`FieldCells`].
    pub cells: Vec<CellSource>,
    /// Force on the air in all cells, in the frame of the field [N/m].
    pub force: [Estimate; 3],
    /// The same along x of the case [N/m].
    pub along: Estimate,
    /// Along x of the case, outside of the cells [N/m].
    pub outside: Estimate,
    /// Force along x of the case between the inlet and 95 % of the way to the belt [N/m]: of the drag on the
    /// elements, and by the balance of the momentum of the same flights, which the belt disturbs below.
    pub above_belt: [Estimate; 2],
    /// Heat of the filaments between the inlet and the belt, or why it is not known. It is not in the cells then.
    pub heat: Result<HeatSums, Fault>,
}

/// Heat of the filaments between the inlet and the belt.
#[derive(Clone, Debug)]
pub struct HeatSums {
    /// In all cells [W/m].
    pub in_cells: Estimate,
    /// Outside of the cells [W/m].
    pub outside: Estimate,
    /// Temperature of the filaments at the inlet, which is that at the end of their spinline [K].
    pub at_inlet: f64,
    /// And at the belt [K].
    pub at_belt: Estimate,
    /// Temperature of the air [K].
    pub of_air: f64,
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
    /// Constant part of the heat per volume, `Sh` [W/m³].
    pub sh: f64,
    /// Its standard error [W/m³]; NaN of a single replicate.
    pub sh_error: f64,
    /// Part per temperature of the air, zero or negative [W/(m³ K)].
    pub sh_per_kelvin: f64,
    /// Its standard error [W/(m³ K)]; NaN of a single replicate.
    pub sh_per_kelvin_error: f64,
    /// Heat per volume in the given air [W/m³].
    pub heat: f64,
    /// Its standard error [W/m³]; NaN of a single replicate.
    pub heat_error: f64,
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
    /// If the case has no such cells ([`Sources::fault`]), or another thread stops the flights; and with the reason
    /// of the first lost fibre, if so many are lost that fewer than two are left, or none of a single one.
    pub fn fly(case: &Case, curtain: &LineFilaments, by: RunContext<'_>) -> Result<Self, Error> {
        let fitting = fitting(case).map_err(Error::Flight)?;
        let mut merged = Merged::new(case, &fitting);
        let each = WIDTH as u64;
        let flights = case.run.replicates.div_ceil(each) as usize;
        let (mut replicate, mut first_lost) = (0, None);
        in_order(
            flights,
            by.threads,
            |flight| {
                let first = flight as u64 * each;
                let last = case.run.replicates.min(first + each);
                let jobs: Vec<Job<'_>> =
                    (first..last).map(|replicate| curtain.job(case, replicate)).collect();
                fly_each(&jobs, &fitting, by)
            },
            |simulated: Result<Vec<Result<CellSums, Error>>, Error>| {
                for sums in simulated? {
                    match sums {
                        Ok(sums) => merged.add(&sums, curtain.filaments_per_metre),
                        Err(error) => {
                            merged.lose(LostFibre::new(replicate, &error));
                            first_lost.get_or_insert(error);
                        }
                    }
                    replicate += 1;
                }
                Ok::<(), Error>(())
            },
        )?;
        if let Some(error) = first_lost.filter(|_| merged.replicates() < case.run.replicates.min(2)) {
            return Err(error);
        }
        Ok(merged.finish(curtain.filaments_per_metre))
    }

    /// Whether the force by the drag is that by the balance of momentum, as far as the flights show. It is not while
    /// the filaments still come down or swing themselves in: their momentum then changes, and the sources are those
    /// of no steady air.
    pub fn are_steady(&self) -> bool {
        let [drag, balance] = &self.above_belt;
        let apart = (balance.mean - drag.mean).abs() / drag.mean.abs().max(balance.mean.abs());
        if self.replicates < FEW {
            return apart <= FAR_OF_FEW;
        }
        let difference = Difference::independent(&drag.values, &balance.values);
        apart <= FAR || difference.is_some_and(|of| of.value.abs() <= ERRORS * of.half_width() / NORMAL_95)
    }

    /// Why there are no sources of a case; none if they can be found.
    pub fn fault(case: &Case) -> Option<Fault> {
        fitting(case).err()
    }
}

impl LineFilaments {
    /// The curtain of a case whose spinline has one; None of any other.
    pub fn of_spinline(case: &Case) -> Option<Self> {
        let curtain = case.spinline.as_ref()?.curtain?;
        let filaments_per_metre = curtain.rows as f64 * curtain.filaments_per_metre;
        Some(Self { filaments_per_metre, inlets: Vec::new() })
    }

    fn job<'a>(&self, case: &'a Case, replicate: u64) -> Job<'a> {
        let share = (replicate as f64 + 0.5) / case.run.replicates as f64;
        let inlet = (share * self.inlets.len() as f64) as usize;
        let place = Inlet { y: self.inlets.get(inlet).copied().unwrap_or_default(), z: 0.0 };
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
    /// How the filament cools, or why this is not known.
    filament: Result<SolidFilament<'a>, Fault>,
    /// Direction of the feed.
    along: Vec3<f64>,
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
            "the air is not a CFD field, so it has no cells for sources",
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
    let [_, _, across] = placed.axes();
    if placed.field.plane_axis().is_some_and(|plane| plane != across.index) {
        return Err(Fault::new(
            "air.field is a plane flow that does not lie across the width of the line, so the width of \
             the line in its cells is not known",
            "write air.field_axis and air.field_machine_direction so that the air is the same along the cross \
             direction",
        ));
    }
    let (low, high) = placed.extent();
    let across = match cells.depth() {
        Some(depth) => [low.z - 0.5 * depth * placed.unit, depth * placed.unit],
        None => [low.z, high.z - low.z],
    };
    let (filament, along) = (filament(case), case.fibre.direction);
    Ok(Fitting { placed, cells, distance: line.distance, across, filament, along })
}

/// How the filament of a case cools below its spinline.
fn filament(case: &Case) -> Result<SolidFilament<'_>, Fault> {
    let line = case.spinline.as_deref().ok_or_else(|| {
        Fault::new(
            "the filaments come from no spinline, so their temperature is not known",
            "add [spinline] to get their heat too",
        )
    })?;
    let of_air = temperature_of(case.air.density).ok_or_else(|| {
        Fault::new(
            "the density of the air is not that of air in the atmosphere, so its temperature is not known",
            "write air.temperature instead of air.density to get the heat too",
        )
    })?;
    // The case could be read, so that its spinline has a steady state.
    let solution = line.solve(case.drag.along).map_err(|failure| failure.fault)?;
    Ok(SolidFilament::new(line, &solution, of_air))
}
